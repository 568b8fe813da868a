//! Deflection of the plate's inner face under the film: mode shapes on equal steps of r, cubic between them.

use super::Indentation;
use super::film::{Profile, Ring};

/// Steps of the table from the axis to the edge of the film; the highest modes of a thin plate have some 5 waves
/// on this length.
pub const STEPS: usize = 64;

/// Mode shapes of the plate's inner face from the axis to the edge of the film.
#[derive(Debug, Clone, PartialEq)]
pub struct Deflection {
    per_step: f64,
    /// Shapes at r = -step, 0, step, ... , rim, rim + step, kg^(-1/2). Shape (modes, STEPS + 3).
    shapes: Vec<Vec<f64>>,
    /// The same, one radius after the other. Shape (STEPS + 3, modes).
    by_radius: Vec<f64>,
}

impl Deflection {
    /// The radii in m at which the shapes are needed for a film that ends at `rim`. Shape (STEPS + 1).
    pub fn radii(rim: f64) -> Vec<f64> {
        (0..=STEPS).map(|i| rim * i as f64 / STEPS as f64).collect()
    }

    /// From the mass-normalised `shapes` (modes, STEPS + 1) at [`Deflection::radii`] of `rim`.
    pub fn new(rim: f64, shapes: &[Vec<f64>]) -> Self {
        let extended = |shape: &Vec<f64>| {
            debug_assert_eq!(shape.len(), STEPS + 1);
            // mirrored at the axis, a parabola on at the edge
            let mut extended = vec![shape[1]];
            extended.extend(shape);
            extended.push(3.0 * (shape[STEPS] - shape[STEPS - 1]) + shape[STEPS - 2]);
            extended
        };
        let shapes: Vec<Vec<f64>> = shapes.iter().map(extended).collect();
        let by_radius = (0..STEPS + 3).flat_map(|i| shapes.iter().map(move |shape| shape[i])).collect();
        Self { per_step: STEPS as f64 / rim, shapes, by_radius }
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.shapes.len()
    }

    /// Every shape times its amplitude, on the table. Shape (STEPS + 3).
    pub fn sum(&self, amplitudes: &[f64]) -> Vec<f64> {
        let mut sum = vec![0.0; STEPS + 3];
        for (shape, amplitude) in self.shapes.iter().zip(amplitudes) {
            for (sum, value) in sum.iter_mut().zip(shape) {
                *sum += amplitude * value;
            }
        }
        sum
    }

    /// First index and weights of the four entries of a table that give its value at `r` (Catmull & Rom).
    fn stencil(&self, r: f64) -> (usize, [f64; 4]) {
        let position = r * self.per_step;
        let index = (position as usize).min(STEPS - 1);
        let t = position - index as f64;
        let weights = [
            0.5 * t * (t * (2.0 - t) - 1.0),
            0.5 * (t * t * (3.0 * t - 5.0) + 2.0),
            0.5 * t * (t * (4.0 - 3.0 * t) + 1.0),
            0.5 * t * t * (t - 1.0),
        ];
        (index, weights)
    }

    /// Value at `r` of a table.
    pub fn value(&self, table: &[f64], r: f64) -> f64 {
        let (index, weights) = self.stencil(r);
        weights.iter().zip(&table[index..index + 4]).map(|(w, value)| w * value).sum()
    }

    /// Value at `r` of every shape. Shape (modes).
    pub fn shapes_at(&self, r: f64, values: &mut [f64]) {
        let (index, weights) = self.stencil(r);
        values.fill(0.0);
        let rows = self.by_radius.chunks_exact(self.modes()).skip(index);
        for (weight, row) in weights.into_iter().zip(rows) {
            values.iter_mut().zip(row).for_each(|(value, shape)| *value += weight * shape);
        }
    }

    /// Value on the axis of every shape. Shape (modes).
    pub fn shapes_on_axis(&self) -> &[f64] {
        let modes = self.modes();
        &self.by_radius[modes..2 * modes]
    }

    /// Adds `loads`, radii in m and forces in N, as generalised forces on the modes, N kg^(-1/2). It is the transpose
    /// of [`Deflection::sum`] and [`Deflection::value`]: loads and motions give the same power on either side.
    pub fn generalised(&self, loads: impl Iterator<Item = (f64, f64)>, forces: &mut [f64]) {
        let mut table = [0.0; STEPS + 3];
        for (r, load) in loads {
            let (index, weights) = self.stencil(r);
            for (entry, weight) in table[index..].iter_mut().zip(weights) {
                *entry += weight * load;
            }
        }
        for (load, shapes) in table.iter().zip(self.by_radius.chunks_exact(self.modes())) {
            for (force, shape) in forces.iter_mut().zip(shapes) {
                *force += load * shape;
            }
        }
    }
}

/// Gap between the deflected plate and the inner body around their contact.
pub struct PlateProfile<'a> {
    deflection: &'a Deflection,
    /// Deflection of the plate and its rate, as [`Deflection::sum`] gives them, in m and m/s.
    plate: [&'a [f64]; 2],
    /// Rate in m/s at which the bodies part on the axis.
    parting: f64,
    /// The plate's deflection and rate on the axis.
    centre: [f64; 2],
    indentation: Indentation,
}

impl<'a> PlateProfile<'a> {
    /// Of a `plate` with a deflection and a rate as [`Deflection::sum`] gives them, in m and m/s, and an inner body of `velocity` m/s
    /// towards it.
    pub fn new(
        deflection: &'a Deflection,
        plate: [&'a [f64]; 2],
        velocity: f64,
        indentation: Indentation,
    ) -> Self {
        let centre = plate.map(|table| deflection.value(table, 0.0));
        Self { deflection, plate, parting: centre[1] - velocity, centre, indentation }
    }
}

impl Profile for PlateProfile<'_> {
    fn gap(&self, r: f64) -> f64 {
        self.indentation.gap(r) + self.deflection.value(self.plate[0], r) - self.centre[0]
    }

    fn rate(&self, ring: Ring, closing: f64) -> f64 {
        let plate = self.deflection.value(self.plate[1], ring.radius());
        closing * self.parting + plate - self.centre[1]
    }

    fn patch(&self) -> f64 {
        self.indentation.square()
    }

    fn closing(&self, ring: Ring) -> f64 {
        self.indentation.closing(ring)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn values_between_the_steps_and_their_transpose() {
        let rim = 2e-3;
        let shape = |r: f64| (3.0 * r / rim).cos();
        let shapes = [Deflection::radii(rim).into_iter().map(shape).collect(), vec![1.0; STEPS + 1]];
        let deflection = Deflection::new(rim, &shapes);
        let table = deflection.sum(&[2.0, 0.5]);
        let radius = [0.0, 1e-9, 0.31e-3, 1.234e-3, 1.999e-3, rim];
        for r in radius {
            assert_relative_eq!(deflection.value(&table, r), 2.0 * shape(r) + 0.5, max_relative = 1e-5);
        }
        let loads = [1.0, -2.0, 3.0, 0.5, 0.1, 7.0];
        let mut forces = [0.0; 2];
        deflection.generalised(radius.into_iter().zip(loads), &mut forces);
        let power: f64 = radius.iter().zip(loads).map(|(r, p)| p * deflection.value(&table, *r)).sum();
        assert_relative_eq!(2.0 * forces[0] + 0.5 * forces[1], power, max_relative = 1e-12);
    }
}
