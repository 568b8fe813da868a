//! Which candidates are watched from one look at all of them to the next.

use super::accumulate::{add_modes, deform_under};
use super::contact::ContactProblem;
use super::nodes::Ball;
use nalgebra::Vector3;

/// Margin of the next survey over that which was needed before.
const RESERVE: f64 = 3.0;
/// Those who are watched anew are chosen for this many margins, so that they do for several surveys.
const AHEAD: f64 = 2.0;
/// They are chosen anew if they are more than this many times those needed.
const MOST_IDLE: usize = 2;

/// What a look at all candidates has shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Survey {
    /// Whether one that was not watched has been passed through.
    pub missed: bool,
    /// Largest gap in m at the survey before of those that have touched since: what margin was needed.
    pub needed: f64,
}

impl ContactProblem<'_> {
    /// Looks at all candidates after [`ContactProblem::solve`], and sees to it that those with gaps below `margin` in m, or
    /// below some times the margin that would have been needed since the last survey, are watched from now on.
    pub fn survey(&mut self, modal: &[f64], balls: &[Ball], margin: f64) -> Survey {
        let (nodes, n) = (self.nodes, self.nodes.len());
        self.collect_push();
        let loaded = self.push.len();
        if let Some(traces) = &self.loads.traces {
            self.push.extend_from_slice(traces.forces());
        }
        deform_under(&mut self.displaced, 0..n, |j| nodes.column(j), &self.push);
        self.push.truncate(loaded);
        if self.loads.traces.is_some() {
            let square = |i: usize| (0..3).map(|c| self.displaced[c * n + i].powi(2)).sum::<f64>();
            self.lag = (0..n).map(square).fold(0.0, f64::max).sqrt();
        }
        add_modes(&mut self.displaced, &nodes.shapes, modal);
        let mut survey = Survey { missed: false, needed: 0.0 };
        let mut active = 0;
        for i in 0..n {
            let in_contact = self.loads.active.get(active) == Some(&i);
            active += usize::from(in_contact);
            let ball = &balls[nodes.ball[i]];
            let displaced = Vector3::from_fn(|c, _| self.displaced[c * n + i]);
            let offset = nodes.place[i] + displaced - ball.centre;
            if let Some(friction) = &mut self.loads.friction {
                friction.put(i, offset);
            }
            let distance = offset.norm();
            let gap = if in_contact { 0.0 } else { distance - ball.radius };
            let passed = !self.watch.contains(i) && gap < -self.closed;
            survey.missed |= passed;
            if in_contact || passed {
                survey.needed = survey.needed.max(self.surveyed[i]);
            }
            self.surveyed[i] = gap;
        }
        self.choose(margin.max(RESERVE * survey.needed));
        survey
    }

    /// Watches at least the candidates whose gaps at the last survey were below `margin` in m.
    fn choose(&mut self, margin: f64) {
        let needed = (0..self.nodes.len()).filter(|&i| self.surveyed[i] < margin);
        let (count, within) =
            needed.fold((0, true), |(count, within), i| (count + 1, within && self.watch.contains(i)));
        if !within || self.watch.len() > MOST_IDLE * count {
            self.chosen.clear();
            self.chosen.extend((0..self.nodes.len()).filter(|&i| self.surveyed[i] < AHEAD * margin));
            // those in contact come first, so that what concerns only them concerns few slots
            self.chosen.sort_by(|a, b| self.surveyed[*a].total_cmp(&self.surveyed[*b]));
            self.watch.choose(self.nodes, &self.chosen);
        }
        self.deformed = 0;
        self.deform_up_to(self.watch.len());
        if let Some(traces) = &self.loads.traces {
            self.watch.remember(self.nodes, traces.forces());
        }
    }
}
