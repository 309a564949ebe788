//! What the kernels count of their work, and about what a unit takes, as `make bench` has it on a quiet machine.
//!
//! Must not know: who adds it up.

use declare::work::Counter;

/// Roll angles at which the compliance of one tooth was found, on every mesh that was tried.
pub static COMPLIANCE_EVALUATIONS: Counter = Counter { name: "compliance_evaluations", seconds: 2e-5, adds: true };
/// Stiffness matrices of a tooth's sector that were factorised.
pub static MESH_FACTORISATIONS: Counter = Counter { name: "mesh_factorisations", seconds: 2e-2, adds: true };
/// Mesh positions at which the load was shared between the pairs.
pub static CONTACT_SOLVES: Counter = Counter { name: "contact_solves", seconds: 3e-7, adds: true };
/// The most slices that the face of a pair was cut into; 1 where one is enough. Each costs as part of its solve.
pub static SLICES: Counter = Counter { name: "slices", seconds: 0.0, adds: false };
/// Mesh positions at which the Hertzian pressure was found.
pub static CONTACT_PRESSURES: Counter = Counter { name: "contact_pressures", seconds: 6e-8, adds: true };
/// Mesh positions at which the stress at the roots of both gears was found.
pub static ROOT_STRESSES: Counter = Counter { name: "root_stresses", seconds: 2e-6, adds: true };
/// Whole outlines of teeth that were drawn or checked.
pub static OUTLINES: Counter = Counter { name: "outlines", seconds: 3e-5, adds: true };

/// All of them.
pub static COUNTERS: [&Counter; 7] = [
    &COMPLIANCE_EVALUATIONS,
    &MESH_FACTORISATIONS,
    &CONTACT_SOLVES,
    &SLICES,
    &CONTACT_PRESSURES,
    &ROOT_STRESSES,
    &OUTLINES,
];
