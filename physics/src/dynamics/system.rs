//! The bodies of an impact as one set of oscillators coupled by two contacts.
//!
//! Every body is a set of mass-normalised coordinates q_k: the rigid spheres (omega = 0), the modes
//! of the plate, those of a bender. The approach of contact i is delta_i = sum_k b_ik q_k - gap_i, less what the
//! residual flexibility yields, and
//! its force acts back as q_k'' + 2 alpha_k q_k' + omega_k^2 q_k = -sum_i b_ik F_i.
//! Contact 0 joins outer body and plate, contact 1 plate and inner body.

use super::centre::LocalCentre;
use super::moving_body::MovingBody;
use super::tangential_load::TangentialLoad;
use crate::actuator::Stack;
use crate::actuator::circuit::{Account, Circuit};
use crate::analytical::hertz::HertzImpact;
use crate::body::ModalBody;
use crate::contact::{Hertz, PatchFlexibility, Residual};
use crate::fluid::Indentation;
use crate::material::Material;
use crate::numerics::duhamel::{Feed, Oscillator};
use crate::result::Drive;
use std::borrow::Cow;
use std::ops::Range;

/// Index of the outer body's first coordinate among the oscillators: the rigid motion, or a bender's first mode. Further
/// ones stand behind those of the plate.
pub const OUTER: usize = 0;
/// Index of the inner body's first coordinate, as the outer one's.
pub const INNER: usize = 1;
/// Index of the first coordinate of the plate.
pub const PLATE: usize = 2;

/// One coordinate of a system: what [`System`] has a row each of.
struct Coordinate {
    oscillator: Oscillator,
    approach: [f64; 2],
    centre: f64,
    bodies: [f64; 2],
    start: [f64; 2],
}

impl Coordinate {
    /// Coordinate `k` of body `i`: the outer one closes its contact as it moves down, the inner one as it moves up.
    fn of_body(bodies: &[MovingBody; 2], i: usize, k: usize) -> Self {
        let body = &bodies[i];
        let alone = |value: f64| std::array::from_fn(|j| if i == j { value } else { 0.0 });
        Self {
            oscillator: body.oscillators[k],
            approach: alone([-body.tip[k], body.tip[k]][i]),
            centre: 0.0,
            bodies: alone(body.tip[k]),
            start: [body.displacement[k], body.velocity[k]],
        }
    }

    /// Mode `k` of the plate.
    fn of_plate(plate: &ModalBody, k: usize) -> Self {
        let (omega, [top, bottom]) = (plate.omega[k], plate.participation[k]);
        Self {
            oscillator: Oscillator { omega, alpha: plate.damping_ratio[k] * omega },
            approach: [top, -bottom],
            centre: 0.5 * (top + bottom),
            bodies: [0.0; 2],
            start: [0.0; 2],
        }
    }
}

/// Oscillators and contacts of an impact.
#[derive(Debug, Clone)]
pub struct System {
    /// The oscillators: outer body, inner body, plate, further modes of both bodies. Shape (n).
    pub oscillators: Vec<Oscillator>,
    /// Displacement along z of outer and inner body (of a bender: of its tip) per unit of each coordinate. Shape (2, n).
    pub bodies: [Vec<f64>; 2],
    /// Coordinates and their rates at t = 0. Each of shape (n).
    pub start: [Vec<f64>; 2],
    /// Approach of each contact per unit of each coordinate, kg^(-1/2). Shape (2, n).
    pub approach: [Vec<f64>; 2],
    /// Displacement along z of the plate's centre (mean of both faces) per unit of each coordinate. Shape (n).
    pub centre: Vec<f64>,
    /// Displacement along x of what is struck at both contacts, along its surface, per unit of each elastic mode's coordinate; none where the
    /// surfaces of the struck body are taken as moving along their normals alone. Shape (modes, 2) or (0).
    pub along: Vec<[f64; 2]>,
    /// What the local deformation adds to it.
    pub local_centre: LocalCentre,
    /// Initial gap of each contact in m.
    pub gap: [f64; 2],
    /// Contact laws.
    pub laws: [Hertz; 2],
    /// Residual flexibility in terms of the approaches; `None` if it is zero.
    pub residual: Option<Residual>,
    /// Part of it in m/N that is the bodies' own, at their tips.
    pub tip_residual: [f64; 2],
    /// Masses of outer and inner body in kg; of a bender the mass that has its kinetic energy at the tip's speed.
    pub masses: [f64; 2],
    /// How the outer body was driven, if it is a bender.
    pub drive: Option<Drive>,
    /// The outer body if it is a stack, which may press on the plate for ever.
    pub stack: Option<Stack>,
    /// What supplies the outer body while it strikes, if it is a stack behind a resistor.
    pub circuit: Option<Circuit>,
    /// What its force on the plate does to such a stack besides what the participations say, by oscillator; none of any other body.
    pub feeds: Vec<(usize, Feed)>,
    /// Speed of the outer body towards the plate in m/s; of a stack that of its tip after a step of the voltage.
    pub speed: f64,
    /// Speed of the inner body towards the plate in m/s at t = 0.
    pub inner_speed: f64,
    /// First eigenfrequency of the plate that is not a rigid motion, Hz.
    pub first_frequency: f64,
    /// Number of elastic modes of the plate.
    pub modes: usize,
    /// What happens along the surfaces and changes the motion across them, where that is known from a run before.
    pub tangential_load: Option<TangentialLoad>,
}

impl System {
    /// The same with the outer body, which is no bender, at `speed` m/s.
    #[must_use]
    pub fn at_speed(&self, speed: f64) -> Self {
        let mut system = self.clone();
        system.start[1][OUTER] *= speed / self.speed;
        system.speed = speed;
        system
    }

    /// Joins outer and inner body with the plate of `material`, reduced to `plate`; `tip_residual` is the residual flexibility in m/N
    /// of the outer and the inner body at their contact points (zero for models A and B).
    pub fn of(
        bodies: &[MovingBody; 2],
        plate: &ModalBody,
        material: &Material,
        tip_residual: [f64; 2],
    ) -> Self {
        Self::between(bodies, plate, [material; 2], tip_residual)
    }

    /// The same with a body or plate of the materials `faces` at the contacts with the outer and the inner body.
    pub fn between(
        bodies: &[MovingBody; 2],
        plate: &ModalBody,
        faces: [&Material; 2],
        tip_residual: [f64; 2],
    ) -> Self {
        let [outer, inner] = bodies;
        let masses = [outer.mass, inner.mass];
        let mut coordinates: Vec<Coordinate> = [0, 1].map(|i| Coordinate::of_body(bodies, i, 0)).into();
        coordinates.extend((0..plate.omega.len()).map(|k| Coordinate::of_plate(plate, k)));
        let own = |k: usize| if k == 0 { OUTER } else { PLATE + plate.omega.len() + k - 1 };
        let (circuit, feeds) = outer.supply.clone().unzip();
        let feeds = feeds.into_iter().flatten().enumerate().map(|(k, feed)| (own(k), feed)).collect();
        for (i, body) in bodies.iter().enumerate() {
            coordinates.extend((1..body.oscillators.len()).map(|k| Coordinate::of_body(bodies, i, k)));
        }
        let each = |value: fn(&Coordinate) -> f64| coordinates.iter().map(value).collect::<Vec<f64>>();
        let laws = [0, 1].map(|i| {
            let MovingBody { tip_radius, material, friction, .. } = &bodies[i];
            Hertz::new(*tip_radius, material, faces[i]).with_friction(material, faces[i], *friction)
        });
        let mut flexibility = plate.residual.unwrap_or(PatchFlexibility::constant([[0.0; 2]; 2]));
        let hit = HertzImpact { mass: masses[0], speed: outer.speed, stiffness: laws[0].stiffness };
        let local_centre = LocalCentre::new(flexibility, &laws, faces[0].plane_strain_modulus(), &hit);
        for (own, tip) in flexibility.own.iter_mut().zip(tip_residual) {
            own[0] += tip;
        }
        // the inner contact closes when the plate moves down
        flexibility.mutual.iter_mut().flatten().for_each(|mutual| *mutual = -*mutual);
        let residual = Residual::new(&flexibility, &laws);
        let elastic = plate.omega.iter().copied().filter(|w| *w > 0.0);
        Self {
            approach: [each(|c| c.approach[0]), each(|c| c.approach[1])],
            bodies: [each(|c| c.bodies[0]), each(|c| c.bodies[1])],
            start: [each(|c| c.start[0]), each(|c| c.start[1])],
            centre: each(|c| c.centre),
            along: Vec::new(),
            gap: [outer.clearance, inner.clearance],
            laws,
            local_centre,
            residual: (!residual.is_zero()).then_some(residual),
            tip_residual,
            masses,
            drive: outer.drive,
            stack: outer.stack,
            circuit,
            feeds,
            speed: outer.speed,
            inner_speed: inner.speed,
            first_frequency: elastic.clone().fold(f64::INFINITY, f64::min) / (2.0 * std::f64::consts::PI),
            modes: elastic.count(),
            tangential_load: None,
            oscillators: coordinates.iter().map(|c| c.oscillator).collect(),
        }
    }

    /// Whether any oscillator is damped.
    pub fn is_damped(&self) -> bool {
        self.oscillators.iter().any(|o| o.alpha > 0.0)
    }

    /// Highest angular frequency of an oscillator without damping, rad/s.
    pub fn highest_frequency(&self) -> f64 {
        self.oscillators.iter().map(|o| o.omega).fold(0.0, f64::max)
    }

    /// Change of both contact forces in N per modal approach of both in m, with the patches `local` as
    /// [`Self::contact`] gives them.
    pub fn tangent(&self, local: [f64; 2]) -> [[f64; 2]; 2] {
        match &self.residual {
            None => [[self.laws[0].tangent(local[0]), 0.0], [0.0, self.laws[1].tangent(local[1])]],
            Some(residual) => {
                let per = |rate| residual.rates(&self.laws, local, rate).1;
                let (first, second) = (per([1.0, 0.0]), per([0.0, 1.0]));
                [[first[0], second[0]], [first[1], second[1]]]
            }
        }
    }

    /// Number of elastic modes of the plate that move both faces the same way.
    pub fn bending_modes(&self) -> usize {
        self.elastic().filter(|k| self.approach[0][*k] * self.approach[1][*k] < 0.0).count()
    }

    /// Places of the rigid motions of a free plate or body among the oscillators.
    pub fn rigid(&self) -> Range<usize> {
        let rigid = self.oscillators[PLATE..].iter().take_while(|o| o.omega == 0.0).count();
        PLATE..PLATE + rigid
    }

    /// Places of the plate's elastic modes among the oscillators, the lowest first.
    pub fn elastic(&self) -> Range<usize> {
        let first = self.rigid().end;
        first..first + self.modes
    }

    /// The same with the `modes` lowest elastic modes of the plate; the others follow as under static forces.
    pub fn lowest(&self, modes: usize) -> Self {
        let elastic = self.elastic();
        let gone = (elastic.start + modes).min(elastic.end)..elastic.end;
        let flexibility = |i: usize, j: usize| -> f64 {
            let of = |k: usize| self.approach[i][k] * self.approach[j][k] / self.oscillators[k].omega.powi(2);
            gone.clone().map(of).sum()
        };
        let mut system = self.softer([flexibility(0, 0), flexibility(0, 1), flexibility(1, 1)]);
        system.modes -= gone.len();
        system.along.truncate(system.modes);
        system.oscillators.drain(gone.clone());
        let pairs = [&mut system.start, &mut system.approach, &mut system.bodies];
        for coordinates in pairs.into_iter().flatten().chain([&mut system.centre]) {
            coordinates.drain(gone.clone());
        }
        for (k, _) in system.feeds.iter_mut().filter(|(k, _)| *k >= gone.end) {
            *k -= gone.len();
        }
        system
    }

    /// The same with a further residual flexibility (0,0), (0,1) = (1,0), (1,1) of the approaches, in m/N.
    pub fn softer(&self, flexibility: [f64; 3]) -> Self {
        let none = || Residual::new(&PatchFlexibility::constant([[0.0; 2]; 2]), &self.laws);
        let residual = self.residual.unwrap_or_else(none).with(flexibility);
        Self { residual: (!residual.is_zero()).then_some(residual), ..self.clone() }
    }

    /// As the contacts see it at `time` s, when they have moved over the plate.
    pub fn touched_at(&self, time: f64) -> Cow<'_, Self> {
        let Some(load) = &self.tangential_load else { return Cow::Borrowed(self) };
        let mut system = self.clone();
        let ways = load.at(time).ways;
        for (k, along) in load.along.iter().enumerate() {
            (0..2).for_each(|i| system.approach[i][k] -= ways[i] * along[i]);
        }
        Cow::Owned(system)
    }

    /// Rates of both contact forces in N/s with the patches `local` in m and the modal approaches' rates `rate` in m/s.
    pub fn force_rate(&self, local: [f64; 2], rate: [f64; 2]) -> [f64; 2] {
        self.tangent(local).map(|row| row[0] * rate[0] + row[1] * rate[1])
    }

    /// Number of oscillators.
    pub fn size(&self) -> usize {
        self.oscillators.len()
    }

    /// Displacements in m, or from the rates velocities in m/s, of outer and inner body.
    pub fn of_bodies(&self, coordinates: &[f64]) -> [f64; 2] {
        [0, 1].map(|i| dot(&self.bodies[i], coordinates))
    }

    /// Coordinates and their rates at t = 0, when the outer body touches. Shapes (n).
    pub fn initial_state(&self) -> (Vec<f64>, Vec<f64>) {
        let [q, v] = &self.start;
        (q.clone(), v.clone())
    }

    /// Kinetic energy of the outer body before the impact in J, to which eq. (1) relates the efficiency.
    pub fn initial_energy(&self) -> f64 {
        0.5 * self.masses[0] * self.speed.powi(2)
    }

    /// Kinetic energy of outer and inner body before the impact in J: the measure of rounding and of the ledger.
    pub fn kinetic_energy(&self) -> f64 {
        self.initial_energy() + 0.5 * self.masses[1] * self.inner_velocity().powi(2)
    }

    /// Momenta of outer and inner body before the impact in N s, without their signs: the scale of momentum residuals.
    pub fn initial_momentum(&self) -> f64 {
        self.masses[0] * self.speed + self.masses[1] * self.inner_velocity().abs()
    }

    /// Velocity of the inner body before the impact in m/s, signed along z.
    pub fn inner_velocity(&self) -> f64 {
        dot(&self.bodies[1], &self.start[1])
    }

    /// The outer body's impact if the plate were a half-space at rest, or without a plate the impact itself: the measure of duration and
    /// force.
    pub fn hertz_impact(&self) -> HertzImpact {
        // zero but where the outer body strikes the inner one
        let struck = self.approach[0][INNER];
        HertzImpact {
            mass: self.masses[0] / (1.0 + self.masses[0] * struck * struck),
            speed: self.speed + struck * self.start[1][INNER],
            stiffness: self.laws[0].stiffness,
        }
    }

    /// Whether contact `i` moves with any coordinate; without a plate the second does not.
    pub fn can_close(&self, i: usize) -> bool {
        self.approach[i].iter().any(|b| *b != 0.0)
    }

    /// The contact that the inner body has: that with the plate, or without one that with the outer body.
    pub fn inner_contact(&self) -> usize {
        usize::from(self.approach[0][INNER] == 0.0)
    }

    /// Whether the outer body is held by a spring of its own (a bender, a stack) and comes back whatever happens.
    pub fn outer_returns(&self) -> bool {
        self.oscillators[OUTER].omega > 0.0
    }

    /// Kinetic and strain energy of all bodies in J, without that of the contacts.
    pub fn energy(&self, q: &[f64], v: &[f64]) -> f64 {
        self.oscillators.iter().zip(q).zip(v).map(|((o, q), v)| 0.5 * (v * v + (o.omega * q).powi(2))).sum()
    }

    /// The same with what a circuit can still give instead of what it has.
    pub fn energy_left(&self, q: &[f64], v: &[f64]) -> f64 {
        match &self.circuit {
            None => self.energy(q, v),
            Some(circuit) => {
                let available = circuit.account(&self.of_outer(q), &self.of_outer(v)).available;
                available + self.energy_without_outer(q, v)
            }
        }
    }

    /// The energy in J but for what a stack's circuit still charges without vibrating, and the speed in m/s at which that moves the free
    /// tip, from now on ever more slowly; `None` without a circuit.
    pub fn energy_but_charging(&self, q: &[f64], v: &[f64]) -> Option<(f64, f64)> {
        let circuit = self.circuit.as_ref()?;
        let (mut own_q, mut own_v) = (self.of_outer(q), self.of_outer(v));
        let mut speed = 0.0;
        for (k, mode) in circuit.modes.iter().enumerate().filter(|(_, mode)| mode.is_decay()) {
            speed += (mode.tip * own_v[k]).abs();
            (own_q[k], own_v[k]) = (0.0, 0.0);
        }
        Some((circuit.account(&own_q, &own_v).available + self.energy_without_outer(q, v), speed))
    }

    /// Kinetic and strain energy of all but the outer body in J.
    fn energy_without_outer(&self, q: &[f64], v: &[f64]) -> f64 {
        let of = |k: usize| 0.5 * (v[k] * v[k] + (self.oscillators[k].omega * q[k]).powi(2));
        (0..self.size()).filter(|k| self.bodies[0][*k] == 0.0).map(of).sum()
    }

    /// Those of all `values` that are of the outer body's own coordinates.
    fn of_outer(&self, values: &[f64]) -> Vec<f64> {
        (0..self.size()).filter(|k| self.bodies[0][*k] != 0.0).map(|k| values[k]).collect()
    }

    /// Energies of the stack, if the outer body is one, and of what lies beyond its tip but for the contacts, J.
    pub fn account(&self, q: &[f64], v: &[f64]) -> Option<(Account, f64)> {
        let (own_q, own_v) = (self.of_outer(q), self.of_outer(v));
        let account = match &self.circuit {
            Some(circuit) => circuit.account(&own_q, &own_v),
            None => self.stack.as_ref()?.account(&own_q, &own_v),
        };
        Some((account, self.energy_without_outer(q, v)))
    }

    /// Strain energy of contacts and residual flexibility in J under the forces `f` in N with the patches `p` in m that go
    /// with them, negative where a contact is open.
    #[inline(always)]
    pub fn stored_energy(&self, f: [f64; 2], p: [f64; 2]) -> f64 {
        match &self.residual {
            None => 0.4 * (f[0] * p[0].max(0.0) + f[1] * p[1].max(0.0)),
            Some(residual) => residual.energy(&self.laws, p),
        }
    }

    /// Approach of both contacts in m, without the part of the residual flexibility.
    pub fn modal_approach(&self, q: &[f64]) -> [f64; 2] {
        [0, 1].map(|i| dot(&self.approach[i], q) - self.gap[i])
    }

    /// Patches (squared radius over tip radius in m; of an open contact the distance, negative) and forces in N of both
    /// contacts at the modal approach `y` in m, `guess` being the patches of a nearby state; `None` if there is no
    /// equilibrium.
    #[inline]
    pub fn contact(&self, y: [f64; 2], guess: [f64; 2]) -> Option<([f64; 2], [f64; 2])> {
        match &self.residual {
            None => Some((y, [self.laws[0].force(y[0]), self.laws[1].force(y[1])])),
            Some(residual) => residual.solve(&self.laws, y, guess),
        }
    }

    /// Contact of the inner body as a film around it sees it, with the patches `local` in m.
    pub fn indentation(&self, local: [f64; 2]) -> Indentation {
        let per_approach =
            self.residual.map_or(1.0, |residual| residual.rates(&self.laws, local, [0.0, 1.0]).0[1]);
        Indentation::new(local[1], per_approach, self.laws[1].tip_radius)
    }

    /// What the contacts add to displacement in m and velocity in m/s of the plate's centre, with the patches `p` in m, the rates of
    /// the modal approaches in m/s and the `forces` in N.
    pub fn motion_of_centre(&self, p: [f64; 2], rate: [f64; 2], forces: [f64; 2]) -> [f64; 2] {
        let (p_rate, force_rate) = match &self.residual {
            Some(residual) => residual.rates(&self.laws, p, rate),
            None => (rate, [0, 1].map(|i| self.laws[i].tangent(p[i]) * rate[i])),
        };
        self.local_centre.motion((p, p_rate), (forces, force_rate))
    }
}

/// Scalar product.
#[inline(always)]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
