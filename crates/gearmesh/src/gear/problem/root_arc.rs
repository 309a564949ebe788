//! The article's optimisation of the root arc, equations 26 to 30, as printed and as corrected.
//!
//! As printed: least F = √(r_f² − x_c²) − y_c + r_c (28), r_c ≥ h_f (29), x_a ≤ x_c ≤ (x_a + x_a1)/2 with C on the line of
//! (30), which gives y_c. A is at the angle π/z + inv α/2 (26), past the middle of the space, so that no x_c is left,
//! whatever the gear. As corrected: A is at π/(2z) + inv α (more with a profile shift), the circle passes through it
//! along the flank, which gives x_c and y_c from r_c; its centre lies between tooth and middle of the space; and the
//! distance between circle and root circle must be least, not a difference of heights that may be negative. Source:
//! Zhai, Liang and Fu, Mathematical Problems in Engineering 2020. Must not know: how the arc is drawn.

use std::f64::consts::PI;

use super::{Problem, Stated, Variable, Worth};
use crate::gear::geometry::error::GeometryError;
use crate::gear::geometry::involute::involute;
use crate::gear::geometry::outline::roots::base_arc::{Base, Circle};
use crate::gear::geometry::outline::roots::optimised_arc;
use crate::gear::geometry::{Gear, GearPair, Side};
use declare::units::{Dimension, LENGTH};
use declare::{Declared, Words};

/// Which problem.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Words)]
pub enum Formulas {
    /// the problem as corrected; its variable is r_c
    #[default]
    Derived,
    /// the problem as printed; its variables are x_c and r_c
    Printed,
}

/// The root arc of zhai2020, equations 26 to 30.
#[derive(Clone, Debug, PartialEq, Declared)]
#[declared(name = "root_arc")]
pub struct RootArcProblem {
    /// Which problem.
    #[declared(default = "derived")]
    pub formulas: Formulas,
}

impl Stated for RootArcProblem {
    fn dimension(&self) -> Dimension {
        LENGTH
    }

    fn maximum(&self) -> [usize; 2] {
        [2, 3]
    }

    fn seconds(&self) -> f64 {
        1e-6
    }

    fn on(&self, pair: &GearPair, side: Side) -> Result<Box<dyn Problem>, GeometryError> {
        let arc = RootArc::new(pair.side(side))?;
        Ok(match self.formulas {
            Formulas::Derived => Box::new(Corrected(arc)),
            Formulas::Printed => Box::new(Printed(arc)),
        })
    }
}

/// What the article's equations name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RootArc {
    /// Circles, angles and the point A, which stay as they are.
    pub base: Base,
    best: Circle,
    /// h_f \[m\].
    dedendum: f64,
    /// The angle of A as printed \[rad\].
    printed_angle: f64,
}

impl RootArc {
    /// # Errors
    /// When the root circle does not lie inside the base circle, or no space is left there.
    pub fn new(gear: &Gear) -> Result<Self, GeometryError> {
        let base = Base::new(gear, "the arc of zhai2020")?;
        let best = base.tangent_circle(optimised_arc::radius(&base));
        let dedendum = gear.reference_radius - gear.root_radius;
        let printed_angle = base.half_pitch + 0.5 * involute(gear.specification.pressure_angle);
        Ok(Self { base, best, dedendum, printed_angle })
    }

    /// Equations 17 to 20.
    #[must_use]
    pub fn article(&self) -> Circle {
        self.base.article_circle()
    }

    /// The solution of the corrected problem in closed form.
    #[must_use]
    pub fn optimum(&self) -> Circle {
        self.best
    }

    /// F of equation 28 \[m\]; NaN where the centre lies beyond the root circle's side.
    #[must_use]
    pub fn objective(&self, Circle { centre: [x, y], radius }: Circle) -> f64 {
        let root = self.base.root_radius;
        ((root - x) * (root + x)).sqrt() - y + radius
    }

    /// The inequalities of (29) and (30) for A at an angle: r_c − h_f, (x_a + x_a1)/2 − x_c, x_c − x_a \[m\].
    fn inequalities(&self, angle: f64, circle: Circle) -> [f64; 3] {
        let place = |angle: f64| self.base.base_radius * libm::sin(angle);
        // A1 is the image of A in the middle of the space.
        let (own, next) = (place(angle), place(2.0 * self.base.half_pitch - angle));
        let x = circle.centre[0];
        [circle.radius - self.dedendum, 0.5 * (own + next) - x, x - own]
    }

    /// The article's inequalities with A in its true place.
    #[must_use]
    pub fn inequalities_derived(&self, circle: Circle) -> [f64; 3] {
        self.inequalities(self.base.angle, circle)
    }

    /// The article's inequalities with A where equation 26 puts it.
    #[must_use]
    pub fn inequalities_printed(&self, circle: Circle) -> [f64; 3] {
        self.inequalities(self.printed_angle, circle)
    }

    /// The angle of A in equation 26 \[rad\]; derived it is [`Base::angle`].
    #[must_use]
    pub fn printed_angle(&self) -> f64 {
        self.printed_angle
    }

    /// The circle of (30) as printed: y_c = k x_c + y_a + k x_a with k = tan of A's angle.
    fn on_printed_line(&self, x: f64, radius: f64) -> Circle {
        let (sine, cosine) = libm::sincos(self.printed_angle);
        let [x_a, y_a] = [self.base.base_radius * sine, self.base.base_radius * cosine];
        Circle { centre: [x, sine / cosine * (x + x_a) + y_a], radius }
    }
}

struct Printed(RootArc);

impl Problem for Printed {
    fn variables(&self) -> Vec<Variable> {
        let variable = |name, maximum| Variable { name, dimension: LENGTH, minimum: 0.0, maximum };
        // The tooth and its space; two dedenda.
        let width = self.0.base.base_radius * libm::sin((2.0 * self.0.base.half_pitch).min(0.5 * PI));
        vec![variable("x_c", width), variable("r_c", 2.0 * self.0.dedendum)]
    }

    fn constraints(&self) -> &'static [&'static str] {
        &["r_c - h_f", "(x_a + x_a1)/2 - x_c", "x_c - x_a"]
    }

    fn worth(&self, point: &[f64]) -> Worth {
        let circle = self.0.on_printed_line(point[0], point[1]);
        let constraints = self.0.inequalities_printed(circle).to_vec();
        Worth { objective: self.0.objective(circle), further: Vec::new(), constraints }
    }
}

struct Corrected(RootArc);

impl Problem for Corrected {
    fn variables(&self) -> Vec<Variable> {
        let base = &self.0.base;
        let maximum = 2.0 * base.touching_radius().max(base.middle_radius());
        vec![Variable { name: "r_c", dimension: LENGTH, minimum: 0.0, maximum }]
    }

    fn constraints(&self) -> &'static [&'static str] {
        &["middle of the space - centre, on the arc's line"]
    }

    fn worth(&self, point: &[f64]) -> Worth {
        let base = &self.0.base;
        let gap = base.gap(base.tangent_circle(point[0]));
        Worth { objective: gap.abs(), further: Vec::new(), constraints: vec![base.middle_radius() - point[0]] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gear::geometry::{GearPair, Rack, Side, Specification};
    use crate::gear::material::Material;

    fn specification(teeth: u32) -> Specification {
        Specification {
            teeth,
            module: 1.5e-3,
            pressure_angle: 20_f64.to_radians(),
            profile_shift: 0.0,
            thickness_allowance: 0.0,
            cutter: None,
            rack: Rack { addendum: 1.0, dedendum: 1.25, tip_radius: 0.38, ..Rack::ISO_53_A },
            tip_radius: None,
            face_width: 0.01,
            bore_radius: 2e-3,
            material: Material::STEEL,
        }
    }

    fn gear(teeth: u32) -> Gear {
        Gear::new(&specification(teeth)).unwrap()
    }

    /// The objective where every constraint holds, +∞ elsewhere.
    fn admissible(worth: &Worth) -> f64 {
        if worth.constraints.iter().all(|value| *value >= 0.0) { worth.objective } else { f64::INFINITY }
    }

    fn problem(teeth: u32, formulas: Formulas) -> Box<dyn Problem> {
        let pair = GearPair::new(specification(teeth), specification(teeth), None).unwrap();
        RootArcProblem { formulas }.on(&pair, Side::Pinion).unwrap()
    }

    /// Tier: published value; X of equation 31 is the arc of equations 17 to 20, but its F is not the printed one, and it
    /// breaks the article's own constraints.
    #[test]
    fn equation_31_contradicts_the_article() {
        let arc = RootArc::new(&gear(17)).unwrap();
        let near = |found: f64, printed: f64, digits: f64| assert!((found * 1e3 - printed).abs() <= digits, "{found}");
        let circle = arc.article();
        near(circle.centre[0], 2.276_488_9, 5e-8);
        near(circle.centre[1], 11.805_171, 5e-7);
        near(circle.radius, 0.999_081_0, 5e-8);
        near(arc.objective(circle), -0.172_030, 5e-7);
        let [radius, middle, centre] = arc.inequalities_derived(circle);
        near(radius, 0.999_081 - 1.875, 1e-6);
        assert!(middle < -8e-5 && centre > 0.0, "{middle} {centre}");
        assert!(arc.inequalities_printed(circle).iter().all(|value| *value < 0.0));
    }

    /// As printed the constraints leave nothing, for any gear: A is past the middle of the space.
    #[test]
    fn the_problem_as_printed_has_no_admissible_point() {
        for teeth in [17, 23, 30, 41] {
            let problem = problem(teeth, Formulas::Printed);
            let [x, radius] = problem.variables()[..] else { panic!("two variables") };
            for i in 0..=200 {
                for k in 0..=50 {
                    let point = [x.maximum * f64::from(i) / 200.0, radius.maximum * f64::from(k) / 50.0];
                    assert!(admissible(&problem.worth(&point)).is_infinite(), "{teeth}: {point:?}");
                }
            }
        }
    }

    /// Tier: second method; a fine scan of the corrected problem finds the closed form, at its bound and inside.
    #[test]
    fn a_scan_finds_the_optimum_of_the_corrected_problem() {
        for (teeth, touches) in [(17, false), (23, true), (30, true), (41, true)] {
            let problem = problem(teeth, Formulas::Derived);
            let [radius] = problem.variables()[..] else { panic!("one variable") };
            let point = |k: u32| radius.maximum * f64::from(k) / 200_000.0;
            let worth = |k: &u32| admissible(&problem.worth(&[point(*k)]));
            let best = (0..=200_000).min_by(|a, b| worth(a).total_cmp(&worth(b))).unwrap();
            let arc = RootArc::new(&gear(teeth)).unwrap();
            let optimum = arc.optimum();
            assert!(
                (point(best) - optimum.radius).abs() <= radius.maximum / 200_000.0,
                "{teeth}: {} {}",
                point(best),
                optimum.radius
            );
            assert_eq!(arc.base.gap(optimum).abs() < 1e-15, touches, "{teeth}: {}", arc.base.gap(optimum));
        }
    }

    /// Tier: published equation; centres of (30) as printed lie on a line through (-x_a, y_a) with the slope of A's angle,
    /// which F of (28) shows; x_c may lie in the tooth and its space, r_c is at most two dedenda.
    #[test]
    fn the_printed_line_is_that_of_equation_30() {
        for teeth in [17, 41] {
            let (gear, problem) = (gear(teeth), problem(teeth, Formulas::Printed));
            let arc = RootArc::new(&gear).unwrap();
            let (sine, cosine) = arc.printed_angle().sin_cos();
            let (x_a, y_a) = (gear.base_radius * sine, gear.base_radius * cosine);
            for (x, radius) in [(0.0, 1e-3), (1e-3, 1e-3), (2.5e-3, 0.4e-3)] {
                let y = ((gear.root_radius - x) * (gear.root_radius + x)).sqrt() + radius
                    - problem.worth(&[x, radius]).objective;
                assert!(((y - y_a) / (x + x_a) - sine / cosine).abs() < 1e-12, "{teeth} {x}: {y}");
            }
            let [x, radius] = problem.variables()[..] else { panic!("two variables") };
            let pitch = std::f64::consts::TAU / f64::from(teeth);
            assert!((x.maximum - gear.base_radius * pitch.sin()).abs() < 1e-15, "{x:?}");
            assert!((radius.maximum - 2.0 * 1.25 * 1.5e-3).abs() < 1e-15, "{radius:?}");
        }
    }

    /// Tier: closed form; angles count from the middle of the tooth, that of the space is at π/z, A's image as far behind it,
    /// so (x_a + x_a1)/2 = r_b sin(π/z) cos(π/z − angle). Equation 26 puts A at π/z + inv(α)/2, inv(20°) = 0.014904.
    #[test]
    fn inequalities_are_those_of_a_and_its_image() {
        for teeth in [17, 41] {
            let gear = gear(teeth);
            let arc = RootArc::new(&gear).unwrap();
            let half_pitch = std::f64::consts::PI / f64::from(teeth);
            assert!((arc.printed_angle() - half_pitch - 0.5 * 0.014_904_383_867_336_45).abs() < 1e-15);
            let circle = Circle { centre: [2e-3, 12e-3], radius: 1.1e-3 };
            for (angle, found) in [
                (gear.half_base_angle, arc.inequalities_derived(circle)),
                (arc.printed_angle(), arc.inequalities_printed(circle)),
            ] {
                let middle = gear.base_radius * half_pitch.sin() * (half_pitch - angle).cos();
                let expected = [
                    circle.radius - 1.875e-3,
                    middle - circle.centre[0],
                    circle.centre[0] - gear.base_radius * angle.sin(),
                ];
                let near = found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-16);
                assert!(near, "{teeth}: {found:?}, {expected:?}");
            }
        }
    }

    /// Room for variables and constraints is kept as many as there are.
    #[test]
    fn as_many_are_foreseen_as_there_are() {
        let count = |formulas| {
            let problem = problem(23, formulas);
            [problem.variables().len(), problem.constraints().len()]
        };
        let [derived, printed] = [Formulas::Derived, Formulas::Printed].map(count);
        let most = RootArcProblem { formulas: Formulas::Derived }.maximum();
        assert_eq!(most, [0, 1].map(|at: usize| derived[at].max(printed[at])));
    }
}
