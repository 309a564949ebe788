//! How a search goes: with coarse samplings first, with the asked one where it decides, or with the asked one all along.
//!
//! A staged search runs its method with a coarse sampling until nothing more is gained. Of what it tried the best designs, each
//! of a place of its own, are looked at as asked for, until none that is left can be the best: the coarse value of one would
//! have to be off by more than any was. A simplex then goes down from the best of them, with all as asked for, after another
//! with a sampling between where there is one. Samples and `search: plain` look at every design as asked for. Must not know: how a method searches, what becomes a table.

mod closer;

use rayon::prelude::*;

use self::closer::{ASKED, BETWEEN, Starts};
use super::goal::Worth;
use super::sampling::{coarser, finer};
use super::{EVALUATIONS, Optimizer};
use crate::stage::Context;
use declare::error::Failure;
use declare::number::significant;
use gearmesh::gear::mesh::{Mesh, Settings};
use gearmesh::gear::modification::template::Fitted;
use gearmesh::optimize::Foreseen;
use gearmesh::optimize::constraints::{Evaluation, KEPT};
use gearmesh::optimize::leaders::Leaders;
use gearmesh::optimize::pareto::{self, Member};
use gearmesh::optimize::search::{Candidate, Generation, Optimizer as Search, Reason};
use gearmesh::optimize::settled::Settled;

/// Searches at most, each with a finer sampling, until the objective is as accurate as wanted.
const ROUNDS: usize = 4;
/// Passes at most: the coarse search, the look at its best, and what follows, once from two places; or searches alone.
pub const MOST: usize = 3 + CLOSER + ROUNDS;
/// Samplings between the coarse one and the asked one, at most.
const CLOSER: usize = 1;
/// Places that are looked at as asked for, at most, and at once.
const PLACES: usize = 64;
const AT_ONCE: usize = 8;
/// The pass that looks for a design; what follows it looks closer.
const SEARCH: &str = "search";

/// One sampling of a search, and what it brought.
#[derive(Clone, Debug)]
pub struct Pass {
    pub what: &'static str,
    pub settings: Settings,
    pub evaluations: usize,
    /// The best objective, as this sampling has it.
    pub best: f64,
    pub ended: String,
}

/// What a search came to.
pub struct Found {
    pub best: Candidate,
    /// The points of a front, where one was searched.
    pub front: Vec<Member>,
    pub history: Vec<Generation>,
    pub evaluations: usize,
    pub ended: String,
    /// Every design and its objective, if asked for.
    pub tried: Vec<(Vec<f64>, f64)>,
    pub settings: Settings,
    /// Estimated relative error of the objective at the best design.
    pub error: f64,
    pub passes: Vec<Pass>,
}

/// What is known of the constraints, from looks of one accuracy.
#[derive(Clone)]
struct Seen {
    /// The largest reserve that any design left, of each.
    most: Vec<f64>,
    /// The least that any design broke of all together.
    broken: f64,
}

impl Seen {
    fn none(limits: usize) -> Self {
        Self { most: vec![f64::NEG_INFINITY; limits], broken: f64::INFINITY }
    }

    fn take(&mut self, evaluation: &Evaluation) {
        for (most, reserve) in self.most.iter_mut().zip(&evaluation.constraints) {
            *most = most.max(*reserve);
        }
        let is_known = evaluation.constraints.iter().all(|reserve| reserve.is_finite());
        self.broken = if is_known { self.broken.min(evaluation.violation()) } else { self.broken };
    }
}

/// A search under way.
pub struct Run<'a> {
    optimizer: &'a Optimizer,
    context: &'a Context<'a>,
    base: &'a Mesh,
    fitted: &'a Fitted<'a>,
    /// The most evaluations of all passes.
    budget: f64,
    history: Vec<Generation>,
    evaluations: usize,
    tried: Vec<(Vec<f64>, f64)>,
    leaders: Leaders,
    seen: Seen,
    /// By how much each constraint was kept at least, whatever coarse looks were off by; nothing where there were none.
    shown: Vec<f64>,
    /// The smallest and the largest value of each objective.
    extent: Vec<(f64, f64)>,
    /// How many designs of a pass could not be built, and why the first could not.
    misfits: (usize, String),
    passes: Vec<Pass>,
}

/// What comes on top of what a method foresees, where a search is staged.
pub fn on_top(foreseen: Foreseen, dimension: usize) -> Foreseen {
    let more = PLACES + CLOSER + CLOSER * BETWEEN.evaluations(dimension) + (1 + ROUNDS) * ASKED.evaluations(dimension);
    Foreseen {
        evaluations: foreseen.evaluations.saturating_add(more),
        batches: foreseen.batches.saturating_add(more),
        exact: false,
        ..foreseen
    }
}

impl<'a> Run<'a> {
    pub fn new(
        optimizer: &'a Optimizer,
        context: &'a Context<'a>,
        (base, fitted): (&'a Mesh, &'a Fitted<'a>),
    ) -> Result<Self, Failure> {
        let bounds = optimizer.bounds().map_err(|wrong| Failure::new(wrong.message))?;
        Ok(Self {
            optimizer,
            context,
            base,
            fitted,
            budget: 1.0,
            history: Vec::new(),
            evaluations: 0,
            tried: Vec::new(),
            leaders: Leaders::new(bounds, PLACES),
            seen: Seen::none(optimizer.goal.limits.len()),
            shown: Vec::new(),
            extent: vec![(f64::INFINITY, f64::NEG_INFINITY); optimizer.goal.objectives().len()],
            misfits: (0, String::new()),
            passes: Vec::new(),
        })
    }

    /// # Errors
    /// When it was stopped, nothing can be built, or nothing keeps the constraints.
    pub fn found(mut self) -> Result<Found, Failure> {
        let asked = self.optimizer.first_settings(self.base, self.fitted);
        if self.optimizer.is_staged() { self.staged(asked) } else { self.plain(asked) }
    }

    /// Says which objectives no design of a search changed.
    fn is_changed(&self, evaluations: usize) {
        let same = self
            .extent
            .iter()
            .zip(self.optimizer.goal.objectives())
            .filter(|((least, most), _)| least.is_finite() && least >= most);
        let same: Vec<String> = same.map(|(_, objective)| format!("`{}`", objective.column)).collect();
        if evaluations > 1 && !same.is_empty() {
            let names = same.join(" and ");
            let said = format!("every design that was tried has the same {names}: nothing in the box changes it");
            (self.context.warn)(said.into());
        }
    }

    /// Says how many designs of a search do not fit the pair: bounds that reach beyond the flank cost looks, and say nothing.
    fn fit(&self, evaluations: usize) {
        let (count, why) = &self.misfits;
        if *count > 0 {
            let share = 100.0 * *count as f64 / evaluations.max(1) as f64;
            let designs = if *count == 1 { "design does" } else { "designs do" };
            let said = format!(
                "{count} {designs} not fit, {share:.0} % of those that were tried, and the first because {why}"
            );
            (self.context.warn)(said.into());
        }
    }

    /// Every design as asked for, until the method ends; again with a finer sampling while the objective is not as accurate
    /// as wanted.
    fn plain(&mut self, asked: Settings) -> Result<Found, Failure> {
        let mut settings = asked;
        let mut round = 1;
        loop {
            let mut search = self.search()?;
            if self.optimizer.stated.settled.is_some() {
                search = search.until_settled(self.optimizer.rule());
            }
            // A repeated search is told of by itself.
            (self.history, self.evaluations, self.tried) = (Vec::new(), 0, Vec::new());
            self.budget = search.budget().max(1) as f64;
            let reason = self.run(&mut search, settings, SEARCH)?;
            let best = self.kept(search.best())?.clone();
            let error = self.optimizer.error(self.base, self.fitted, &best.point, settings);
            let next = self.next_settings(&best.point, settings, error);
            match next.filter(|_| round < ROUNDS) {
                Some(next) => (settings, round) = (next, round + 1),
                None => {
                    self.doubt(&mut search);
                    self.is_accurate(error);
                    let front = self.front_of(&search);
                    return Ok(self.finish(best, front, (settings, error), self.said(reason)));
                }
            }
        }
    }

    /// Coarse first.
    fn staged(&mut self, asked: Settings) -> Result<Found, Failure> {
        let rule = self.optimizer.rule();
        let mut search = self.search()?.until_settled(rule);
        let dimension = self.optimizer.template.variables().len();
        self.budget = (search.budget() + PLACES + ASKED.evaluations(dimension)).max(1) as f64;
        let coarse = coarser(asked);
        let reason = self.run(&mut search, coarse[0], SEARCH)?;
        self.doubt(&mut search);
        let ended = self.said(reason);
        self.built(search.best())?;
        if self.optimizer.goal.has_front() {
            let members: Vec<Member> =
                search.front(2 * self.optimizer.stated.front_points).into_iter().cloned().collect();
            return self.confirmed(&members, asked, ended);
        }
        let mut from = self.confirm(asked)?;
        for closer in &coarse[1..] {
            let candidate = self.refine(&from.best, *closer, BETWEEN, rule)?;
            from = self.compared(from, candidate, asked)?;
        }
        let mut settings = asked;
        let mut round = 1;
        loop {
            let best = self.refine_all(&from, settings, rule)?;
            let error = self.optimizer.error(self.base, self.fitted, &best.point, settings);
            match self.next_settings(&best.point, settings, error).filter(|_| round < ROUNDS) {
                Some(next) => (from, settings, round) = (Starts::of(best, true), next, round + 1),
                None => {
                    self.is_accurate(error);
                    let best = self.kept(Some(&best))?.clone();
                    return Ok(self.finish(best, Vec::new(), (settings, error), ended));
                }
            }
        }
    }

    fn finish(
        &mut self,
        best: Candidate,
        front: Vec<Member>,
        (settings, error): (Settings, f64),
        ended: String,
    ) -> Found {
        let best = match pareto::balanced(&front) {
            Some(balanced) => {
                Candidate { point: balanced.point.clone(), value: balanced.evaluation.value, violation: 0.0 }
            }
            None => best,
        };
        Found {
            best,
            front,
            history: std::mem::take(&mut self.history),
            evaluations: self.evaluations,
            ended,
            tried: std::mem::take(&mut self.tried),
            settings,
            error,
            passes: std::mem::take(&mut self.passes),
        }
    }

    fn front_of(&self, search: &Search) -> Vec<Member> {
        if !self.optimizer.goal.has_front() {
            return Vec::new();
        }
        search.front(self.optimizer.stated.front_points).into_iter().cloned().collect()
    }

    fn search(&self) -> Result<Search, Failure> {
        self.optimizer.search(self.context.seed).map_err(|error| Failure::new(error.message))
    }

    /// A pass of a search.
    fn run(&mut self, search: &mut Search, settings: Settings, what: &'static str) -> Result<Reason, Failure> {
        let cycle = self.base.sampled(settings);
        let before = self.evaluations;
        self.extent.fill((f64::INFINITY, f64::NEG_INFINITY));
        self.misfits = (0, String::new());
        let reason = search.run_constrained(|points| self.evaluate(&cycle, points))?;
        self.history
            .extend(search.history().iter().map(|row| Generation { evaluations: before + row.evaluations, ..*row }));
        let (evaluations, best) = (search.evaluations(), search.best().map_or(f64::INFINITY, |best| best.value));
        if what == SEARCH {
            self.is_changed(evaluations);
            self.fit(evaluations);
        }
        let ended = if what == SEARCH { self.said(reason) } else { reason.to_string() };
        self.passes.push(Pass { what, settings, evaluations, best, ended });
        Ok(reason)
    }

    fn evaluate(&mut self, cycle: &Mesh, points: &[Vec<f64>]) -> Result<Vec<Evaluation>, Failure> {
        self.context.check_stop()?;
        let (optimizer, fitted) = (self.optimizer, self.fitted);
        let worths: Vec<Worth> = points.par_iter().map(|point| optimizer.worth(cycle, fitted, point)).collect();
        let evaluations: Vec<Evaluation> = worths.into_iter().map(|worth| worth.evaluation).collect();
        for (point, evaluation) in points.iter().zip(&evaluations) {
            if evaluation.value.is_infinite()
                && let Err(wrong) = fitted.design(point)
            {
                self.misfits.0 += 1;
                if self.misfits.0 == 1 {
                    self.misfits.1 = wrong.message;
                }
            }
            self.leaders.take(point, evaluation);
            self.seen.take(evaluation);
            let finite = self.extent.iter_mut().zip(evaluation.objectives()).filter(|(_, value)| value.is_finite());
            finite.for_each(|((least, most), value)| (*least, *most) = (least.min(value), most.max(value)));
        }
        if self.context.demand.table(EVALUATIONS) {
            self.tried.extend(points.iter().cloned().zip(evaluations.iter().map(|evaluation| evaluation.value)));
        }
        self.evaluations += points.len();
        (self.context.progress)((self.evaluations as f64 / self.budget).min(1.0));
        Ok(evaluations)
    }

    /// From here on designs are looked at as asked for: what is said of the constraints is to be true of them.
    /// Gives what was seen until now.
    fn look_as_asked(&mut self) -> Seen {
        std::mem::replace(&mut self.seen, Seen::none(self.optimizer.goal.limits.len()))
    }

    /// A batch by itself as a row of the history.
    fn note(&mut self, evaluations: &[Evaluation]) {
        let kept = evaluations.iter().filter(|it| it.violation() == 0.0 && it.value.is_finite());
        let (sum, best, count) = kept.fold((0.0, f64::INFINITY, 0_usize), |(sum, best, count), evaluation| {
            (sum + evaluation.value, evaluation.value.min(best), count + 1)
        });
        self.history.push(Generation {
            best,
            best_so_far: best,
            mean: if count == 0 { f64::INFINITY } else { sum / count as f64 },
            evaluations: self.evaluations,
        });
    }

    fn next_settings(&self, point: &[f64], settings: Settings, error: f64) -> Option<Settings> {
        let accuracy = self.optimizer.stated.accuracy.filter(|accuracy| error > *accuracy)?;
        let next = finer(settings, self.optimizer.settings_for(self.base, self.fitted, point, accuracy));
        (next != settings).then_some(next)
    }

    fn is_accurate(&self, reached: f64) {
        if let Some(accuracy) = self.optimizer.stated.accuracy.filter(|accuracy| reached > *accuracy) {
            let said = format!("the objective is accurate to {reached:.1e}, not to {accuracy:.1e}");
            (self.context.warn)(said.into());
        }
    }

    fn doubt(&self, search: &mut Search) {
        if let Some(doubt) = search.doubt() {
            (self.context.warn)(doubt.to_owned().into());
        }
    }

    /// Why a search ended.
    fn said(&self, reason: Reason) -> String {
        if reason != Reason::Settled {
            return reason.to_string();
        }
        let Settled { improvement, evaluations } = self.optimizer.rule();
        format!("{reason}: no gain of {} % in {evaluations} evaluations", significant(100.0 * improvement, 4))
    }

    fn built<'b>(&self, best: Option<&'b Candidate>) -> Result<&'b Candidate, Failure> {
        best.ok_or_else(|| self.optimizer.nothing_built(self.fitted))
    }

    fn kept<'b>(&self, best: Option<&'b Candidate>) -> Result<&'b Candidate, Failure> {
        let best = self.built(best)?;
        if best.violation > 0.0 { Err(self.nothing_kept()) } else { Ok(best) }
    }

    /// Which constraints no design keeps, and by how much.
    fn nothing_kept(&self) -> Failure {
        let goal = &self.optimizer.goal;
        let missed = |limit: usize, reserve: f64| {
            let limit = &goal.limits[limit];
            format!("`{}` (nearest: {})", limit.text, limit.missed(reserve, goal.measures[limit.measure].unit))
        };
        // A search in the neighbourhood of the best sees little of what keeps one limit and breaks another.
        let is_shown = |limit: &usize| goal.limits.len() > 1 && self.shown.get(*limit).is_some_and(|kept| *kept >= 0.0);
        let never = (0..goal.limits.len()).filter(|limit| self.seen.most[*limit] < -KEPT && !is_shown(limit));
        let never: Vec<String> = never.map(|limit| missed(limit, self.seen.most[limit])).collect();
        if never.is_empty() {
            let all: Vec<&str> = goal.limits.iter().map(|limit| limit.text.as_str()).collect();
            return Failure::new(format!(
                "each of the constraints {} is kept by some design, but none that was tried keeps all of them: the nearest \
                 breaks them by {} % of their limits in all",
                all.join(", "),
                significant(100.0 * self.seen.broken, 3)
            ));
        }
        Failure::new(format!("no design that was tried keeps {}", never.join(" or ")))
    }
}
