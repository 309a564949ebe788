//! The least and the largest value of a number inside the intervals of its inputs, and whether one of them is what was published.
//!
//! Must not know: what computes it, what the inputs are. An input is 0 in the middle of its interval, and -1 and 1 at its ends.

use std::cmp::Ordering;

use declare::error::Failure;

/// So many inputs of a number are tried at all corners.
const MOST_AT_ALL: usize = 4;
/// How often what lies between a value and a refusal is halved: to a millionth of the half-width.
const HALVINGS: usize = 20;
/// Rounds in which a place is looked for where a number is least or largest between the ends.
const CLOSER: usize = 10;
/// Rounds in which one is looked for where it is what was published.
const MEETING: usize = 40;
/// This share of what is between the first values makes no difference.
const SETTLED: f64 = 0.01;
/// So many times what is between them: it grows without end.
const ENDLESS: f64 = 30.0;

/// Of each input.
pub type Place = Vec<f64>;
/// A number, or why there is none.
pub type Value = Result<f64, String>;
/// The numbers of some goals at some places.
pub type Ask<'a> = &'a mut dyn FnMut(&[(usize, Place)]) -> Result<Vec<Value>, Failure>;

/// A number whose inputs have intervals.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    pub inputs: usize,
    /// What it is with all inputs in the middle.
    pub stated: f64,
    pub published: f64,
    pub tolerance: f64,
}

/// What is known of a number.
#[derive(Clone, Debug)]
pub struct Found {
    pub least: f64,
    pub largest: f64,
    /// Ends that have no number, and how far towards them one was found.
    pub cuts: Vec<Cut>,
    /// Corners that were tried, those of them without a number, and why at the first.
    pub corners: usize,
    pub refused: usize,
    pub reason: String,
    /// Why not all values between the least and the largest are taken, where that was found.
    pub broken: Option<Broken>,
}

/// An end of an input that has no number.
#[derive(Clone, Debug)]
pub struct Cut {
    pub input: usize,
    /// 0 for the lower end, 1 for the upper one.
    pub side: usize,
    /// The outermost place that has one, nearly.
    pub place: f64,
    pub reason: String,
}

/// Where a number is not continuous.
#[derive(Clone, Debug)]
pub struct Broken {
    pub place: Place,
    pub how: How,
}

#[derive(Clone, Debug)]
pub enum How {
    /// It has none, for this reason.
    Refused(String),
    /// It jumps from one value to another.
    Jumps(f64, f64),
    /// It grows without end.
    Endless,
}

/// A goal and what is known of it so far.
struct State {
    goal: Goal,
    known: Vec<(Place, f64)>,
    /// Of each input both ends: the outermost place with a number, and the number.
    ends: Vec<[(f64, f64); 2]>,
    found: Found,
}

/// What lies between a number and a refusal of one input.
struct Edge {
    goal: usize,
    input: usize,
    side: usize,
    admitted: (f64, f64),
    refused: (f64, String),
}

/// Three places of an input, at the middle one of which a number is beyond both others.
struct Peak {
    goal: usize,
    input: usize,
    sign: f64,
    places: [(f64, f64); 3],
    spread: f64,
    is_open: bool,
}

/// The way between two places, with what was published between their numbers.
struct Way {
    goal: usize,
    places: [Place; 2],
    ends: [(f64, f64); 2],
    gap: f64,
    is_open: bool,
}

/// What is known of each goal; of none without inputs.
///
/// # Errors
/// What `ask` says.
pub fn look(goals: &[Option<Goal>], ask: Ask) -> Result<Vec<Option<Found>>, Failure> {
    let mut states: Vec<Option<State>> = goals.iter().map(|goal| goal.map(State::new)).collect();
    ends(&mut states, ask)?;
    corners(&mut states, ask)?;
    closer(&mut states, ask)?;
    meet(&mut states, ask)?;
    Ok(states.into_iter().map(|state| Some(state?.found)).collect())
}

/// How many corners are tried of so many inputs, at the most.
pub fn corners_of(inputs: usize) -> usize {
    match inputs {
        0 | 1 => 0,
        few @ ..=MOST_AT_ALL => 1 << few,
        _ => 2,
    }
}

impl Goal {
    /// Whether a number is below, above, or what was published.
    fn side(&self, value: f64) -> Ordering {
        let allowed = self.tolerance + 1e-12 * value.abs().max(self.published.abs());
        if (value - self.published).abs() <= allowed { Ordering::Equal } else { value.total_cmp(&self.published) }
    }
}

impl State {
    fn new(goal: Goal) -> Self {
        let Goal { inputs, stated, .. } = goal;
        let found = Found {
            least: stated,
            largest: stated,
            cuts: Vec::new(),
            corners: 0,
            refused: 0,
            reason: String::new(),
            broken: None,
        };
        Self { goal, known: Vec::new(), ends: vec![[(0.0, stated); 2]; inputs], found }
    }

    /// All inputs in the middle but one.
    fn alone(&self, input: usize, place: f64) -> Place {
        let mut all = vec![0.0; self.goal.inputs];
        all[input] = place;
        all
    }

    fn learn(&mut self, place: Place, value: f64) {
        self.found.least = self.found.least.min(value);
        self.found.largest = self.found.largest.max(value);
        self.known.push((place, value));
    }

    /// Whether what was published lies between the least and the largest value, and not at the middle.
    fn is_between(&self) -> Option<bool> {
        let Found { least, largest, .. } = self.found;
        let of = |value: f64| self.goal.side(value);
        (of(self.goal.stated) != Ordering::Equal)
            .then(|| of(least) != Ordering::Greater && of(largest) != Ordering::Less)
    }

    /// The corners that are tried: all, or those where the ends are that alone make the number least, and largest.
    fn corners(&self) -> Vec<Place> {
        let (count, ends) = (self.goal.inputs, &self.ends);
        if count <= MOST_AT_ALL {
            let corner = |corner: usize| (0..count).map(|input| ends[input][corner >> input & 1].0).collect();
            return (0..corners_of(count)).map(corner).collect();
        }
        let furthest = |sign: f64| -> Place {
            let of_input = |ends: &[(f64, f64); 2]| {
                let beyond = ends.iter().filter(|(_, value)| sign * (value - self.goal.stated) > 0.0);
                beyond.max_by(|one, other| (sign * one.1).total_cmp(&(sign * other.1))).map_or(0.0, |(place, _)| *place)
            };
            ends.iter().map(of_input).collect()
        };
        // What a single input does is known.
        let is_new = |place: &Place| place.iter().filter(|place| **place != 0.0).count() > 1;
        [-1.0, 1.0].map(furthest).into_iter().filter(is_new).collect()
    }
}

/// One input after the other at both of its ends, or as near to them as there is a number.
fn ends(states: &mut [Option<State>], ask: Ask) -> Result<(), Failure> {
    let all = states.iter().enumerate().filter_map(|(at, state)| Some((at, state.as_ref()?)));
    let of_goal = |(goal, state): (usize, &State)| {
        let sides = |input| [0, 1].map(|side| (goal, input, side));
        (0..state.goal.inputs).flat_map(sides).collect::<Vec<_>>()
    };
    let all: Vec<(usize, usize, usize)> = all.flat_map(of_goal).collect();
    let place = |states: &[Option<State>], goal: usize, input: usize, place: f64| {
        (goal, states[goal].as_ref().map_or_else(Vec::new, |state| state.alone(input, place)))
    };
    let end = |side: usize| if side == 0 { -1.0 } else { 1.0 };
    let asked: Vec<_> = all.iter().map(|(goal, input, side)| place(states, *goal, *input, end(*side))).collect();
    let mut edges: Vec<Edge> = Vec::new();
    for (((goal, input, side), (_, at)), value) in all.into_iter().zip(&asked).zip(ask(&asked)?) {
        let Some(state) = &mut states[goal] else { continue };
        match value {
            Ok(value) => {
                state.ends[input][side] = (end(side), value);
                state.learn(at.clone(), value);
            }
            Err(reason) => {
                let (admitted, refused) = ((0.0, state.goal.stated), (end(side), reason));
                edges.push(Edge { goal, input, side, admitted, refused });
            }
        }
    }
    for _ in 0..if edges.is_empty() { 0 } else { HALVINGS } {
        let middle = |edge: &Edge| 0.5 * (edge.admitted.0 + edge.refused.0);
        let asked: Vec<_> = edges.iter().map(|edge| place(states, edge.goal, edge.input, middle(edge))).collect();
        for (edge, value) in edges.iter_mut().zip(ask(&asked)?) {
            match value {
                Ok(value) => edge.admitted = (middle(edge), value),
                Err(reason) => edge.refused = (middle(edge), reason),
            }
        }
    }
    for Edge { goal, input, side, admitted, refused: (_, reason) } in edges {
        let Some(state) = &mut states[goal] else { continue };
        state.ends[input][side] = admitted;
        if admitted.0 != 0.0 {
            state.learn(state.alone(input, admitted.0), admitted.1);
        }
        state.found.cuts.push(Cut { input, side, place: admitted.0, reason });
    }
    Ok(())
}

fn corners(states: &mut [Option<State>], ask: Ask) -> Result<(), Failure> {
    let of_goal = |(goal, state): (usize, &Option<State>)| {
        let corners = state.as_ref().map_or_else(Vec::new, State::corners);
        corners.into_iter().map(|corner| (goal, corner)).collect::<Vec<_>>()
    };
    let asked: Vec<(usize, Place)> = states.iter().enumerate().flat_map(of_goal).collect();
    let values = ask(&asked)?;
    for ((goal, corner), value) in asked.into_iter().zip(values) {
        let Some(state) = &mut states[goal] else { continue };
        state.found.corners += 1;
        match value {
            Ok(value) => state.learn(corner, value),
            Err(reason) => {
                if state.found.refused == 0 {
                    state.found.reason = reason;
                }
                state.found.refused += 1;
            }
        }
    }
    Ok(())
}

impl Peak {
    /// Of an input between whose ends a number is beyond both of theirs, if it is.
    fn of(goal: usize, state: &State, input: usize) -> Option<Self> {
        let [low, high] = state.ends[input];
        let middle = (0.0, state.goal.stated);
        let values = [low.1, middle.1, high.1];
        let [least, largest] = [f64::min, f64::max].map(|of| values.into_iter().reduce(of).unwrap_or(0.0));
        let sign = if middle.1 > low.1.max(high.1) { 1.0 } else { -1.0 };
        let is_peak = sign * middle.1 > (sign * low.1).max(sign * high.1) && low.0 < 0.0 && high.0 > 0.0;
        let places = [low, middle, high];
        is_peak.then_some(Self { goal, input, sign, places, spread: largest - least, is_open: true })
    }

    fn between(&self) -> [f64; 2] {
        [0, 1].map(|at| 0.5 * (self.places[at].0 + self.places[at + 1].0))
    }

    /// Goes on about the best of five places.
    fn learn(&mut self, [left, right]: [f64; 2]) {
        let [one, two] = self.between();
        let [low, middle, high] = self.places;
        let five = [low, (one, left), middle, (two, right), high];
        let best = (1..4).fold(2, |best, at| if self.sign * five[at].1 > self.sign * five[best].1 { at } else { best });
        self.places = [five[best - 1], five[best], five[best + 1]];
        let beside = [five[best - 1].1, five[best + 1].1].map(|value| (value - five[best].1).abs());
        self.is_open = beside[0].max(beside[1]) > SETTLED * self.spread;
    }
}

/// Where the middle of an input is beyond both of its ends, what was published may lie beyond all corners.
fn closer(states: &mut [Option<State>], ask: Ask) -> Result<(), Failure> {
    let of_goal = |(goal, state): (usize, &Option<State>)| {
        let state = state.as_ref().filter(|state| state.is_between() == Some(false));
        state
            .into_iter()
            .flat_map(|state| (0..state.goal.inputs).filter_map(|input| Peak::of(goal, state, input)))
            .collect::<Vec<_>>()
    };
    let mut peaks: Vec<Peak> = states.iter().enumerate().flat_map(of_goal).collect();
    for _ in 0..CLOSER {
        let open = || peaks.iter().enumerate().filter(|(_, peak)| peak.is_open);
        let of_peak = |(at, peak): (usize, &Peak)| peak.between().map(|place| (at, place));
        let wanted: Vec<(usize, f64)> = open().flat_map(of_peak).collect();
        let place = |(at, place): &(usize, f64)| {
            let Peak { goal, input, .. } = peaks[*at];
            Some((goal, states[goal].as_ref()?.alone(input, *place)))
        };
        let asked: Vec<(usize, Place)> = wanted.iter().filter_map(place).collect();
        if asked.is_empty() {
            break;
        }
        let values = ask(&asked)?;
        for ((wanted, asked), values) in wanted.chunks(2).zip(asked.chunks(2)).zip(values.chunks(2)) {
            let peak = &mut peaks[wanted[0].0];
            let Some(state) = &mut states[peak.goal] else { continue };
            for ((_, place), value) in asked.iter().zip(values) {
                match value {
                    Ok(value) => state.learn(place.clone(), *value),
                    Err(reason) => state.found.broken = Some(Broken::refused(place, reason)),
                }
            }
            match values {
                [Ok(left), Ok(right)] if state.is_between() == Some(false) => peak.learn([*left, *right]),
                _ => peak.is_open = false,
            }
        }
    }
    for Peak { goal, input, places: [_, (place, value), _], spread, .. } in peaks {
        let Some(state) = &mut states[goal] else { continue };
        if (value - state.goal.stated).abs() > ENDLESS * spread {
            state.found.broken = Some(Broken { place: state.alone(input, place), how: How::Endless });
        }
    }
    Ok(())
}

impl Broken {
    fn refused(place: &Place, reason: &str) -> Self {
        Self { place: place.clone(), how: How::Refused(reason.to_owned()) }
    }
}

impl Way {
    /// Between those two on whose way the fewest inputs move, and whose numbers are nearest to each other.
    fn of(goal: usize, state: &State) -> Option<Self> {
        let of = |wanted: Ordering| {
            let middle = std::iter::once((vec![0.0; state.goal.inputs], state.goal.stated));
            let all = middle.chain(state.known.iter().cloned());
            all.filter(|(_, value)| state.goal.side(*value) == wanted).collect::<Vec<_>>()
        };
        if state.is_between() != Some(true) || !of(Ordering::Equal).is_empty() {
            return None;
        }
        // How many inputs move on the way, and how far the numbers are apart.
        let apart = |below: &(Place, f64), above: &(Place, f64)| {
            let moved = below.0.iter().zip(&above.0).filter(|(one, other)| one.total_cmp(other).is_ne()).count();
            (moved, above.1 - below.1)
        };
        let (lower, upper) = (of(Ordering::Less), of(Ordering::Greater));
        let pairs = lower.iter().flat_map(|below| upper.iter().map(move |above| (below, above)));
        let (below, above) = pairs.min_by(|one, other| {
            let (one, other) = (apart(one.0, one.1), apart(other.0, other.1));
            one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
        })?;
        let (ends, gap) = ([(0.0, below.1), (1.0, above.1)], above.1 - below.1);
        Some(Self { goal, places: [below.0.clone(), above.0.clone()], ends, gap, is_open: true })
    }

    fn at(&self, share: f64) -> Place {
        let [from, to] = &self.places;
        from.iter().zip(to).map(|(from, to)| from + share * (to - from)).collect()
    }

    /// The next place: half way, and every other time where a straight line is what was published.
    fn next(&self, round: usize, published: f64) -> f64 {
        let [(from, low), (to, high)] = self.ends;
        let straight = if round.is_multiple_of(2) { (published - low) / (high - low) } else { 0.5 };
        from + (to - from) * straight.clamp(0.01, 0.99)
    }

    fn width(&self) -> f64 {
        (self.ends[1].1 - self.ends[0].1).abs()
    }
}

/// What lies between two numbers is taken where a number is continuous: whether what was published is, is tried.
fn meet(states: &mut [Option<State>], ask: Ask) -> Result<(), Failure> {
    let way = |(goal, state): (usize, &Option<State>)| Way::of(goal, state.as_ref()?);
    let mut ways: Vec<Way> = states.iter().enumerate().filter_map(way).collect();
    for round in 0..MEETING {
        let mut wanted: Vec<(usize, f64)> = Vec::new();
        for (at, way) in ways.iter().enumerate().filter(|(_, way)| way.is_open) {
            let published = states[way.goal].as_ref().map_or(0.0, |state| state.goal.published);
            wanted.push((at, way.next(round, published)));
        }
        if wanted.is_empty() {
            break;
        }
        let asked: Vec<(usize, Place)> =
            wanted.iter().map(|(at, share)| (ways[*at].goal, ways[*at].at(*share))).collect();
        for (((at, share), (_, place)), value) in wanted.into_iter().zip(&asked).zip(ask(&asked)?) {
            let way = &mut ways[at];
            let Some(state) = &mut states[way.goal] else { continue };
            match value {
                Err(reason) => {
                    state.found.broken = Some(Broken::refused(place, &reason));
                    way.is_open = false;
                }
                Ok(value) => {
                    state.learn(place.clone(), value);
                    let side = state.goal.side(value);
                    way.ends[usize::from(side == Ordering::Greater)] = (share, value);
                    way.is_open = side != Ordering::Equal;
                }
            }
        }
    }
    for way in ways.iter().filter(|way| way.is_open && way.width() > SETTLED * way.gap) {
        let Some(state) = &mut states[way.goal] else { continue };
        let [(from, low), (to, high)] = way.ends;
        let how = if way.width() > ENDLESS * way.gap { How::Endless } else { How::Jumps(low, high) };
        state.found.broken = Some(Broken { place: way.at(0.5 * (from + to)), how });
    }
    // What was met is met, whatever lies elsewhere.
    for state in states.iter_mut().flatten() {
        if state.known.iter().any(|(_, value)| state.goal.side(*value) == Ordering::Equal) {
            state.found.broken = None;
        }
    }
    Ok(())
}
