//! One base pitch of mesh: which pairs are in contact where, and quick copies of everything elastic.
//!
//! Cycle positions τ \[m\] run from 0, where a pair starts contact at A, to p_b, where the next one does; pair j of a
//! position is at s = s_A + τ + j p_b. The number of pairs in contact is a property of the zone a position was taken
//! from: no position is ever compared with a zone's end, so both one-sided limits at B and D exist. With corner contact
//! the springs are the pairs of a window of whole base pitches, as many at every position, from one base pitch before A to
//! at least one after E; zones then only count the pairs inside the path of contact. Must not know: modification, load.

use std::sync::Arc;

use super::across::Across;
use super::count::Total;
use super::ends::Ends;
use super::error::MeshError;
use super::path::{CLOSEST, Path};
use super::roots::Roots;
use crate::gear::compliance::{ContactLaw, PairCompliance, RootInfluences, ToothCompliance};
use crate::gear::contact::flattening::{Bodies, InSeries, Logarithmic, combined_radius};
use crate::gear::contact::plain::{PlainLaw, PlainLaws};
use crate::gear::contact::tip::{Ended, Tips};
use crate::gear::contact::{CornerContact, SliceCoupling};
use crate::gear::geometry::{GearPair, Side};
use crate::gear::mesh::trace::SpanRule;
use crate::numeric::chebyshev::Series;
use crate::numeric::complementarity::MOST_SPRINGS;
use crate::numeric::graded::Graded;
use crate::numeric::lobatto::Rule;
use crate::numeric::piecewise;
use crate::numeric::together::{Found, Together};
use declare::work::Work;

/// Zones shorter than this share of the base pitch are ignored: a contact ratio of 2 up to rounding is 2.
const SHORTEST_ZONE: f64 = 1e-9;

/// A position nearer than this share of the base pitch to where the number of pairs changes belongs behind it, whatever
/// rounding made of it.
const BORDER: f64 = 1e-12;

/// Relative accuracies of what the law of a pair adds up to while tips are far, and of what far tips add to it per load.
const PLAIN: [f64; 2] = [3e-14, 1e-12];

/// Pairs in corner contact: one before A and one after E.
const CORNERS: usize = 2;

/// How a mesh cycle is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Settings {
    /// Positions per base pitch; zone ends, relief starts, first touches and extrema are added.
    pub positions: usize,
    /// Slices on each smooth stretch of the face that is in contact, where there is no closed form; where slices are
    /// coupled, equal ones on the whole face.
    pub slices: usize,
    /// Whether tip corners also touch, before A and after E.
    pub corner_contact: CornerContact,
    /// Whether a loaded slice of the face takes its neighbours along.
    pub slice_coupling: SliceCoupling,
}

impl Default for Settings {
    /// 64 positions, 17 slices, contact from A to E only, slices that do not hold each other.
    fn default() -> Self {
        Self { positions: 64, slices: 17, corner_contact: CornerContact::None, slice_coupling: SliceCoupling::None }
    }
}

/// A stretch of the cycle with the same pairs in contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zone {
    /// τ where it begins \[m\].
    pub start: f64,
    /// τ where it ends \[m\].
    pub end: f64,
    /// Pairs inside the path of contact, loaded or not.
    pub pairs: usize,
}

/// A pair's mesh cycle.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// The gears, from which period and zones follow.
    pub pair: GearPair,
    /// How it is sampled, and where flanks may touch.
    pub settings: Settings,
    /// How many pairs are considered in every position, where that is not the number in the zone.
    springs: Option<usize>,
    /// The common face width \[m\].
    pub face_width: f64,
    /// In the order of τ, one base pitch together: two, or one where ε_α is whole; the first has the most pairs.
    pub zones: Vec<Zone>,
    pub(in crate::gear::mesh) path: Path,
    pub(in crate::gear::mesh) bodies: Bodies,
    pub(in crate::gear::mesh) elasticity: Elasticity,
    /// The derivatives of what both teeth yield without the contact, over their roll angles \[m/(N rad)\].
    pub(in crate::gear::mesh) rates: Arc<[Option<Series>; 2]>,
    /// Where slices hold each other.
    pub(in crate::gear::mesh) across: Option<Across>,
    /// C_jk by the number of pitches between j and k, less one; against the path position of the pair behind.
    coupling: Vec<Graded>,
    /// What loads do to the roots of both gears, if anybody knows.
    pub(in crate::gear::mesh) roots: Option<Arc<Roots>>,
    pub(in crate::gear::mesh) rows: SpanRule,
    pub(in crate::gear::mesh) slices: Rule,
    /// Of quick copies of gaps.
    pub(in crate::gear::mesh) copies: piecewise::Rule,
    /// Counted by every load case of this cycle and of those sampled otherwise.
    pub(in crate::gear::mesh) work: Arc<Total>,
}

/// Against the path position.
#[derive(Clone, Debug)]
pub(in crate::gear::mesh) enum Elasticity {
    /// Stiffness of a pair \[N/m\].
    Linear(Graded),
    /// Compliance of both teeth without the contact, times the common face width, and α; β \[1/Pa\] and ln β; where contact is
    /// resolved, the teeth's tips; and from A to E, as far as tips are not near, what all of it adds up to.
    Logarithmic { compliance: Graded, constant: Graded, rates: [f64; 2], ends: Option<Box<Ends>>, plain: Together<2> },
}

impl Elasticity {
    pub(in crate::gear::mesh) fn is_resolved(&self) -> bool {
        matches!(self, Self::Logarithmic { ends: Some(_), .. })
    }

    /// β \[1/Pa\] and its logarithm, of laws that have them.
    pub(in crate::gear::mesh) fn rates(&self) -> [f64; 2] {
        if let Self::Logarithmic { rates, .. } = self { *rates } else { [0.0; 2] }
    }

    /// As far as the law of a pair is known beforehand, from A to E.
    #[inline]
    pub(in crate::gear::mesh) fn plain(&self, s: f64) -> PlainLaw {
        self.plain_at_each(&[s]).at(0)
    }

    /// The same at ascending places.
    #[inline]
    pub(in crate::gear::mesh) fn plain_at_each<const M: usize>(&self, places: &[f64; M]) -> PlainLaws<M> {
        let Self::Logarithmic { plain, .. } = self else { return PlainLaws::NONE };
        let Found { values, bounds: lasts } = plain.at_each(places);
        let mut laws = PlainLaws { lasts, ..PlainLaws::NONE };
        for (m, of_place) in values.into_iter().enumerate() {
            [laws.totals[m], laws.rests[m]] = of_place;
        }
        laws
    }

    /// Flanks and teeth of a pair in series, per width; of another compliance than the pair's own, if one is given.
    pub(in crate::gear::mesh) fn series(&self, s: f64, own: Option<f64>) -> InSeries<'_> {
        let Self::Logarithmic { compliance, constant, rates: [rate, log_rate], ends, .. } = self else {
            return InSeries::NONE;
        };
        let law = Logarithmic { constant: constant.value(s), rate: *rate, log_rate: *log_rate };
        let series = law.in_series(own.unwrap_or_else(|| compliance.value(s)));
        match ends {
            None => series,
            Some(ends) => series.at_ends(&**ends, s),
        }
    }
}

impl Mesh {
    /// # Errors
    /// When the contact ratio is below 1 (contact is lost) or above what the solver holds.
    pub fn new(pair: &GearPair, compliance: &PairCompliance, settings: Settings) -> Result<Self, MeshError> {
        let ratio = (pair.end_of_contact - pair.start_of_contact) / pair.base_pitch;
        if !(ratio >= 1.0 - SHORTEST_ZONE && ratio <= MOST_SPRINGS as f64) {
            return Err(MeshError::ContactRatio { ratio, largest: MOST_SPRINGS });
        }
        let exact = settings.corner_contact == CornerContact::Exact;
        let springs = most_pairs(ratio) + if exact { CORNERS } else { 0 };
        if springs > MOST_SPRINGS {
            return Err(MeshError::ContactRatioWithCorners { ratio, largest: MOST_SPRINGS - CORNERS });
        }
        if let Some(side) = [Side::Pinion, Side::Gear].into_iter().find(|side| exact && pair.is_curtailed(*side)) {
            return Err(MeshError::CurtailedContact(side));
        }
        let path = Path::new(pair, settings.corner_contact);
        let bodies = Bodies::of(pair, compliance.plane);
        let face_width = pair.pinion.specification.face_width.min(pair.gear.specification.face_width);
        let (pinion_series, gear_series) = (compliance.pinion.total_series(), compliance.gear.total_series());
        let across = match settings.slice_coupling {
            SliceCoupling::None => None,
            SliceCoupling::Plate => Some(Across::new(pair, compliance, &path, face_width)?),
        };
        let total = |series: &Option<Series>, tooth: &ToothCompliance, roll: f64| {
            series.as_ref().map_or_else(|| tooth.total(roll), |series| series.value(roll))
        };
        let teeth = |s: f64| {
            let (pinion, gear) = path.rolls(s);
            total(&pinion_series, &compliance.pinion, pinion)
                + total(&gear_series, &compliance.gear, gear)
                + compliance.pinion.added(path.inclination(Side::Pinion, s))
                + compliance.gear.added(path.inclination(Side::Gear, s))
        };
        let fit = |function: &dyn Fn(f64) -> f64| path.fit(0.0, function).unwrap_or_default();
        let law = |new: fn(&Bodies, f64, [f64; 2]) -> Logarithmic, s: f64| {
            let (pinion, gear) = path.rolls(s);
            let depths = [compliance.pinion.contact_depth.value(pinion), compliance.gear.contact_depth.value(gear)];
            new(&bodies, combined_radius(path.radii(s)), depths)
        };
        let elasticity = match compliance.contact {
            Some(ContactLaw::Linear) => {
                let contact = bodies.linear() / face_width;
                Elasticity::Linear(fit(&|s| 1.0 / (teeth(s) + contact)))
            }
            None => Elasticity::Linear(fit(&|s| 1.0 / teeth(s))),
            Some(contact) => {
                let resolved = contact == ContactLaw::Resolved;
                let new = if resolved { Logarithmic::half_planes } else { Logarithmic::weber };
                let Logarithmic { rate, log_rate, .. } = law(new, pair.start_of_contact);
                let ends = resolved.then(|| Box::new(Ends::new(pair, compliance, &path)));
                let plain = |s: f64| {
                    let law = law(new, s);
                    let ([added, rest], last) =
                        ends.as_ref().map_or(([0.0; 2], law.last()), |ends| ends.far(s, rate).parts());
                    ([teeth(s) * face_width + law.constant + added, rest], last)
                };
                Elasticity::Logarithmic {
                    compliance: fit(&|s| teeth(s) * face_width),
                    constant: fit(&|s| law(new, s).constant),
                    rates: [rate, log_rate],
                    plain: Together::fit(path.inside(), PLAIN, plain),
                    ends,
                }
            }
        };
        let neighbours = if compliance.coupled {
            let known = compliance.pinion.neighbours.len().max(compliance.gear.neighbours.len());
            known.min(springs - 1)
        } else {
            0
        };
        let coupling = (0..neighbours)
            .map_while(|index| {
                let ahead = pair.base_pitch * (index + 1) as f64;
                let body = |s: f64| {
                    // The pair ahead has the larger roll angle on the pinion and the smaller one on the gear: the tooth at
                    // whose tip a corner touches is the further one of either gear.
                    let (behind, ahead) = (path.rolls(s), (s + ahead, path.rolls(s + ahead)));
                    let pinion = path.inclination(Side::Pinion, ahead.0);
                    let gear = path.inclination(Side::Gear, s);
                    compliance.pinion.neighbour(index, [behind.0, ahead.1.0], pinion)
                        + compliance.gear.neighbour(index, [ahead.1.1, behind.1], gear)
                };
                path.fit(ahead, &body)
            })
            .collect();
        let rates = [&pinion_series, &gear_series].map(|series| series.as_ref().map(Series::derivative));
        let zones = zones(ratio, pair.base_pitch);
        let (rows, slices) = (SpanRule::new(), Rule::new(settings.slices));
        let springs = exact.then_some(springs);
        let pair = pair.clone();
        let work = Arc::default();
        Ok(Self {
            pair,
            settings,
            springs,
            face_width,
            zones,
            path,
            bodies,
            elasticity,
            rates: Arc::new(rates),
            across,
            coupling,
            roots: None,
            rows,
            slices,
            copies: piecewise::Rule::new(),
            work,
        })
    }

    /// The same cycle with what loads do to the roots of pinion and gear.
    #[must_use]
    pub fn with_roots(mut self, influences: &[RootInfluences; 2]) -> Self {
        self.roots = Some(Roots::new(influences).into());
        self
    }

    /// The same cycle with the same corner contact and coupling of slices, sampled otherwise.
    #[must_use]
    pub fn sampled(&self, settings: Settings) -> Self {
        // Both are in the quick copies.
        let Settings { corner_contact, slice_coupling, .. } = self.settings;
        let settings = Settings { corner_contact, slice_coupling, ..settings };
        let same = settings.slices == self.settings.slices;
        let slices = if same { self.slices.clone() } else { Rule::new(settings.slices) };
        Self { settings, slices, ..self.clone() }
    }

    /// A copy whose work is counted separately.
    #[must_use]
    pub fn counted_separately(&self) -> Self {
        Self { work: Arc::default(), ..self.clone() }
    }

    /// What was computed on this cycle so far, however sampled.
    #[must_use]
    pub fn work(&self) -> Work {
        self.work.work()
    }

    /// p_b \[m\].
    #[must_use]
    pub fn period(&self) -> f64 {
        self.pair.base_pitch
    }

    /// How many pairs may carry load in a zone with `pairs` inside the path of contact.
    #[must_use]
    pub fn springs(&self, pairs: usize) -> usize {
        self.springs.unwrap_or(pairs)
    }

    /// Pairs inside the path of contact at a cycle position; nearer than rounding to where their number changes it is behind.
    #[must_use]
    pub fn pairs_behind(&self, position: f64) -> usize {
        let border = BORDER * self.period();
        self.zones.iter().find(|zone| position < zone.end - border).or(self.zones.last()).map_or(1, |zone| zone.pairs)
    }

    /// Which of them is the newest one inside the path of contact; with corner contact one is before A.
    #[must_use]
    pub fn newest(&self) -> usize {
        usize::from(self.springs.is_some())
    }

    /// The path position s of spring `spring` at the cycle position τ.
    #[must_use]
    pub fn path_position(&self, position: f64, spring: usize) -> f64 {
        let pitches = (spring.cast_signed() - self.newest().cast_signed()) as f64;
        self.pair.start_of_contact + position + self.pair.base_pitch * pitches
    }

    /// The roll angles of the points of pinion and gear that touch at a path position, tip corners included.
    #[must_use]
    pub fn rolls(&self, s: f64) -> [f64; 2] {
        self.path.rolls(s).into()
    }

    /// By how much the loads on pinion and gear are turned from the normals of their flanks there \[rad\].
    #[must_use]
    pub fn inclinations(&self, s: f64) -> [f64; 2] {
        [Side::Pinion, Side::Gear].map(|side| self.path.inclination(side, s))
    }

    /// The flanks' radii of curvature there, pinion and gear.
    #[must_use]
    pub fn radii(&self, s: f64) -> [f64; 2] {
        self.path.radii(s)
    }

    /// The same of what touches: beyond the end of its flank that of a rounding. And whose sharp corner touches by itself.
    pub(in crate::gear::mesh) fn touching(&self, s: f64) -> ([f64; 2], Option<Side>) {
        let mut radii = self.path.radii(s);
        let within = CLOSEST * self.pair.base_pitch;
        let side = if s > self.pair.end_of_contact + within {
            Side::Pinion
        } else if s < self.pair.start_of_contact - within {
            Side::Gear
        } else {
            return (radii, None);
        };
        let round = self.pair.side(side).flank_end.radius;
        if round <= 0.0 {
            return (radii, Some(side));
        }
        radii[side as usize] = round;
        (radii, None)
    }

    /// Where contact is resolved: the tips of both teeth at a path position.
    pub(in crate::gear) fn tips(&self, s: f64) -> Option<Tips<'_>> {
        match &self.elasticity {
            Elasticity::Logarithmic { ends: Some(ends), .. } => Some(ends.tips(s)),
            _ => None,
        }
    }

    /// Whether the law of contact knows the corners of tips.
    #[must_use]
    pub fn knows_corners(&self) -> bool {
        self.elasticity.is_resolved()
    }

    /// Whether any pair feels its neighbours' load.
    pub(in crate::gear::mesh) fn coupled(&self) -> bool {
        !self.coupling.is_empty()
    }

    /// Penetration at the pair at `behind` per load on the one that is `pitches` ≥ 1 ahead of it, and the reverse.
    pub(in crate::gear::mesh) fn coupling(&self, behind: f64, pitches: usize) -> f64 {
        self.coupling.get(pitches - 1).map_or(0.0, |graded| graded.value(behind))
    }
}

fn most_pairs(ratio: f64) -> usize {
    zones(ratio, 1.0).iter().map(|zone| zone.pairs).max().unwrap_or(1)
}

/// ⌊ε⌋ + 1 pairs as long as the newest one shares the contact with the oldest, ⌊ε⌋ after that.
fn zones(ratio: f64, period: f64) -> Vec<Zone> {
    let whole = (ratio + SHORTEST_ZONE).floor();
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // the ratio was checked to be 1 to MOST_SPRINGS
    let fewest = whole as usize;
    let shared = (ratio - whole) * period;
    if shared < SHORTEST_ZONE * period {
        return vec![Zone { start: 0.0, end: period, pairs: fewest }];
    }
    vec![Zone { start: 0.0, end: shared, pairs: fewest + 1 }, Zone { start: shared, end: period, pairs: fewest }]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zones_fold_the_ends_of_contact_for_every_contact_ratio() {
        for (ratio, expected) in [
            (1.0, vec![1]),
            (1.0001, vec![2, 1]),
            (1.6457, vec![2, 1]),
            (2.0, vec![2]),
            (2.5, vec![3, 2]),
            (3.2, vec![4, 3]),
        ] {
            let zones = zones(ratio, 9e-3);
            assert_eq!(zones.iter().map(|zone| zone.pairs).collect::<Vec<_>>(), expected, "{ratio}");
            let average: f64 = zones.iter().map(|zone| (zone.end - zone.start) * zone.pairs as f64).sum();
            assert!((average / 9e-3 - ratio).abs() < 1e-12, "the mean number of pairs is the contact ratio");
        }
        // 2 up to rounding, from both sides.
        assert_eq!(zones(2.0 - 4e-16, 1.0), zones(2.0, 1.0));
        assert_eq!(zones(2.0 + 4e-16, 1.0), zones(2.0, 1.0));
    }
}
