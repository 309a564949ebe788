//! What a study says of single teeth: pitch deviations, and traces of their flanks.
//!
//! Must not know: how a curve is found.

use std::collections::BTreeSet;

use super::tables::{Deviations, Flank};
use crate::stage::evaluated::Evaluated;
use declare::Declared;
use declare::declared::{self, FromFile, Parameter, Placed};
use declare::error::{Diagnostic, Failure, Faults, Place};
use declare::parameter::Shape;
use declare::record::{Record, Value};
use declare::units::LENGTH;
use gearmesh::gear::geometry::{GearPair, Side};
use gearmesh::gear::mesh::answers::hunting::{PitchDeviations, Teeth, ToothFlanks};
use gearmesh::gear::modification::measured::Measured;
use gearmesh::gear::modification::{Design, Gears, Specified};

/// The largest pitch deviation that is looked at \[m\]; beyond it nothing is small against a tooth.
const MOST: f64 = 1e-3;
/// So many teeth are mostly measured of a gear of which not all are (ISO 1328-1 has three).
const SAMPLE: usize = 4;

/// Deviations of the working flanks of a gear's teeth, which count in the order in which they come into mesh (ISO 1328-1).
#[derive(Clone, Debug, Declared)]
pub struct StatedDeviations {
    /// Cumulative pitch deviations F_p of each tooth as they are measured on the reference circle: how much farther from the first
    /// tooth's flank than its nominal place, in the direction of counting.
    #[declared(minimum = -MOST, maximum = MOST, dimension = LENGTH, example = "3 um")]
    pub cumulative: Option<Placed<Vec<f64>>>,
    /// Single pitch deviations f_p of each tooth: of the pitch that ends at it. Their mean is taken off.
    #[declared(minimum = -MOST, maximum = MOST, dimension = LENGTH, example = "-3 um")]
    pub single: Option<Placed<Vec<f64>>>,
    /// Flanks as measured, tooth by tooth; teeth that none is of have that of the design.
    pub flanks: Option<Vec<Traced>>,
}

/// The flank of a tooth as measured, beside what the design takes off.
#[derive(Clone, Debug, Declared)]
pub struct StatedFlank {
    /// Which teeth have it, from 1 in the order in which teeth come into mesh.
    #[declared(minimum = 1, maximum = 10_000, example = "1")]
    pub tooth: Vec<usize>,
    #[declared(flatten)]
    pub file: FromFile,
    #[declared(flatten)]
    pub trace: Measured,
}

/// The same with the record that says so, for messages about its fields.
#[derive(Clone, Debug)]
pub struct Traced {
    stated: StatedFlank,
    record: Record,
}

impl Parameter for Traced {
    const SHAPE: Shape = StatedFlank::SHAPE;

    fn consistent(value: &Value) -> Result<(), Diagnostic> {
        <StatedFlank as Parameter>::consistent(value)
    }

    fn of_value(value: &Value) -> Self {
        Self { stated: StatedFlank::of_value(value), record: declared::group(value).clone() }
    }

    fn to_value(&self) -> Value {
        self.stated.to_value()
    }
}

impl Traced {
    /// What is wrong with its tooth of this place in the list.
    fn of_tooth(&self, place: usize, message: String) -> Diagnostic {
        self.record.locate(Diagnostic::new(message).of_item(StatedFlank::NAMES.tooth, place))
    }

    /// The ways along which it was measured.
    fn ways(&self) -> impl Iterator<Item = &'static str> {
        let Measured { roll_lengths, roll_angles, diameters, face_positions, .. } = &self.stated.trace;
        let is_along = [roll_lengths, roll_angles, diameters].into_iter().any(Option::is_some);
        let ways = [("along the profile", is_along), ("across the face", face_positions.is_some())];
        ways.into_iter().filter(|(_, is_there)| *is_there).map(|(way, _)| way)
    }
}

impl StatedDeviations {
    /// Refuses what contradicts itself, whatever the gear that is called `name`.
    pub fn check(&self, name: &str, place: Place) -> Result<(), Faults> {
        let names = Self::NAMES;
        if let (Some(one), Some(other)) = (&self.cumulative, &self.single) {
            let (place, message) = (
                if one.place.offset > other.place.offset { one.place } else { other.place },
                format!("`{}` and `{}` of the {name}'s teeth say the same", names.cumulative, names.single),
            );
            return Err(Diagnostic::new(message).at(place).help("keep one of them").into());
        }
        let is_empty = |given: &Option<Placed<Vec<f64>>>| given.as_ref().is_none_or(|given| given.value.is_empty());
        if is_empty(&self.cumulative) && is_empty(&self.single) && self.flanks.as_ref().is_none_or(Vec::is_empty) {
            let message = format!(
                "give `{}` or `{}` of the {name}'s teeth, or some of their `{}`",
                names.cumulative, names.single, names.flanks
            );
            return Err(Diagnostic::new(message).at(place).into());
        }
        let mut wrong = Vec::new();
        let mut seen = BTreeSet::new();
        for traced in self.flanks.iter().flatten() {
            wrong.extend(traced.stated.trace.check().map_err(|wrong| traced.record.locate(wrong)).err());
            if traced.stated.tooth.is_empty() {
                let message = "this flank is of no tooth";
                wrong.push(traced.record.locate(Diagnostic::new(message).of(StatedFlank::NAMES.tooth)));
            }
            for (place, &tooth) in traced.stated.tooth.iter().enumerate() {
                let again: Vec<_> = traced.ways().filter(|way| !seen.insert((tooth, *way))).collect();
                if let [way, ..] = again[..] {
                    let message = format!("tooth {tooth} of the {name} has two traces {way}");
                    wrong.push(traced.of_tooth(place, message).help("keep one of them"));
                }
            }
        }
        Faults::all(wrong)
    }

    /// F_p of each tooth \[m\], of which the first has none; empty where none are stated.
    fn cumulative(&self) -> Vec<f64> {
        let from_first = |all: Vec<f64>| all.iter().map(|deviation| deviation - all[0]).collect();
        let Some(single) = &self.single else {
            return from_first(self.cumulative.clone().map_or_else(Vec::new, |of| of.value));
        };
        let mean = single.value.iter().sum::<f64>() / single.value.len().max(1) as f64;
        let mut sum = 0.0;
        let summed = |deviation: &f64| {
            sum += deviation - mean;
            sum
        };
        from_first(single.value.iter().map(summed).collect())
    }

    fn place_of_pitches(&self) -> Place {
        self.cumulative.as_ref().or(self.single.as_ref()).map(|of| of.place).unwrap_or_default()
    }

    /// How many teeth there are, as far as that can be told.
    pub fn teeth(&self) -> Option<usize> {
        let stated = self.cumulative.as_ref().or(self.single.as_ref()).map(|of| of.value.len());
        let named: BTreeSet<usize> =
            self.flanks.iter().flatten().flat_map(|traced| &traced.stated.tooth).copied().collect();
        // A gear that is measured as a whole has no gap; one tooth or a few are a sample.
        let is_whole = named.len() > SAMPLE && named.last() == Some(&named.len());
        stated.or_else(|| is_whole.then_some(named.len()))
    }

    /// How many traces of teeth there are.
    pub fn traces(&self) -> usize {
        self.counted(|_| true)
    }

    /// How many of them go across the face alone, and over all of the flank.
    pub fn traces_across(&self) -> [usize; 2] {
        [false, true].map(|along| {
            self.counted(|trace| {
                let goes_along =
                    trace.roll_lengths.is_some() || trace.roll_angles.is_some() || trace.diameters.is_some();
                trace.face_positions.is_some() && goes_along == along
            })
        })
    }

    fn counted(&self, is: impl Fn(&Measured) -> bool) -> usize {
        let flanks = self.flanks.iter().flatten().filter(|traced| is(&traced.stated.trace));
        flanks.map(|traced| traced.stated.tooth.len()).sum()
    }
}

/// What is stated of both gears, on a pair.
pub struct OfPair<'a> {
    pub teeth: Teeth,
    pub deviations: Deviations,
    pair: &'a GearPair,
    /// Of each trace its gear, what it says, and what it comes to.
    traces: Vec<(Side, &'a Traced, Vec<Evaluated>)>,
}

impl<'a> OfPair<'a> {
    /// # Errors
    /// What is not of this pair, with its place in the study.
    pub fn new(pair: &'a GearPair, stated: [Option<&'a StatedDeviations>; 2]) -> Result<Self, Failure> {
        let cumulative = stated.map(|gear| gear.map(StatedDeviations::cumulative).unwrap_or_default());
        let pitch = PitchDeviations::new(pair, [&cumulative[0], &cumulative[1]]).map_err(|why| {
            let place = stated[why.side as usize].map(StatedDeviations::place_of_pitches).unwrap_or_default();
            Failure::of(Diagnostic::new(why.to_string()).at(place))
        })?;
        let (mut flanks, mut traces, mut wrong) = (ToothFlanks::default(), Vec::new(), Vec::new());
        for (side, gear) in [Side::Pinion, Side::Gear].into_iter().zip(stated) {
            for traced in gear.into_iter().flat_map(|gear| gear.flanks.iter().flatten()) {
                let mut own = Design::default();
                let gears = if side == Side::Pinion { Gears::Pinion } else { Gears::Gear };
                if let Err(found) = own.add(gears, &traced.stated.trace, pair) {
                    let message = format!("a flank of the {}: {}", side.name(), found.message);
                    wrong.push(traced.record.locate(Diagnostic { message, ..found }));
                    continue;
                }
                for (place, tooth) in traced.stated.tooth.iter().enumerate() {
                    // Teeth count from 1 in a study, and have a minimum.
                    if let Err(why) = flanks.give(pair, side, tooth - 1, &own) {
                        wrong.push(traced.of_tooth(place, why.to_string()));
                    }
                }
                let evaluated = own.side(side).iter().flat_map(|part| Evaluated::all(&part.modification.resolved()));
                traces.push((side, traced, evaluated.collect()));
            }
        }
        Faults::all(wrong)?;
        let counts = [Side::Pinion, Side::Gear].map(|side| flanks.count(side));
        let deviations = Deviations::new(&cumulative, counts);
        Ok(Self { teeth: Teeth { pitch, flanks }, deviations, pair, traces })
    }

    /// Refuses a design that leaves too little of a tooth together with its own flank.
    ///
    /// # Errors
    /// Which tooth, with the place of its trace in the study.
    pub fn fit(&self, name: &str, design: &Design) -> Result<(), Failure> {
        self.teeth.flanks.fit(design, self.pair).map_err(|(side, tooth, wrong)| {
            let of_tooth = |(of, traced, _): &&(Side, &Traced, Vec<Evaluated>)| {
                *of == side && traced.stated.tooth.contains(&(tooth + 1))
            };
            let place = self.traces.iter().find(of_tooth).map(|(_, traced, _)| traced.record.place).unwrap_or_default();
            let message = format!("design `{name}` with tooth {} of the {}: {}", tooth + 1, side.name(), wrong.message);
            Failure::of(Diagnostic::new(message).at(place))
        })
    }

    /// What the traces of all teeth come to, gear by gear and tooth by tooth.
    pub fn evaluated(&self) -> Vec<Flank> {
        let of = |(side, traced, evaluated): &(Side, &Traced, Vec<Evaluated>)| {
            let row = |tooth: usize, evaluated: Evaluated| Flank { side: *side, tooth, evaluated };
            let teeth = traced.stated.tooth.iter();
            teeth.flat_map(|tooth| evaluated.iter().map(move |of| row(*tooth, *of))).collect::<Vec<_>>()
        };
        let mut rows: Vec<Flank> = self.traces.iter().flat_map(of).collect();
        rows.sort_by_key(|row| (row.side as usize, row.tooth));
        rows
    }
}
