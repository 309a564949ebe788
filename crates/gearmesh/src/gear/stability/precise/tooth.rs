//! One gear in twice the precision: circles, root curve, and the compliance of its teeth by the energy method.
//!
//! Formulas are those of ISO 21771-1, of a rack's tip round in polar coordinates, and of Yang and Lin (see
//! `compliance/energy.rs`), with the root's slope from polar derivatives, the flank on panels that shrink towards the
//! pointed tip, and composite Gauss–Legendre rules; the kernels do none of this. Must not know: the kernels.

use super::Inputs;
use super::rules::{Panel, Rule};
use crate::gear::geometry::Side;
use crate::numeric::double_double::Double;

/// Panels of the root curve.
const ROOT_PANELS: usize = 6;

/// Integrals of dy/x³ · (1, y, y²) and dy/x, lengths over the base radius.
type Moments = [Double; 4];

/// One gear.
pub(super) struct Tooth {
    pub base_radius: Double,
    pub form_radius: Double,
    pub form_roll: Double,
    pub tip_roll: Double,
    /// ψ_b.
    half_base_angle: Double,
    /// s_a.
    pub tip_thickness: Double,
    /// Compliance without contact against the roll angle, from the root up; empty until it is asked for.
    table: Vec<Panel>,
    body: Body,
    root: Root,
    apex_roll: Double,
    stretch: Double,
    /// 2(1 + ν).
    shear: Double,
}

/// What the fitted formula of the gear body takes.
struct Body {
    root_radius: Double,
    half_angle: Double,
    polynomials: [Double; 4],
}

/// The root curve: distance of the round's centre below the pitch line, its radius, its place along the pitch line.
#[derive(Clone, Copy)]
struct Root {
    reference_radius: Double,
    depth: Double,
    round: Double,
    offset: Double,
    /// cot γ at the joint with the involute.
    joint: Double,
}

/// inv α as a function of tan α.
fn involute(tangent: Double) -> Double {
    tangent - tangent.arctangent(Double::ONE)
}

/// The tangent of the angle whose involute function is `value`: Newton's method on u − atan u, whose rate is u²/(1 + u²).
pub(super) fn inverse_involute(value: Double, guess: f64) -> Double {
    let mut tangent = Double::from(guess);
    for _ in 0..60 {
        let square = tangent.square();
        let step = (involute(tangent) - value) * (square + 1.0) / square;
        tangent = (tangent - step).max(Double::from(1e-9));
        if step.abs().high <= 1e-30 * tangent.high {
            break;
        }
    }
    tangent
}

impl Root {
    /// Radius and half angle at cot γ = t, with their rates by t.
    ///
    /// The pitch point is r from the centre, and the curve is D = d √(1 + t²) + ρ farther along the normal, at γ.
    fn polar(&self, t: Double) -> [Double; 4] {
        let stretch = (t.square() + 1.0).sqrt();
        let (sine, cosine) = (Double::ONE / stretch, t / stretch);
        let distance = self.depth * stretch + self.round;
        let rate = self.depth * cosine;
        // dγ/dt = −sin² γ.
        let turn = -sine.square();
        let (across, along) = (distance * cosine, self.reference_radius - distance * sine);
        let across_rate = rate * cosine - distance * sine * turn;
        let along_rate = -(rate * sine + distance * cosine * turn);
        let square = across.square() + along.square();
        let radius = square.sqrt();
        let angle = (self.depth * t + self.offset) / self.reference_radius - across.arctangent(along);
        let angle_rate = self.depth / self.reference_radius - (across_rate * along - across * along_rate) / square;
        [radius, angle, (across * across_rate + along * along_rate) / radius, angle_rate]
    }
}

impl Tooth {
    pub(super) fn new(inputs: &Inputs, side: Side) -> Self {
        let gear = &inputs.gears[usize::from(side == Side::Gear)];
        let (sine, cosine) = inputs.pressure_angle.sine_cosine();
        let tangent = sine / cosine;
        let module = inputs.module;
        let reference_radius = module.half() * gear.teeth;
        let base_radius = reference_radius * cosine;
        // x_E.
        let shift = gear.shift + Double::from(gear.thickness_allowance).half() / (module * tangent);
        let root_radius = reference_radius - module * (Double::from(gear.dedendum) - shift);
        let natural = reference_radius + module * (gear.shift + gear.addendum);
        let tip_radius = gear.tip_radius.unwrap_or(natural) * gear.tip_scale;
        let half_base_angle =
            (Double::PI.half() + (shift * tangent).times_power_of_two(2.0)) / gear.teeth + involute(tangent);
        let roll = |radius: Double| ((radius - base_radius) * (radius + base_radius)).sqrt() / base_radius;

        let land =
            Double::PI.times_power_of_two(0.25) - tangent * gear.dedendum - (Double::ONE - sine) * gear.round / cosine;
        let mut root = Root {
            reference_radius,
            depth: module * (Double::from(gear.dedendum) - shift - gear.round),
            round: module * gear.round,
            offset: module * (Double::PI.half() - land.max(Double::ZERO)),
            joint: cosine / sine,
        };
        let end = reference_radius * sine - (root.depth + root.round * sine) / sine;
        let form_roll = if end >= Double::ZERO {
            end / base_radius
        } else {
            let excess = |t: Double| {
                let [radius, angle, ..] = root.polar(t);
                angle - half_base_angle + involute(roll(radius))
            };
            let base = bisected(Double::ZERO, root.joint, |t| root.polar(t)[0] - base_radius);
            root.joint = bisected(base, root.joint, excess);
            roll(root.polar(root.joint)[0])
        };
        let tip_roll = roll(tip_radius);
        let apex_roll = inverse_involute(half_base_angle, 1.0);
        let half_angle = root.offset / reference_radius;
        Self {
            base_radius,
            form_radius: (form_roll.square() + 1.0).sqrt() * base_radius,
            form_roll,
            tip_roll,
            half_base_angle,
            tip_thickness: (half_base_angle - involute(tip_roll)) * tip_radius.times_power_of_two(2.0),
            table: Vec::new(),
            body: Body {
                root_radius,
                half_angle,
                polynomials: polynomials(half_angle, root_radius / gear.bore_radius),
            },
            root,
            apex_roll,
            stretch: Double::from(gear.youngs_modulus) * gear.face_width,
            shear: (Double::ONE + gear.poisson_ratio).times_power_of_two(2.0),
        }
    }

    /// Tabulates the compliance from the form point to the tip; `shear_factor` as in the energy method.
    pub(super) fn tabulate(&mut self, rule: &Rule, shear_factor: f64) {
        let mut moments = self.root_moments(rule);
        let mut table = Vec::new();
        let mut from = self.form_roll;
        while from < self.tip_roll {
            // Half of the way to where the flanks would meet.
            let to = (from + (self.apex_roll - from).half()).min(self.tip_roll);
            let rolls = Panel::nodes(from, to, rule);
            let mut values = Vec::with_capacity(rolls.len());
            let mut before = from;
            for &roll in &rolls {
                self.add_flank(&mut moments, before, roll, rule);
                values.push(self.compliance(&moments, roll, shear_factor));
                before = roll;
            }
            self.add_flank(&mut moments, before, to, rule);
            table.push(Panel::new(to, rolls, values, rule));
            from = to;
        }
        self.table = table;
    }

    /// Compliance without the contact \[m/N\].
    pub(super) fn value(&self, roll: Double) -> Double {
        let last = self.table.len() - 1;
        let panel = self.table[..last].iter().position(|panel| roll <= panel.upper).unwrap_or(last);
        self.table[panel].value(roll)
    }

    /// Distance from the flank to the centreline along the load line.
    pub(super) fn contact_depth(&self, roll: Double) -> Double {
        let (sine, cosine) = (roll - self.half_base_angle).sine_cosine();
        self.base_radius * (roll * cosine - sine) / cosine
    }

    fn root_moments(&self, rule: &Rule) -> Moments {
        let mut moments = [Double::ZERO; 4];
        // q = asinh t spreads the curve evenly.
        let joint = (self.root.joint + (self.root.joint.square() + 1.0).sqrt()).logarithm();
        for panel in 0..ROOT_PANELS {
            let share = |index: usize| joint * (index as f64) / ROOT_PANELS as f64;
            rule.integrate(share(panel), share(panel + 1), &mut moments, |q| {
                let (up, down) = (q.exponential(), (-q).exponential());
                let (t, rate) = ((up - down).half(), (up + down).half());
                let [radius, angle, radius_rate, angle_rate] = self.root.polar(t);
                let (sine, cosine) = angle.sine_cosine();
                let height_rate = (radius_rate * cosine - radius * sine * angle_rate) * rate;
                integrands(
                    radius * sine / self.base_radius,
                    radius * cosine / self.base_radius,
                    height_rate / self.base_radius,
                )
            });
        }
        moments
    }

    fn add_flank(&self, moments: &mut Moments, from: Double, to: Double, rule: &Rule) {
        rule.short(from, to, moments, |roll| {
            let (sine, cosine) = (roll - self.half_base_angle).sine_cosine();
            integrands(roll * cosine - sine, cosine + roll * sine, roll * cosine)
        });
    }

    fn compliance(&self, moments: &Moments, roll: Double, shear_factor: f64) -> Double {
        let (sine, cosine) = (roll - self.half_base_angle).sine_cosine();
        let [constant, linear, square, area] = *moments;
        let bending = (constant - (cosine * linear).times_power_of_two(2.0) + cosine.square() * square) * 1.5;
        let shear = cosine.square() * area * self.shear.half() * shear_factor;
        let axial = sine.square() * area.half();
        let Body { root_radius, half_angle, polynomials: [l, m, p, q] } = &self.body;
        let tangent = sine / cosine;
        let arm = (self.base_radius / cosine - *root_radius) / (*root_radius * *half_angle).times_power_of_two(2.0);
        let body = cosine.square() * (*l * arm.square() + *m * arm + *p * (Double::ONE + *q * tangent.square()));
        (bending + shear + axial + body) / self.stretch
    }
}

/// dy/x³ · (1, y, y²) and dy/x.
fn integrands(x: Double, y: Double, rate: Double) -> Moments {
    let cubed = rate / (x.square() * x);
    [cubed, cubed * y, cubed * y.square(), rate / x]
}

/// Sainsot, Velex and Duverger: L, M, P, Q of X = A/θ² + B h² + C h/θ + D/θ + E h + F; decimal numbers rounded as every
/// program that reads them rounds them.
fn polynomials(theta: Double, h: Double) -> [Double; 4] {
    const ROWS: [[f64; 6]; 4] = [
        [-5.574e-5, -1.9986e-3, -2.3015e-4, 4.7702e-3, 0.0271, 6.8045],
        [60.111e-5, 28.100e-3, -83.431e-4, -9.9256e-3, 0.1624, 0.9086],
        [-50.952e-5, 185.50e-3, 0.0538e-4, 53.300e-3, 0.2895, 0.9236],
        [-6.2042e-5, 9.0889e-3, -4.0964e-4, 7.8297e-3, -0.1472, 0.6904],
    ];
    ROWS.map(|[a, b, c, d, e, f]| {
        (theta.square() * f + theta * d + a + h * (theta * c)) / theta.square() + h * (h * b + e)
    })
}

/// Where `function` changes its sign.
pub(super) fn bisected(from: Double, to: Double, function: impl Fn(Double) -> Double) -> Double {
    let (mut low, mut high) = (from, to);
    let sign = function(low).high < 0.0;
    for _ in 0..110 {
        let middle = (low + high).half();
        if (function(middle).high < 0.0) == sign { low = middle } else { high = middle }
    }
    (low + high).half()
}
