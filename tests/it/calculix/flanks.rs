//! Flanks that stand before each other with what is taken off them: their gap, where it is least, and meshes moved by
//! it.
//!
//! Must not know: elasticity, the deck.

use std::f64::consts::FRAC_PI_2;

use gearmesh::gear::contact::separation::{Facing, Touch};
use gearmesh::gear::finite_elements::mesh::ElementMesh;
use gearmesh::gear::geometry::{Gear, GearPair, Side};
use gearmesh::gear::modification::Design;

/// Places of a flank that are looked at for the least gap.
const LOOKS: usize = 20_000;

/// A pair of flanks at a path position, where the unmodified involutes would touch.
#[derive(Clone, Copy)]
pub struct Flanks<'a> {
    pub pair: &'a GearPair,
    pub design: &'a Design,
    pub s: f64,
    /// Whose points are looked at; the other gear's involute is what they stand before.
    pub of: Side,
}

/// The place where two flanks come nearest to each other.
#[derive(Clone, Copy, Debug)]
pub struct Nearest {
    /// Roll angles of pinion and gear.
    pub rolls: [f64; 2],
    /// The gap there \[m\].
    pub gap: f64,
    /// How far that is from the line of action, along the flank towards the tip \[m\].
    pub off: f64,
    /// The arm of a force along the normal of the other gear's involute, over the own base radius; the other gear's is
    /// 1.
    pub arm: f64,
}

impl Flanks<'_> {
    fn facing(&self) -> Facing {
        Facing::new(self.pair, self.of)
    }

    /// How the point with this roll angle stands before the other gear's involute, which goes on beyond the tip; `turn`
    /// along the base circle before the position.
    fn touch(&self, roll: f64, turn: f64) -> Touch {
        let facing = self.facing();
        let point = facing.point_position(roll);
        // The formulas hold on both sides of the line of action.
        facing.touch(point, point - facing.turned(self.of, self.s) + turn)
    }

    /// The gap at a roll angle \[m\], and the roll angle of the other gear's point.
    pub fn gap(&self, roll: f64) -> (f64, f64) {
        let touch = self.touch(roll, 0.0);
        let other = self.facing().flank_roll(touch.curvature);
        (touch.separation + self.design.depth(self.of, roll) + self.design.depth(self.of.other(), other), other)
    }

    /// Where the flanks come nearest to each other, both within their tips.
    pub fn nearest(&self) -> Nearest {
        let [own, other] = [self.of, self.of.other()].map(|side| self.pair.side(side));
        let ends = [own.form_roll, own.flank_end.roll];
        let last = other.flank_end.roll * (1.0 + 1e-9);
        let looks = (0..=LOOKS).map(|look| ends[0] + (ends[1] - ends[0]) * look as f64 / LOOKS as f64);
        // The line of action itself, which may be between two looks, or beyond the tip.
        let nominal = self.pair.roll(self.of, self.s);
        let looks = looks.chain([nominal.min(ends[1])]);
        let found = looks.map(|roll| (roll, self.gap(roll))).filter(|(_, (_, met))| *met <= last);
        let (roll, (gap, met)) = found.min_by(|one, two| one.1.0.total_cmp(&two.1.0)).unwrap();
        let place = |roll: f64| 0.5 * own.base_radius * roll * roll;
        // The other gear's coordinate of a point that its own gear carries along by a small turn.
        let step = 1e-7;
        let carried = |turn: f64| turn - self.touch(roll, turn).separation;
        Nearest {
            rolls: if self.of == Side::Pinion { [roll, met] } else { [met, roll] },
            gap,
            off: place(roll) - place(nominal),
            arm: (carried(step) - carried(-step)) / (2.0 * step),
        }
    }
}

/// Takes `depth` \[m\] of a roll angle off the right flank, normal to it; inside the tooth less, nothing on the
/// centreline and in the body.
pub fn take_off(mesh: &mut ElementMesh, gear: &Gear, depth: impl Fn(f64) -> f64) {
    let module = gear.specification.module;
    for node in &mut mesh.nodes {
        let [x, y] = node.map(|length| length * module);
        let radius = x.hypot(y);
        if x <= 0.0 || radius <= gear.root_radius {
            continue;
        }
        let roll = gear.roll_at(radius.min(gear.tip_radius)).max(gear.form_roll);
        let part = (x.atan2(y) / gear.half_angle_at_roll(roll)).min(1.0);
        // Below the involute it dies away.
        let share = ((radius - gear.root_radius) / (gear.form_radius - gear.root_radius)).min(1.0);
        let taken = depth(roll) * part * (FRAC_PI_2 * share).sin().powi(2);
        let (sine, cosine) = gear.load_angle(roll).sin_cos();
        *node = [x - taken * cosine, y - taken * sine].map(|length| length / module);
    }
}
