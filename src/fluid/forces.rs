//! Forces of the fluid on the coordinates of a wet impact.

use super::deflection::PlateProfile;
use super::film::{CELLS, Film, FilmForces};
use super::{Deflection, Drag, Viscosity};
use crate::impact::system::{INNER, PLATE};
use crate::scene::{Fluid, Inner, Plate};

/// Film and drag, of which at least one is there, on the inner body and the modes of the plate.
#[derive(Debug, Clone, PartialEq)]
pub struct FluidForces {
    film: Option<(Film, Deflection)>,
    drag: Option<Drag>,
    /// Initial gap in m and 1/sqrt(mass) of the inner body.
    inner: (f64, f64),
}

/// What the fluid does at one instant. Coordinates are the inner body's and then the plate's: n = 1 + modes.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FluidLoad {
    /// Generalised forces. Shape (n).
    pub force: Vec<f64>,
    /// Generalised forces of the film per uniform closing speed of 1 m/s, N s/m kg^(-1/2). Shape (n).
    pub unit_force: Vec<f64>,
    /// Resistance of the film against a uniform closing speed, N s/m; 0 without a film.
    pub resistance: f64,
    /// Force of the film, positive where it pushes the bodies apart, N.
    pub film_force: f64,
    /// Force of the drag on the inner body along z, N.
    pub drag_force: f64,
    /// Power dissipated in the film, and by the drag, W.
    pub dissipation: [f64; 2],
    film: FilmForces,
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
        Ok(there.then(|| Self { film, drag, inner: (inner.gap, 1.0 / mass.sqrt()) }))
    }

    /// Number of coordinates the fluid acts on, counted from that of the inner body.
    pub fn size(&self) -> usize {
        1 + self.film.as_ref().map_or(0, |(_, deflection)| deflection.modes())
    }

    /// The forces in the state (`q`, `v`) of the coordinates of a [`System`](crate::impact::system::System).
    pub fn evaluate(&self, q: &[f64], v: &[f64], load: &mut FluidLoad) {
        const { assert!(PLATE == INNER + 1) };
        let size = self.size();
        let (q, v) = (&q[INNER..INNER + size], &v[INNER..INNER + size]);
        for forces in [&mut load.force, &mut load.unit_force] {
            forces.clear();
            forces.resize(size, 0.0);
        }
        (load.resistance, load.film_force, load.drag_force, load.dissipation) = (0.0, 0.0, 0.0, [0.0; 2]);
        let (gap, per_mass) = self.inner;
        if let Some((film, deflection)) = &self.film {
            let plate = [deflection.sum(&q[1..]), deflection.sum(&v[1..])];
            let profile = PlateProfile {
                deflection,
                plate: [&plate[0], &plate[1]],
                distance: [gap - per_mass * q[0], -per_mass * v[0]],
            };
            film.solve(&profile, &mut load.film);
            let solved = &load.film;
            for (forces, loads, sum) in [
                (&mut load.force, &solved.load, solved.force),
                (&mut load.unit_force, &solved.unit_load, solved.resistance),
            ] {
                forces[0] = -per_mass * sum;
                deflection.generalised(&solved.radius, loads, &mut forces[1..]);
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
}
