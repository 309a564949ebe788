//! Why a gear or a pair is impossible: the values, the admissible range, and the parameter to change.
//!
//! Must not know: where a study states the parameter. Lengths and angles arrive in SI and are shown in mm and degrees.

use std::fmt;

use super::Side;

/// A gear or pair that cannot be made or cannot run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{problem}", side_prefix(*.side))]
pub struct GeometryError {
    /// The gear that is meant; `None` when there is only one gear or when the pair is meant.
    pub side: Option<Side>,
    pub problem: Problem,
}

/// A length, shown in mm with its significant digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Millimetres(pub f64);

/// An angle, shown in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Degrees(pub f64);

/// A plain number, shown with its significant digits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plain(pub f64);

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    #[error("{} is {found}, but must be {range}", .parameter.words())]
    OutOfRange { parameter: Parameter, found: String, range: String },
    #[error(
        "the rack's teeth end in a point before they are {dedendum} modules deep: the pressure angle is {angle}, but must be below {largest}"
    )]
    NoTipLand { dedendum: Plain, angle: Degrees, largest: Degrees },
    #[error("the rack's tip radius is {radius} modules, but must be 0 to {largest} (full round)")]
    TipRoundTooLarge { radius: Plain, largest: Plain },
    #[error(
        "no involute is left: the root curve reaches up to {form}, the tip circle is at {tip}; {teeth} teeth need a profile shift of at least {least} modules not to be undercut"
    )]
    NoFlank { form: Millimetres, tip: Millimetres, teeth: u32, least: Plain },
    #[error(
        "the teeth are pointed: the flanks meet at a radius of {apex}, the tip radius is {tip}, but must be below that"
    )]
    Pointed { tip: Millimetres, apex: Millimetres, tip_is_given: bool },
    #[error("the bore radius is {bore}, but must be at least {least} and below the root radius {root}")]
    Bore { bore: Millimetres, least: Millimetres, root: Millimetres },
    #[error("{} differs: {pinion} on the pinion, {gear} on the gear", .parameter.words())]
    Differs { parameter: Parameter, pinion: String, gear: String },
    #[error("the centre distance is {found}, but must be at least {least} for the teeth to fit into each other")]
    CentreDistance { found: Millimetres, least: Millimetres },
    #[error(
        "profile shifts that add up to {sum} modules leave no working pressure angle; their sum must be above {least}"
    )]
    ProfileShiftSum { sum: Plain, least: Plain },
    #[error(
        "its tip circle ({tip}) reaches to the root circle of the mate: clearance {clearance}, but must be at least 0 mm"
    )]
    NoClearance { tip: Millimetres, clearance: Millimetres },
    #[error(
        "interference: the mate's tip ({mate_tip}) would touch {reached}, below the form radius {form}; the mate's tip radius must be at most {largest}"
    )]
    Interference { mate_tip: Millimetres, reached: Reached, form: Millimetres, largest: Millimetres },
    #[error("the contact ratio is {ratio}, but must be above 1")]
    ContactRatio { ratio: Plain },
    #[error(
        "a circular fillet of radius {radius} does not fit between two teeth: the fillets would overlap by {overlap}"
    )]
    FilletDoesNotFit { radius: Millimetres, overlap: Millimetres },
    #[error(
        "an arc of radius {radius} at the root does not fit between two teeth: neighbouring arcs would overlap by {overlap}; its radius must be at most {largest}"
    )]
    RootArcTooLarge { radius: Millimetres, overlap: Millimetres, largest: Millimetres },
    #[error(
        "{construction} begins on the base circle and ends on the root circle, so the root radius {root} must be below the base radius {base}; with this rack that is so below {most} teeth, and there are {teeth}"
    )]
    NothingBelowBase { construction: &'static str, root: Millimetres, base: Millimetres, teeth: u32, most: Plain },
    #[error(
        "no centre of an arc lies between tooth and space: on the base circle the tooth takes up {angle} deg on either side of its centreline, but must take up less than {most} deg"
    )]
    NoSpace { angle: Plain, most: Plain },
    #[error(
        "the root curve cuts the tooth off at a radius of {height}; {teeth} teeth need a profile shift of at least {least} modules not to be undercut"
    )]
    CutOff { height: Millimetres, teeth: u32, least: Plain },
    #[error(
        "the tip is broken by {size}, but must be by {largest} at most, where the two flanks' breaks meet or no flank is left"
    )]
    TipBreakTooLarge { size: Millimetres, largest: Millimetres },
    #[error("the modified flank ends below its own root: {depth} are taken off where the root begins")]
    ReliefTooDeep { depth: Millimetres },
}

/// How deep interference reaches.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reached {
    Radius(Millimetres),
    /// Beyond the tangent point of the path of contact, where there is no involute.
    InsideBaseCircle,
}

/// What a user states about gears.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    Teeth,
    Module,
    PressureAngle,
    ProfileShift,
    RackAddendum,
    RackDedendum,
    RackTipRadius,
    TipRadius,
    FaceWidth,
    BoreRadius,
    YoungsModulus,
    PoissonRatio,
    CentreDistance,
}

impl Parameter {
    fn words(self) -> &'static str {
        match self {
            Self::Teeth => "the number of teeth",
            Self::Module => "the module",
            Self::PressureAngle => "the pressure angle",
            Self::ProfileShift => "the profile shift",
            Self::RackAddendum => "the rack's addendum",
            Self::RackDedendum => "the rack's dedendum",
            Self::RackTipRadius => "the rack's tip radius",
            Self::TipRadius => "the tip radius",
            Self::FaceWidth => "the face width",
            Self::BoreRadius => "the bore radius",
            Self::YoungsModulus => "Young's modulus",
            Self::PoissonRatio => "Poisson's ratio",
            Self::CentreDistance => "the centre distance",
        }
    }

    /// The field's name, after `pinion.` or `gear.` where each gear has its own.
    fn field(self, side: Option<Side>) -> &'static str {
        let [alone, pinion, gear] = match self {
            Self::Teeth => ["teeth", "pinion.teeth", "gear.teeth"],
            Self::ProfileShift => ["profile_shift", "pinion.profile_shift", "gear.profile_shift"],
            Self::TipRadius => ["tip_radius", "pinion.tip_radius", "gear.tip_radius"],
            Self::FaceWidth => ["face_width", "pinion.face_width", "gear.face_width"],
            Self::BoreRadius => ["bore_radius", "pinion.bore_radius", "gear.bore_radius"],
            Self::Module => ["module"; 3],
            Self::PressureAngle => ["pressure_angle"; 3],
            Self::RackAddendum => ["rack.addendum"; 3],
            Self::RackDedendum => ["rack.dedendum"; 3],
            Self::RackTipRadius => ["rack.tip_radius"; 3],
            Self::YoungsModulus => ["material.youngs_modulus"; 3],
            Self::PoissonRatio => ["material.poisson_ratio"; 3],
            Self::CentreDistance => ["centre_distance"; 3],
        };
        match side {
            None => alone,
            Some(Side::Pinion) => pinion,
            Some(Side::Gear) => gear,
        }
    }
}

impl GeometryError {
    /// The parameter it is about, as a path such as `pinion.teeth` or `rack.tip_radius`.
    #[must_use]
    pub fn field(&self) -> &'static str {
        let parameter = match &self.problem {
            Problem::OutOfRange { parameter, .. } | Problem::Differs { parameter, .. } => *parameter,
            Problem::NoTipLand { .. } => Parameter::PressureAngle,
            Problem::TipRoundTooLarge { .. } | Problem::FilletDoesNotFit { .. } => Parameter::RackTipRadius,
            Problem::NoFlank { .. } | Problem::Interference { .. } => Parameter::Teeth,
            Problem::RootArcTooLarge { .. }
            | Problem::NothingBelowBase { .. }
            | Problem::NoSpace { .. }
            | Problem::CutOff { .. } => return "outline.root",
            Problem::TipBreakTooLarge { .. } => return "outline.tip",
            Problem::ReliefTooDeep { .. } => return "outline.flank",
            Problem::Pointed { tip_is_given, .. } if !tip_is_given => Parameter::ProfileShift,
            Problem::Pointed { .. } | Problem::NoClearance { .. } => Parameter::TipRadius,
            Problem::Bore { .. } => Parameter::BoreRadius,
            Problem::CentreDistance { .. } => Parameter::CentreDistance,
            Problem::ProfileShiftSum { .. } => return "pinion.profile_shift",
            Problem::ContactRatio { .. } => Parameter::RackAddendum,
        };
        parameter.field(self.side)
    }

    #[must_use]
    pub fn on(mut self, side: Side) -> Self {
        self.side = Some(side);
        self
    }
}

impl From<Problem> for GeometryError {
    fn from(problem: Problem) -> Self {
        Self { side: None, problem }
    }
}

fn side_prefix(side: Option<Side>) -> &'static str {
    match side {
        None => "",
        Some(Side::Pinion) => "pinion: ",
        Some(Side::Gear) => "gear: ",
    }
}

/// Six significant digits, without trailing zeros.
fn significant(value: f64) -> String {
    if value.abs() <= 0.0 || !value.is_finite() {
        return format!("{value}");
    }
    let magnitude = libm::floor(libm::log10(value.abs()));
    if !(-4.0..9.0).contains(&magnitude) {
        return format!("{value:.5e}");
    }
    // In range by the line above.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    let text = format!("{value:.*}", (5.0 - magnitude).max(0.0) as usize);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

impl fmt::Display for Millimetres {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} mm", significant(self.0 * 1e3))
    }
}

impl fmt::Display for Degrees {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} deg", significant(self.0.to_degrees()))
    }
}

impl fmt::Display for Plain {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(&significant(self.0))
    }
}

impl fmt::Display for Reached {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Radius(radius) => write!(formatter, "at a radius of {radius}"),
            Self::InsideBaseCircle => formatter.write_str("beyond the tangent point on the base circle"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_with_the_digits_that_tell() {
        for (value, shown) in [
            (0.014_25, "14.25 mm"),
            (0.1, "100 mm"),
            (-1.234_567_8e-4, "-0.123457 mm"),
            (0.0, "0 mm"),
            (1e-12, "1.00000e-9 mm"),
        ] {
            assert_eq!(Millimetres(value).to_string(), shown);
        }
        assert_eq!(Plain(123_456_789.0).to_string(), "123456789");
    }
}
