//! What follows a coarse search: the best of what it tried as asked for, and down from there.
//!
//! Must not know: how a method searches.

use super::{AT_ONCE, Found, Pass, Run};
use declare::error::Failure;
use declare::number::significant;
use gearmesh::gear::transmission_error::cycle::Settings;
use gearmesh::optimize;
use gearmesh::optimize::leaders::Leader;
use gearmesh::optimize::pareto::{self, Member};
use gearmesh::optimize::search::Candidate;
use gearmesh::optimize::settled::Settled;

/// How a simplex goes down.
#[derive(Clone, Copy)]
pub(super) struct Descent {
    /// Its first edges, as a share of each range.
    edge: f64,
    /// For each of its corners: evaluations at most, and those without a gain after which it has settled.
    most: usize,
    without_gain: usize,
}

/// With the sampling between, whose minimum may be elsewhere than the coarse one's; it is cheap enough to follow a kink.
pub(super) const BETWEEN: Descent = Descent { edge: 0.1, most: 150, without_gain: 60 };
/// From there, as asked for.
pub(super) const ASKED: Descent = Descent { edge: 0.03, most: 150, without_gain: 30 };

impl Descent {
    /// At most, with so many variables.
    pub(super) fn evaluations(self, dimension: usize) -> usize {
        self.most * (dimension + 1)
    }
}

impl Run<'_> {
    /// The best of the leaders as asked for. The values of those that are not looked at would have to be off by more than
    /// those of any that are.
    pub(super) fn confirm(&mut self, asked: Settings) -> Result<Candidate, Failure> {
        let leaders: Vec<Leader> = self.leaders.all().to_vec();
        let mut best: Option<Candidate> = None;
        let mut off = 0.0_f64;
        let mut looked = 0;
        for some in leaders.chunks(AT_ONCE) {
            if let Some(best) = &best
                && some.iter().all(|leader| !may_lead(leader, best, off))
            {
                break;
            }
            let points: Vec<Vec<f64>> = some.iter().map(|leader| leader.point.clone()).collect();
            let cycle = self.base.sampled(asked);
            let evaluations = self.evaluate(&cycle, &points)?;
            looked += points.len();
            for (leader, evaluation) in some.iter().zip(&evaluations) {
                let (value, violation) = (evaluation.value, evaluation.violation());
                if value < f64::INFINITY {
                    off = off.max((leader.value - value).abs() / value.abs().max(f64::MIN_POSITIVE));
                    let found = Candidate { point: leader.point.clone(), value, violation };
                    if best.as_ref().is_none_or(|best| (violation, value) < (best.violation, best.value)) {
                        best = Some(found);
                    }
                }
            }
            self.note(&evaluations);
        }
        let best = best.ok_or_else(|| self.optimizer.nothing_built(self.pair))?;
        let ended = format!("coarse values are off by up to {} %", significant(100.0 * off, 2));
        self.passes.push(Pass { what: "confirm", settings: asked, evaluations: looked, best: best.value, ended });
        Ok(best)
    }

    /// Which of two designs is better as asked for, where only the first one's value is.
    pub(super) fn better(&mut self, one: Candidate, other: Candidate, asked: Settings) -> Result<Candidate, Failure> {
        let cycle = self.base.sampled(asked);
        let evaluations = self.evaluate(&cycle, std::slice::from_ref(&other.point))?;
        self.note(&evaluations);
        let (value, violation) = (evaluations[0].value, evaluations[0].violation());
        let is_better = value < f64::INFINITY && (violation, value) < (one.violation, one.value);
        Ok(if is_better { Candidate { value, violation, ..other } } else { one })
    }

    /// Down from a design.
    pub(super) fn refine(
        &mut self,
        from: &Candidate,
        settings: Settings,
        descent: Descent,
        rule: Settled,
    ) -> Result<Candidate, Failure> {
        let bounds = self.optimizer.bounds().map_err(|wrong| Failure::new(wrong.message))?;
        let dimension = bounds.dimension();
        let rule = Settled { evaluations: descent.without_gain * (dimension + 1), ..rule };
        let search = optimize::refinement(bounds, &from.point, descent.edge, descent.evaluations(dimension));
        let mut search = search.until_settled(rule);
        self.run(&mut search, settings, "refine")?;
        // It began at that design.
        Ok(search.best().cloned().unwrap_or_else(|| from.clone()))
    }

    /// The points of a front as asked for: those that still are on it.
    pub(super) fn confirmed(&mut self, members: &[Member], asked: Settings, ended: String) -> Result<Found, Failure> {
        if members.is_empty() {
            return Err(self.nothing_kept());
        }
        let points: Vec<Vec<f64>> = members.iter().map(|member| member.point.clone()).collect();
        let cycle = self.base.sampled(asked);
        let evaluations = self.evaluate(&cycle, &points)?;
        self.note(&evaluations);
        let looked = points.len();
        let again: Vec<Member> =
            points.into_iter().zip(evaluations).map(|(point, evaluation)| Member { point, evaluation }).collect();
        let mut front = pareto::front(&again);
        front.sort_by(|a, b| a.evaluation.value.total_cmp(&b.evaluation.value));
        let front = pareto::thinned(front, self.optimizer.stated.front_points);
        let balanced = pareto::balanced(&front).ok_or_else(|| self.nothing_kept())?;
        let best = Candidate { point: balanced.point.clone(), value: balanced.evaluation.value, violation: 0.0 };
        let left = format!("{} of {looked} points are on the front", front.len());
        self.passes.push(Pass { what: "confirm", settings: asked, evaluations: looked, best: best.value, ended: left });
        let error = self.optimizer.error(self.base, self.pair, &best.point, asked);
        self.is_accurate(error);
        Ok(self.finish(best, front, (asked, error), ended))
    }
}

/// Whether a leader may be better than what was looked at, if its value is off by no more than any was.
fn may_lead(leader: &Leader, best: &Candidate, off: f64) -> bool {
    let least = leader.value - off * leader.value.abs();
    // A constraint that is broken in a coarse look may be kept in a closer one.
    least < best.value && leader.violation <= best.violation + off
}
