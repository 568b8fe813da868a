//! Forces of the fluid on the coordinates of a wet impact.

use crate::dynamics::system::{INNER, PLATE};
use crate::fluid::deflection::PlateProfile;
use crate::fluid::film::{CELLS, Film, FilmForces, Neck, Overlap};
use crate::fluid::{Deflection, Drag, Indentation, Viscosity};
use crate::scene::{Fluid, Inner, Plate};

/// Film and drag, of which at least one is there, on the inner body and the modes of the plate.
#[derive(Debug, Clone, PartialEq)]
pub struct FluidForces {
    film: Option<(Film, Deflection)>,
    drag: Option<Drag>,
    /// 1/sqrt(mass) of the inner body.
    per_mass: f64,
}

/// What the fluid does at one instant. Coordinates are the inner body's and then the plate's: n = 1 + modes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FluidLoad {
    /// Generalised forces. Shape (n).
    pub force: Vec<f64>,
    /// Generalised forces of the film per closing speed of the bodies of 1 m/s, N s/m kg^(-1/2). Shape (n).
    pub unit_force: Vec<f64>,
    /// Resistance of the film against a closing speed of the bodies, N s/m; 0 without a film.
    pub resistance: f64,
    /// Force of the film, positive where it pushes the bodies apart, N.
    pub film_force: f64,
    /// Force of the drag on the inner body along z, N.
    pub drag_force: f64,
    /// Power dissipated in the film, and by the drag, W.
    pub dissipation: [f64; 2],
    film: FilmForces,
}

impl FluidLoad {
    /// Overlap of plate and inner body off the axis, where the model has no contact: lubrication does not apply there.
    pub fn overlap(&self) -> Option<Overlap> {
        self.film.overlap
    }

    /// Where the film narrows most towards its edge.
    pub fn neck(&self) -> Option<Neck> {
        self.film.neck()
    }
}

impl FluidForces {
    /// The radius in m at which the film ends: that of the plate or of the tip.
    pub fn rim(plate: &Plate, inner: &Inner) -> f64 {
        plate.radius.min(inner.shape.tip_radius())
    }

    /// Film (if the scene has one) and drag; `None` if neither is there. `shapes` gives the mass-normalised shapes
    /// of the wet plate's inner face, shape (modes, radii), at the radii in m.
    ///
    /// # Errors
    /// Those of `shapes`.
    pub fn new<E>(
        fluid: &Fluid,
        plate: &Plate,
        inner: &Inner,
        shapes: impl FnOnce(&[f64]) -> Result<Vec<Vec<f64>>, E>,
    ) -> Result<Option<Self>, E> {
        Self::with_cells(fluid, plate, inner, CELLS, shapes)
    }

    /// As [`FluidForces::new`] with `cells` cells of the film.
    ///
    /// # Errors
    /// Those of `shapes`.
    pub fn with_cells<E>(
        fluid: &Fluid,
        plate: &Plate,
        inner: &Inner,
        cells: usize,
        shapes: impl FnOnce(&[f64]) -> Result<Vec<Vec<f64>>, E>,
    ) -> Result<Option<Self>, E> {
        let film = if fluid.squeeze_film {
            let rim = Self::rim(plate, inner);
            let (viscosity, tip) = (Viscosity::new(fluid), inner.shape.tip_radius());
            let deflection = Deflection::new(rim, &shapes(&Deflection::radii(rim))?);
            Some((Film::new(viscosity, fluid.minimum_gap, tip, rim, cells), deflection))
        } else {
            None
        };
        let drag = Drag::new(fluid, inner);
        let mass = inner.shape.mass(&inner.material);
        let there = film.is_some() || drag.is_some();
        Ok(there.then(|| Self { film, drag, per_mass: 1.0 / mass.sqrt() }))
    }

    /// Number of coordinates the fluid acts on, counted from that of the inner body.
    pub fn size(&self) -> usize {
        1 + self.film.as_ref().map_or(0, |(_, deflection)| deflection.modes())
    }

    /// Minimal gap of the film in m; no gap is smaller than that of no film.
    pub(super) fn minimum_gap(&self) -> f64 {
        self.film.as_ref().map_or(f64::INFINITY, |(film, _)| film.minimum_gap())
    }

    /// The forces in the state (`q`, `v`) of the coordinates of a [`System`](crate::dynamics::system::System), where the inner
    /// body's contact has the `indentation`.
    pub fn evaluate(&self, q: &[f64], v: &[f64], indentation: Indentation, load: &mut FluidLoad) {
        const { assert!(PLATE == INNER + 1) };
        let size = self.size();
        let (q, v) = (&q[INNER..INNER + size], &v[INNER..INNER + size]);
        for forces in [&mut load.force, &mut load.unit_force] {
            forces.clear();
            forces.resize(size, 0.0);
        }
        (load.resistance, load.film_force, load.drag_force, load.dissipation) = (0.0, 0.0, 0.0, [0.0; 2]);
        let per_mass = self.per_mass;
        if let Some((film, deflection)) = &self.film {
            let plate = [deflection.sum(&q[1..]), deflection.sum(&v[1..])];
            let profile = PlateProfile::new(deflection, [&plate[0], &plate[1]], per_mass * v[0], indentation);
            film.solve(&profile, &mut load.film);
            let solved = &load.film;
            for (forces, loads, sum, relief) in [
                (&mut load.force, &solved.load, solved.force, solved.relief[0]),
                (&mut load.unit_force, &solved.unit_load, solved.resistance, solved.relief[1]),
            ] {
                forces[0] = -per_mass * sum;
                let loads = solved.faces.iter().zip(loads).map(|(face, load)| (face.ring.radius(), *load));
                deflection.generalised(loads.chain([(0.0, -relief)]), &mut forces[1..]);
            }
            (load.film_force, load.resistance) = (solved.force, solved.resistance);
            load.dissipation[0] = solved.dissipation;
        }
        if let Some(drag) = &self.drag {
            let velocity = per_mass * v[0];
            load.drag_force = drag.force(velocity);
            load.force[0] += per_mass * load.drag_force;
            load.dissipation[1] = -load.drag_force * velocity;
        }
    }

    /// How the forces change with the motion, in the state with velocities `v` that `load` was evaluated in.
    pub fn tangent(&self, v: &[f64], load: &FluidLoad) -> Tangent {
        let n = self.size();
        let per_mass = self.per_mass;
        let mut tangent = Tangent { size: n, per_rate: vec![0.0; n * n], per_place: vec![0.0; n * n] };
        if let Some((_, deflection)) = &self.film {
            // flow through a face per rate of each coordinate, and the gap there per coordinate
            let (mut flow, mut gap, mut shapes) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
            let centre = deflection.shapes_on_axis();
            let at = |radius: f64, closing: f64, values: &mut [f64]| {
                values[0] = -per_mass * closing;
                deflection.shapes_at(radius, &mut values[1..]);
                for (value, centre) in values[1..].iter_mut().zip(centre) {
                    *value -= (1.0 - closing) * centre;
                }
            };
            for face in &load.film.faces {
                at(face.ring.radius(), face.closing, &mut shapes);
                flow.iter_mut().zip(&shapes).for_each(|(flow, shape)| *flow -= face.ring.area() * shape);
                // the growth of the patch is omitted
                at(face.radius, face.closing, &mut gap);
                let rows = tangent.per_rate.chunks_exact_mut(n).zip(tangent.per_place.chunks_exact_mut(n));
                for ((per_rate, per_place), own) in rows.zip(&flow) {
                    // a fall of the pressure loads everything inside of the face
                    let (per_flow, per_gap) = (-own * face.per_flow, -own * face.per_gap);
                    per_rate.iter_mut().zip(&flow).for_each(|(entry, flow)| *entry += per_flow * flow);
                    per_place.iter_mut().zip(&gap).for_each(|(entry, gap)| *entry += per_gap * gap);
                }
            }
        }
        if let Some(drag) = &self.drag {
            tangent.per_rate[0] -= per_mass * per_mass * drag.damping(per_mass * v[INNER]);
        }
        tangent
    }
}

/// Changes of the fluid's generalised forces with rates and places of the coordinates, the cells of the film where they are.
#[derive(Debug, Clone, PartialEq)]
pub struct Tangent {
    /// Number n of the coordinates.
    pub size: usize,
    /// Force k per rate of coordinate l, 1/s. Shape (n, n).
    pub per_rate: Vec<f64>,
    /// Force k per coordinate l, 1/s^2. Shape (n, n).
    pub per_place: Vec<f64>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::ShearThinning;
    use approx::assert_relative_eq;

    /// Against differences of the forces themselves; what the motion of the cells adds is small. In contact that of the patch adds much to
    /// what the places change.
    #[test]
    fn the_forces_dissipate_what_they_take_and_the_tangent_is_their_derivative() {
        let law = ShearThinning { infinite_shear_viscosity: 1e-4, relaxation_time: 1e-3, power_index: 0.5 };
        for (shear_thinning, gap) in [(None, 2e-5_f64), (Some(law), 2e-5), (None, 0.0)] {
            let fluid = Fluid {
                viscosity: 0.02,
                density: 900.0,
                minimum_gap: 1e-6,
                squeeze_film: true,
                added_mass_frequency_ratio: 1.0,
                plate_damping_ratio: 0.0,
                drag_coefficient: 0.5,
                shear_thinning,
            };
            let shape = |r: f64| [40.0 * (1.0 - (r / 4e-3).powi(2)), 30.0 * (800.0 * r).cos()];
            let deflection = |radii: &[f64]| {
                (0..2).map(|k| radii.iter().map(|r| shape(*r)[k]).collect()).collect::<Vec<Vec<f64>>>()
            };
            let rim = 3e-3;
            let film = Film::new(Viscosity::new(&fluid), fluid.minimum_gap, 5e-3, rim, CELLS);
            let forces = FluidForces {
                film: Some((film, Deflection::new(rim, &deflection(&Deflection::radii(rim))))),
                drag: Some(Drag { coefficient: 1e-4 }),
                per_mass: 1.0 / 3e-3f64.sqrt(),
            };
            let (q, v) = ([0.0, 2e-7, 3e-8, -2e-8], [0.0, 0.02, 3e-3, -1e-3]);
            let at = |q: &[f64], v: &[f64]| {
                let approach = forces.per_mass * q[1] - 40.0 * q[2] - 30.0 * q[3];
                let indentation = Indentation::new(approach - gap, 1.0, 5e-3);
                let mut load = FluidLoad::default();
                forces.evaluate(q, v, indentation, &mut load);
                load
            };
            let load = at(&q, &v);
            // what relieves the contact is taken from the plate's modes and the body alike
            let taken: f64 = load.force.iter().zip(&v[INNER..]).map(|(force, v)| -force * v).sum();
            assert_relative_eq!(taken, load.dissipation[0] + load.dissipation[1], max_relative = 1e-11);
            let tangent = forces.tangent(&v, &load);
            let size = |values: &[f64]| values.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
            for l in 0..3 {
                let both = [(&tangent.per_rate, false, v, 1e-6), (&tangent.per_place, true, q, 1e-11)];
                for (per, places, values, step) in both.into_iter().take(if gap > 0.0 { 2 } else { 1 }) {
                    let moved = |by: f64| {
                        let mut values = values;
                        values[INNER + l] += by;
                        if places { at(&values, &v) } else { at(&q, &values) }.force
                    };
                    let (above, below) = (moved(step), moved(-step));
                    for k in 0..3 {
                        let difference = (above[k] - below[k]) / (2.0 * step);
                        assert_relative_eq!(
                            per[k * 3 + l],
                            difference,
                            epsilon = 1e-2 * size(per),
                            max_relative = 1e-2
                        );
                    }
                }
            }
        }
    }
}
