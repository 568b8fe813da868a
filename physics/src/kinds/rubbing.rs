//! Bodies that strike obliquely or turn: their motion along the surfaces they touch, from the forces across them.

mod settled;

use crate::body::continuum::ModesAlong;
use crate::contact::{Hertz, Press, TangentialContact};
use crate::dynamics::StopReason;
use crate::dynamics::integration::{Integration, Options};
use crate::dynamics::sliding::{Slid, Sliding, Tilt, TurningBody};
use crate::dynamics::surface_modes::{MovingSurfaces, SurfaceMode};
use crate::dynamics::system::System;
use crate::error::{Error, Result};
use crate::kinds::impacts::SAMPLES_PER_CONTACT;
use crate::material::Material;
use crate::numerics::duhamel::Oscillator;
use crate::result::Sideways;
use crate::scene::{Inner, Outer, Plate, Shape, Turning};
use std::borrow::Cow;

/// Velocity across the surfaces by forces along them, over the speed, from which on there is a warning.
const NOTABLE_ACROSS: f64 = 0.01;
/// The same of velocities at a right angle to the direction in which friction is taken.
const NOTABLE_ASIDE: f64 = 0.01;
/// Growth of a contact's stiffness by friction from which on there is a warning where a model omits it.
const NOTABLE_STIFFENING: f64 = 1e-3;

/// Steps along the surfaces over those that seem enough, tried in turn until velocities have this error over the speed.
const FINER: [f64; 5] = [1.0, 2.0, 4.0, 8.0, 16.0];
const SETTLED: f64 = 5e-4;

/// Times in s, and how both contacts are pressed then.
type PressHistory<'a> = (&'a [f64], Cow<'a, [Vec<Press>; 2]>);

/// Law of a contact, and the materials of tip and face.
pub(super) type Touching = (Hertz, [Material; 2]);

/// What the outer body strikes, as far as that moves along its surface.
#[derive(Debug, Clone)]
pub(super) enum StruckSurface {
    /// The inner body.
    OtherBody,
    /// What moves in these modes; a wall in none.
    Moving(Vec<SurfaceMode>),
}

impl StruckSurface {
    /// Of a plate in `system`, struck at `offset` m from its centre, that moves `along` itself in more modes than those of the system.
    pub(super) fn plate(plate: &Plate, offset: f64, system: &System, along: &ModesAlong) -> Self {
        let mode = |(&omega, &along): (&f64, &[f64; 2])| SurfaceMode {
            oscillator: Oscillator { omega, alpha: plate.damping_ratio * omega },
            approach: [0.0; 2],
            along,
        };
        let mut further: Vec<SurfaceMode> = along.omega.iter().zip(&along.along).map(mode).collect();
        if plate.edge == crate::scene::Edge::Free {
            let (mass, arm) = (plate.mass(), 0.5 * plate.thickness);
            let inertia = mass * (0.25 * plate.radius.powi(2) + arm * arm / 3.0);
            let (push, turn) = (mass.sqrt().recip(), inertia.sqrt().recip());
            // along x, and about y: the outer face moves towards +x
            further.push(SurfaceMode::rigid([0.0; 2], [push; 2]));
            let along = [arm * turn, -arm * turn];
            further.push(SurfaceMode::rigid([-offset * turn, 0.0], along));
        }
        Self::elastic(further, system)
    }

    /// Of an elastic body in `system` with these `further` motions.
    pub(super) fn elastic(further: Vec<SurfaceMode>, system: &System) -> Self {
        Self::Moving(surface_modes(further, &system.along, system))
    }

    /// Whether it moves by itself.
    fn moves(&self) -> bool {
        matches!(self, Self::Moving(modes) if modes.iter().any(|mode| mode.along != [0.0; 2]))
    }

    /// Whether elastic modes move it along itself.
    pub(super) fn vibrates(&self) -> bool {
        matches!(self, Self::Moving(modes) if modes.iter().any(|mode| mode.oscillator.omega > 0.0))
    }
}

/// `further` motions and the elastic modes of `system`, which move the surfaces at both contacts by `along` per unit.
pub(super) fn surface_modes(
    further: Vec<SurfaceMode>,
    along: &[[f64; 2]],
    system: &System,
) -> Vec<SurfaceMode> {
    let elastic = along.iter().zip(system.elastic()).map(|(along, k)| SurfaceMode {
        oscillator: system.oscillators[k],
        approach: [system.approach[0][k], system.approach[1][k]],
        along: *along,
    });
    further.into_iter().chain(elastic).collect()
}

/// Bodies, and what they touch.
#[derive(Debug, Clone)]
pub(super) struct Rubbing {
    pub(super) outer: Outer,
    pub(super) inner: Option<Inner>,
    pub(super) struck: StruckSurface,
    /// See [`Tilt`]; known of plates.
    pub(super) tilt: Option<Tilt>,
    /// Modes that move its surfaces at a right angle to the x direction, which are left out; none of a plate or a wall.
    pub(super) aside: Vec<SurfaceMode>,
    pub(super) contacts: [Touching; 2],
}

/// Motion along the surfaces, and the energy that friction took.
pub(super) struct Rubbed {
    pub(super) sideways: Sideways,
    /// In both contacts, J; `None` without friction.
    pub(super) dissipated: Option<[f64; 2]>,
    /// See [`Slid::across`], over the speed of the outer body across what it strikes.
    across: f64,
    /// See [`Settled`](crate::dynamics::integration::Settled); `None` where the models omit it.
    unsettled: Option<f64>,
    /// See [`Slid::error`].
    error: f64,
    /// Largest speed of the struck surfaces at a right angle to x, where there is friction, over that of the outer body.
    aside: f64,
}

impl Rubbed {
    /// What the user has to know of the motion across the surfaces that friction causes.
    pub(super) fn warnings(&self) -> Vec<String> {
        let across = (self.across > NOTABLE_ACROSS && self.unsettled.is_none()).then(|| {
            format!(
                "friction bends or turns what is struck, which the model omits: forces and efficiency may be wrong by about {:.1} % (normal velocity that friction gives the contacts, over that of the outer body)",
                100.0 * self.across
            )
        });
        let unsettled = self.unsettled.filter(|error| *error > settled::SETTLED).map(|error| {
            format!(
                "friction bends or turns what is struck, and the normal and tangential forces have not converged: velocities and force peaks are uncertain by {error:.0e}"
            )
        });
        let error = (self.error > SETTLED).then(|| {
            format!(
                "tangential velocities are uncertain by {:.0e} of the speed: high-frequency modes of what is struck are not resolved",
                self.error
            )
        });
        let aside = (self.aside > NOTABLE_ASIDE).then(|| {
            format!(
                "the surfaces of the body also move perpendicular to x, at up to {:.1} % of the speed; the model omits friction in that direction: rotate the body about z so that they move along x",
                100.0 * self.aside
            )
        });
        across.into_iter().chain(unsettled).chain(error).chain(aside).collect()
    }

    /// Energy that friction dissipates, J; `None` without friction.
    pub(super) fn friction_work(&self) -> Option<f64> {
        self.dissipated.map(|dissipated| dissipated.iter().sum())
    }
}

/// The body of this `shape` where it touches; `None` of one that does not turn freely or whose inertia is not known.
fn turning_body(shape: &Shape, material: &Material, turning: &Turning) -> Option<TurningBody> {
    let (mass, arm) = (shape.mass(material), shape.tip_radius());
    let inertia = match shape {
        Shape::Sphere { radius } => 0.4 * mass * radius * radius,
        Shape::Compact { .. } => turning.moment_of_inertia?,
        Shape::Bender(_) | Shape::Stack(_) => return None,
    };
    Some(TurningBody { mass, inertia, arm })
}

/// Whether bodies move along the surfaces they meet, or turn.
pub(super) fn moves_along(outer: &Outer, inner: Option<&Inner>) -> bool {
    let rubs = outer.turning.friction > 0.0 || inner.is_some_and(|inner| inner.turning.friction > 0.0);
    let spins = outer.turning.spin != 0.0 || inner.is_some_and(|inner| inner.turning.spin != 0.0);
    // off-centre a plate's normal turns
    outer.angle != 0.0 || spins || outer.offset != 0.0 && rubs
}

/// Coefficients of friction of both contacts.
fn frictions(outer: &Outer, inner: Option<&Inner>) -> [f64; 2] {
    [outer.turning.friction, inner.map_or(0.0, |inner| inner.turning.friction)]
}

/// A sentence where friction makes the `contacts` of unlike materials stiffer, for a model that omits that.
pub(super) fn omitted_stiffening(
    contacts: [Touching; 2],
    outer: &Outer,
    inner: Option<&Inner>,
) -> Option<String> {
    let growth = contacts.into_iter().zip(frictions(outer, inner)).map(|((law, [tip, face]), friction)| {
        let smooth = Hertz::new(law.tip_radius, &tip, &face);
        smooth.with_friction(&tip, &face, friction).stiffness / smooth.stiffness - 1.0
    });
    let most = growth.fold(0.0, f64::max);
    (most > NOTABLE_STIFFENING).then(|| {
        format!("friction makes the contacts stiffer by up to {:.1} %, which the model omits", 100.0 * most)
    })
}

/// Whether friction's effect on the motion across the surfaces is known to `enough`, or as well as it ever is.
pub(super) fn is_settled(result: &Integration, enough: f64) -> bool {
    result.friction.as_ref().is_none_or(|friction| friction.error <= enough.max(settled::SETTLED))
}

/// Whether bodies that move along the surfaces they meet rub on them.
pub(super) fn rubs_along(outer: &Outer, inner: Option<&Inner>) -> bool {
    moves_along(outer, inner) && frictions(outer, inner).iter().any(|friction| *friction > 0.0)
}

impl Rubbing {
    fn frictions(&self) -> [f64; 2] {
        frictions(&self.outer, self.inner.as_ref())
    }

    fn has_friction(&self) -> bool {
        self.frictions().iter().any(|friction| *friction > 0.0)
    }

    /// Whether forces act along the surfaces.
    fn is_pushed(&self) -> bool {
        self.has_friction() || self.tilt.is_some() && self.struck.moves()
    }

    /// `options` that keep the contact forces of `system` as well, where forces act along the surfaces.
    pub(super) fn keeping_forces(&self, system: &System, options: &Options) -> Options {
        if !self.is_pushed() {
            return *options;
        }
        let interval = system.hertz_impact().duration() / SAMPLES_PER_CONTACT;
        let forces_alone = options.sample_interval.is_none();
        let sample_interval = options.sample_interval.or(Some(interval));
        Options { sample_interval, forces_alone, presses: true, ..*options }
    }

    /// What they do under the contact forces that `result` has as its history; `None` of a run that was cut.
    ///
    /// # Errors
    /// [`Error::Internal`] without that history.
    pub(super) fn solve(&self, result: &Integration) -> Result<Option<Rubbed>> {
        if result.stop == StopReason::Cut {
            return Ok(None);
        }
        let inner = self.inner.as_ref();
        let spins = [self.outer.turning.spin, inner.map_or(0.0, |inner| inner.turning.spin)];
        let along = self.outer.speed * self.outer.angle.sin();
        let slid = match &result.friction {
            _ if !self.is_pushed() => Slid::default(),
            Some(friction) => friction.slid.clone(),
            None => self.slide(result)?,
        };
        let [at_outer, at_inner] = slid.impulse;
        let [outer, inner] = self.turning_bodies();
        // impulse along x on the inner body's upper side
        let pushed = match self.struck {
            StruckSurface::OtherBody => at_outer,
            _ => 0.0 - at_inner,
        };
        let per_mass = |body: Option<TurningBody>| body.map_or(0.0, |body| 1.0 / body.mass);
        let [tilted_outer, tilted_inner] = slid.tilted;
        let per_inertia = |body: Option<TurningBody>| body.map_or(0.0, |body| body.arm / body.inertia);
        Ok(Some(Rubbed {
            sideways: Sideways {
                outer_tangential_velocity_final: along + (tilted_outer - at_outer) * per_mass(outer),
                inner_tangential_velocity_final: self
                    .inner
                    .as_ref()
                    .map(|_| (pushed + tilted_inner) * per_mass(inner)),
                outer_spin_final: spins[0] + at_outer * per_inertia(outer),
                inner_spin_final: self.inner.as_ref().map(|_| spins[1] + pushed * per_inertia(inner)),
            },
            dissipated: self.has_friction().then_some(slid.dissipated),
            across: slid.across / self.outer.normal_speed(),
            unsettled: result.friction.as_ref().map(|friction| friction.error),
            error: slid.error,
            aside: self.speed_aside(result)? / self.outer.speed,
        }))
    }

    fn turning_bodies(&self) -> [Option<TurningBody>; 2] {
        let of_inner = |inner: &Inner| turning_body(&inner.shape, &inner.material, &inner.turning);
        let Outer { shape, material, turning, .. } = &self.outer;
        [turning_body(shape, material, turning), self.inner.as_ref().and_then(of_inner)]
    }

    /// What friction does under the contact forces that `result` has as its history, with an estimate of its error.
    fn slide(&self, result: &Integration) -> Result<Slid> {
        if !self.struck.moves() {
            return self.slide_in_steps(result, 1.0);
        }
        let mobility = self.mobilities();
        // quick modes are not resolved: whether that matters shows in twice as many steps
        let mut coarse = self.slide_in_steps(result, 0.5)?;
        for finer in FINER {
            let fine = self.slide_in_steps(result, finer)?;
            let change = |i: usize| {
                let tilted =
                    self.tilt.map_or(0.0, |tilt| (fine.tilted[i] - coarse.tilted[i]) / tilt.masses[i]);
                (mobility[i] * (fine.impulse[i] - coarse.impulse[i]).abs() + tilted.abs()) / self.outer.speed
            };
            let error = change(0).max(change(1)) / 3.0;
            coarse = Slid { error, ..fine };
            if error <= SETTLED {
                break;
            }
        }
        Ok(coarse)
    }

    /// Relative acceleration of the bodies' surfaces at each contact per force along it, 1/kg.
    fn mobilities(&self) -> [f64; 2] {
        let [first, second] = self.turning_bodies().map(|body| body.map_or(0.0, |body| body.mobility()));
        match self.struck {
            StruckSurface::OtherBody => [first + second, 0.0],
            StruckSurface::Moving(_) => [first, second],
        }
    }

    /// The same in `finer` times as many steps as seem enough.
    fn slide_in_steps(&self, result: &Integration, finer: f64) -> Result<Slid> {
        let (time, presses) = self.presses(result)?;
        let arms = self.turning_bodies().map(|body| body.map_or(0.0, |body| body.arm));
        let along = self.outer.speed * self.outer.angle.sin();
        let spins = [self.outer.turning.spin, self.inner.as_ref().map_or(0.0, |inner| inner.turning.spin)];
        let surfaces = [along - spins[0] * arms[0], spins[1] * arms[1]];
        let (velocity, modes) = match &self.struck {
            StruckSurface::OtherBody => ([surfaces[0] - surfaces[1], 0.0], &[][..]),
            StruckSurface::Moving(modes) => (surfaces, &modes[..]),
        };
        let frictions = self.frictions();
        let contact = |i: usize| {
            let (_, [tip, face]) = &self.contacts[i];
            let widest = presses[i].iter().map(|press| press.radius).fold(0.0, f64::max);
            // surfaces that do not move along each other stay so, unless a plate between moves them
            let moves = velocity[i] != 0.0 || !modes.is_empty();
            let rubs = frictions[i] > 0.0 && moves && widest > 0.0;
            rubs.then(|| TangentialContact::new([tip, face], frictions[i], widest))
        };
        let contacts = [contact(0), contact(1)];
        let (mobility, tilt) = (self.mobilities(), self.tilt);
        let sliding = Sliding { contacts, mobility, modes, velocity, centres: [along, 0.0], tilt };
        Ok(sliding.slide(time, &presses, finer))
    }

    /// Largest speed in m/s at which what is struck moves its rubbing surfaces at a right angle to x.
    fn speed_aside(&self, result: &Integration) -> Result<f64> {
        if self.aside.is_empty() || !self.has_friction() {
            return Ok(0.0);
        }
        let (time, presses) = self.presses(result)?;
        let mut surfaces = MovingSurfaces::new(&self.aside);
        let mut most = 0.0_f64;
        for k in 1..time.len() {
            let [from, to] = [k - 1, k].map(|k| [presses[0][k].force, presses[1][k].force]);
            let length = time[k] - time[k - 1];
            surfaces.prepare(length);
            let moved = surfaces.press(from, to);
            // a surface that nothing presses does not rub
            let rubs = |i: usize| self.frictions()[i] > 0.0 && to[i] > 0.0;
            most = (0..2).filter(|i| rubs(*i)).map(|i| moved[i].abs() / length).fold(most, f64::max);
        }
        Ok(most)
    }

    /// Times in s, and how both contacts are pressed then.
    fn presses<'b>(&self, result: &'b Integration) -> Result<PressHistory<'b>> {
        let history = result.history.as_ref();
        let history = history.ok_or_else(|| Error::Internal("the forces were not kept".into()))?;
        let forces = ["outer_force", "inner_force"].map(|name| history.curve(name));
        let presses = match (&result.presses, forces) {
            (Some(presses), _) => Cow::Borrowed(presses),
            (None, [Some(outer), Some(inner)]) => Cow::Owned([(0, outer), (1, inner)].map(|(i, forces)| {
                forces.iter().map(|force| self.contacts[i].0.press(force.max(0.0))).collect()
            })),
            _ => return Err(Error::Internal("the history has no contact forces".into())),
        };
        Ok((&history.time, presses))
    }
}
