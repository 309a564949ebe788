//! The walk over the whole mesh cycle of a design under a torque, in smooth spans.
//!
//! The cycle is cut at the ends of its zones, where a modification starts or ends, where flanks begin to touch at another
//! place (with corner contact), and where a pair takes up or loses its load, which is found to rounding; in between
//! everything is smooth. Must not know: how a balance is found, what is done with the values.

use super::loading::{Loading, State};
use super::trace::{NODES, Span, Trace};

/// Cuts closer than this share of the base pitch are one.
pub(super) const CLOSEST: f64 = 1e-10;
/// Cuts that one span may be given for pairs that take up or lose load.
const MOST_CUTS: usize = 24;

impl Loading<'_> {
    /// Visits the whole cycle in order, in smooth spans no longer than `longest` \[m\].
    pub fn walk(&self, longest: f64, mut visit: impl FnMut(&Span, &[State; NODES])) {
        let closest = CLOSEST * self.cycle.period();
        for zone in &self.cycle.zones {
            let mut start = zone.start;
            let inside = self.breaks.iter().copied().filter(|cut| zone.end - cut > closest).chain([zone.end]);
            for end in inside {
                if end - start <= closest {
                    continue;
                }
                let panels = ((end - start) / longest - 1e-9).ceil().max(1.0);
                let width = (end - start) / panels;
                let mut from = start;
                let mut first = self.state(start, zone.pairs);
                let mut panel = 1.0;
                while panel <= panels {
                    let to = if panel < panels { start + width * panel } else { end };
                    let span = Span { start: from, end: to, pairs: zone.pairs, touches: [None; 2] };
                    let mut cuts = MOST_CUTS;
                    first = self.smooth(&span, first, &mut cuts, &mut visit);
                    from = to;
                    panel += 1.0;
                }
                start = end;
            }
        }
    }

    /// Visits a span, in parts if the set of loaded pairs changes inside it. Returns the state at its end.
    ///
    /// All parts share `cuts`: where gaps are equal but for rounding, the changes that rounding makes have no end.
    fn smooth(
        &self,
        span: &Span,
        first: State,
        cuts: &mut usize,
        visit: &mut impl FnMut(&Span, &[State; NODES]),
    ) -> State {
        let rows = &self.cycle.rows;
        let mut states = [first; NODES];
        for (node, state) in states.iter_mut().enumerate().skip(1) {
            *state = self.state(span.position(rows, node), span.pairs);
        }
        if *cuts > 0
            && let Some((position, pair)) = self.change(span, &states)
        {
            *cuts -= 1;
            let before = Span { end: position, touches: [span.touches[0], pair], ..*span };
            let after = Span { start: position, touches: [pair, span.touches[1]], ..*span };
            let middle = self.smooth(&before, first, cuts, visit);
            return self.smooth(&after, middle, cuts, visit);
        }
        let last = states[NODES - 1];
        self.settle(span, &mut states);
        visit(span, &states);
        last
    }

    /// The transmission error over the cycle.
    #[must_use]
    pub fn trace(&self) -> Trace {
        let mut trace = Trace { spans: Vec::with_capacity(32) };
        self.walk(self.span_length(0), |span, states| {
            trace.spans.push((*span, std::array::from_fn(|node| states[node].transmission_error())));
        });
        trace
    }

    /// The longest span for the wanted number of positions, short enough for `harmonics`.
    pub(super) fn span_length(&self, harmonics: usize) -> f64 {
        let spans = (self.cycle.settings.positions as f64 / (NODES - 1) as f64).max(harmonics as f64);
        self.cycle.period() / spans.max(1.0)
    }
}
