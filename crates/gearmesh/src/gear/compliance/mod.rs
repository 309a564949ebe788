//! Compliance of teeth: what every method gives, as functions of the roll angle of the loaded point.
//!
//! Micro-geometry never enters these tables; it only changes gaps. Lengths in m, forces in N.
//! Must not know: modification, load.

pub mod across_face;
pub mod energy;
pub mod finite_element;
pub mod inclined;
pub mod iso6336;
pub mod ring;
pub mod sainsot;
#[cfg(test)]
mod tests;
pub mod weber_banaschek;

use std::any::Any;
use std::fmt::Debug;

use self::inclined::Inclined;
use super::finite_elements::MeshError;
use super::geometry::error::{GeometryError, Millimetres, Plain};
use super::geometry::root::RootShape;
use super::geometry::{GearPair, Side};
use crate::gear::material::Plane;
use crate::gear::work::COMPLIANCE_EVALUATIONS;
use crate::numeric::chebyshev::{Series, nodes};
use crate::numeric::complementarity::MOST_SPRINGS;
use crate::numeric::parabola::peak;
use crate::numeric::surface::Surface;
use declare::declared::Registrable;
use declare::work::Work;
use declare::{Words, registry};

registry!(
    METHODS: Method = energy::Energy,
    weber_banaschek::WeberBanaschek,
    iso6336::Iso6336,
    finite_element::FiniteElement,
);

/// A way to the compliance of a pair: a declared struct, which anybody can make.
pub trait Method: Any + Debug + Registrable + Send + Sync {
    /// Whether it knows a pair of teeth only as a whole, so that root, contact law and coupling mean nothing to it.
    fn whole_pair(&self) -> bool {
        false
    }

    /// Whether it cannot treat a root with a sharp corner, the shape `base_circle`.
    fn needs_fillet(&self) -> bool {
        false
    }

    /// The contact law that goes with it where none is asked for.
    fn usual_contact(&self) -> ContactLaw {
        ContactLaw::Linear
    }

    /// Whether it knows teeth with a contact law.
    fn knows(&self, contact: ContactLaw) -> bool {
        match contact {
            ContactLaw::Linear => true,
            ContactLaw::LoadDependent => !self.whole_pair(),
            ContactLaw::Resolved => false,
        }
    }

    /// The tables of a pair, with sentences for the user where a formula is used outside its range.
    ///
    /// # Errors
    /// When the method does not hold for this pair.
    fn tabulate(&self, pair: &GearPair, assumptions: Assumptions) -> Result<Tabulated, ComplianceError>;

    /// What it takes to tabulate a pair.
    fn foresee(&self, assumptions: Assumptions) -> Foreseen {
        integrated(assumptions)
    }

    /// Itself as a method that knows the stress at the roots: those that mesh the teeth.
    fn root_stresses(&self) -> Option<&dyn RootStresses> {
        None
    }
}

/// A method that knows the largest stress at the root of both gears' teeth.
pub trait RootStresses {
    /// About how many influences [`Self::tabulate_with_roots`] gives, of pinion and gear together.
    fn foresee_influences(&self, assumptions: Assumptions) -> usize;

    /// What [`Method::tabulate`] gives, and the influences of loads on the roots of pinion and gear, from meshes of their own.
    ///
    /// # Errors
    /// When the method does not hold for this pair.
    fn tabulate_with_roots(
        &self,
        pair: &GearPair,
        assumptions: Assumptions,
    ) -> Result<(Tabulated, [RootInfluences; 2]), ComplianceError>;
}

/// What loads on the flanks of a gear's teeth do to the surface of one tooth's root, on the side of the loads.
#[derive(Clone, Debug, PartialEq)]
pub struct RootInfluences {
    /// Radii of places along that surface, from the root land up to the involute \[m\].
    pub radii: Vec<f64>,
    /// Their lengths along the surface \[m\], ascending.
    pub lengths: Vec<f64>,
    /// Stress along the surface per load per face width \[1/m\], positive in tension, against the roll angle of the load
    /// \[rad\]; by the loaded tooth, then by place. The loaded teeth are an odd number with the tooth itself in the middle,
    /// before it those behind, after it those further on, where roll angles are larger.
    pub stresses: Vec<Vec<Series>>,
    /// The same under a load along the flank, towards the root, at the tip: what inclined loads at its corner have of it. By
    /// the loaded tooth, then by place; no places where contact is not resolved.
    pub along: Vec<Vec<f64>>,
    /// Estimated error of the largest stress under any load, relative to it.
    pub error_estimate: f64,
}

impl RootInfluences {
    /// The largest stress of a tooth under loads of its own, at the nodes of the tables; of the gear that has these roots.
    #[must_use]
    pub fn largest(&self, side: Side) -> Vec<RootStress> {
        let own = &self.stresses[self.stresses.len() / 2];
        let Some(first) = own.first() else { return Vec::new() };
        let of_places: Vec<Vec<f64>> = own.iter().map(Series::node_values).collect();
        let rolls = nodes(first.lower(), first.upper(), first.coefficients().len());
        let row = |(node, roll): (usize, f64)| {
            let stresses: Vec<f64> = of_places.iter().map(|values| values[node]).collect();
            let (stress, radius) = peak(&self.lengths, &self.radii, &stresses)?;
            Some(RootStress { side, roll, stress, radius, error_estimate: self.error_estimate })
        };
        rolls.into_iter().enumerate().filter_map(row).collect()
    }
}

/// What a method takes, before it runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Foreseen {
    /// About how many nodes the series of both teeth have.
    pub nodes: usize,
    /// About the most nodes that the tables of neighbours of both have; 0 where there are none.
    pub neighbours: usize,
    /// What it counts of its work: compliances that are evaluated or, where teeth are meshed, sectors that are
    /// factorised.
    pub work: Work,
    /// How many times as long as usual a unit of work takes.
    pub times: f64,
    /// The most bytes that it holds.
    pub memory: u64,
}

/// What methods take that integrate along a tooth: series of some dozens of nodes and, where teeth are coupled, a table of
/// every pair of nodes for up to three neighbours.
fn integrated(assumptions: Assumptions) -> Foreseen {
    Foreseen {
        nodes: 128,
        neighbours: if assumptions.coupled { 3000 } else { 0 },
        work: Work::of(&COMPLIANCE_EVALUATIONS, 224),
        times: if assumptions.coupled { 4.0 } else { 1.0 },
        memory: 4 << 20,
    }
}

/// What every method is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Assumptions {
    /// Shape of the root of every tooth; methods that know a pair only as a whole ignore it.
    pub root: RootShape,
    /// How two flanks flatten against each other; methods that know a pair only as a whole ignore it.
    pub contact: ContactLaw,
    /// Whether loads on neighbouring teeth are to deflect each other through the gear bodies.
    pub coupled: bool,
    /// Torque on the pinion \[N m\] where the study names one: for what a method has to say about its range, never for a
    /// compliance.
    pub torque: Option<f64>,
    /// Wanted error of a tooth's compliances, relative to its own; a method takes the cheapest settings that meet it. Without
    /// one it takes those it is told, and its defaults.
    pub accuracy: Option<f64>,
}

impl Default for Assumptions {
    /// As a study that says nothing: generated roots, linear contact, teeth that deflect each other.
    fn default() -> Self {
        Self { root: RootShape::Trochoid, contact: ContactLaw::Linear, coupled: true, torque: None, accuracy: None }
    }
}

/// What a method gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Tabulated {
    /// The tables of both gears.
    pub compliance: PairCompliance,
    /// Sentences for the user, one for each formula that is used outside its range.
    pub warnings: Vec<String>,
    /// How far off the compliances may be from what the method would give with perfect numerics, in units of the tooth's
    /// own.
    pub error_estimate: f64,
    /// One per gear, for methods that mesh the teeth.
    pub meshes: Vec<MeshFacts>,
    /// What it took.
    pub work: Work,
}

/// The mesh a gear's compliance was found with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeshFacts {
    /// The gear that was meshed.
    pub side: Side,
    /// Elements across a tooth.
    pub elements_across: usize,
    /// Elements of one tooth with its share of the body; the gear has as many times its number of teeth.
    pub elements: usize,
    /// Unknown displacements of the same.
    pub unknowns: usize,
    /// How far off the compliances may be, relative to the tooth's own.
    pub error_estimate: f64,
}

/// The largest tension along the surface of a loaded tooth's root.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RootStress {
    /// The gear whose tooth is loaded.
    pub side: Side,
    /// Roll angle of the loaded point \[rad\].
    pub roll: f64,
    /// Per load per face width \[Pa/(N/m) = 1/m\].
    pub stress: f64,
    /// Radius of the place \[m\].
    pub radius: f64,
    /// Estimated relative error of the stresses of this gear.
    pub error_estimate: f64,
}

/// Relative error of what is integrated and interpolated to rounding, as values of another program with 40 digits bound it.
pub const ROUNDING: f64 = 1e-12;

/// What `tooth` gives for both gears; for gears that are alike it is called once.
///
/// # Errors
/// Those of `tooth`.
pub fn of_both<T: Clone, E>(pair: &GearPair, mut tooth: impl FnMut(Side) -> Result<T, E>) -> Result<[T; 2], E> {
    let pinion = tooth(Side::Pinion)?;
    let gear = if pair.pinion == pair.gear { pinion.clone() } else { tooth(Side::Gear)? };
    Ok([pinion, gear])
}

/// Why a method cannot give a compliance for a pair.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ComplianceError {
    /// The gear has no root of the shape that is asked for, such as fillets that would overlap.
    #[error(transparent)]
    Root(GeometryError),
    /// The tip is so nearly pointed that no series of 512 nodes follows the compliance up to it.
    #[error("{}: the tip is too near to a point to be integrated: it is {} thick", .side.name(), Millimetres(*.thickness))]
    Unresolved {
        /// The gear with that tip.
        side: Side,
        /// s_a \[m\].
        thickness: f64,
    },
    /// A broken tip that is narrower than contacts are.
    #[error("{}: the chamfer or rounding at its tip is {}; resolved contact takes {} or more, or a tip without one: smaller ones are narrower than the contact", .side.name(), Millimetres(*.size), Millimetres(*.minimum))]
    SmallTipBreak {
        /// The gear with that tip.
        side: Side,
        /// Size of the chamfer or radius of the rounding \[m\].
        size: f64,
        /// The least \[m\].
        minimum: f64,
    },
    /// The bore is outside the range in which the formula of Sainsot, Velex and Duverger can be used for the gear body.
    #[error("{}: the root radius is {} times the bore radius, but must be {} to {} times it for the gear body formula; the body `ring` takes any bore", .side.name(), Plain(*.bore_ratio), Plain(.range[0]), Plain(.range[1]))]
    BoreOfFormula {
        /// The gear with that bore.
        side: Side,
        /// h = r_f/r_bore.
        bore_ratio: f64,
        /// Least and most of h.
        range: [f64; 2],
    },
    /// θ_f is below what the formula of the gear body can be used for: there are too many teeth.
    #[error("{}: the half root angle is {} rad, but must be at least {} rad for the gear body formula; the body `ring` takes any number of teeth", .side.name(), Plain(*.half_angle), Plain(*.minimum))]
    ManyTeeth {
        /// The gear with these teeth.
        side: Side,
        /// θ_f \[rad\].
        half_angle: f64,
        /// The least θ_f \[rad\].
        minimum: f64,
    },
    /// The formula of the gear body gives a compliance that is not positive at some roll angle of the flank.
    #[error("{}: the gear body formula gives a negative compliance ({} m/N) at a half root angle of {} rad (fitted for 0.01 to 0.12) and a root-to-bore ratio of {} (fitted for 1.4 to 7); the body `ring` takes any", .side.name(), Plain(*.compliance), Plain(*.half_angle), Plain(*.bore_ratio))]
    NegativeBody {
        /// The gear with that body.
        side: Side,
        /// 1/k_f \[m/N\], 0 or less.
        compliance: f64,
        /// θ_f \[rad\].
        half_angle: f64,
        /// h = r_f/r_bore.
        bore_ratio: f64,
    },
    /// c′ of ISO 6336-1 is not a positive number for this pair.
    #[error("the formula of ISO 6336-1 gives no stiffness for these profile shifts, dedenda and pressure angle: c′ is {} N/(mm µm)", Plain(*.single * 1e-9))]
    NoIsoStiffness {
        /// c′ \[N/m²\].
        single: f64,
    },
    /// A gear cannot be meshed or solved with finite elements.
    #[error("{}, {across} elements across: {error}", .side.name())]
    Mesh {
        /// The gear that was meshed.
        side: Side,
        /// Elements across a tooth.
        across: usize,
        /// Why not.
        error: MeshError,
    },
    /// So little of the gear yields below the contact that a half plane down to the contact's length is softer.
    #[error("{}: at a roll angle of {} rad the tooth and its body yield less than the half plane at the contact does within {}, so that nothing is left for resolved contact; a smaller bore leaves some, and where the load line meets the centreline of the tooth outside the bore `contact: load_dependent` needs none", .side.name(), Plain(*.roll), Millimetres(*.length))]
    Stiff {
        /// The gear.
        side: Side,
        /// Where on its flank \[rad\].
        roll: f64,
        /// The length of the law \[m\].
        length: f64,
    },
    /// ν is above what the elements take in plane strain.
    #[error("{}: Poisson's ratio is {}, but must be 0 to {} in plane strain: nearer to incompressible the elements lock; `plane: stress` takes any", .side.name(), Plain(*.poisson_ratio), Plain(*.maximum))]
    Incompressible {
        /// The gear of that material.
        side: Side,
        /// ν.
        poisson_ratio: f64,
        /// The largest ν that they take in plane strain.
        maximum: f64,
    },
}

/// The compliances \[m/N\] of one gear's tooth over the whole of its face width, against the roll angle \[rad\] of the
/// contact point.
#[derive(Clone, Debug, PartialEq)]
pub struct ToothCompliance {
    /// The tooth bent as a beam. ISO 6336 has half of the pair's compliance here, finite elements have 0.
    pub bending: Series,
    /// The tooth sheared; 0 by ISO 6336 and finite elements.
    pub shear: Series,
    /// The tooth compressed along its centreline; 0 by ISO 6336 and finite elements.
    pub axial: Series,
    /// Gear body under the tooth's own load.
    pub body: Series,
    /// Distance from the contact point to the tooth's centreline along the load line \[m\]: the depth t of the
    /// load-dependent contact laws.
    pub contact_depth: Series,
    /// B \[1/Pa\]: towards the corner of its tip a tooth yields by −B ln(c/m) more to a load per width, at the distance c
    /// along the flank. 0 but for resolved contact, where it is not in the other parts.
    pub corner: f64,
    /// Where contact is resolved: what loads do at the corner of the tip that are not normal to the flank.
    pub inclined: Option<Inclined>,
    /// Deflection at a tooth per load on the one k + 1 pitches further, in the sense in which the roll angles of loaded
    /// teeth grow. Arguments: the roll angles of the loaded points of the first and of the further tooth; on the line of
    /// action they differ by (k + 1)·2π/z, in corner contact by less. Reciprocal, so one table serves both.
    pub neighbours: Vec<Surface>,
}

impl ToothCompliance {
    /// Everything but the contact \[m/N\].
    #[must_use]
    pub fn total(&self, roll: f64) -> f64 {
        self.bending.value(roll) + self.shear.value(roll) + self.axial.value(roll) + self.body.value(roll)
    }

    /// Everything but the contact as one table, four times as fast to read; `None` when the parts' ranges differ.
    #[must_use]
    pub fn total_series(&self) -> Option<Series> {
        Series::sum(&[&self.bending, &self.shear, &self.axial, &self.body])
    }
}

/// How many teeth to one side of a loaded one can be loaded with it: as many pairs as share the contact, and in corner
/// contact one more at each end.
#[must_use]
pub fn neighbours(pair: &GearPair, side: Side) -> u32 {
    let teeth = pair.side(side).specification.teeth;
    // The contact ratio of what can be built is far below 2^32.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let [pairs, maximum] = [pair.contact_ratio.ceil() as u32 + 1, MOST_SPRINGS as u32 - 1];
    pairs.min(maximum).min(teeth - 1)
}

/// How two flanks flatten against each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum ContactLaw {
    /// 4(1 − ν²)/(π E b), whatever the load
    ///
    /// The article `energy_ga`.
    Linear,
    /// Weber and Banaschek: grows with the logarithm of the load
    ///
    /// 2/(πE′)·[ln(2t/b_H) − ν′/2] per body and load per width: each tooth is a half plane down to its centreline.
    LoadDependent,
    /// Half planes at the contact alone, teeth with their tips below it
    ///
    /// For finite elements, which know the difference.
    Resolved,
}

/// Everything the contact solver needs to know of a pair's elasticity.
#[derive(Clone, Debug, PartialEq)]
pub struct PairCompliance {
    /// The pinion's teeth, over the pinion's roll angles.
    pub pinion: ToothCompliance,
    /// The gear's teeth, over the gear's roll angles.
    pub gear: ToothCompliance,
    /// None where the compliances of the teeth include it already, for methods that know a pair as a whole.
    pub contact: Option<ContactLaw>,
    /// The plane state of the flanks: what contact takes for E.
    pub plane: Plane,
    /// Whether loads on neighbouring teeth deflect each other through the gear bodies.
    pub coupled: bool,
}
