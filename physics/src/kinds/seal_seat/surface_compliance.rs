//! How the nodes in contact yield along the surfaces of the balls, each in two directions, and passes over them.

use super::nodes::Nodes;
use super::watch::Watch;
use nalgebra::Vector3;
use pulp::{Arch, Simd, WithSimd};

/// Turn of a normal in rad up to which the compliance made with the normal before is kept. The compliance only predicts how slips change: an
/// error of that size makes the iteration slower, but does not change its result.
const TURN: f64 = 2e-3;
/// Tangential force over the largest one from which on a node slides.
pub(super) const SLIDING: f64 = 1.0 - 1e-6;
/// Passes over the nodes that stick for their part of a correction: more change nothing that counts.
const RESPONSE_PASSES: usize = 3;

/// The nodes in contact, with two directions along the surface each.
#[derive(Debug, Clone, Default)]
pub(super) struct SurfaceCompliance {
    nodes: Vec<usize>,
    /// Normals with which the nodes' compliance was made. Shape (n).
    normal: Vec<Vector3<f64>>,
    /// Directions across the present normals. Shape (n, 2).
    axes: Vec<[Vector3<f64>; 2]>,
    /// Displacements in m/N of all nodes along both directions under unit forces on one along each. Shape (n of the force, 2, 2, n).
    compliance: Vec<f64>,
    /// Largest displacement of a node per force on itself, m/N. Shape (n).
    own: Vec<f64>,
}

/// Nodes that stick or slide, by the directions of a [`SurfaceCompliance`].
#[derive(Debug, Clone, Default)]
pub(super) struct SlidingNodes {
    /// Tangential forces in N. Shape (2, n).
    force: Vec<f64>,
    /// Motion in m over the ball's surface. Shape (2, n).
    slip: Vec<f64>,
    /// Largest tangential forces in N. Shape (n).
    most: Vec<f64>,
}

impl SlidingNodes {
    /// Of `n` nodes without forces.
    fn of(n: usize) -> Self {
        Self { force: vec![0.0; 2 * n], slip: vec![0.0; 2 * n], most: vec![0.0; n] }
    }

    /// Tangential force in N on the node in this `place`.
    fn at(&self, place: usize) -> [f64; 2] {
        [self.force[place], self.force[self.most.len() + place]]
    }

    /// Changes that force by `change` in N, and all slips by what the `columns` of the node's compliance say.
    #[inline(always)]
    fn push(&mut self, place: usize, change: [f64; 2], columns: &[f64]) {
        let n = self.most.len();
        self.force[place] += change[0];
        self.force[n + place] += change[1];
        let (first, second) = columns.split_at(2 * n);
        for ((slip, first), second) in self.slip.iter_mut().zip(first).zip(second) {
            *slip += change[0] * first + change[1] * second;
        }
    }
}

/// What a pass over the nodes has brought.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Pass {
    /// Change of the tangential forces, summed over the nodes, N.
    pub(super) changed: f64,
    /// Their sum, N.
    pub(super) held: f64,
}

impl SurfaceCompliance {
    /// Takes the nodes `active`, ascending, with the normals `normal` of all candidates.
    pub(super) fn follow(
        &mut self,
        active: &[usize],
        normal: &[Vector3<f64>],
        watch: &mut Watch,
        nodes: &Nodes,
    ) {
        let place_before = |i: &usize| {
            let place = self.nodes.binary_search(i).ok();
            place.filter(|&place| (normal[*i] - self.normal[place]).amax() <= TURN)
        };
        let before: Vec<Option<usize>> = active.iter().map(place_before).collect();
        if self.nodes != active || before.contains(&None) {
            self.replace(active, normal, &before);
            for place in (0..active.len()).filter(|&place| before[place].is_none()) {
                self.fill(place, watch, nodes);
            }
        }
        for (axes, &i) in self.axes.iter_mut().zip(active) {
            axes[0] = (axes[0] - normal[i].dot(&axes[0]) * normal[i]).normalize();
            axes[1] = normal[i].cross(&axes[0]);
        }
    }

    /// Takes other nodes, with what is known of those that have been there, at the places `before`.
    fn replace(&mut self, active: &[usize], normal: &[Vector3<f64>], before: &[Option<usize>]) {
        let old = std::mem::take(self);
        let (m, n) = (old.nodes.len(), active.len());
        self.nodes.extend_from_slice(active);
        self.compliance.resize(4 * n * n, 0.0);
        let columns = self.compliance.chunks_exact_mut(4 * n);
        for ((&i, place), columns) in active.iter().zip(before).zip(columns) {
            let Some(place) = *place else {
                self.normal.push(normal[i]);
                self.axes.push(across(&normal[i]));
                self.own.push(0.0);
                continue;
            };
            self.normal.push(old.normal[place]);
            self.axes.push(old.axes[place]);
            self.own.push(old.own[place]);
            let known = old.compliance[4 * m * place..].chunks_exact(m);
            for (column, known) in columns.chunks_exact_mut(n).zip(known) {
                for (entry, place) in column.iter_mut().zip(before) {
                    *entry = place.map_or(0.0, |place| known[place]);
                }
            }
        }
    }

    /// Makes what concerns the node in this `place`; the compliance is symmetric.
    fn fill(&mut self, place: usize, watch: &mut Watch, nodes: &Nodes) {
        let (n, end) = (self.nodes.len(), watch.up_to(&self.nodes));
        for d in 0..2 {
            watch.under(nodes, self.nodes[place], self.axes[place][d], end);
            for (a, (&i, axes)) in self.nodes.iter().zip(&self.axes).enumerate() {
                for c in 0..2 {
                    let entry = watch.compliance(i, axes[c]);
                    self.compliance[(4 * place + 2 * d + c) * n + a] = entry;
                    self.compliance[(4 * a + 2 * c + d) * n + place] = entry;
                }
            }
        }
        let entry = |d: usize, c: usize| self.compliance[(4 * place + 2 * d + c) * n + place];
        let (mean, half) = (0.5 * (entry(0, 0) + entry(1, 1)), 0.5 * (entry(0, 0) - entry(1, 1)));
        self.own[place] = mean + half.hypot(entry(0, 1));
    }

    /// The nodes with what `of` gives for each candidate: force in N, motion in m over the ball's surface, largest tangential force in N.
    pub(super) fn sliding(&self, of: impl Fn(usize) -> (Vector3<f64>, Vector3<f64>, f64)) -> SlidingNodes {
        let n = self.nodes.len();
        let mut nodes = SlidingNodes::of(n);
        for (place, (&i, axes)) in self.nodes.iter().zip(&self.axes).enumerate() {
            let (force, slip, most) = of(i);
            for c in 0..2 {
                nodes.force[c * n + place] = axes[c].dot(&force);
                nodes.slip[c * n + place] = axes[c].dot(&slip);
            }
            nodes.most[place] = most;
        }
        nodes
    }

    /// The forces in N on `nodes`, with the candidates.
    pub(super) fn forces(&self, nodes: &SlidingNodes) -> impl Iterator<Item = (usize, Vector3<f64>)> {
        self.nodes.iter().zip(&self.axes).enumerate().map(|(place, (&i, axes))| {
            let [first, second] = nodes.at(place);
            (i, first * axes[0] + second * axes[1])
        })
    }

    /// Lets each node stick or slide, in turn.
    pub(super) fn pass(&self, nodes: &mut SlidingNodes) -> Pass {
        Arch::new().dispatch(GaussSeidel { surface: self, nodes })
    }

    /// Changes the forces as far as small slips and other normal forces do, `pressed` times those before: what slides goes on sliding the
    /// same way, what sticks yields.
    pub(super) fn respond(&self, nodes: &mut SlidingNodes, pressed: impl Fn(usize) -> f64) {
        let size = 4 * self.nodes.len();
        let column = |place: usize| &self.compliance[place * size..][..size];
        let mut sticking = Vec::with_capacity(self.nodes.len());
        for (place, &i) in self.nodes.iter().enumerate() {
            let [first, second] = nodes.at(place);
            if first.hypot(second) < SLIDING * nodes.most[place] {
                sticking.push(place);
            } else {
                let more = pressed(i) - 1.0;
                nodes.push(place, [more * first, more * second], column(place));
            }
        }
        for _ in 0..RESPONSE_PASSES {
            for &place in &sticking {
                let slip = [nodes.slip[place], nodes.slip[self.nodes.len() + place]];
                nodes.push(place, slip.map(|slip| -slip / self.own[place]), column(place));
            }
        }
    }
}

/// Two directions across `normal` and each other.
fn across(normal: &Vector3<f64>) -> [Vector3<f64>; 2] {
    let mut least = Vector3::zeros();
    least[normal.iamin()] = 1.0;
    let first = normal.cross(&least).normalize();
    [first, normal.cross(&first)]
}

/// See [`SurfaceCompliance::pass`].
struct GaussSeidel<'a> {
    surface: &'a SurfaceCompliance,
    nodes: &'a mut SlidingNodes,
}

impl WithSimd for GaussSeidel<'_> {
    type Output = Pass;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Pass {
        let Self { surface: SurfaceCompliance { compliance, own, .. }, nodes } = self;
        let n = own.len();
        let mut pass = Pass::default();
        for (place, columns) in compliance.chunks_exact(4 * n).enumerate() {
            let old = nodes.at(place);
            let wanted = [0, 1].map(|c| old[c] - nodes.slip[c * n + place] / own[place]);
            let size = (wanted[0] * wanted[0] + wanted[1] * wanted[1]).sqrt();
            let most = nodes.most[place];
            let share = if size > most { most / size } else { 1.0 };
            let change = [0, 1].map(|c| share * wanted[c] - old[c]);
            pass.changed += (change[0] * change[0] + change[1] * change[1]).sqrt();
            pass.held += share * size;
            nodes.push(place, change, columns);
        }
        pass
    }
}

#[cfg(test)]
mod tests {
    use super::super::contact::tests::nodes;
    use super::*;

    /// Forces that cancel given slips, of sets that lose and win nodes while their normals turn.
    #[test]
    fn sticking_nodes_are_pushed_back_to_where_they_were() {
        let mut random = fastrand::Rng::with_seed(7);
        let (nodes, residual) = nodes(12, &mut random);
        let mut watch = Watch::none(12);
        watch.choose(&nodes, &(0..12).rev().collect::<Vec<_>>());
        let mut normal: Vec<Vector3<f64>> =
            (0..12).map(|_| Vector3::from_fn(|_, _| random.f64() - 0.5).normalize()).collect();
        let mut surface = SurfaceCompliance::default();
        for active in [&[0, 3, 5][..], &[0, 3, 5, 7], &[3, 7, 8, 11], &[3, 7, 8, 11]] {
            surface.follow(active, &normal, &mut watch, &nodes);
            let slip: Vec<Vector3<f64>> = active
                .iter()
                .map(|&i| {
                    let slip = Vector3::from_fn(|_, _| random.f64() - 0.5);
                    slip - normal[i].dot(&slip) * normal[i]
                })
                .collect();
            let place = |i: usize| active.iter().position(|&j| i == j).expect("active");
            let mut sliding = surface.sliding(|i| (Vector3::zeros(), slip[place(i)], f64::INFINITY));
            for _ in 0..2000 {
                surface.pass(&mut sliding);
            }
            let force: Vec<_> = surface.forces(&sliding).collect();
            for (&i, slip) in active.iter().zip(&slip) {
                let moved = Vector3::from_fn(|c, _| {
                    let row = &residual[(3 * i + c) * 36..][..36];
                    force.iter().map(|(j, f)| (0..3).map(|d| row[3 * j + d] * f[d]).sum::<f64>()).sum()
                });
                let left = slip + moved - normal[i].dot(&moved) * normal[i];
                assert!(left.norm() < 0.02 * slip.norm(), "{active:?}, {i}: {left}");
            }
            // less than makes a new compliance
            for normal in &mut normal {
                *normal = (*normal + 0.5 * TURN * Vector3::from_fn(|_, _| random.f64() - 0.5)).normalize();
            }
        }
    }
}
