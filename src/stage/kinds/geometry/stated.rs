//! Gears as somebody states them, two of them or one alone, and the pair that they are.
//!
//! Must not know: outlines, tables.

use std::f64::consts::FRAC_PI_4;

use declare::error::Diagnostic;
use declare::error::Place;
use declare::record::Record;
use declare::units::{ANGLE, LENGTH};
use declare::{Declared, Words};
use gearmesh::gear::geometry::error::{GeometryError, Parameter, Subject};
use gearmesh::gear::geometry::outline::roots::Root;
use gearmesh::gear::geometry::outline::tip::{self, Tip};
use gearmesh::gear::geometry::pair;
use gearmesh::gear::geometry::pinion_cutter::PinionCutter;
use gearmesh::gear::geometry::thickness::{self, Limits};
use gearmesh::gear::geometry::{Gear, GearPair, Rack, Side, Specification};
use gearmesh::gear::material::Material;

/// Two involute spur gears on their centre distance, or one alone.
#[derive(Debug, Declared)]
pub struct StatedGears {
    /// Module m.
    #[declared(minimum = 1e-5, maximum = 1.0, dimension = LENGTH, example = "3 mm")]
    pub module: f64,
    /// Pressure angle α of the basic rack.
    #[declared(minimum = 0.08, maximum = FRAC_PI_4, dimension = ANGLE, default = "20 deg")]
    pub pressure_angle: f64,
    /// Basic rack that cuts both gears, in modules (ISO 53).
    #[declared(default = "{}")]
    pub rack: Rack,
    /// Material of both gears.
    #[declared(default = "{}")]
    pub material: Material,
    /// The gear the torque is given on.
    pub pinion: StatedGear,
    /// The mating gear; without it the pinion is a gear alone, to be drawn.
    pub gear: Option<StatedGear>,
    /// Centre distance a_w; the one without backlash of nominal profile shifts when it is not given.
    #[declared(minimum = 1e-6, maximum = 1e3, dimension = LENGTH, example = "90 mm")]
    pub centre_distance: Option<f64>,
    /// What becomes of a pair where a tip would touch below the mate's root form circle.
    #[declared(default = "usable")]
    pub interference: Interference,
    /// What the centre distance may be off by: the limits of the backlash say what comes of it.
    pub centre_distance_allowance: Option<CentreDistanceAllowance>,
}

/// Where there is no involute for a tip to touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Interference {
    /// contact ends at the form circle, with a warning, unless the tip would cut into the root
    Usable,
    /// the pair is refused
    Refuse,
}

/// What of a gear follows from the centre distance without backlash.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum FromCentreDistance {
    /// its profile shift: what is left of x1 + x2
    ProfileShift,
    /// its tip shortening: the clearance is that of the basic rack
    TipShortening,
    /// both of them
    Both,
}

impl FromCentreDistance {
    fn gives_profile_shift(self) -> bool {
        self != Self::TipShortening
    }

    fn gives_tip(self) -> bool {
        self != Self::ProfileShift
    }
}

/// What the thickness of a gear is measured with.
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
pub struct MeasuredWith {
    /// k, teeth that a span goes over; when not given those of a `span` that says the thickness, or those whose planes touch nearest
    /// the V-circle.
    #[declared(minimum = 1, maximum = 10_000, example = "6")]
    pub span_teeth: Option<u32>,
    /// D_M, diameter of the balls; when not given that of the balls that say the thickness, or of those that touch the V-circle.
    #[declared(minimum = 1e-6, maximum = 10.0, dimension = LENGTH, example = "5.25 mm")]
    pub ball_diameter: Option<f64>,
}

/// Deviations from the centre distance (DIN 3964).
#[derive(Clone, Copy, Debug, PartialEq, Declared)]
pub struct CentreDistanceAllowance {
    /// Upper allowance A_ae.
    #[declared(dimension = LENGTH, minimum = -0.1, maximum = 0.1, example = "20 um")]
    pub upper: f64,
    /// Lower allowance A_ai.
    #[declared(dimension = LENGTH, minimum = -0.1, maximum = 0.1, example = "-20 um")]
    pub lower: f64,
}

/// One of the gears.
#[derive(Debug, Declared)]
pub struct StatedGear {
    /// Number of teeth z.
    #[declared(
        minimum = 4,
        maximum = 10_000,
        example = "24",
        negative = "a negative number of teeth is an internal gear elsewhere; only external gears are modelled"
    )]
    pub teeth: u32,
    /// Face width b.
    #[declared(minimum = 1e-6, maximum = 100.0, dimension = LENGTH, example = "20 mm")]
    pub face_width: f64,
    /// Radius of the bore, where the body is clamped.
    #[declared(minimum = 0.0, maximum = 1e4, dimension = LENGTH, example = "18 mm")]
    pub bore_radius: f64,
    /// Profile shift coefficient x.
    #[declared(minimum = -2.0, maximum = 3.0, default = "0.0", counts_in = "module")]
    pub profile_shift: f64,
    /// Thickness of the teeth, when it is not that without backlash: profile shift, tip circle and centre distance are then
    /// nominal.
    pub tooth_thickness: Option<Box<dyn thickness::Stated>>,
    /// Tip radius r_a, when it is not m(z/2 + h_aP* + x).
    #[declared(minimum = 1e-6, maximum = 1e4, dimension = LENGTH, example = "39 mm")]
    pub tip_radius: Option<f64>,
    /// Tip shortening k in modules: r_a = m(z/2 + h_aP* + x − k).
    #[declared(minimum = -1.0, maximum = 1.0, example = "0.1", counts_in = "module")]
    pub tip_shortening: Option<f64>,
    /// What of this gear is not stated, but follows from the centre distance.
    pub from_centre_distance: Option<FromCentreDistance>,
    /// What its thickness is measured with in `inspection`, when it is not as usual.
    #[declared(default = "{}")]
    pub measured_with: MeasuredWith,
    /// Basic rack that cuts this gear, when it is not the common one.
    pub rack: Option<Rack>,
    /// Pinion-type cutter that shapes this gear, where no rack cuts it; of the rack its addendum counts then.
    pub pinion_cutter: Option<PinionCutter>,
    /// Root of this gear's teeth in its outline, when it is not the common one.
    pub root: Option<Box<dyn Root>>,
    /// Corners of this gear's tips, when they are not the common ones.
    pub tip: Option<Box<dyn tip::Stated>>,
    /// Material of this gear, when it is not the common one.
    pub material: Option<Material>,
}

impl StatedGears {
    /// Whether the gear that an error is about states a tip of its own.
    #[must_use]
    pub fn says_tip(error: &GeometryError, record: &Record) -> bool {
        record.inside(Self::side(error)).entry(StatedGear::NAMES.tip).is_some()
    }

    fn side(error: &GeometryError) -> &'static str {
        if error.side == Some(Side::Gear) { Self::NAMES.gear } else { Self::NAMES.pinion }
    }

    /// Where a record states what an error is about.
    #[must_use]
    pub fn place_of(error: &GeometryError, record: &Record) -> Place {
        let (names, own) = (Self::NAMES, StatedGear::NAMES);
        let inside = |group, field| record.inside(group).place_of(field);
        let gear = Self::side(error);
        let rack = |field| {
            let of = record.inside(gear);
            let of = if of.entry(own.rack).is_some() { of.inside(own.rack) } else { record.inside(names.rack) };
            of.place_of(field)
        };
        let cutter = |field| record.inside(gear).inside(own.pinion_cutter).place_of(field);
        match error.subject() {
            Subject::Parameter(parameter) => match parameter {
                Parameter::Teeth => inside(gear, own.teeth),
                Parameter::ProfileShift => inside(gear, own.profile_shift),
                Parameter::TipRadius => inside(gear, own.tip_radius),
                Parameter::TipAngle => inside(gear, own.tip),
                Parameter::ToothThickness => inside(gear, own.tooth_thickness),
                Parameter::FaceWidth => inside(gear, own.face_width),
                Parameter::BoreRadius => inside(gear, own.bore_radius),
                Parameter::Module => record.place_of(names.module),
                Parameter::PressureAngle => record.place_of(names.pressure_angle),
                Parameter::CentreDistance => record.place_of(names.centre_distance),
                Parameter::RackAddendum => rack(Rack::NAMES.addendum),
                Parameter::RackDedendum => rack(Rack::NAMES.dedendum),
                Parameter::RackTipRadius => rack(Rack::NAMES.tip_radius),
                Parameter::Protuberance => rack(Rack::NAMES.protuberance),
                Parameter::ProtuberanceAngle => rack(Rack::NAMES.protuberance_angle),
                Parameter::MachiningAllowance => rack(Rack::NAMES.machining_allowance),
                Parameter::NotchRadius => rack(Rack::NAMES.notch_radius),
                Parameter::CutterTeeth => cutter(PinionCutter::NAMES.teeth),
                Parameter::CutterProfileShift => cutter(PinionCutter::NAMES.profile_shift),
                Parameter::CutterAddendum => cutter(PinionCutter::NAMES.addendum),
                Parameter::CutterTipRadius => cutter(PinionCutter::NAMES.tip_radius),
                Parameter::YoungsModulus => inside(names.material, Material::NAMES.youngs_modulus),
                Parameter::PoissonRatio => inside(names.material, Material::NAMES.poisson_ratio),
            },
            Subject::Tip => inside(gear, own.tip),
            Subject::Root | Subject::Flank => record.place,
        }
    }

    /// Refuses fields of a gear that say the same.
    ///
    /// # Errors
    /// Which of them, with its place in `record`.
    pub fn check(&self, record: &Record) -> Result<(), Diagnostic> {
        let own = StatedGear::NAMES;
        for (side, gear) in self.each() {
            let follows = gear.from_centre_distance;
            let tip_follows = follows.is_some_and(FromCentreDistance::gives_tip);
            let twice = |first: &str, second: &str, what: &str| {
                Err(Diagnostic::new(format!("`{first}` and `{second}` both say {what}"))
                    .at(record.inside(side.name()).place_of(second))
                    .help("give one of them"))
            };
            let tip = "where the tip is";
            match (gear.tip_radius, gear.tip_shortening) {
                (Some(_), Some(_)) => return twice(own.tip_radius, own.tip_shortening, tip),
                (Some(_), _) if tip_follows => return twice(own.tip_radius, own.from_centre_distance, tip),
                (_, Some(_)) if tip_follows => return twice(own.tip_shortening, own.from_centre_distance, tip),
                _ => {}
            }
            let own_record = record.inside(side.name());
            // A default stands where its gear does.
            let states_shift = gear.profile_shift != 0.0 || own_record.place_of(own.profile_shift) != own_record.place;
            if gear.shift_follows() && states_shift {
                return twice(own.profile_shift, own.from_centre_distance, "the profile shift");
            }
            if follows.is_some() && (self.gear.is_none() || self.centre_distance.is_none()) {
                let field = own.from_centre_distance;
                let (missing, help) = if self.gear.is_none() {
                    ("a mate", "add the mating gear as `gear`, or leave this out")
                } else {
                    ("a centre distance", "add `centre_distance`, or leave this out")
                };
                return Err(Diagnostic::new(format!("`{field}` needs {missing}"))
                    .at(record.inside(side.name()).place_of(field))
                    .help(help));
            }
        }
        let both_follow = self.each().filter(|(_, gear)| gear.shift_follows()).count() == 2;
        if both_follow {
            return Err(Diagnostic::new("the centre distance says the sum of both profile shifts, not each of them")
                .at(record.inside(Side::Gear.name()).place_of(own.from_centre_distance))
                .help("state `profile_shift` of one of the gears"));
        }
        Ok(())
    }

    /// x of both gears, and k where a tip follows from the centre distance.
    fn shifts(&self, gear: &StatedGear) -> Result<([f64; 2], Option<f64>), GeometryError> {
        let gears = [&self.pinion, gear];
        let mut shifts = gears.map(|gear| gear.profile_shift);
        let Some(distance) =
            self.centre_distance.filter(|_| gears.iter().any(|gear| gear.from_centre_distance.is_some()))
        else {
            return Ok((shifts, None));
        };
        let teeth = gears.map(|gear| gear.teeth);
        let sum = || pair::profile_shift_sum(teeth, self.module, self.pressure_angle, distance);
        if let Some(free) = gears.iter().position(|gear| gear.shift_follows()) {
            shifts[free] = sum()? - shifts[1 - free];
        }
        Ok((shifts, Some(pair::tip_shortening(teeth, self.module, shifts[0] + shifts[1], distance))))
    }

    /// The pinion, and the gear of a pair.
    pub fn each(&self) -> impl Iterator<Item = (Side, &StatedGear)> {
        [(Side::Pinion, Some(&self.pinion)), (Side::Gear, self.gear.as_ref())]
            .into_iter()
            .filter_map(|(side, gear)| Some((side, gear?)))
    }

    /// The pair, none of a gear alone; `common` is the tip of a gear that states none.
    #[must_use]
    pub fn pair(&self, common: Tip) -> Option<Result<GearPair, GeometryError>> {
        let gear = self.gear.as_ref()?;
        let gears = [&self.pinion, gear];
        let tips = gears.map(|gear| gear.tip(common));
        let pair = || {
            let (shifts, shortening) = self.shifts(gear)?;
            let specification = |index: usize, side| {
                self.specification(gears[index], shifts[index], shortening).map_err(|error| error.on(side))
            };
            let specifications = [specification(0, Side::Pinion)?, specification(1, Side::Gear)?];
            let pair = GearPair::with_tips(specifications, tips, self.centre_distance)?;
            if self.interference == Interference::Refuse {
                pair.refuse_interference()?;
            }
            Ok(pair)
        };
        Some(pair())
    }

    /// The pinion without a mate.
    ///
    /// # Errors
    /// When it cannot be.
    pub fn alone(&self, common: Tip) -> Result<Gear, GeometryError> {
        Gear::new(&self.specification(&self.pinion, self.pinion.profile_shift, None)?)
            .and_then(|gear| gear.with_tip(self.pinion.tip(common)))
    }

    /// `shortening` is k of a gear whose tip follows from the centre distance.
    fn specification(
        &self,
        gear: &StatedGear,
        profile_shift: f64,
        shortening: Option<f64>,
    ) -> Result<Specification, GeometryError> {
        let (module, rack) = (self.module, gear.rack.unwrap_or(self.rack));
        let follows = shortening.filter(|_| gear.from_centre_distance.is_some_and(FromCentreDistance::gives_tip));
        let nominal = Specification {
            teeth: gear.teeth,
            module,
            pressure_angle: self.pressure_angle,
            profile_shift,
            thickness_allowance: 0.0,
            rack,
            cutter: gear.pinion_cutter,
            tip_radius: gear.tip_radius.or_else(|| {
                let height = rack.addendum + profile_shift - gear.tip_shortening.or(follows)?;
                Some(module * (0.5 * f64::from(gear.teeth) + height))
            }),
            face_width: gear.face_width,
            bore_radius: gear.bore_radius,
            material: gear.material.unwrap_or(self.material),
        };
        let limits = gear.limits(&nominal)?;
        Ok(Specification { thickness_allowance: limits.map_or(0.0, Limits::middle), ..nominal })
    }
}

impl StatedGear {
    fn shift_follows(&self) -> bool {
        self.from_centre_distance.is_some_and(FromCentreDistance::gives_profile_shift)
    }

    /// The allowances of its thickness, where it has any.
    ///
    /// # Errors
    /// When no gear like it is so thick.
    pub fn limits(&self, specification: &Specification) -> Result<Option<Limits>, GeometryError> {
        self.tooth_thickness.as_ref().map(|stated| stated.limits(specification)).transpose()
    }

    /// What its thickness is measured with: as stated, or else as that was whereby it is stated.
    pub fn measured_with(&self) -> MeasuredWith {
        let (span_teeth, ball_diameter) = self.tooth_thickness.as_ref().map_or((None, None), |of| of.measured_with());
        let MeasuredWith { span_teeth: own_teeth, ball_diameter: own_diameter } = self.measured_with;
        MeasuredWith { span_teeth: own_teeth.or(span_teeth), ball_diameter: own_diameter.or(ball_diameter) }
    }

    fn tip(&self, common: Tip) -> Tip {
        self.tip.as_ref().map_or(common, |tip| tip.tip())
    }
}
