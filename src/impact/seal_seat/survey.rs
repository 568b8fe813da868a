//! Which candidates are watched from one look at all of them to the next.

use super::contact::{CLOSED, Contact};
use super::nodes::Ball;

/// Margin of the next survey over that which was needed before.
const RESERVE: f64 = 2.0;
/// Place of a candidate that is not watched.
pub(super) const UNWATCHED: usize = usize::MAX;

/// What a look at all candidates has shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Survey {
    /// Whether one that was not watched has been passed through.
    pub missed: bool,
    /// Largest gap in m at the survey before of those that have touched since: what margin was needed.
    pub needed: f64,
}

impl Contact<'_> {
    /// Looks at all candidates after [`Contact::solve`], and watches from now on those with gaps below `margin` in m, or
    /// below twice the margin that would have been needed since the last survey.
    pub fn survey(&mut self, modal: &[f64], balls: &[Ball], margin: f64) -> Survey {
        let mut survey = Survey { missed: false, needed: 0.0 };
        self.collect_push();
        let (mut active, mut watched) = (0, 0);
        for i in 0..self.nodes.len() {
            let was_watched = self.loads.watched.get(watched) == Some(&i);
            watched += usize::from(was_watched);
            let touches = self.loads.active.get(active) == Some(&i);
            if touches {
                active += 1;
                self.gap[i] = 0.0;
            } else {
                self.yielding[i] = self.nodes.displaced(i, &self.push);
                self.look(i, modal, balls);
            }
            let passed = !was_watched && self.gap[i] < -CLOSED * balls[self.nodes.ball[i]].radius;
            survey.missed |= passed;
            if touches || passed {
                survey.needed = survey.needed.max(self.surveyed[i]);
            }
        }
        self.surveyed.clone_from(&self.gap);
        self.watch(margin.max(RESERVE * survey.needed));
        survey
    }

    /// Watches the candidates whose gaps at the last survey were below `margin` in m.
    fn watch(&mut self, margin: f64) {
        self.loads.watched.clear();
        self.loads.watched.extend((0..self.nodes.len()).filter(|&i| self.surveyed[i] < margin));
        self.slot.fill(UNWATCHED);
        for (slot, &i) in self.loads.watched.iter().enumerate() {
            self.slot[i] = slot;
        }
        self.compact.clear();
        for &i in &self.loads.watched {
            let row = self.nodes.row(i);
            self.compact.extend(self.loads.watched.iter().map(|&j| row[j]));
        }
    }
}
