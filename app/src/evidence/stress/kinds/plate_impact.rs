//! A random impact over the whole admissible range.

use crate::body::ModalBody;
use crate::body::kirchhoff::UnitPlate;
use crate::contact::PatchFlexibility;
use crate::dynamics::system::System;
use crate::dynamics::wet::FluidForces;
use crate::error::Result;
use crate::fluid::added_mass::{immersed, mass_factor};
use crate::kinds::plate_impact::PlateImpact;
use crate::scene::{Edge, Fluid, Inner, Material, Outer, Plate, Shape, ShearThinning, Turning};
use std::collections::HashMap;
use std::sync::{Arc, Mutex};

/// Most modes of a case, and the numbers for which eigenproblems are solved; a case takes the lowest of the next.
const TIERS: [usize; 3] = [16, 64, 256];
/// Poisson's ratios of plates: each is an eigenproblem of its own.
const PLATE_POISSON: [f64; 5] = [-0.9, -0.2, 0.0, 0.3, 0.499];
/// Most modes of a case that is also solved in a fluid, and how many in four of these are: a third of all.
const WET_MODES: usize = 24;
const WET_SHARE: u8 = 3;
/// Most radians the highest mode of a case in a fluid turns through. The film feels every turn, so that longer cases cost
/// hundreds of thousands of steps.
const WET_TURNS: f64 = 5e5;
/// Kinds of impacts, as the names of their values begin.
pub const DRY: &str = "";
pub const WET: &str = "wet_";
pub const MOVING: &str = "moving_";
/// Turns a seed into that of the moving impact.
const MOVING_SEED: u64 = 0x6d6f_7669_6e67;
/// Length of a run in durations of a Hertz contact.
const DURATIONS: f64 = 6.0;

/// Modes of plates of unit radius, solved when they are first asked for.
#[derive(Default)]
pub struct UnitPlateModes(Mutex<HashMap<(Edge, usize, usize), Arc<UnitPlate>>>);

impl UnitPlateModes {
    fn get(&self, edge: Edge, poisson: usize, tier: usize) -> Result<Arc<UnitPlate>> {
        // a clamped plate's modes do not depend on Poisson's ratio beyond its rigidity, but the type checks it
        let key = (edge, poisson, tier);
        let mut plates = self.0.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if let Some(plate) = plates.get(&key) {
            return Ok(plate.clone());
        }
        let plate = Arc::new(UnitPlate::new(edge, PLATE_POISSON[poisson], TIERS[tier])?);
        plates.insert(key, plate.clone());
        Ok(plate)
    }
}

/// An impact to be solved.
pub struct StressImpact {
    /// In words.
    pub description: String,
    /// The bodies; in a fluid with its mass and damping.
    pub system: System,
    /// Film and drag, if there are any.
    pub forces: Option<FluidForces>,
    /// End of the run in s; `None` = when no further contact is possible.
    pub end_time: Option<f64>,
}

/// What one seed gives.
pub struct StressCase {
    /// Seed it was drawn from.
    pub seed: u64,
    /// The inner body at rest, the outer one a sphere, the end given, no fluid.
    pub dry: StressImpact,
    /// The same in a fluid, for some of the cases.
    pub wet: Option<StressImpact>,
    /// The same with a compact outer body or an inner one that moves, some without a given end; for some of the cases.
    pub moving: Option<StressImpact>,
}

impl StressImpact {
    /// The impact `dry` of `setup` on a plate reduced to `body` in a random fluid; each of its effects may be absent. `unit` is the
    /// plate of unit radius.
    fn wet(
        random: &mut Random,
        mut setup: PlateImpact,
        body: ModalBody,
        tips: [f64; 2],
        unit: &UnitPlate,
        dry: &Self,
    ) -> Result<Self> {
        let elastic = body.omega.len();
        let viscosity = random.log(1e-5, 0.1);
        let fluid = Fluid {
            viscosity,
            density: random.log(0.1, 2e4),
            minimum_gap: random.log(1e-7, 1e-5),
            squeeze_film: random.0.u8(0..4) > 0,
            added_mass_frequency_ratio: if random.0.bool() { random.uniform(0.05, 1.0) } else { 1.0 },
            plate_damping_ratio: if random.0.bool() { random.log(1e-4, 5.0) } else { 0.0 },
            drag_coefficient: if random.0.bool() { random.log(1e-2, 10.0) } else { 0.0 },
            shear_thinning: (random.0.u8(0..4) == 0).then(|| ShearThinning {
                infinite_shear_viscosity: viscosity * random.log(1e-3, 1.0),
                relaxation_time: random.log(1e-6, 1.0),
                power_index: random.uniform(0.1, 1.0),
            }),
        };
        let plate = immersed(body, &fluid);
        let per_mass = mass_factor(fluid.added_mass_frequency_ratio).sqrt().recip();
        let amplitude =
            1.0 / (setup.plate.radius * (setup.plate.material.density * setup.plate.thickness).sqrt());
        let forces = FluidForces::new(&fluid, &setup.plate, &setup.inner, |radii| {
            let radii: Vec<f64> = radii.iter().map(|r| r / setup.plate.radius).collect();
            let mut shapes = unit.deflection(&radii);
            shapes.truncate(elastic);
            shapes.iter_mut().flatten().for_each(|value| *value *= amplitude * per_mass);
            Ok::<_, crate::Error>(shapes)
        })?;
        let description = format!("{}, in {fluid:?}", dry.description);
        setup.fluid = Some(fluid);
        let system = setup.rigid_system(&plate, tips);
        Ok(Self { description, system, forces, end_time: dry.end_time })
    }

    /// The impact `dry` of `setup` on a plate reduced to `body` with a compact outer body or an inner one that moves.
    fn moving(
        random: &mut Random,
        mut setup: PlateImpact,
        body: &ModalBody,
        tips: [f64; 2],
        dry: &Self,
    ) -> Self {
        let Shape::Sphere { radius } = setup.outer.shape else {
            unreachable!("the outer body is drawn as a sphere")
        };
        let mass = setup.outer.shape.mass(&setup.outer.material) * random.log(0.1, 100.0);
        if random.0.bool() {
            setup.outer.shape = Shape::Compact { mass, tip_radius: radius };
        }
        if random.0.bool() {
            setup.inner.speed = setup.outer.speed * random.uniform(-0.9, 2.0);
        }
        let system = setup.rigid_system(body, tips);
        let end_time = DURATIONS * system.hertz_impact().duration() + setup.inner.gap / setup.outer.speed;
        let end_time = random.0.bool().then_some(end_time);
        let description = format!(
            "{}, but outer {:.2e} kg, inner at {:.2e} m/s, end {end_time:?} s",
            dry.description, system.masses[0], setup.inner.speed
        );
        Self { description, system, forces: None, end_time }
    }
}

impl StressCase {
    /// The impacts, each with its kind.
    pub fn impacts(&self) -> impl Iterator<Item = (&'static str, &StressImpact)> {
        let others = [(WET, &self.wet), (MOVING, &self.moving)];
        let others = others.into_iter().filter_map(|(kind, impact)| Some((kind, impact.as_ref()?)));
        std::iter::once((DRY, &self.dry)).chain(others)
    }

    /// Draws the case of `seed`.
    ///
    /// # Errors
    /// If the plate's eigenproblem can't be solved.
    pub fn draw(seed: u64, plates: &UnitPlateModes) -> Result<Self> {
        let mut random = Random(fastrand::Rng::with_seed(seed));
        let mut material = |name: &str, poisson_ratio: f64| {
            Material::elastic(name, random.log(1e6, 1e12), poisson_ratio, random.log(500.0, 2e4))
        };
        let (plate_material, outer_material, inner_material) =
            (material("plate", 0.0), material("outer", 0.3), material("inner", 0.3));
        let poisson = random.0.usize(0..PLATE_POISSON.len());
        let mut body = |mut material: Material| {
            material.poisson_ratio = random.uniform(-0.99, 0.499);
            material
        };
        let (outer_material, inner_material) = (body(outer_material), body(inner_material));
        let edge = [Edge::Clamped, Edge::SimplySupported, Edge::Free][random.0.usize(0..3)];
        let radius = random.log(1e-3, 0.1);
        let damping_ratio = match random.0.usize(0..4) {
            0 => random.log(1e-4, 0.3),
            1 => random.log(0.3, 20.0),
            _ => 0.0,
        };
        let plate = Plate {
            radius,
            thickness: radius * random.log(0.002, 2.0),
            edge,
            material: Material { poisson_ratio: PLATE_POISSON[poisson], ..plate_material },
            damping_ratio,
        };
        let outer_shape = Shape::Sphere { radius: radius * random.log(0.02, 2.0) };
        let outer_mass = outer_shape.mass(&outer_material);
        let mass_ratio = random.log(1e-4, 1e4);
        let inner_shape = Shape::Compact {
            mass: outer_mass * mass_ratio,
            tip_radius: outer_shape.tip_radius() * random.log(0.05, 20.0),
        };
        let speed = random.log(1e-4, 50.0);
        let outer = Outer::centred(outer_shape, outer_material, speed);
        let modes = (random.log(1.0, 257.0) as usize).clamp(1, TIERS[2]);
        let mut setup = PlateImpact {
            friction: 0.0,
            plate,
            outer,
            inner: Inner {
                shape: inner_shape,
                material: inner_material,
                gap: 0.0,
                speed: 0.0,
                turning: Turning::default(),
            },
            fluid: None,
            series: None,
        };
        let tier = TIERS.iter().position(|tier| *tier >= modes).unwrap_or(TIERS.len() - 1);
        let unit = plates.get(edge, poisson, tier)?;
        let mut body = lowest(unit.scale(&setup.plate), modes);
        let dry = setup.rigid_system(&body, [0.0; 2]);
        let hit = dry.hertz_impact();
        let (approach, force) = (hit.approach_peak(), hit.force_peak());
        if random.0.bool() {
            setup.inner.gap = approach * random.log(1e-4, 10.0);
        }
        let mut tips = [0.0; 2];
        if random.0.u8(0..3) == 0 {
            // a residual flexibility up to that of the contacts themselves, positive definite
            let flexibility = approach / force * random.log(1e-3, 1.0);
            let mutual = random.uniform(-0.9, 0.9);
            body.residual = Some(PatchFlexibility::constant([
                [flexibility, mutual * flexibility],
                [mutual * flexibility, flexibility],
            ]));
            tips = [flexibility * random.uniform(0.0, 1.0), flexibility * random.uniform(0.0, 1.0)];
        }
        let system = setup.rigid_system(&body, tips);
        let end_time = DURATIONS * hit.duration() + setup.inner.gap / speed;
        let description = format!(
            "{edge:?} plate R {:.3e} m, t/R {:.3e}, E {:.1e} Pa, damping {:.2e}, {modes} modes; outer {:.2e} kg at {speed:.2e} m/s; inner {mass_ratio:.2e} of it, gap {:.1e} m; residual {}",
            setup.plate.radius,
            setup.plate.thickness / setup.plate.radius,
            setup.plate.material.youngs_modulus,
            setup.plate.damping_ratio,
            outer_mass,
            setup.inner.gap,
            system.residual.is_some(),
        );
        let dry = StressImpact { description, system, forces: None, end_time: Some(end_time) };
        // streams of their own: what is drawn above stays the same
        let mut random = Random(fastrand::Rng::with_seed(seed.rotate_left(32) ^ MOVING_SEED));
        let moving = (random.0.u8(0..4) == 0)
            .then(|| StressImpact::moving(&mut random, setup.clone(), &body, tips, &dry));
        let mut random = Random(fastrand::Rng::with_seed(!seed));
        let wet = (modes <= WET_MODES && random.0.u8(0..4) < WET_SHARE)
            .then(|| StressImpact::wet(&mut random, setup, body, tips, &unit, &dry))
            .transpose()?
            .filter(|wet| wet.system.highest_frequency() * end_time <= WET_TURNS);
        Ok(Self { seed, dry, wet, moving })
    }
}

/// `body` with its rigid motion and the `modes` lowest elastic modes.
fn lowest(mut body: ModalBody, modes: usize) -> ModalBody {
    let rigid = body.omega.iter().filter(|w| **w == 0.0).count();
    body.omega.truncate(rigid + modes);
    body.damping_ratio.truncate(rigid + modes);
    body.participation.truncate(rigid + modes);
    body
}

/// Random numbers over ranges.
struct Random(fastrand::Rng);

impl Random {
    fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.f64()
    }

    /// Evenly over the logarithm.
    fn log(&mut self, low: f64, high: f64) -> f64 {
        (self.uniform(low.ln(), high.ln())).exp()
    }
}
