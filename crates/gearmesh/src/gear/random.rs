//! For tests only: random pairs, loads and designs as they occur, the same ones each time.
//!
//! The program's tests have this file too, for populations that take longer than tests of the kernels may. Must not know:
//! what is tested with them.

use chacha20::ChaCha8Rng;
use rand_core::{Rng, SeedableRng};

use crate::gear::compliance::energy::Energy;
use crate::gear::compliance::{Assumptions, ContactLaw, Method};
use crate::gear::geometry::root::RootShape;
use crate::gear::geometry::{GearPair, Rack, Specification};
use crate::gear::material::Material;
use crate::gear::mesh::{Loaded, Mesh, Settings};
use crate::gear::modification::curve::Curve;
use crate::gear::modification::end_relief::{EndRelief, FaceEnd};
use crate::gear::modification::helix_slope::HelixSlope;
use crate::gear::modification::lead_crowning::LeadCrowning;
use crate::gear::modification::relief::{Amount, FromTip, Start};
use crate::gear::modification::tip_relief::TipRelief;
use crate::gear::modification::{Design, Gears};

/// Draws from ranges.
pub(crate) struct Random(ChaCha8Rng);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    /// 0 to 1.
    pub(crate) fn share(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, minimum: f64, maximum: f64) -> f64 {
        minimum + (maximum - minimum) * self.share()
    }

    /// Evenly over the orders of magnitude.
    pub(crate) fn scaled(&mut self, minimum: f64, maximum: f64) -> f64 {
        libm::exp(self.between(libm::log(minimum), libm::log(maximum)))
    }

    pub(crate) fn of<T: Copy>(&mut self, choices: &[T]) -> T {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
        let index = (self.share() * choices.len() as f64) as usize;
        choices[index]
    }

    /// A possible pair: 12 to 60 teeth with up to five times as many, module 1 to 8 mm, shifted or not.
    pub(crate) fn pair(&mut self) -> GearPair {
        loop {
            let module = self.scaled(1e-3, 8e-3);
            let angle = self.of(&[17.5_f64, 20.0, 20.0, 22.5, 25.0]).to_radians();
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let pinion = self.between(12.0, 61.0) as u32;
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
            let gear = (f64::from(pinion) * self.between(1.0, 5.0)) as u32;
            let shifts = if self.share() < 0.5 { [0.0; 2] } else { [self.between(0.0, 0.5), self.between(-0.4, 0.3)] };
            let width = module * self.between(3.0, 15.0);
            let rack = Rack { addendum: 1.0, dedendum: 1.25, tip_radius: self.between(0.1, 0.3), ..Rack::ISO_53_A };
            let bore = self.between(1.4, 4.0);
            let of = |teeth: u32, profile_shift: f64| Specification {
                teeth,
                module,
                pressure_angle: angle,
                profile_shift,
                thickness_allowance: 0.0,
                cutter: None,
                rack,
                tip_radius: None,
                face_width: width,
                bore_radius: module * (0.5 * f64::from(teeth) + profile_shift - 1.25) / bore,
                material: Material::STEEL,
            };
            // Corner contact is not modelled where contact ends at a form circle.
            if let Ok(pair) = GearPair::new(of(pinion, shifts[0]), of(gear, shifts[1]), None)
                && pair.refuse_interference().is_ok()
            {
                return pair;
            }
        }
    }

    /// A torque that bends the teeth by about 1 to 30 µm \[N m\].
    pub(crate) fn torque(&mut self, pair: &GearPair) -> f64 {
        let width = pair.pinion.specification.face_width;
        self.scaled(2e4, 6e5) * width * pair.pinion.base_radius
    }

    /// Profile and lead modifications of a few micrometres; some have no closed form across the face.
    pub(crate) fn design(&mut self, pair: &GearPair) -> Design {
        loop {
            let curve = self.of(&["linear", "parabolic", "power"]);
            let (amount, fraction, exponent) =
                (self.between(0.0, 20e-6), self.between(0.2, 1.0), self.between(1.2, 3.0));
            let tip = TipRelief {
                amount: Amount::Depth(amount),
                start: Start::Fraction(fraction),
                counted_from: FromTip::Tip,
                curve: match curve {
                    "linear" => Curve::Linear,
                    "parabolic" => Curve::Parabolic,
                    _ => Curve::Power { exponent },
                },
            };
            let crown = LeadCrowning { amount: self.between(0.0, 15e-6) };
            let slope = HelixSlope { amount: self.between(-15e-6, 15e-6) };
            let width = pair.pinion.specification.face_width;
            let end = EndRelief {
                amount: self.between(1e-6, 20e-6),
                length: width * self.between(0.1, 0.45),
                end: FaceEnd::Both,
                curve: Curve::Power { exponent: self.between(1.2, 3.5) },
            };
            let mut design = Design::default();
            let mut fits = true;
            if self.share() < 0.8 {
                fits &= design.add(self.of(&[Gears::Pinion, Gears::Gear, Gears::Both]), &tip, pair).is_ok();
            }
            if self.share() < 0.5 {
                fits &= design.add(Gears::Pinion, &crown, pair).is_ok();
            }
            if self.share() < 0.3 {
                fits &= design.add(Gears::Gear, &slope, pair).is_ok();
            }
            if self.share() < 0.6 {
                fits &= design.add(self.of(&[Gears::Pinion, Gears::Gear]), &end, pair).is_ok();
            }
            if fits {
                return design;
            }
        }
    }

    /// A design of a random pair under a load, the teeth by the energy method.
    pub(crate) fn case(&mut self, settings: Settings) -> Case {
        loop {
            let pair = self.pair();
            let contact = self.of(&[ContactLaw::Linear, ContactLaw::LoadDependent]);
            let coupled = self.share() < 0.2;
            let assumptions = Assumptions { root: RootShape::Trochoid, contact, coupled, torque: None, accuracy: None };
            if let Ok(found) = (Energy { harmonics: 10, ..Energy::default() }).tabulate(&pair, assumptions) {
                let cycle = Mesh::new(&pair, &found.compliance, settings).unwrap();
                let (design, torque) = (self.design(&pair), self.torque(&pair));
                return Case { cycle, design, torque };
            }
        }
    }
}

/// A design under a load.
pub(crate) struct Case {
    pub(crate) cycle: Mesh,
    pub(crate) design: Design,
    pub(crate) torque: f64,
}

impl Case {
    pub(crate) fn load_case(&self) -> Loaded<'_> {
        self.cycle.loaded(&self.design, self.torque)
    }
}
