//! How far a gear with its full profile is from being invalid, alone and with its mate.
//!
//! Lengths in m, angles in rad. Source: Zhai, Liang and Fu 2020, equation 23, for the least shift of a sharp rack; ISO
//! 21771-1:2024 for the rest. Must not know: tables, what is done about a gear that is not valid.

use super::error::GeometryError;
use super::outline::Outline;
use super::outline::roots::Root;
use super::outline::roots::trochoid::{RackTip, Trochoid};
use super::tip_path::{Corner, TipPath};
use super::{Gear, GearPair, Side};

/// Anything below this is rounding: roll angles \[rad\], and lengths in modules.
const ROUNDING: f64 = 1e-12;

/// One gear alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validity {
    /// x_min = h_a*(z_min − z)/z_min with z_min = 2 h_a*/sin² α, of a sharp rack whose straight flank is h_a* deep.
    pub least_shift_sharp: f64,
    /// x_min of the gear's own rack.
    pub least_shift: f64,
    /// Where the flank begins in the profile as drawn.
    pub form_radius: f64,
    /// How far the bottom of the space in the profile as drawn lies above the root circle.
    pub root_gap: f64,
    /// s_a on the tip circle.
    pub tip_thickness: f64,
    /// Where the flanks would meet in a point.
    pub apex_radius: f64,
}

/// One gear with its mate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mating {
    /// Down to where the flank works: where the mate's tip reaches, or the root form circle.
    pub active_radius: f64,
    /// Roll angle from the beginning of the drawn flank to where the mate's tip would reach on an involute.
    pub contact_reserve: f64,
    /// Least distance of the mate's tip from the drawn root, on its whole way; negative where it cuts in.
    pub root_distance: f64,
    /// Between the root circle and the mate's tip.
    pub clearance: f64,
    /// By how many modules the mate's tip must be lowered for the rack's own clearance.
    pub missing_tip_shortening: f64,
}

impl Validity {
    /// The validity of a gear that is drawn with this outline.
    #[must_use]
    pub fn new(gear: &Gear, outline: &Outline) -> Self {
        let specification = &gear.specification;
        let sine = libm::sin(specification.pressure_angle);
        let [x, y] = outline.segments[0].start();
        Self {
            least_shift_sharp: specification.rack.addendum - 0.5 * f64::from(specification.teeth) * sine * sine,
            least_shift: gear.least_shift_without_undercut(),
            form_radius: gear.radius_at(outline.form_roll),
            root_gap: libm::hypot(x, y) - gear.root_radius,
            tip_thickness: gear.tip_thickness(),
            apex_radius: gear.radius_at(gear.apex_roll()),
        }
    }
}

/// Least distance \[m\] of the mate's tip from the root of a gear, both as their racks cut them; below 0 where it cuts in.
///
/// # Errors
/// When one of them cannot be drawn.
pub(super) fn root_distance(pair: &GearPair, side: Side) -> Result<f64, GeometryError> {
    let drawn = |side: Side| {
        let gear = pair.side(side);
        let toe = Trochoid { rack_tip: RackTip::Given }.toe(gear).map_err(|error| error.on(side))?;
        Outline::new(gear, toe, gear.tip, None).map_err(|error| error.on(side))
    };
    let (own, mate) = (drawn(side)?, drawn(side.other())?);
    Ok(TipPath::new(pair, side, Corner::all(&mate)).distance(&own.segments))
}

impl Mating {
    /// The validity of the gear on a side of a pair, with its own outline and its mate's.
    #[must_use]
    pub fn new(pair: &GearPair, side: Side, outline: &Outline, mate: &Outline) -> Self {
        let (gear, other) = (pair.side(side), pair.side(side.other()));
        let specification = &gear.specification;
        let lowest = pair.reached_roll(side);
        let clearance = pair.centre_distance - other.tip_radius - gear.root_radius;
        let usual = specification.module * (gear.dedendum() - specification.rack.addendum);
        Self {
            active_radius: gear.radius_at(pair.lowest_roll(side)),
            contact_reserve: lowest - outline.form_roll,
            root_distance: TipPath::new(pair, side, Corner::all(mate)).distance(&outline.segments),
            clearance,
            missing_tip_shortening: (usual - clearance) / specification.module,
        }
    }

    /// Whether the mate's tip reaches below the flank.
    #[must_use]
    pub fn interferes(&self) -> bool {
        self.contact_reserve < -ROUNDING
    }

    /// Whether the mate's tip cuts into the root of a gear of this module \[m\].
    #[must_use]
    pub fn cuts_root(&self, module: f64) -> bool {
        self.root_distance < -ROUNDING * module
    }
}
