//! The forces of a step: what both contacts answer at its Gauss points, by sweeps from the first to the last.
//!
//! The approach at Gauss point j depends on the forces at all of them, but hardly on the later ones (the bodies
//! answer to the past), so that sweeps in the order of time, each with the newest forces, converge quickly. With a
//! residual flexibility every visit of a point does one Newton step of the contacts' own small system, from
//! the Hertz approaches of the visit before.

use super::batch::OscillatorBatch;
use super::collocation::{Collocation, POINTS, Points};
use super::contact_balance::work;
use super::point_laws::{HertzPoints, PointLaw, ResidualPoints, Visit};
use super::step_table::StepTable;
use super::system::{System, dot};
use super::tangential_load::StepLoad;
use crate::numerics::stages::{STAGES, Stages};
use wide::f64x4;

/// Sweeps after which a step counts as too long.
const MAX_SWEEPS: usize = 30;
/// Contraction that is relied upon at most: one sweep may have been lucky.
const BEST_CONTRACTION: f64 = 1e-2;
/// Sweeps after which the contacts' own system is solved fully at every visit.
const MAX_NEWTON_SWEEPS: usize = 12;

/// Course of both contacts over one step, at its start, Gauss points and end.
#[derive(Debug, Clone, Copy, Default)]
pub struct Course {
    /// Length of the step in s; 0 before the first.
    pub h: f64,
    /// Modal approach, on which the force works, m.
    pub approach: [Points; 2],
    /// Patches (see [`System::contact`]), positive where the bodies touch, m.
    pub local_approach: [Points; 2],
    /// Force in N.
    pub force: [Points; 2],
    /// Work of the force polynomials along the approaches in J.
    pub work: [f64; 2],
    /// Strain energy of the contacts at the end in J.
    pub stored: f64,
    /// Kinetic and strain energy of the bodies at the end in J.
    pub motion: f64,
    /// Forces along the surfaces at the nodes in N, where they are known as shares of those across; and the work on the bodies in J of what
    /// happens along the surfaces.
    pub along: [Stages; 2],
    pub along_work: f64,
    /// Part of the approaches that comes of the contacts' ways over a plate, m.
    pub shift: [Points; 2],
}

impl Course {
    /// Values at the end: modal approaches in m, local approaches in m, forces in N.
    #[inline(always)]
    pub fn end(&self) -> [[f64; 2]; 3] {
        let last = |rows: &[Points; 2]| [rows[0][POINTS - 1], rows[1][POINTS - 1]];
        [last(&self.approach), last(&self.local_approach), last(&self.force)]
    }

    /// Forces at the Gauss points in N.
    #[inline(always)]
    pub fn stages(&self) -> [Stages; 2] {
        let inner = |row: &Points| std::array::from_fn(|j| row[j + 1]);
        [inner(&self.force[0]), inner(&self.force[1])]
    }
}

/// When sweeps may end: all bounds hold.
#[derive(Debug, Clone, Copy)]
pub struct ForceError {
    /// Of each contact in N, for the impulse of the step and its own peak.
    pub absolute: [f64; 2],
    /// Over the largest force of the step, for its energy.
    pub relative: f64,
}

/// The solver of the steps of one run.
#[derive(Debug)]
pub struct StepSolver<'a> {
    pub system: &'a System,
    pub collocation: &'a Collocation,
    pub batch: OscillatorBatch,
    /// Factor by which a sweep reduced the change of the forces lately.
    contraction: f64,
    /// The latest extrapolation: ratio of the steps, weights of the points of the step before at each Gauss point.
    extrapolation: (f64, [f64x4; POINTS]),
}

/// Unknowns of a step at its Gauss points.
struct Unknowns {
    approach: [f64x4; 2],
    local: [Stages; 2],
    force: [Stages; 2],
}

/// Values at start, nodes and end of a step.
pub(super) fn points(start: f64, stages: Stages, end: f64) -> Points {
    std::array::from_fn(|p| match p {
        0 => start,
        _ if p == POINTS - 1 => end,
        _ => stages[p - 1],
    })
}

impl<'a> StepSolver<'a> {
    /// For the contacts and bodies of `system`.
    pub fn new(system: &'a System, collocation: &'a Collocation) -> Self {
        Self {
            system,
            collocation,
            batch: OscillatorBatch::new(system),
            contraction: 1.0,
            extrapolation: (0.0, [f64x4::ZERO; POINTS]),
        }
    }

    /// Solves a step of the length of `table` that follows on `before`, from the state `now` into `next`; `None` if
    /// the sweeps do not settle within `force_error` or the contact has no equilibrium. `load` has what happens
    /// along the surfaces.
    pub fn solve(
        &mut self,
        table: &StepTable,
        before: &Course,
        now: (&[f64x4], &[f64x4]),
        (next_q, next_v): (&mut [f64x4], &mut [f64x4]),
        load: Option<&StepLoad>,
        force_error: ForceError,
    ) -> Option<Course> {
        let mut free = table.free_approach(&self.batch, self.system.gap, now.0, now.1);
        let loaded = load.zip(table.load.as_ref()).map(|(load, answers)| {
            let along = table.free_motion(&self.batch, |k| self.batch.along[k], now.0, now.1);
            free = load.moved(free, along);
            (load, answers, along)
        });
        let [own0, mutual, own1] = &table.coupling;
        let under_load = loaded.map(|(load, answers, _)| answers.coupling(&table.coupling, load));
        let coupling = match &under_load {
            Some(all) => all.each_ref(),
            None => [own0, mutual, mutual, own1],
        };
        let unforced = free.map(f64x4::to_array);
        let guess = self.guess(before, table.h).unwrap_or(unforced);
        let laws = &self.system.laws;
        let solved = match self.system.residual {
            None => {
                self.sweep(coupling, &free, guess, MAX_SWEEPS, force_error, HertzPoints::new(laws, table))
            }
            Some(residual) => {
                let points = |full| ResidualPoints::new(laws, residual, table, full);
                self.sweep(coupling, &free, guess, MAX_NEWTON_SWEEPS, force_error, points(false))
                    .or_else(|| self.sweep(coupling, &free, unforced, MAX_SWEEPS, force_error, points(true)))
            }
        };
        let (unknowns, contraction) = solved?;
        self.contraction = contraction;
        let (mut end, mut motion) = table.advance(&self.batch, &unknowns.force, now, (next_q, next_v));
        let (mut along, mut along_work, mut shift) = ([[0.0; STAGES]; 2], 0.0, [[0.0; POINTS]; 2]);
        if let Some((load, answers, free)) = loaded {
            along = load.forces(&unknowns.force);
            let (added, all) = table.advance_along(&self.batch, &along, (next_q, next_v));
            let forced = answers.along(&along, &unknowns.force);
            let [start, last] = [now.0, next_q].map(|q| self.batch.moved_along(q));
            let moved = [0, 1].map(|i| points(start[i], (free[i] + forced[i]).to_array(), last[i]));
            shift = load.shift(&moved);
            motion = all;
            for i in 0..2 {
                end[i] += added[i] + shift[i][POINTS - 1];
                along_work += work(self.collocation, &along[i], &moved[i]);
                along_work += work(self.collocation, &unknowns.force[i], &shift[i]);
            }
        }
        let end_approach = [end[0] - self.system.gap[0], end[1] - self.system.gap[1]];
        let last = unknowns.local.map(|p| dot(&self.collocation.ends[1], &p));
        let (end_local, end_force) = self
            .system
            .contact(end_approach, last)
            .or_else(|| self.system.contact(end_approach, end_approach))?;
        let join = |start: [f64; 2], stages: &[Stages; 2], end: [f64; 2]| -> [Points; 2] {
            std::array::from_fn(|i| points(start[i], stages[i], end[i]))
        };
        let [approach, local, force] = before.end();
        let approach = join(approach, &unknowns.approach.map(f64x4::to_array), end_approach);
        Some(Course {
            h: table.h,
            approach,
            work: [0, 1].map(|i| work(self.collocation, &unknowns.force[i], &approach[i])),
            stored: self.system.stored_energy(end_force, end_local),
            motion,
            along,
            along_work,
            shift,
            local_approach: join(local, &unknowns.local, end_local),
            force: join(force, &unknowns.force, end_force),
        })
    }

    /// Sweeps, each point by `law`, until the forces are right to `force_error`; `coupling` has the approaches lost per force, contacts (0,0),
    /// (0,1), (1,0), (1,1). Gives also the contraction of the last sweeps.
    #[inline(always)]
    fn sweep(
        &self,
        [own0, by_inner, by_outer, own1]: [&[f64x4; STAGES]; 4],
        free: &[f64x4; 2],
        local: [Stages; 2],
        max_sweeps: usize,
        force_error: ForceError,
        mut law: impl PointLaw,
    ) -> Option<(Unknowns, f64)> {
        let mut force = [[0.0; STAGES]; 2];
        // the approaches under the newest forces
        let [mut y0, mut y1] = *free;
        for j in 0..STAGES {
            let f = law.begin(j, [local[0][j], local[1][j]]);
            y0 -= own0[j] * f[0] + by_inner[j] * f[1];
            y1 -= by_outer[j] * f[0] + own1[j] * f[1];
            [force[0][j], force[1][j]] = f;
        }
        let mut unknowns = Unknowns { approach: *free, local, force };
        let (mut contraction, mut earlier) = (self.contraction, f64::INFINITY);
        for _ in 0..max_sweeps {
            let (mut changes, mut largest) = ([0.0_f64; 2], 0.0_f64);
            let mut kinked = false;
            law.prepare(&unknowns.local);
            for j in 0..STAGES {
                let visit = Visit {
                    point: j,
                    approach: [y0.as_array()[j], y1.as_array()[j]],
                    local: [unknowns.local[0][j], unknowns.local[1][j]],
                    force: [unknowns.force[0][j], unknowns.force[1][j]],
                };
                let (d, f) = law.visit(visit)?;
                let step = [f[0] - visit.force[0], f[1] - visit.force[1]];
                y0 -= own0[j] * step[0] + by_inner[j] * step[1];
                y1 -= by_outer[j] * step[0] + own1[j] * step[1];
                for i in 0..2 {
                    changes[i] = changes[i].max(step[i].abs());
                    largest = largest.max(f[i]);
                    kinked |= (f[i] > 0.0) != (visit.force[i] > 0.0);
                    unknowns.local[i][j] = d[i];
                    unknowns.force[i][j] = f[i];
                }
            }
            unknowns.approach = [y0, y1];
            let change = changes[0].max(changes[1]);
            if !change.is_finite() {
                return None;
            }
            if earlier.is_finite() {
                contraction = change / earlier;
            }
            // Newton's step across a touch knows only the side it comes from;
            // in a very short step any force gives the right impulse, but not the right energy
            let left = if kinked { 1.0 } else { contraction.clamp(BEST_CONTRACTION, 1.0) };
            if change * left <= force_error.relative * largest
                && (0..2).all(|i| changes[i] * left <= force_error.absolute[i])
            {
                return Some((unknowns, contraction));
            }
            earlier = change;
        }
        None
    }

    /// Local approaches at the Gauss points of a step of `h` s, extrapolated from the step before; `None` if there is
    /// none, or none near enough.
    fn guess(&mut self, before: &Course, h: f64) -> Option<[Stages; 2]> {
        if h > 2.5 * before.h {
            return None;
        }
        let ratio = h / before.h;
        if ratio != self.extrapolation.0 {
            self.extrapolation = (ratio, self.collocation.extrapolation(ratio));
        }
        let (_, weights) = &self.extrapolation;
        let at_nodes = |values: &Points| {
            let mut guess = f64x4::ZERO;
            for p in 0..POINTS {
                guess += weights[p] * values[p];
            }
            guess.to_array()
        };
        Some([at_nodes(&before.local_approach[0]), at_nodes(&before.local_approach[1])])
    }
}
