//! Why a gear or a pair is impossible: the values, the admissible range, and the parameter to change.
//!
//! Must not know: where a study states the parameter. Lengths and angles arrive in SI and are shown in mm and degrees.

pub mod parameter;
mod reached;
pub mod shown;
#[cfg(test)]
mod tests;

pub use parameter::Parameter;
pub use reached::Reached;
pub use shown::{Degrees, Millimetres, Plain};

use shown::{beside, beside_both};

use super::Side;

/// A gear or pair that cannot be made or cannot run.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{}{problem}", side_prefix(*.side))]
pub struct GeometryError {
    /// The gear that is meant; `None` when there is only one gear or when the pair is meant.
    pub side: Option<Side>,
    /// What is wrong, with its numbers.
    pub problem: Problem,
}

/// What makes a gear or a pair impossible, with the numbers of its message.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Problem {
    /// A value is outside the range in which a gear can be computed at all.
    #[error("{} is {found}, but must be {range}", .parameter.words())]
    OutOfRange {
        /// The parameter with that value.
        parameter: Parameter,
        /// The value, with its unit.
        found: String,
        /// The admissible range, in words.
        range: String,
    },
    /// The flanks of the rack's teeth meet before its dedendum is reached: (π/4 − h_fP* tan α) is not positive.
    #[error(
        "the rack's teeth end in a point before they are {dedendum} modules deep: the pressure angle is {}, but must be below {}",
        beside(.angle, .largest),
        beside(.largest, .angle)
    )]
    NoTipLand {
        /// h_fP*.
        dedendum: Plain,
        /// α \[rad\].
        angle: Degrees,
        /// The pressure angle at which they meet at that depth: atan(π/(4 h_fP*)) \[rad\].
        largest: Degrees,
    },
    /// The round of the rack's tip is more than a full round.
    #[error(
        "the rack's tip radius is {} modules, but must be 0 to {} (full round)",
        beside(.radius, .largest),
        beside(.largest, .radius)
    )]
    TipRoundTooLarge {
        /// ρ_fP*.
        radius: Plain,
        /// ρ_fP* at which the tip land of the rack vanishes.
        largest: Plain,
    },
    /// The teeth of the cutter are pointed.
    #[error(
        "the cutter's teeth are pointed: their flanks meet at a radius of {}, its tip radius is {}, but must be below that",
        beside(.apex, .tip),
        beside(.tip, .apex)
    )]
    CutterPointed {
        /// r_a0 \[m\].
        tip: Millimetres,
        /// Radius at which the two flanks of its tooth meet \[m\].
        apex: Millimetres,
    },
    /// The round of the cutter's tip is more than a full round, or begins below its base circle.
    #[error(
        "the cutter's tip radius is {} modules, but must be 0 to {}, where its tips are fully round or no flank is left",
        beside(.radius, .largest),
        beside(.largest, .radius)
    )]
    CutterRoundTooLarge {
        /// ρ_aP0*.
        radius: Plain,
        /// The largest ρ_aP0*.
        largest: Plain,
    },
    /// The cutter's involute begins before the gear's ends.
    #[error(
        "a cutter of {teeth} teeth has no involute for the flank beyond a radius of {}, but the tip circle is at {}: it needs more teeth",
        beside(.reached, .tip),
        beside(.tip, .reached)
    )]
    CutterTooSmall {
        /// z_0.
        teeth: u32,
        /// Where its base circle cuts \[m\].
        reached: Millimetres,
        /// r_a \[m\].
        tip: Millimetres,
    },
    /// The tool leaves so much stock that its teeth end in a point before they reach the root.
    #[error(
        "the machining allowance is {} modules, but must be below {}, where the tool's teeth end in a point before they are {dedendum} modules deep",
        beside(.allowance, .largest),
        beside(.largest, .allowance)
    )]
    AllowanceTooLarge {
        /// q*.
        allowance: Plain,
        /// h_fP*.
        dedendum: Plain,
        /// q* at which the tool's tip land vanishes.
        largest: Plain,
    },
    /// The protuberance cuts away the whole flank.
    #[error(
        "no involute is left: the protuberance of {protuberance} modules at {angle}, less a machining allowance of {allowance}, cuts the flank away up to the tip circle at {tip}"
    )]
    ProtuberanceTooLarge {
        /// pr*.
        protuberance: Plain,
        /// q*.
        allowance: Plain,
        /// α_prP \[rad\].
        angle: Degrees,
        /// r_a \[m\].
        tip: Millimetres,
    },
    /// The notch that grinding leaves does not go over into the root.
    #[error(
        "grinding leaves a notch {depth} deep in the root, since the allowance is larger than the protuberance; the radius of the notch is {} modules, but must be above {} and at most {} to meet the root",
        beside_both(.radius, [.smallest, .largest]),
        beside(.smallest, .radius),
        beside(.largest, .radius)
    )]
    NotchRadius {
        /// ρ_g*.
        radius: Plain,
        /// t_g \[m\].
        depth: Millimetres,
        /// t_g*, with which the arc turns by a right angle.
        smallest: Plain,
        /// ρ_g* with which the arc still reaches the root curve, by bisection.
        largest: Plain,
    },
    /// The form radius is not below the tip radius: undercut has cut the involute off, or the tip circle is too small.
    #[error(
        "no involute is left: the root curve reaches up to {}, the tip circle is at {}; {teeth} teeth need a profile shift of at least {minimum} modules not to be undercut",
        beside(.form, .tip),
        beside(.tip, .form)
    )]
    NoFlank {
        /// Form radius, where root curve and involute meet \[m\].
        form: Millimetres,
        /// r_a \[m\].
        tip: Millimetres,
        /// z.
        teeth: u32,
        /// x_min: the least profile shift without undercut \[modules\].
        minimum: Plain,
    },
    /// The thickness s_a at the tip circle is not positive.
    #[error(
        "the teeth are pointed: the flanks meet at a radius of {}, the tip radius is {}, but must be below that",
        beside(.apex, .tip),
        beside(.tip, .apex)
    )]
    Pointed {
        /// r_a \[m\].
        tip: Millimetres,
        /// Radius at which the two flanks of a tooth meet \[m\].
        apex: Millimetres,
        /// Whether r_a was specified; otherwise it follows from the profile shift.
        tip_is_given: bool,
    },
    /// The bore is so small that the body could turn about it without limit, or it reaches the root circle.
    #[error(
        "the bore radius is {}, but must be at least {} and below the root radius {}",
        beside_both(.bore, [.minimum, .root]),
        beside(.minimum, .bore),
        beside(.root, .bore)
    )]
    Bore {
        /// Radius of the bore \[m\].
        bore: Millimetres,
        /// The least radius: r_f/1000 \[m\].
        minimum: Millimetres,
        /// r_f \[m\].
        root: Millimetres,
    },
    /// Pinion and gear differ in what they must share to mesh: module or pressure angle.
    #[error("{} differs: {pinion} on the pinion, {gear} on the gear", .parameter.words())]
    Differs {
        /// The parameter that differs.
        parameter: Parameter,
        /// Its value on the pinion, with its unit.
        pinion: String,
        /// Its value on the gear, with its unit.
        gear: String,
    },
    /// a_w is more than a thousandth of a module below the one without backlash, or not finite.
    #[error(
        "the centre distance is {}, but must be at least {}, or a thousandth of a module less, for the teeth to fit into each other",
        beside(.found, .minimum),
        beside(.minimum, .found)
    )]
    CentreDistance {
        /// a_w \[m\].
        found: Millimetres,
        /// a_w without backlash \[m\].
        minimum: Millimetres,
    },
    /// inv α_w = inv α + 2 tan α (x1 + x2)/(z1 + z2) is not positive, so there is no α_w.
    #[error(
        "profile shifts that add up to {} modules leave no working pressure angle; their sum must be above {}",
        beside(.sum, .minimum),
        beside(.minimum, .sum)
    )]
    ProfileShiftSum {
        /// x1 + x2 \[modules\].
        sum: Plain,
        /// x1 + x2 at which inv α_w vanishes \[modules\].
        minimum: Plain,
    },
    /// A tip circle overlaps the root circle of the mate.
    #[error(
        "its tip circle ({tip}) reaches to the root circle of the mate: clearance {clearance}, but must be at least 0 mm"
    )]
    NoClearance {
        /// r_a of the gear that is meant \[m\].
        tip: Millimetres,
        /// c = a_w − r_a − r_f of the mate \[m\]; negative here.
        clearance: Millimetres,
    },
    /// The mate's tip touches below the form radius, where there is no involute of this gear.
    #[error(
        "interference: the mate's tip ({}) {}would touch {}, below the form radius {}; the mate's tip radius must be at most {}",
        beside(.mate_tip, .largest),
        .cut.map_or_else(String::new, |depth| format!("cuts {depth} into the root: it ")),
        .reached.beside(*.form),
        .reached.form(*.form),
        beside(.largest, .mate_tip)
    )]
    Interference {
        /// r_a of the mate \[m\].
        mate_tip: Millimetres,
        /// How deep that cuts into the root \[m\], where nothing less is refused.
        cut: Option<Millimetres>,
        /// How far down it touches.
        reached: Reached,
        /// Form radius of this gear \[m\].
        form: Millimetres,
        /// The r_a of the mate with which it would touch at the form radius \[m\].
        largest: Millimetres,
    },
    /// ε_α is not above 1: a pair of teeth would leave contact before the next one takes over.
    #[error("the contact ratio is {}, but must be above 1", beside(.ratio, &Plain(1.0)))]
    ContactRatio {
        /// ε_α.
        ratio: Plain,
    },
    /// Fillets of the rack's own tip radius overlap on the root circle.
    #[error(
        "a circular fillet of radius {radius} does not fit between two teeth: the fillets would overlap by {overlap}"
    )]
    FilletDoesNotFit {
        /// ρ_fP \[m\].
        radius: Millimetres,
        /// How far neighbouring fillets overlap along the root circle \[m\].
        overlap: Millimetres,
    },
    /// Root arcs of a stated radius overlap on the root circle.
    #[error(
        "an arc of radius {} at the root does not fit between two teeth: neighbouring arcs would overlap by {overlap}; its radius must be at most {}",
        beside(.radius, .largest),
        beside(.largest, .radius)
    )]
    RootArcTooLarge {
        /// Radius of the arc \[m\].
        radius: Millimetres,
        /// How far neighbouring arcs overlap along the root circle \[m\].
        overlap: Millimetres,
        /// The radius with which neighbouring arcs meet in the middle of the space \[m\].
        largest: Millimetres,
    },
    /// An arc from base circle to root circle is asked for, but the root circle is not inside the base circle.
    #[error(
        "{construction} begins on the base circle and ends on the root circle, so the root radius {} must be below the base radius {}; with this rack that is so below {maximum} teeth, and there are {teeth}",
        beside(.root, .base),
        beside(.base, .root)
    )]
    NothingBelowBase {
        /// What asks for it, as the subject of the message.
        construction: &'static str,
        /// r_f \[m\].
        root: Millimetres,
        /// r_b \[m\].
        base: Millimetres,
        /// z.
        teeth: u32,
        /// The number of teeth at which r_f = r_b with this rack and profile shift; a real number.
        maximum: Plain,
    },
    /// Undercut is so deep that no thickness is left at the tooth's neck.
    #[error(
        "the root curve cuts the tooth off at a radius of {height}; {teeth} teeth need a profile shift of at least {minimum} modules not to be undercut"
    )]
    CutOff {
        /// Height of the neck above the gear's centre \[m\].
        height: Millimetres,
        /// z.
        teeth: u32,
        /// x_min: the least profile shift without undercut \[modules\].
        minimum: Plain,
    },
    /// A tooth is to be thicker at least than at most.
    #[error(
        "the smallest tooth is {}, but must be at most the largest, {}",
        beside(.smallest, .largest),
        beside(.largest, .smallest)
    )]
    ThicknessLimits {
        /// As stated: an allowance, a span, a dimension over balls \[m\].
        largest: Millimetres,
        /// Likewise \[m\].
        smallest: Millimetres,
    },
    /// Balls that measure as little would lie inside the base circle.
    #[error(
        "the dimension over balls is {}, but must be above {}, where their centres are on the base circle",
        beside(.found, .minimum),
        beside(.minimum, .found)
    )]
    BallsInside {
        /// M_dK \[m\].
        found: Millimetres,
        /// The least M_dK \[m\].
        minimum: Millimetres,
    },
    /// Teeth that are made so much thinner do not exist.
    #[error(
        "the thickness allowance is {}, but must be above {}, where the tooth vanishes",
        beside(.allowance, .minimum),
        beside(.minimum, .allowance)
    )]
    NoTooth {
        /// A_s \[m\].
        allowance: Millimetres,
        /// A_s at which the tooth has no thickness at the base circle \[m\].
        minimum: Millimetres,
    },
    /// A chamfer or rounding of the tip does not fit the tooth.
    #[error(
        "the tip is broken by {}, but must be by {} at most, where the two flanks' breaks meet or no flank is left",
        beside(.size, .largest),
        beside(.largest, .size)
    )]
    TipBreakTooLarge {
        /// Size of the chamfer, or radius of the rounding \[m\].
        size: Millimetres,
        /// The largest one that fits, by bisection \[m\].
        largest: Millimetres,
    },
    /// Modifications take off the flank so that it does not reach the tip circle.
    #[error("the modified flank does not reach the tip circle: {depth} are taken off at the tip")]
    TipTakenOff {
        /// What is taken off at the tip, normal to the flank \[m\].
        depth: Millimetres,
    },
    /// Modifications take off the whole flank at the form point.
    #[error("the modified flank ends below its own root: {depth} are taken off where the root begins")]
    ReliefTooDeep {
        /// What is taken off at the form point, normal to the flank \[m\].
        depth: Millimetres,
    },
}

/// What an error is about, of all that its user stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// A number.
    Parameter(Parameter),
    /// The shape of the root.
    Root,
    /// What is done to the tip's corner.
    Tip,
    /// The modification of the flank.
    Flank,
}

impl GeometryError {
    /// What it is about; of which gear, `side` says.
    #[must_use]
    pub fn subject(&self) -> Subject {
        Subject::Parameter(match &self.problem {
            Problem::OutOfRange { parameter: Parameter::TipAngle, .. } | Problem::TipBreakTooLarge { .. } => {
                return Subject::Tip;
            }
            Problem::OutOfRange { parameter, .. } | Problem::Differs { parameter, .. } => *parameter,
            Problem::NoTipLand { .. } => Parameter::PressureAngle,
            Problem::TipRoundTooLarge { .. } | Problem::FilletDoesNotFit { .. } => Parameter::RackTipRadius,
            Problem::CutterPointed { .. } => Parameter::CutterProfileShift,
            Problem::CutterRoundTooLarge { .. } => Parameter::CutterTipRadius,
            Problem::CutterTooSmall { .. } => Parameter::CutterTeeth,
            Problem::AllowanceTooLarge { .. } => Parameter::MachiningAllowance,
            Problem::ProtuberanceTooLarge { .. } => Parameter::Protuberance,
            Problem::NotchRadius { .. } => Parameter::NotchRadius,
            Problem::NoFlank { .. } | Problem::Interference { .. } => Parameter::Teeth,
            Problem::RootArcTooLarge { .. } | Problem::NothingBelowBase { .. } | Problem::CutOff { .. } => {
                return Subject::Root;
            }
            Problem::ReliefTooDeep { .. } | Problem::TipTakenOff { .. } => return Subject::Flank,
            Problem::Pointed { tip_is_given: false, .. } | Problem::ProfileShiftSum { .. } => Parameter::ProfileShift,
            Problem::Pointed { .. } | Problem::NoClearance { .. } => Parameter::TipRadius,
            Problem::Bore { .. } => Parameter::BoreRadius,
            Problem::ThicknessLimits { .. } | Problem::BallsInside { .. } | Problem::NoTooth { .. } => {
                Parameter::ToothThickness
            }
            Problem::CentreDistance { .. } => Parameter::CentreDistance,
            Problem::ContactRatio { .. } => Parameter::RackAddendum,
        })
    }

    /// The same error of the gear on a side, so that the message names it.
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
