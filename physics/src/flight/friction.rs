//! Coulomb's friction of a sphere that stays on a surface, and of the spring that holds its turn.

/// Share of its limit up to which friction surely sticks; just below the limit it slips if it can.
const STICKS: f64 = 1.0 - 1e-9;

/// What acts on a sphere on a surface besides friction, and how large friction can be.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfaceLoads {
    /// Force along the surface in N.
    pub(super) along: f64,
    /// Largest friction force of the surface in N: coefficient times normal force.
    pub(super) grip: f64,
    /// Largest moment in N m with which the spring resists a turn.
    pub(super) resistance: f64,
    /// Mass in kg, moment of inertia in kg m^2, radius in m.
    pub(super) mass: f64,
    pub(super) inertia: f64,
    pub(super) radius: f64,
}

/// Whether two surfaces stick to each other, or the sign of their slip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bond {
    Stick,
    Slip(i8),
}

/// How a sphere moves on a surface: whether it slips there, and whether it turns against the spring.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Regime {
    pub(super) surface: Bond,
    /// `Stick`: the spring holds the turn.
    pub(super) turn: Bond,
}

/// Friction force and moment, and the accelerations that follow.
#[derive(Debug, Clone, Copy)]
pub(super) struct FrictionResponse {
    pub(super) friction: f64,
    pub(super) moment: f64,
    /// Along the surface in m/s^2.
    pub(super) acceleration: f64,
    /// In rad/s^2.
    pub(super) spin_rate: f64,
}

impl Regime {
    /// Whether nothing moves.
    pub(super) fn rests(self) -> bool {
        self.surface == Bond::Stick && self.turn == Bond::Stick
    }

    /// Forces and accelerations in this regime.
    pub(super) fn answer(self, loads: &SurfaceLoads) -> FrictionResponse {
        let SurfaceLoads { along, grip, resistance, mass, inertia, radius } = *loads;
        let moment_of = |sign: i8| -f64::from(sign) * resistance;
        let (friction, moment) = match (self.surface, self.turn) {
            (Bond::Stick, Bond::Stick) => (-along, radius * along),
            (Bond::Stick, Bond::Slip(sign)) => {
                let moment = moment_of(sign);
                // a + r spin' = 0
                let compliance = 1.0 / mass + radius.powi(2) / inertia;
                (-(along / mass + radius * moment / inertia) / compliance, moment)
            }
            (Bond::Slip(sign), turn) => {
                let friction = -f64::from(sign) * grip;
                let moment = match turn {
                    Bond::Stick => -radius * friction,
                    Bond::Slip(sign) => moment_of(sign),
                };
                (friction, moment)
            }
        };
        FrictionResponse {
            friction,
            moment,
            acceleration: (along + friction) / mass,
            spin_rate: (radius * friction + moment) / inertia,
        }
    }

    /// The regime at a `slip` of the surface in m/s and a `spin` in rad/s, either of which may be exactly 0: then what friction
    /// can hold stays, and what it can't moves as the rest of the forces has it.
    pub(super) fn at(loads: &SurfaceLoads, slip: f64, spin: f64) -> Self {
        let bonds = |rate: f64, holds: bool| -> Vec<Bond> {
            let signs = [Bond::Slip(1), Bond::Slip(-1)];
            match rate {
                0.0 if holds => [&[Bond::Stick], &signs[..]].concat(),
                0.0 => signs.to_vec(),
                rate => vec![if rate > 0.0 { signs[0] } else { signs[1] }],
            }
        };
        let turns = if loads.resistance > 0.0 { bonds(spin, true) } else { vec![Bond::Slip(1)] };
        let mut best = (f64::INFINITY, Regime { surface: Bond::Slip(1), turn: turns[0] });
        for surface in bonds(slip, true) {
            for &turn in &turns {
                let regime = Regime { surface, turn };
                let excess = regime.excess(loads, [slip, spin]);
                if excess < best.0 {
                    best = (excess, regime);
                }
                if excess <= 0.0 {
                    return regime;
                }
            }
        }
        best.1
    }

    /// By how much, relative to the loads, the regime contradicts itself at a slip and a spin; 0 if it does not.
    fn excess(self, loads: &SurfaceLoads, [slip, spin]: [f64; 2]) -> f64 {
        let answer = self.answer(loads);
        let begins = |rate: f64, sign: i8| (-f64::from(sign) * rate).max(0.0) * loads.mass;
        let surface = match self.surface {
            Bond::Stick => answer.friction.abs() - STICKS * loads.grip,
            Bond::Slip(sign) if slip == 0.0 => {
                begins(answer.acceleration + loads.radius * answer.spin_rate, sign)
            }
            Bond::Slip(_) => 0.0,
        };
        let turn = match self.turn {
            Bond::Stick => (answer.moment.abs() - STICKS * loads.resistance) / loads.radius,
            Bond::Slip(sign) if spin == 0.0 && loads.resistance > 0.0 => {
                begins(answer.spin_rate * loads.radius, sign)
            }
            Bond::Slip(_) => 0.0,
        };
        surface.max(turn)
    }
}
