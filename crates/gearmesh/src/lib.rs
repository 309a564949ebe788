//! Spur gears with modified teeth: geometry, stiffness, contact, transmission error, and the search for good ones.
//!
//! Names are those of ISO 21771 and ISO 6336. Everything is in SI and `f64`: metres, newtons, pascals, radians. Kernels are
//! pure: no input or output, no clock, no global state; sums have a fixed order, so the same input gives the same bits on
//! any number of threads. Must not know: YAML, studies, files.
//!
//! The way from a pair to its transmission error is [`gear::geometry::GearPair`] → [`gear::compliance::Method::tabulate`] →
//! [`gear::mesh::Mesh`], which no modification changes → [`gear::mesh::MeshedDesign`], the gaps of one design →
//! [`gear::mesh::Loaded`], one torque → its curve, its summary, its peak-to-peak. [`prelude`] has the names that this takes.
//!
//! # The transmission error of a relieved pair
//!
//! ```
//! use gearmesh::prelude::*;
//!
//! fn main() -> Result<(), Box<dyn std::error::Error>> {
//!     let gear = |teeth, bore| Specification::spur(teeth, mm(3.0)).face_width(mm(20.0)).bore_radius(mm(bore));
//!     let pair = GearPair::new(gear(24, 18.0), gear(36, 28.0), None)?;
//!     let mesh = Mesh::by(&pair, &Energy::default())?;
//!     let design = Design::of(Gears::Both, &TipRelief::linear(um(14.0), Start::Fraction(0.8)), &pair)?;
//!     for point in mesh.loaded(&design, 150.0).curve(Wanted::default()) {
//!         println!("{:.4} mm: {:.3} um", point.cycle_position * 1e3, point.transmission_error * 1e6);
//!     }
//! #   let error = |design: &Design| mesh.loaded(design, 150.0).peak_to_peak();
//! #   assert!(error(&design) < 0.2 * error(&Design::default()));
//!     Ok(())
//! }
//! ```
//!
//! [`gear::mesh::Loaded::ask`] gives any of [`gear::mesh::answers::quantities::QUANTITIES`] without the curve; a curve with
//! its summary has peak-to-peak, mean, variance and harmonics.
//!
//! # The best relief for a torque
//!
//! ```
//! use gearmesh::prelude::*;
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let gear = |teeth, bore| Specification::spur(teeth, mm(3.0)).face_width(mm(20.0)).bore_radius(mm(bore));
//! # let pair = GearPair::new(gear(24, 18.0), gear(36, 28.0), None)?;
//! # let mesh = Mesh::by(&pair, &Energy::default())?;
//! // Pair and mesh as above. Amount and fraction of long relief are free.
//! let peak_to_peak = |point: &Vec<f64>| -> Result<f64, Diagnostic> {
//!     let design = Design::of(Gears::Both, &TipRelief::linear(point[0], Start::Fraction(point[1])), &pair)?;
//!     Ok(mesh.loaded(&design, 150.0).peak_to_peak())
//! };
//! let bounds = Bounds::new(vec![(0.0, um(30.0)), (0.2, 1.0)])?;
//! let mut search = optimizer(&DifferentialEvolution::default(), bounds, Seed::new(1))?;
//! // A relief that does not fit is worth nothing.
//! let evaluate = |points: &[Vec<f64>]| -> Result<Vec<f64>, Failure> {
//!     Ok(points.iter().map(|point| peak_to_peak(point).unwrap_or(f64::INFINITY)).collect())
//! };
//! search.run(evaluate)?;
//! let best = search.best().ok_or("nothing fits")?;
//! println!("{:.2} um over {:.3}: {:.3} um", best.point[0] * 1e6, best.point[1], best.value * 1e6);
//! # assert!(best.value < peak_to_peak(&vec![14e-6, 0.8])?);
//! # Ok(())
//! # }
//! ```
//!
//! # A modification of your own
//!
//! What a drawing states is a struct that declares itself ([`gear::modification::Specified`]); what it comes to on a gear is
//! a depth over the roll angle, a deviation across the face, or what is not a sum of both, a surface over roll angle
//! and face ([`gear::modification::Modification`]), with any number of breaks. Solver and optimisers know it then;
//! studies know those of [`gear::modification::FAMILIES`]. The derive needs the crate `declare` beside this one.
//!
//! ```
//! use std::sync::Arc;
//!
//! use declare::Declared;
//! use declare::units::LENGTH;
//! use gearmesh::gear::modification::flank::Flank;
//! use gearmesh::gear::modification::{Modification, Specified};
//! use gearmesh::prelude::*;
//!
//! /// A wave over the active flank.
//! #[derive(Clone, Debug, Declared)]
//! #[declared(name = "wave")]
//! struct Wave {
//!     /// How deep it is.
//!     #[declared(dimension = LENGTH, minimum = 0.0, maximum = 1e-4, range)]
//!     pub amount: f64,
//! }
//!
//! impl Specified for Wave {
//!     fn on(&self, pair: &GearPair, side: Side) -> Result<Arc<dyn Modification>, Diagnostic> {
//!         let flank = Flank::new(pair, side);
//!         Ok(Arc::new(OnGear { amount: self.amount, from: flank.root_roll, to: flank.tip_roll }))
//!     }
//! }
//!
//! #[derive(Debug)]
//! struct OnGear {
//!     amount: f64,
//!     from: f64,
//!     to: f64,
//! }
//!
//! impl Modification for OnGear {
//!     fn depth(&self, roll: f64) -> f64 {
//!         let share = (roll - self.from) / (self.to - self.from);
//!         self.amount * (1.0 - (std::f64::consts::TAU * share).cos()) * 0.5
//!     }
//!
//!     fn varies_along_profile(&self) -> bool {
//!         true
//!     }
//!
//!     fn resolved(&self) -> Vec<(&'static str, f64)> {
//!         vec![("amount", self.amount)]
//!     }
//! }
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! # let gear = |teeth: u32, bore_radius: f64| Specification {
//! #     teeth,
//! #     module: 3e-3,
//! #     pressure_angle: 20_f64.to_radians(),
//! #     profile_shift: 0.0, thickness_allowance: 0.0, cutter: None,
//! #     rack: Rack::ISO_53_A,
//! #     tip_radius: None,
//! #     face_width: 20e-3,
//! #     bore_radius,
//! #     material: Material::STEEL,
//! # };
//! # let pair = GearPair::new(gear(24, 18e-3), gear(36, 28e-3), None)?;
//! let mut design = Design::default();
//! design.add(Gears::Pinion, &Wave { amount: 5e-6 }, &pair)?;
//! assert!(design.add(Gears::Pinion, &Wave { amount: 1.0 }, &pair).is_err());
//! # let middle = 0.5 * (Flank::new(&pair, Side::Pinion).root_roll + Flank::new(&pair, Side::Pinion).tip_roll);
//! # assert!((design.depth(Side::Pinion, middle) - 5e-6).abs() < 1e-15);
//! # Ok(())
//! # }
//! ```
//!
//! # What is stable
//!
//! Versions follow [Semantic Versioning](https://semver.org). Until 1.0 a minor version may rename and move; the changelog
//! names it. What [`prelude`] has is meant to stay. Names and meaning of declared fields, which studies are written in, only
//! gain members. `numeric`, `gear::finite_elements` and `gear::stability` are public for tests and benches: they may change in
//! any version.

#![warn(missing_docs, unreachable_pub)]

pub mod gear;
pub mod numeric;
pub mod optimize;
pub mod prelude;
