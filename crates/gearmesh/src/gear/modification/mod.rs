//! Tooth flank modifications: the trait every family has, the registry, and designs made of them.
//!
//! Depths are normal to the flank \[m\], positive where material is removed, and add up per gear. The profile is a
//! function of the gear's roll angle \[rad\], the lead a function of z \[m\], which counts from the middle of the face
//! and points the same way for both gears. Names and signs: ISO 21771-1, ISO 1328-1. Must not know: compliance, load.

pub mod arc;
pub mod curve;
pub mod end_relief;
pub mod flank;
pub mod helix_slope;
pub mod lead_crowning;
pub mod measured;
pub mod parabola;
pub mod profile;
pub mod profile_crowning;
pub mod profile_slope;
pub mod relief;
mod room;
pub mod root_relief;
pub mod section;
pub mod template;
#[cfg(test)]
mod tests;
pub mod tip_curve;
pub mod tip_relief;

use std::fmt::Debug;
use std::marker::PhantomData;
use std::sync::Arc;

use self::flank::Flank;
use super::geometry::{GearPair, Side};
use crate::numeric::quadratic::Quadratic;
use declare::declared::Declared;
use declare::error::Diagnostic;
use declare::parameter::{FILE, Field, Member, Shape, count};
use declare::record::Record;
use declare::{Declared, Words};

/// Every family, in the order in which they are listed to the user.
pub const FAMILIES: &[Family] = &[
    Family::of::<tip_relief::TipRelief>(),
    Family::of::<root_relief::RootRelief>(),
    Family::of::<arc::ArcRelief>(),
    Family::of::<parabola::ParabolicRelief>(),
    Family::of::<profile_crowning::ProfileCrowning>(),
    Family::of::<profile_slope::ProfileSlope>(),
    Family::of::<lead_crowning::LeadCrowning>(),
    Family::of::<helix_slope::HelixSlope>(),
    Family::of::<end_relief::EndRelief>(),
    Family::of::<measured::Measured>(),
];

/// A modification as a drawing states it: a declared struct, which anybody can make.
pub trait Specified: Declared {
    /// Refuses combinations that no declaration can express.
    ///
    /// # Errors
    /// Which field does not go with which.
    fn check(&self) -> Result<(), Diagnostic> {
        Ok(())
    }

    /// What it is on one gear of a pair. It has passed [`Specified::check`].
    ///
    /// # Errors
    /// When it does not fit, for example a relief longer than the flank, with the admissible range.
    fn on(&self, pair: &GearPair, side: Side) -> Result<Arc<dyn Modification>, Diagnostic>;
}

/// Which gears are modified.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Words)]
pub enum Gears {
    /// the driving gear
    Pinion,
    /// the driven gear
    Gear,
    /// each of the two, with the same values
    Both,
}

impl Gears {
    fn sides(self) -> &'static [Side] {
        match self {
            Self::Pinion => &[Side::Pinion],
            Self::Gear => &[Side::Gear],
            Self::Both => &[Side::Pinion, Side::Gear],
        }
    }
}

/// What a study states of every modification.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Declared)]
pub struct Where {
    /// Which gear is modified.
    pub gear: Gears,
}

type Put = fn(&mut Design, &Record, &GearPair) -> Result<(), Diagnostic>;

/// A family as registered.
#[derive(Clone, Copy)]
pub struct Family {
    /// Its name, meaning and fields, those of [`Where`] before its own.
    pub member: Member,
    /// Refuses combinations of fields that no declaration can express; values may still be ranges.
    pub check: fn(&Record) -> Result<(), Diagnostic>,
    /// Adds it to a design without a look at what is left of the tooth. The record has passed `check`, with ranges or
    /// without, and holds none.
    put: Put,
}

impl Family {
    const fn of<T: Specified>() -> Self {
        Self {
            member: Member { fields: Stated::<T>::FIELDS, ..T::MEMBER },
            check: |record| {
                T::consistent(record)?;
                let stated = T::read(&record.without_ranges(T::MEMBER.fields));
                stated.check().map_err(|wrong| record.locate(wrong))
            },
            put: |design, record, pair| {
                design.put(Where::read(record).gear, &T::read(record), pair).map_err(|wrong| record.locate(wrong))
            },
        }
    }
}

/// The fields of a family as a study states them.
struct Stated<T>(PhantomData<T>);

impl<T: Declared> Stated<T> {
    /// Lists of numbers may stand in a file.
    const FILES: &'static [Field] = if has_lists(T::MEMBER.fields) { &[FILE] } else { &[] };
    const ALL: [&'static [Field]; 3] = [Where::MEMBER.fields, Self::FILES, T::MEMBER.fields];
    const COUNT: usize = count(&Self::ALL);
    const PADDED: &'static [Field; MOST_FIELDS] = &{
        assert!(Self::COUNT <= MOST_FIELDS);
        let mut fields = [FILE; MOST_FIELDS];
        let (mut table, mut at) = (0, 0);
        while table < Self::ALL.len() {
            let mut field = 0;
            while field < Self::ALL[table].len() {
                fields[at] = Self::ALL[table][field];
                at += 1;
                field += 1;
            }
            table += 1;
        }
        fields
    };
    const FIELDS: &'static [Field] = Self::PADDED.split_at(Self::COUNT).0;
}

const fn has_lists(fields: &[Field]) -> bool {
    let mut at = 0;
    while at < fields.len() {
        if matches!(fields[at].shape, Shape::List(Shape::Quantity { .. } | Shape::Number { .. })) {
            return true;
        }
        at += 1;
    }
    false
}

/// The most fields of a family.
const MOST_FIELDS: usize = 16;

/// One modification of one gear, with everything resolved.
///
/// What is taken off at a place is the sum of up to three functions. One that is not 0 comes with its flag; without it the
/// function is never asked for, and [`Design::add`] refuses what it finds:
///
/// | function | of | flag | broken where |
/// |---|---|---|---|
/// | [`Self::depth`] | the roll angle | [`Self::varies_along_profile`] | [`Self::profile_breaks`] |
/// | [`Self::lead`] | z | [`Self::varies_along_face`] | [`Self::lead_breaks`] |
/// | [`Self::surface`] | both | [`Self::varies_over_surface`] | both |
///
/// Roll angles \[rad\] are those of the gear and may lie beyond its active flank, where corner contact or an outline
/// looks; z \[m\] counts from the middle of its face, which is the middle of the mate's too, and points the same way for
/// both gears. Values are \[m\], normal to the flank, positive where material is removed; a slope or a twist may be negative
/// in places. With the whole face in contact and linear contact, what has a mean of 0 across the face leaves the loaded
/// transmission error as it is.
pub trait Modification: Debug + Send + Sync {
    /// Depth at a roll angle; continuous. 0 unless it is said.
    fn depth(&self, _roll: f64) -> f64 {
        0.0
    }

    /// The quadratic in the roll angle that [`Modification::depth`] equals between the breaks on either side of `roll`; `None`
    /// where it is of another kind, or where nobody says. It saves time and nothing else.
    fn profile_quadratic(&self, _roll: f64) -> Option<Quadratic> {
        None
    }

    /// [`Modification::depth`] at `roll` and its first and second derivative over the roll angle \[m, m/rad, m/rad²\], of the
    /// smooth stretch that `inside` lies on, whose end may be `roll`; `None` where nobody says. It saves time, and spares what
    /// searches along the profile the differences of rounded depths.
    fn profile_rates(&self, _roll: f64, _inside: f64) -> Option<[f64; 3]> {
        None
    }

    /// Roll angles at which the depth, or the surface, is not smooth; any number of them. Where a smooth stretch bends back
    /// more than sixteen times, corner contact needs breaks at every turn too.
    fn profile_breaks(&self) -> &[f64] {
        &[]
    }

    /// Ascending roll angles between which the depth, or the surface, is a cubic of its own, where there are so many that no few
    /// polynomials follow it: of a spline through the points of a trace. It is smooth there, with a second derivative that is
    /// continuous.
    fn profile_knots(&self) -> &[f64] {
        &[]
    }

    /// Whether [`Modification::depth`] may differ from 0.
    fn varies_along_profile(&self) -> bool {
        false
    }

    /// What is taken off at a roll angle and z beside the depth and the lead: for what is not a sum of both, such as a
    /// twist; continuous. It may be broken where [`Modification::profile_breaks`] and [`Modification::lead_breaks`]
    /// say.
    fn surface(&self, _roll: f64, _z: f64) -> f64 {
        0.0
    }

    /// [`Modification::surface`] at a roll angle and z, and its first and second derivative over the roll angle; `None` where nobody says.
    /// It saves time and nothing else.
    fn surface_rates(&self, _roll: f64, _z: f64) -> Option<[f64; 3]> {
        None
    }

    /// Whether [`Modification::surface`] may differ from 0.
    fn varies_over_surface(&self) -> bool {
        false
    }

    /// Deviation at z; continuous.
    fn lead(&self, z: f64) -> f64 {
        let [constant, slope, bend] = self.lead_quadratic(z).unwrap_or_default();
        constant + z * (slope + z * bend)
    }

    /// The polynomial c0 + c1 z + c2 z² that the lead equals between the breaks on either side of `z`; `None` when it
    /// is of another kind there.
    fn lead_quadratic(&self, _z: f64) -> Option<[f64; 3]> {
        Some([0.0; 3])
    }

    /// The z at which the lead, or the surface, is not smooth.
    fn lead_breaks(&self) -> &[f64] {
        &[]
    }

    /// Whether [`Modification::lead`] may differ from 0.
    fn varies_along_face(&self) -> bool {
        false
    }

    /// Whether the lead, and the surface, at −z is that at z; unless it is said, where neither varies.
    fn lead_is_even(&self) -> bool {
        !self.varies_along_face() && !self.varies_over_surface()
    }

    /// Names and values (SI) of what was given and of what follows from it.
    fn resolved(&self) -> Vec<(&'static str, f64)>;
}

/// What both gears of a pair are given.
#[derive(Clone, Debug, Default)]
pub struct Design {
    /// Modifications of the pinion; their depths add up.
    pub pinion: Vec<NamedModification>,
    /// Modifications of the gear; their depths add up.
    pub gear: Vec<NamedModification>,
    /// How fast the gap between the flanks grows with z, since the axes are not parallel or a lead is off \[m/m\]: of a pair as
    /// it is mounted, see [`super::misalignment`]. It turns about the middle of the face, where it takes nothing off.
    pub tilt: f64,
}

/// One modification and the name of its family.
#[derive(Clone, Debug)]
pub struct NamedModification {
    /// The name under which a study states it, such as `tip_relief`.
    pub family: &'static str,
    /// What it takes off its gear.
    pub modification: Arc<dyn Modification>,
}

impl Design {
    /// The modifications of the gear on a side.
    #[must_use]
    pub fn side(&self, side: Side) -> &[NamedModification] {
        match side {
            Side::Pinion => &self.pinion,
            Side::Gear => &self.gear,
        }
    }

    /// Whether what both gears lose across the face is the same on either side of its middle.
    #[must_use]
    #[allow(clippy::float_cmp)] // no tilt is what nobody stated
    pub fn lead_is_even(&self) -> bool {
        self.tilt == 0.0 && self.pinion.iter().chain(&self.gear).all(|part| part.modification.lead_is_even())
    }

    /// One modification of one gear or both.
    ///
    /// # Errors
    /// As [`Design::add`].
    pub fn of<T: Specified>(gears: Gears, stated: &T, pair: &GearPair) -> Result<Self, Diagnostic> {
        let mut design = Self::default();
        design.add(gears, stated, pair)?;
        Ok(design)
    }

    /// Adds a modification to one gear or both.
    ///
    /// # Errors
    /// When a value is out of its range, when values contradict each other or do not fit the pair, or when all
    /// modifications of a gear together take off more than half of its tooth.
    pub fn add<T: Specified>(&mut self, gears: Gears, stated: &T, pair: &GearPair) -> Result<(), Diagnostic> {
        stated.in_range()?;
        self.add_of_any_size(gears, stated, pair)
    }

    /// The same beyond the ranges that a study may state.
    pub(crate) fn add_of_any_size<T: Specified>(
        &mut self,
        gears: Gears,
        stated: &T,
        pair: &GearPair,
    ) -> Result<(), Diagnostic> {
        self.attempt(|design| {
            design.put(gears, stated, pair)?;
            design.check_rooms(gears, pair)
        })
    }

    /// The same, as `family: { fields }` of a study states it.
    ///
    /// # Errors
    /// As [`Design::add`], with places.
    pub fn add_record(&mut self, family: &'static Family, record: &Record, pair: &GearPair) -> Result<(), Diagnostic> {
        (family.check)(record)?;
        self.attempt(|design| {
            (family.put)(design, record, pair)?;
            design.check_rooms(Where::read(record).gear, pair).map_err(|error| error.or_at(record.place))
        })
    }

    /// Makes a change, and takes back what was added where it is refused.
    fn attempt(&mut self, change: impl FnOnce(&mut Self) -> Result<(), Diagnostic>) -> Result<(), Diagnostic> {
        let before = [self.pinion.len(), self.gear.len()];
        let changed = change(self);
        if changed.is_err() {
            self.pinion.truncate(before[0]);
            self.gear.truncate(before[1]);
        }
        changed
    }

    fn put<T: Specified>(&mut self, gears: Gears, stated: &T, pair: &GearPair) -> Result<(), Diagnostic> {
        stated.check()?;
        for &side in gears.sides() {
            let modification = stated.on(pair, side)?;
            check_flags(&*modification, &Flank::new(pair, side)).map_err(|function| {
                let family = T::MEMBER.name;
                Diagnostic::new(format!(
                    "`{family}` has a {function} that is not 0, but its flag says that there is none"
                ))
            })?;
            let parts = if side == Side::Pinion { &mut self.pinion } else { &mut self.gear };
            parts.push(NamedModification { family: T::MEMBER.name, modification });
        }
        Ok(())
    }

    /// The sum of the depths of one gear at a roll angle; leads and surfaces are not among them.
    #[must_use]
    pub fn depth(&self, side: Side, roll: f64) -> f64 {
        self.side(side).iter().map(|part| part.modification.depth(roll)).sum()
    }

    /// The sum of the lead deviations of both gears at z, and what their axes add.
    #[must_use]
    pub fn lead(&self, z: f64) -> f64 {
        let parts = self.pinion.iter().chain(&self.gear).map(|part| part.modification.lead(z));
        parts.sum::<f64>() + self.tilt * z
    }

    /// Every resolved parameter: gear, family, name, value (SI).
    #[must_use]
    pub fn resolved(&self) -> Vec<(Side, &'static str, &'static str, f64)> {
        let of = |side: Side| {
            self.side(side).iter().flat_map(move |part| {
                let values = part.modification.resolved().into_iter();
                values.map(move |(name, value)| (side, part.family, name, value))
            })
        };
        of(Side::Pinion).chain(of(Side::Gear)).collect()
    }
}

/// Which function is not 0 although its flag says that there is none: a family that forgot a flag would do nothing.
fn check_flags(modification: &dyn Modification, flank: &Flank) -> Result<(), &'static str> {
    // Nowhere special.
    let roll = flank.root_roll + 0.93 * (flank.tip_roll - flank.root_roll);
    let z = 0.37 * flank.face_width;
    if !modification.varies_along_profile() && modification.depth(roll) != 0.0 {
        return Err("depth");
    }
    if !modification.varies_along_face() && modification.lead(z) != 0.0 {
        return Err("lead");
    }
    if !modification.varies_over_surface() && modification.surface(roll, z) != 0.0 {
        return Err("surface");
    }
    Ok(())
}

/// The family called `name`.
#[must_use]
pub fn family(name: &str) -> Option<&'static Family> {
    FAMILIES.iter().find(|family| family.member.name == name)
}

/// The families as a user may write them, for [`declare::parameter::Shape::Member`].
#[must_use]
pub fn members() -> &'static [Member] {
    const MEMBERS: [Member; FAMILIES.len()] = {
        let mut members = [FAMILIES[0].member; FAMILIES.len()];
        let mut index = 1;
        while index < FAMILIES.len() {
            members[index] = FAMILIES[index].member;
            index += 1;
        }
        members
    };
    &MEMBERS
}

/// The largest amount \[m\]: beyond it a relief is no longer small against the tooth.
pub(crate) const MOST_AMOUNT: f64 = 5e-3;
