//! Two surfaces in contact of which at least one yields, each with the dent that stays in it.
//!
//! Both bear one pressure over one circle, and what each loses of its curvature adds up to that of the tip: a/R = sum a/rho. An elastic
//! surface gives way under a pressure as a yielding one comes back from it; so where only one of them yields it takes the more of the
//! flattening the more it yields.
//!
//! The approach follows from the energy: on the way to a deeper dent F dx = dW + sum dD, with the elastic energy W of both surfaces and
//! what each has dissipated, D. Unloading returns W. D never falls, so a closed loop never returns more than it took.

use super::elastic_plastic::{ElasticPlastic, Flattened};
use super::{Hertz, Press};
use crate::material::Material;
use crate::numerics::root::{root, root_near};
use std::f64::consts::PI;

/// Least square of the overload from which that of the next step is looked for.
const LEAST_NEAR: f64 = 1e-3;

/// Onset of yield of a plate over that of a sphere from which the sphere dents more in the end.
const WEAKER_SPHERE: f64 = 0.8;

/// Squares of the overload between which a contact begins to yield, halvings of the search, and growth of the dissipated energy that is
/// none.
const LIMITS: [f64; 2] = [1e-6, 1e6];
const LIMIT_STEPS: usize = 60;
const ROUNDING: f64 = 1e-12;

/// What a surface has been through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dent {
    /// Where it was flattened furthest.
    deepest: Flattened,
    /// Curvature that it has lost for good, 1/m, and the largest slope at the rim that went with it.
    curvature: f64,
    slope: f64,
    /// Energy that it has dissipated, J.
    lost: f64,
    /// Its share in the approach at which the dents touch, m.
    depth: f64,
}

impl Dent {
    /// Flattening for good of a contact with the radius `radius` in m under which a virgin surface would be flattened by `lasting`: within
    /// the dent that of its curvature, beyond its rim no more.
    fn flattening(&self, radius: f64, lasting: f64) -> f64 {
        lasting.max((radius * self.curvature).min(self.slope))
    }

    const NONE: Dent = Dent { deepest: Flattened::NONE, curvature: 0.0, slope: 0.0, lost: 0.0, depth: 0.0 };
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct DentedSurface {
    law: ElasticPlastic,
    dent: Dent,
}

/// The contact of a tip and a flat, body and plate.
#[derive(Debug, Clone, Copy)]
pub struct DentedContact {
    hertz: Hertz,
    /// E* in Pa.
    modulus: f64,
    /// Of body and plate; `None`: elastic. Which of them yields more in the end.
    surfaces: [Option<DentedSurface>; 2],
    weaker: usize,
    /// Squares of the overloads of both surfaces at the end of the last step.
    near: [f64; 2],
    /// Up to where it is elastic.
    limit: YieldPoint,
    /// How it is pressed at the end of the last step.
    press: Press,
    /// Elastic energy now, and what has been dissipated so far on all spots, J.
    stored: f64,
    dissipated: f64,
    /// Largest radius at which it has yielded so far, on all spots, m.
    widest: f64,
}

/// The end of the elastic branch.
#[derive(Debug, Clone, Copy, PartialEq)]
struct YieldPoint {
    /// Square of the overload of the weaker surface.
    w: f64,
    /// In N; approach beyond that at which the dents touch, m; elastic energy and what both dents have dissipated, J.
    force: f64,
    approach: f64,
    energy: f64,
}

impl YieldPoint {
    const NONE: YieldPoint = YieldPoint { w: 0.0, force: 0.0, approach: 0.0, energy: 0.0 };
}

/// The contact at a pressure.
struct Pressed {
    press: Press,
    /// Approach in m and energy in J that unloading gives back.
    recovers: f64,
    stored: f64,
    /// The surfaces as they would be if virgin.
    now: [Option<Flattened>; 2],
    /// Energies that the surfaces have dissipated, J.
    lost: [f64; 2],
}

impl Pressed {
    /// Energy in J that a virgin contact would have taken.
    fn energy(&self) -> f64 {
        self.stored + self.lost[0] + self.lost[1]
    }
}

/// Which of `surfaces` of body and plate yields more in the end: a sphere of equal material is the weaker one in a deep dent.
fn weaker(surfaces: &[Option<DentedSurface>; 2]) -> usize {
    let onset = surfaces.map(|s| s.map_or(f64::INFINITY, |s| s.law.onset_pressure()));
    usize::from(onset[1] < WEAKER_SPHERE * onset[0])
}

impl DentedContact {
    /// The contact `hertz` of a body and the plate, of the materials `pair`; a material yields at `yield_strength` in Pa of its own.
    /// `None` if neither does.
    pub fn new(hertz: Hertz, pair: [&Material; 2], yield_strength: [Option<f64>; 2]) -> Option<Self> {
        let modulus = 1.0 / pair.iter().map(|m| 1.0 / m.plane_strain_modulus()).sum::<f64>();
        let surfaces = [0, 1].map(|i| {
            let (modulus, hardening) = (pair[i].plane_strain_modulus(), pair[i].hardening.unwrap_or(0.0));
            let law = |y| ElasticPlastic::new(modulus, [y, hardening], pair[i].poisson_ratio, i == 0);
            yield_strength[i].map(|y| DentedSurface { law: law(y), dent: Dent::NONE })
        });
        let weaker = weaker(&surfaces);
        surfaces[weaker]?;
        let contact = Self {
            hertz,
            modulus,
            surfaces,
            weaker,
            near: [1.0; 2],
            limit: YieldPoint::NONE,
            press: Press::default(),
            stored: 0.0,
            dissipated: 0.0,
            widest: 0.0,
        };
        Some(contact.with_elastic_limit())
    }

    /// The same if virgin, on a plate that is pulled along its face by `stress` Pa; a contact with dents stays as they were made.
    #[must_use]
    pub fn on_a_pulled_plate(mut self, stress: f64) -> Self {
        if let (true, Some(plate)) = (self.is_virgin(), &mut self.surfaces[1]) {
            plate.law = plate.law.pulled(stress);
            self.weaker = weaker(&self.surfaces);
            return self.with_elastic_limit();
        }
        self
    }

    /// Whether nothing has yielded yet.
    pub fn is_virgin(&self) -> bool {
        self.surfaces.iter().flatten().all(|surface| surface.dent.lost == 0.0)
    }

    /// Force in N up to which the contact is elastic while virgin.
    pub fn critical_force(&self) -> f64 {
        self.hertz.force(self.critical_approach())
    }

    /// x_c = (3 pi p/(4 E*))^2 R with the mean pressure p at the onset, m.
    pub fn critical_approach(&self) -> f64 {
        let onsets = self.surfaces.iter().flatten().map(|surface| surface.law.onset_pressure());
        let pressure = onsets.fold(f64::INFINITY, f64::min);
        (0.75 * PI * pressure / self.modulus).powi(2) * self.hertz.tip_radius
    }

    /// Approach in m at which the dented surfaces touch.
    pub fn depth(&self) -> f64 {
        self.surfaces.iter().flatten().map(|s| s.dent.depth).sum()
    }

    /// How it is pressed at the end of the last step.
    pub fn press(&self) -> Press {
        self.press
    }

    /// Work in J done on the contact so far: what it stores and what it has lost.
    pub fn taken(&self) -> f64 {
        self.stored + self.dissipated
    }

    /// Energy in J dissipated so far.
    pub fn dissipated(&self) -> f64 {
        self.dissipated
    }

    /// Largest radius of the contact over that of the tip at which it has yielded so far.
    pub fn widest(&self) -> f64 {
        self.widest / self.hertz.tip_radius
    }

    /// The same with a fresh spot of the body.
    #[must_use]
    pub fn on_a_fresh_spot(mut self) -> Self {
        let Some(body) = &mut self.surfaces[0] else { return self };
        body.dent = Dent::NONE;
        self.with_elastic_limit()
    }

    /// The same with the elastic limit that its dents leave it.
    fn with_elastic_limit(mut self) -> Self {
        let lost = self.surfaces.iter().flatten().map(|surface| surface.dent.lost).sum::<f64>();
        let deepens = |w: f64| self.pressed(w).lost.iter().sum::<f64>() > lost * (1.0 + ROUNDING);
        let [mut low, mut high] = LIMITS.map(f64::ln);
        for _ in 0..LIMIT_STEPS {
            let middle = 0.5 * (low + high);
            if deepens(middle.exp()) { high = middle } else { low = middle }
        }
        let w = low.exp();
        let at = self.pressed(w);
        self.limit = YieldPoint { w, force: at.press.force, approach: at.recovers, energy: at.energy() };
        self
    }

    fn weaker_law(&self) -> &ElasticPlastic {
        let weaker = self.surfaces[self.weaker].as_ref();
        &weaker.expect("`new` sees that one yields").law
    }

    /// Both surfaces if virgin, at the square `w` of the weaker one's overload, and the shear stress in Pa that they bear.
    fn virgin(&self, w: f64) -> ([Option<Flattened>; 2], f64) {
        let other = 1 - self.weaker;
        let at = |of_weaker: Flattened, near: f64| {
            let shear = of_weaker.pressure * of_weaker.shears();
            let mut now = [Some(of_weaker); 2];
            now[other] = self.surfaces[other].map(|surface| surface.law.sheared(shear, w, near));
            (now, shear)
        };
        let law = self.weaker_law();
        let alone = at(law.flattened(w), self.near[other]);
        let (0, [Some(body), Some(plate)]) = (self.weaker, alone.0) else { return alone };
        if body.approach <= 1.0 {
            return alone;
        }
        // the sphere slopes by what both surfaces are flattened: the more it does the less pressure flattens the plate; one secant is enough,
        // since a twentieth of the slope is a hundredth of the pressure
        let sloping = body.flattening + plate.flattening;
        let less =
            at(law.flattened_at(w, sloping), plate.approach).0[1].map_or(0.0, |plate| plate.flattening);
        let flattening = plate.flattening.powi(2) / (2.0 * plate.flattening - less);
        let near = plate.approach * (flattening / plate.flattening).powi(2);
        at(law.flattened_at(w, body.flattening + flattening), near)
    }

    /// The contact at the square `w` of the overload that the weaker surface would have if virgin.
    fn pressed(&self, w: f64) -> Pressed {
        let (now, shear) = self.virgin(w);
        let dents = self.surfaces.map(|s| s.map_or(Dent::NONE, |s| s.dent));
        let deepest = [0, 1].map(|i| {
            let now = now[i].unwrap_or(Flattened::NONE);
            if now.approach > dents[i].deepest.approach { now } else { dents[i].deepest }
        });
        // the dent that is more even sets the pressure; what comes back is shared by their depths
        let even = deepest[usize::from(deepest[1].evenness > deepest[0].evenness)];
        let depth = deepest.map(|d| if d.lost > 0.0 { d.lost / d.pressure } else { 0.0 });
        let mean = |of: &dyn Fn(&Flattened) -> f64| {
            let all = depth[0] + depth[1];
            if all == 0.0 {
                return of(&Flattened::NONE);
            }
            (0..2).filter(|&i| depth[i] > 0.0).map(|i| depth[i] / all * of(&deepest[i])).sum()
        };
        let pressure = shear / even.shears();
        let unit = pressure / self.modulus;
        let lasting = now.map(|now| now.map_or(0.0, |now| now.lasting));
        let radius = self.radius(unit * even.bends(), lasting, &dents);
        let force = PI * radius * radius * pressure;
        let recovers = |d: &Flattened| {
            let eased = if d.pressure > 0.0 { shear / (d.pressure * d.shears()) } else { 1.0 };
            d.recovers() * eased.powf(3.0 / d.exponent() - 2.0)
        };
        let recovers = radius * unit * mean(&recovers);
        Pressed {
            press: Press { force, radius, evenness: even.evenness, curvature: unit * even.bends() / radius },
            recovers,
            stored: force * recovers / (1.0 + mean(&Flattened::exponent)),
            now,
            lost: [0, 1].map(|i| {
                let Some(now) = now[i] else { return 0.0 };
                // where a dent is wider than a virgin surface would be flattened it does not flow
                let flows = (now.lasting / dents[i].flattening(radius, now.lasting)).min(1.0);
                dents[i].lost.max(now.lost * (flows * radius).powi(3))
            }),
        }
    }

    /// Radius a of the contact in m where elastic surfaces are flattened by `bends`: a/R = bends + what the `dents` are flattened for good where
    /// virgin surfaces would be by `lasting`. Both sides are linear between the radii at which a dent begins to be filled, and is.
    fn radius(&self, bends: f64, lasting: [f64; 2], dents: &[Dent; 2]) -> f64 {
        let tip = self.hertz.tip_radius;
        let error = |a: f64| {
            a / tip - bends - dents[0].flattening(a, lasting[0]) - dents[1].flattening(a, lasting[1])
        };
        let filled = |i: usize| [lasting[i], dents[i].slope].map(|slope| slope / dents[i].curvature);
        let [[a, b], [c, d]] = [filled(0), filled(1)];
        let mut kinks = [a, b, c, d];
        kinks.sort_unstable_by(f64::total_cmp);
        let mut low = [0.0, error(0.0)];
        for a in kinks.into_iter().filter(|a| a.is_finite()) {
            let high = [a, error(a)];
            if high[1] >= 0.0 && a > low[0] {
                return low[0] - low[1] * (high[0] - low[0]) / (high[1] - low[1]);
            }
            low = high;
        }
        low[0] - low[1] * tip
    }

    /// Approach in m of the contact `at` the square `w` of the weaker surface's overload, beyond that at which the dents touch: by itself, since
    /// beside the depth of a dent a first touch is lost in rounding.
    fn approach(&self, w: f64, at: &Pressed) -> f64 {
        let YieldPoint { force, approach, energy, .. } = self.limit;
        if w <= self.limit.w {
            return at.recovers;
        }
        // of second order, as the steps are, and exact in energy
        approach + 2.0 * (at.energy() - energy) / (force + at.press.force)
    }

    /// Square of the overload of the weaker surface, if virgin, at the approach `x` in m of both, which is beyond that at which they touch.
    fn overload(&self, x: f64) -> f64 {
        let near = self.near[self.weaker];
        let x = x - self.depth();
        let approach = |w: f64| self.approach(w, &self.pressed(w));
        if let Some(found) = root_near(approach, x, near, 1.0) {
            return found;
        }
        let error = |w: f64| approach(w) - x;
        let mut ends = [0.9 * near, 1.1 * near];
        let mut values = ends.map(error);
        if values[0] > 0.0 {
            (ends, values) = ([0.0, ends[0]], [-x, values[0]]);
        }
        while values[1] < 0.0 {
            (ends, values) = ([ends[1], 2.0 * ends[1]], [values[1], error(2.0 * ends[1])]);
        }
        root(error, ends, values)
    }

    /// Force in N at the approach `x` in m from virgin surfaces, and its slope in N/m.
    pub fn force(&self, x: f64) -> [f64; 2] {
        let [force, slope, _] = self.answer(x);
        [force, slope]
    }

    /// Force in N at the approach `x` in m from virgin surfaces, its slope in N/m, and the work in J that the contact would have taken by
    /// then.
    pub fn answer(&self, x: f64) -> [f64; 3] {
        if x <= self.depth() {
            return [0.0, 0.0, self.dissipated];
        }
        let w = self.overload(x);
        let beyond = (1.0 + 1e-6) * w;
        let [at, next] = [w, beyond].map(|w| self.pressed(w));
        let approach = self.approach(beyond, &next) - self.approach(w, &at);
        let lost = if w > self.limit.w { self.deepens(&at).iter().sum() } else { 0.0 };
        [at.press.force, (next.press.force - at.press.force) / approach, self.dissipated + lost + at.stored]
    }

    /// What both dents dissipate further on the way to the contact `at`, J; never negative.
    fn deepens(&self, at: &Pressed) -> [f64; 2] {
        [0, 1].map(|i| at.lost[i] - self.surfaces[i].map_or(0.0, |s| s.dent.lost))
    }

    /// Ends a step at the approach `x` in m.
    pub fn advance(&mut self, x: f64) {
        (self.stored, self.press) = (0.0, Press::default());
        if x <= self.depth() {
            return;
        }
        let w = self.overload(x);
        let at = self.pressed(w);
        (self.stored, self.press) = (at.stored, at.press);
        self.near = [0, 1].map(|i| at.now[i].map_or(w, |now| now.approach).max(LEAST_NEAR));
        if w <= self.limit.w {
            return;
        }
        let deeper = x - at.recovers - self.depth();
        let lost = self.deepens(&at);
        let all = lost[0] + lost[1];
        self.dissipated += all;
        self.widest = self.widest.max(at.press.radius);
        for (i, surface) in self.surfaces.iter_mut().enumerate() {
            if let (Some(DentedSurface { dent, .. }), Some(now)) = (surface, at.now[i]) {
                dent.lost = at.lost[i];
                dent.depth += if all > 0.0 { deeper * lost[i] / all } else { 0.0 };
                dent.curvature = dent.flattening(at.press.radius, now.lasting) / at.press.radius;
                dent.slope = dent.slope.max(now.lasting);
                if now.approach > dent.deepest.approach.max(1.0) {
                    dent.deepest = now;
                }
            }
        }
        self.limit = YieldPoint { w, force: at.press.force, approach: at.recovers, energy: at.energy() };
    }
}

#[cfg(test)]
mod tests;
