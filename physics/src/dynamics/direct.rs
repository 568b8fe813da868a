//! Impacts without a plate, or without an inner body.
//!
//! There is one contact then, the first of a [`System`]; the second belongs to no coordinate and never closes. A wall does not move: in place
//! of the inner body stands a coordinate that nothing is coupled to.

use super::moving_body::MovingBody;
use super::system::{INNER, System};
use crate::body::ModalBody;
use crate::material::Material;
use crate::numerics::duhamel::Oscillator;

/// Distance in m at which the second contact stays for ever; small against every approach, on which the accuracy of both contacts goes by.
const OPEN: f64 = 1e-15;

impl System {
    /// `outer` strikes an elastic `body` of `material`, behind which nothing lies.
    pub fn on_body(outer: MovingBody, body: &ModalBody, material: &Material, tip_residual: f64) -> Self {
        let still = still(&outer);
        let mut system = Self::of(&[outer, still], body, material, [tip_residual, 0.0]);
        system.open_second();
        system
    }

    /// `outer` strikes a flat wall of `material`.
    pub fn on_wall(outer: MovingBody, material: &Material) -> Self {
        let still = still(&outer);
        Self::direct([outer, still], material)
    }

    /// Takes the second contact out: it never closes.
    fn open_second(&mut self) {
        self.approach[1].fill(0.0);
        self.gap[1] = OPEN;
        self.laws[1] = self.laws[0];
    }

    /// `outer` strikes `inner`; both tips are curved. Source: Johnson, Contact Mechanics, 1985, section 4.2: 1/R = 1/R1 + 1/R2.
    pub fn of_two_bodies(outer: MovingBody, inner: MovingBody) -> Self {
        let material = inner.material.clone();
        let [first, second] = [outer.tip_radius, inner.tip_radius];
        let tip_radius = first * second / (first + second);
        Self::direct([MovingBody { tip_radius, ..outer }, inner], &material)
    }

    /// The first contact joins both bodies; that of the outer body's tip with a face of `material`.
    fn direct(bodies: [MovingBody; 2], material: &Material) -> Self {
        let nothing = ModalBody {
            omega: Vec::new(),
            damping_ratio: Vec::new(),
            participation: Vec::new(),
            residual: None,
        };
        let mut system = Self::of(&bodies, &nothing, material, [0.0; 2]);
        system.approach[0][INNER] = system.approach[1][INNER];
        system.open_second();
        system
    }
}

/// In place of an inner body: a coordinate at rest, with what else `outer` has.
fn still(outer: &MovingBody) -> MovingBody {
    MovingBody {
        oscillators: vec![Oscillator { omega: 0.0, alpha: 0.0 }],
        tip: vec![0.0],
        displacement: vec![0.0],
        velocity: vec![0.0],
        speed: 0.0,
        drive: None,
        stack: None,
        supply: None,
        ..outer.clone()
    }
}
