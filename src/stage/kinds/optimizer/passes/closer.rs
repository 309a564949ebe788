//! What follows a coarse search: the best of what it tried as asked for, and down from there.
//!
//! Must not know: how a method searches.

use super::{AT_ONCE, Found, Pass, Run, Seen};
use declare::error::Failure;
use declare::number::significant;
use gearmesh::gear::mesh::Settings;
use gearmesh::optimize;
use gearmesh::optimize::constraints::Evaluation;
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
    pub(super) fn confirm(&mut self, asked: Settings) -> Result<Starts, Failure> {
        let leaders: Vec<Leader> = self.leaders.all().to_vec();
        let mut best: Option<Starts> = None;
        let mut off = Off::default();
        let mut looked = 0;
        let coarse = self.look_as_asked();
        for some in leaders.chunks(AT_ONCE) {
            if let Some(Starts { best, .. }) = &best
                && some.iter().all(|leader| !off.may_lead(leader, best))
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
                    off.learn(leader, evaluation);
                    let found = Candidate { point: leader.point.clone(), value, violation };
                    best = Some(match best {
                        Some(starts) => starts.with(found, leader.violation == 0.0),
                        None => Starts::of(found, leader.violation == 0.0),
                    });
                }
            }
            self.note(&evaluations);
        }
        let best = best.ok_or_else(|| self.optimizer.nothing_built(self.fitted))?;
        self.shown = off.shown(&coarse);
        let ended = format!("coarse values are off by up to {} %", significant(100.0 * off.value, 2));
        self.passes.push(Pass { what: "confirm", settings: asked, evaluations: looked, best: best.best.value, ended });
        Ok(best)
    }

    /// With another design, whose value is that of a coarse look.
    pub(super) fn compared(&mut self, starts: Starts, other: Candidate, asked: Settings) -> Result<Starts, Failure> {
        let cycle = self.base.sampled(asked);
        let evaluations = self.evaluate(&cycle, std::slice::from_ref(&other.point))?;
        self.note(&evaluations);
        let (value, violation) = (evaluations[0].value, evaluations[0].violation());
        let kept = other.violation == 0.0;
        let found = Candidate { value, violation, ..other };
        Ok(if value < f64::INFINITY { starts.with(found, kept) } else { starts })
    }

    /// Down from each, with all as asked for; the best of what is found.
    pub(super) fn refine_all(
        &mut self,
        from: &Starts,
        settings: Settings,
        rule: Settled,
    ) -> Result<Candidate, Failure> {
        let found = self.refine(&from.best, settings, ASKED, rule)?;
        let Some(beyond) = &from.beyond else { return Ok(found) };
        let other = self.refine(beyond, settings, ASKED, rule)?;
        Ok(if rank(&other) < rank(&found) { other } else { found })
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
        // Where nothing kept the constraints in a coarse look, what came nearest may as asked for.
        let points: Vec<Vec<f64>> = if members.is_empty() {
            self.leaders.all().iter().map(|leader| leader.point.clone()).collect()
        } else {
            members.iter().map(|member| member.point.clone()).collect()
        };
        self.shown = self.look_as_asked().most;
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
        let error = self.optimizer.error(self.base, self.fitted, &best.point, asked);
        self.is_accurate(error);
        Ok(self.finish(best, front, (asked, error), ended))
    }
}

/// By which designs are compared: those that keep all constraints first.
fn rank(candidate: &Candidate) -> (f64, f64) {
    (candidate.violation, candidate.value)
}

/// Where to go down from, with all as asked for.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Starts {
    pub(super) best: Candidate,
    /// Whether that kept the constraints in a coarse look.
    kept: bool,
    /// A better one but for a constraint that it kept in a coarse look, and breaks by no more than that was off: the best that
    /// keeps it may be beside.
    beyond: Option<Candidate>,
}

impl Starts {
    pub(super) fn of(best: Candidate, kept: bool) -> Self {
        Self { best, kept, beyond: None }
    }

    /// With another one; `kept` says whether it kept the constraints in a coarse look.
    fn with(self, found: Candidate, kept: bool) -> Self {
        let is_better = rank(&found) < rank(&self.best);
        let [(best, kept), (other, other_kept)] =
            if is_better { [(found, kept), (self.best, self.kept)] } else { [(self.best, self.kept), (found, kept)] };
        let others = [Some(other).filter(|_| other_kept), self.beyond].into_iter().flatten();
        let beyond = others.filter(|it| it.violation > 0.0 && it.value < best.value);
        let beyond = beyond.min_by(|a, b| a.value.total_cmp(&b.value));
        Self { best, kept, beyond }
    }
}

/// What coarse values were off by at most, of those that were looked at.
#[derive(Clone, Debug, Default)]
struct Off {
    /// Of the objective, as a share of it.
    value: f64,
    /// Of each constraint, in shares of its limit.
    constraints: Vec<f64>,
}

impl Off {
    fn learn(&mut self, leader: &Leader, evaluation: &Evaluation) {
        let value = (leader.value - evaluation.value).abs() / evaluation.value.abs().max(f64::MIN_POSITIVE);
        self.value = self.value.max(value);
        self.constraints.resize(evaluation.constraints.len(), 0.0);
        let pairs = leader.constraints.iter().zip(&evaluation.constraints);
        for (off, (coarse, asked)) in self.constraints.iter_mut().zip(pairs) {
            *off = off.max((coarse - asked).abs());
        }
    }

    /// What a coarse look shows of the constraints, be it off as much as any was: by how much each was kept at least.
    fn shown(&self, coarse: &Seen) -> Vec<f64> {
        let off = self.constraints.iter().copied().chain(std::iter::repeat(0.0));
        coarse.most.iter().zip(off).map(|(most, off)| most - off).collect()
    }

    /// Whether a leader may be better than what was looked at, if it is off by no more than any was: by its objective among
    /// those that may keep the constraints, and as long as none does by how much it breaks.
    fn may_lead(&self, leader: &Leader, best: &Candidate) -> bool {
        let off: f64 = self.constraints.iter().sum();
        if best.violation > 0.0 {
            return leader.violation - off < best.violation;
        }
        leader.violation <= off && leader.value - self.value * leader.value.abs() < best.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What breaks a limit that it kept in a coarse look is gone down from too, where it is better but for that.
    #[test]
    fn a_better_design_just_beyond_a_limit_is_not_lost() {
        let starts = Starts::of(best(10.0, 0.0), true);
        let beyond = starts.clone().with(best(9.0, 0.001), true);
        assert_eq!(beyond, Starts { beyond: Some(best(9.0, 0.001)), ..starts.clone() });
        assert_eq!(starts.clone().with(best(9.0, 0.001), false), starts);
        assert_eq!(starts.clone().with(best(11.0, 0.001), true), starts);
        // The best of them, and none once a design that keeps all is as good.
        assert_eq!(beyond.clone().with(best(8.0, 0.002), true).beyond, Some(best(8.0, 0.002)));
        assert_eq!(beyond.clone().with(best(9.5, 0.002), true), beyond);
        assert_eq!(beyond.clone().with(best(8.5, 0.0), false), Starts::of(best(8.5, 0.0), false));
        // Begun with one that breaks it: of use if it kept it in a coarse look.
        assert_eq!(Starts::of(best(9.0, 0.001), true).with(best(10.0, 0.0), true), beyond);
        assert_eq!(Starts::of(best(9.0, 0.001), false).with(best(10.0, 0.0), true), starts);
    }

    fn leader(value: f64, constraint: f64) -> Leader {
        Leader { point: vec![0.0], value, violation: (-constraint).max(0.0), constraints: vec![constraint] }
    }

    fn best(value: f64, violation: f64) -> Candidate {
        Candidate { point: vec![0.0], value, violation }
    }

    /// Coarse values were off by a tenth of the objective, and by 0.02 of the limit.
    #[test]
    fn leaders_are_looked_at_as_long_as_they_may_be_better() {
        let mut off = Off::default();
        off.learn(&leader(9.0, 0.05), &Evaluation { value: 10.0, constraints: vec![0.03], ..Evaluation::default() });
        off.learn(&leader(5.0, 0.01), &Evaluation { value: 5.1, constraints: vec![0.01], ..Evaluation::default() });
        let may = |of: &Leader, best: Candidate| off.may_lead(of, &best);
        assert!(may(&leader(10.9, 0.0), best(10.0, 0.0)) && !may(&leader(11.2, 0.0), best(10.0, 0.0)));
        // It broke the limit in a coarse look, by less and by more than that may be off.
        assert!(may(&leader(5.0, -0.019), best(10.0, 0.0)) && !may(&leader(5.0, -0.021), best(10.0, 0.0)));
        // While none keeps the limit, one that may is better whatever its objective.
        assert!(may(&leader(99.0, 0.0), best(10.0, 0.01)) && may(&leader(99.0, -0.029), best(10.0, 0.01)));
        assert!(!may(&leader(1.0, -0.031), best(10.0, 0.01)));
        // A limit that was kept by 0.05 at most was kept by 0.03 at least.
        let shown = off.shown(&Seen { most: vec![0.05], broken: 0.0 });
        assert!((shown[0] - 0.03).abs() < 1e-12, "{shown:?}");
    }
}
