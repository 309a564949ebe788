//! The names that a program takes which computes a transmission error, or searches for a better one.
//!
//! Must not know: anything of its own.

pub use crate::gear::compliance::energy::{Energy, GearBody};
pub use crate::gear::compliance::finite_element::FiniteElement;
pub use crate::gear::compliance::iso6336::Iso6336;
pub use crate::gear::compliance::weber_banaschek::WeberBanaschek;
pub use crate::gear::compliance::{Assumptions, ContactLaw, Method, Tabulated};
pub use crate::gear::contact::{CornerContact, SliceCoupling};
pub use crate::gear::geometry::root::RootShape;
pub use crate::gear::geometry::{Gear, GearPair, Rack, Side, Specification};
pub use crate::gear::lengths::{mm, um};
pub use crate::gear::material::{Material, Plane};
pub use crate::gear::mesh::Loaded;
pub use crate::gear::mesh::answers::curve::Wanted;
pub use crate::gear::mesh::{Mesh, Settings};
pub use crate::gear::modification::arc::ArcRelief;
pub use crate::gear::modification::curve::Curve;
pub use crate::gear::modification::end_relief::{EndRelief, FaceEnd};
pub use crate::gear::modification::helix_slope::HelixSlope;
pub use crate::gear::modification::lead_crowning::LeadCrowning;
pub use crate::gear::modification::measured::{Measured, Smoothing};
pub use crate::gear::modification::parabola::ParabolicRelief;
pub use crate::gear::modification::profile_crowning::ProfileCrowning;
pub use crate::gear::modification::profile_slope::ProfileSlope;
pub use crate::gear::modification::relief::{Amount, FromRoot, FromTip, IsoAmount, Start};
pub use crate::gear::modification::root_relief::RootRelief;
pub use crate::gear::modification::tip_curve::{FlankPoint, Formulas, Through, TipPoint};
pub use crate::gear::modification::tip_relief::TipRelief;
pub use crate::gear::modification::{Design, Gears};
pub use crate::optimize::bounds::Bounds;
pub use crate::optimize::differential_evolution::DifferentialEvolution;
pub use crate::optimize::genetic::Genetic;
pub use crate::optimize::nelder_mead::NelderMead;
pub use crate::optimize::powell::Powell;
pub use crate::optimize::{optimizer, search::Optimizer};
pub use declare::error::{Diagnostic, Failure};
pub use declare::seed::Seed;
