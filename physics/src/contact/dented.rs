//! Two surfaces in contact of which at least one yields, each with the dent that stays in it.
//!
//! Both bear one pressure over one circle, and what each loses of its curvature adds up to that of the tip: a/R = sum a/rho. An elastic
//! surface gives way under a pressure as a yielding one comes back from it; so where only one of them yields it takes the more of the
//! flattening the more it yields. With equal materials this is the law of Jackson and Green for the pair.

use super::Hertz;
use super::elastic_plastic::{ElasticPlastic, Flattened};
use crate::material::Material;
use crate::numerics::quadrature::gauss_legendre;
use crate::numerics::root::{root, root_near};
use std::f64::consts::PI;

/// Gauss points of the work of a step.
const WORK_POINTS: usize = 2;

/// Critical approaches at least from which those of the next step are looked for.
const LEAST_NEAR: f64 = 1e-3;

/// What a surface has been through.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dent {
    /// Where it was flattened furthest.
    deepest: Flattened,
    /// Curvature that it has lost for good, 1/m.
    curvature: f64,
    /// Depth in m.
    depth: f64,
}

impl Dent {
    const NONE: Dent = Dent { deepest: Flattened::NONE, curvature: 0.0, depth: 0.0 };
}

#[derive(Debug, Clone, Copy, PartialEq)]
struct Surface {
    law: ElasticPlastic,
    dent: Dent,
}

/// The contact of a tip and a flat, body and plate.
#[derive(Debug, Clone, Copy)]
pub struct DentedContact {
    hertz: Hertz,
    /// E* in Pa.
    modulus: f64,
    /// Of body and plate; `None`: elastic. Which of them yields first.
    surfaces: [Option<Surface>; 2],
    weaker: usize,
    /// Approach at the end of the last step, m, critical approaches of both surfaces there, and the work done on the contact so far, J.
    last: f64,
    near: [f64; 2],
    taken: f64,
}

/// The contact at a pressure.
struct Pressed {
    /// In N; approach beyond that at which the dents touch, and radius in m.
    force: f64,
    approach: f64,
    radius: f64,
    /// The surfaces as they would be if virgin.
    now: [Option<Flattened>; 2],
    /// Depths of the dents, m.
    depths: [f64; 2],
}

/// Which of `surfaces` yields first.
fn weaker(surfaces: &[Option<Surface>; 2]) -> usize {
    let onset = surfaces.map(|s| s.map_or(f64::INFINITY, |s| s.law.onset_pressure()));
    usize::from(onset[1] < onset[0])
}

impl DentedContact {
    /// The contact `hertz` of a body and the plate, of the materials `pair`; a material yields at `yield_strength` in Pa of its own.
    /// `None` if neither does.
    pub fn new(hertz: Hertz, pair: [&Material; 2], yield_strength: [Option<f64>; 2]) -> Option<Self> {
        let modulus = 1.0 / pair.iter().map(|m| 1.0 / m.plane_strain_modulus()).sum::<f64>();
        let surfaces = [0, 1].map(|i| {
            let law = |y| ElasticPlastic::new(pair[i].plane_strain_modulus(), y, pair[i].poisson_ratio);
            yield_strength[i].map(|y| Surface { law: law(y), dent: Dent::NONE })
        });
        let weaker = weaker(&surfaces);
        surfaces[weaker]?;
        Some(Self { hertz, modulus, surfaces, weaker, last: 0.0, near: [1.0; 2], taken: 0.0 })
    }

    /// The same if virgin, on a plate that is pulled along its face by `stress` Pa; a contact with dents stays as they were made.
    #[must_use]
    pub fn on_a_pulled_plate(mut self, stress: f64) -> Self {
        if let (true, Some(plate)) = (self.is_virgin(), &mut self.surfaces[1]) {
            plate.law = plate.law.pulled(stress);
            self.weaker = weaker(&self.surfaces);
        }
        self
    }

    /// Whether nothing has yielded yet.
    pub fn is_virgin(&self) -> bool {
        self.depth() == 0.0
    }

    /// Force in N up to which the contact is elastic while virgin.
    pub fn critical_force(&self) -> f64 {
        self.hertz.force(self.critical_approach())
    }

    /// x_c = (3 pi p/(4 E*))^2 R with the mean pressure p at the onset, m.
    pub fn critical_approach(&self) -> f64 {
        let pressure = self.weaker_law().onset_pressure();
        (0.75 * PI * pressure / self.modulus).powi(2) * self.hertz.tip_radius
    }

    /// Approach in m at which the dented surfaces touch.
    pub fn depth(&self) -> f64 {
        self.surfaces.iter().flatten().map(|s| s.dent.depth).sum()
    }

    /// Work in J done on the contact so far: what it stores and what it has lost.
    pub fn taken(&self) -> f64 {
        self.taken
    }

    /// The same with a fresh spot of the body.
    #[must_use]
    pub fn on_a_fresh_spot(mut self) -> Self {
        if let Some(body) = &mut self.surfaces[0] {
            body.dent = Dent::NONE;
        }
        self.last = self.depth();
        self
    }

    fn weaker_law(&self) -> &ElasticPlastic {
        let weaker = self.surfaces[self.weaker].as_ref();
        &weaker.expect("`new` sees that one yields").law
    }

    /// The contact where the weaker surface, if virgin, would have come by `w` critical approaches.
    fn pressed(&self, w: f64) -> Pressed {
        let of_weaker = self.weaker_law().flattened(w);
        let shear = of_weaker.pressure * of_weaker.shears();
        let now = [0, 1].map(|i| {
            let law = &self.surfaces[i].as_ref()?.law;
            let is_weaker = i == self.weaker || law == self.weaker_law();
            Some(if is_weaker { of_weaker } else { law.sheared(shear, w, self.near[i]) })
        });
        let dents = self.surfaces.map(|s| s.map_or(Dent::NONE, |s| s.dent));
        // how even the pressure is: as each dent has made it, by their depths
        let deepest = [0, 1].map(|i| {
            let now = now[i].unwrap_or(Flattened::NONE);
            if now.approach > dents[i].deepest.approach { now } else { dents[i].deepest }
        });
        let stays = deepest[0].stays + deepest[1].stays;
        let mean = |of: &dyn Fn(&Flattened) -> f64| {
            if stays == 0.0 {
                return of(&Flattened::NONE);
            }
            deepest.iter().filter(|d| d.stays > 0.0).map(|d| d.stays / stays * of(d)).sum()
        };
        let pressure = shear / mean(&Flattened::shears);
        let unit = pressure / self.modulus;
        let bends = unit * mean(&Flattened::bends);
        let lasting = now.map(|now| now.map_or(0.0, |now| now.lasting));
        // a/R = what is elastic + sum max(a kappa, lasting): from below by Newton's method, which ends after as many steps as there are dents
        let (mut flowing, mut left) = (bends + lasting[0] + lasting[1], 1.0 / self.hertz.tip_radius);
        let mut resting = [false; 2];
        let radius = loop {
            let radius = flowing / left;
            let rests = |i: &usize| !resting[*i] && radius * dents[*i].curvature > lasting[*i];
            let Some(i) = (0..2).find(rests) else { break radius };
            resting[i] = true;
            (flowing, left) = (flowing - lasting[i], left - dents[i].curvature);
        };
        let depths = [0, 1].map(|i| dents[i].depth.max(radius * now[i].map_or(0.0, |now| now.stays)));
        let recovers = |d: &Flattened| {
            let eased = if d.pressure > 0.0 { shear / (d.pressure * d.shears()) } else { 1.0 };
            d.recovers * eased.powf(3.0 / d.exponent - 2.0)
        };
        Pressed {
            force: PI * radius * radius * pressure,
            // each by itself: beside the depth of a dent a first touch is lost in rounding
            approach: radius * unit * mean(&recovers)
                + (depths[0] - dents[0].depth)
                + (depths[1] - dents[1].depth),
            radius,
            now,
            depths,
        }
    }

    /// Critical approaches of the weaker surface, if virgin, at the approach `x` in m of both, which is beyond that at which they touch.
    fn critical_approaches(&self, x: f64) -> f64 {
        let near = self.near[self.weaker];
        let x = x - self.depth();
        if let Some(found) = root_near(|w| self.pressed(w).approach, x, near, 1.0) {
            return found;
        }
        let error = |w: f64| self.pressed(w).approach - x;
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
        if x <= self.depth() {
            return [0.0; 2];
        }
        let w = self.critical_approaches(x);
        let [at, beyond] = [w, (1.0 + 1e-6) * w].map(|w| self.pressed(w));
        [at.force, (beyond.force - at.force) / (beyond.approach - at.approach)]
    }

    /// Ends a step at the approach `x` in m.
    pub fn advance(&mut self, x: f64) {
        let [from, to] = [self.last, x].map(|x| x.max(self.depth()));
        self.last = x;
        if from == to {
            return;
        }
        let (points, weights) = gauss_legendre(WORK_POINTS);
        let [middle, half] = [0.5 * (from + to), 0.5 * (to - from)];
        let force = |p: &f64| self.pressed(self.critical_approaches(middle + half * p)).force;
        self.taken += half * points.iter().zip(weights).map(|(p, w)| w * force(p)).sum::<f64>();
        if x <= self.depth() {
            return;
        }
        let w = self.critical_approaches(x);
        let Pressed { radius, now, depths, .. } = self.pressed(w);
        self.near = [0, 1].map(|i| now[i].map_or(w, |now| now.approach).max(LEAST_NEAR));
        for (i, surface) in self.surfaces.iter_mut().enumerate() {
            if let (Some(Surface { dent, .. }), Some(now)) = (surface, now[i]) {
                dent.depth = depths[i];
                dent.curvature = dent.curvature.max(now.lasting / radius);
                if now.approach > dent.deepest.approach.max(1.0) {
                    dent.deepest = now;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    fn steel(factor: f64) -> Material {
        Material::elastic("steel", factor * 210e9, 0.3, 7780.0)
    }

    /// A tip of 10 mm and a flat of steel; `factors` of their stiffness.
    fn pair(tip_radius: f64, factors: [f64; 2], yield_strength: [Option<f64>; 2]) -> DentedContact {
        let [body, plate] = factors.map(steel);
        let hertz = Hertz::new(tip_radius, &body, &plate);
        DentedContact::new(hertz, [&body, &plate], yield_strength).unwrap()
    }

    /// Jackson and Green's eqs. (16) to (23) as they stand there, of a sphere on a rigid flat: force in N at `w` critical approaches.
    fn jackson_and_green(radius: f64, modulus: f64, strength: f64, w: f64) -> f64 {
        let factor = 1.295 * (0.736_f64 * 0.3).exp();
        let critical = (0.5 * PI * factor * strength / modulus).powi(2) * radius;
        let critical_force = 4.0 / 3.0 * (radius / modulus).powi(2) * (0.5 * PI * factor * strength).powi(3);
        let contact =
            (radius * w * critical * (w / 1.9).powf(0.14 * (23.0 * strength / modulus).exp())).sqrt();
        let hardness = 2.84 * strength * (1.0 - (-0.82 * (contact / radius).powf(-0.7)).exp());
        critical_force
            * ((-0.25 * w.powf(5.0 / 12.0)).exp() * w.powf(1.5)
                + 4.0 * hardness / (factor * strength) * (1.0 - (-w.powf(5.0 / 9.0) / 25.0).exp()) * w)
    }

    const STRENGTH: f64 = 600e6;

    #[test]
    fn on_a_rigid_flat_it_is_the_law_of_jackson_and_green() {
        for yields in [[Some(STRENGTH), None], [None, Some(STRENGTH)]] {
            let factors = yields.map(|y| if y.is_some() { 1.0 } else { 1e9 });
            let contact = pair(0.01, factors, yields);
            for w in [3.0, 10.0, 40.0, 100.0] {
                let force = contact.force(w * contact.critical_approach())[0];
                let expected = jackson_and_green(0.01, 210e9 / 0.91, STRENGTH, w);
                assert_relative_eq!(force, expected, max_relative = 1e-6);
            }
        }
    }

    /// Two equal surfaces meet in a plane, which is a rigid flat to each: half the approach, twice the radius.
    #[test]
    fn equal_surfaces_are_mirror_images() {
        let mut both = pair(0.01, [1.0; 2], [Some(STRENGTH); 2]);
        let mut one = pair(0.02, [1.0, 1e9], [Some(STRENGTH), None]);
        for x in [0.5e-6, 4e-6, 9e-6, 7e-6, 11e-6, 8e-6] {
            assert_relative_eq!(both.force(x)[0], one.force(0.5 * x)[0], max_relative = 1e-6);
            both.advance(x);
            one.advance(0.5 * x);
            assert_relative_eq!(both.depth(), 2.0 * one.depth(), max_relative = 1e-6);
        }
    }

    /// Unlike moduli and yield strengths: continuous where either surface begins to yield, and Hertz's law before.
    #[test]
    fn loading_is_hertz_s_law_and_then_softer() {
        for strengths in
            [[None, Some(3e8)], [Some(4e8), Some(3e8)], [Some(3e8), Some(3.001e8)], [Some(9e8), Some(3e8)]]
        {
            let contact = pair(0.01, [1.0, 0.4], strengths);
            let critical = contact.critical_approach();
            let mut before = [0.0; 2];
            for k in 1..6000 {
                let x = 0.02 * f64::from(k) * critical;
                let [force, slope] = contact.force(x);
                let elastic = contact.hertz.force(x);
                if x < critical {
                    assert_relative_eq!(force, elastic, max_relative = 1e-9);
                }
                assert!(force > before[0] && force < 1.03 * elastic && slope > 0.0, "{strengths:?} {k}");
                assert!(
                    force - before[0] < 2.0 * 0.02 * critical * contact.hertz.tangent(x),
                    "{strengths:?} {k}"
                );
                before = [force, slope];
            }
        }
    }

    /// Beside the depth of a dent the first touch after it is below the rounding of the approach; the force begins as a power all the same.
    #[test]
    fn a_dent_is_touched_gently() {
        let mut contact = pair(0.01, [1.0; 2], [None, Some(1e8)]);
        contact.advance(300.0 * contact.critical_approach());
        contact.advance(0.0);
        let depth = contact.depth();
        let mut before = 0.0;
        for k in 0..40 {
            let x = depth + 1e-20 * 2.0_f64.powi(k) * (depth / 1e-5);
            let [force, slope] = contact.force(x);
            assert!(
                force >= before && slope.is_finite() && (x == depth || slope > 0.0),
                "{k}: {force} {slope}"
            );
            before = force;
        }
    }

    /// Let go and pressed again it is elastic, F = F_m ((x - x_r)/(x_m - x_r))^n (Etsion, Kligerman & Kadin 2005, eqs. 13 and 15), whichever
    /// surface yields.
    #[test]
    fn a_dent_is_elastic_up_to_the_force_that_made_it() {
        for strengths in [[Some(STRENGTH); 2], [None, Some(STRENGTH)], [Some(STRENGTH), None]] {
            let mut contact = pair(0.01, [1.0; 2], strengths);
            let x_m = 30.0 * contact.critical_approach();
            let [f_m, _] = contact.force(x_m);
            contact.advance(x_m);
            let (x_r, taken) = (contact.depth(), contact.taken());
            assert!(x_r > 0.2 * x_m && x_r < 0.7 * x_m);
            let exponent =
                1.5 * contact.surfaces.iter().flatten().next().unwrap().dent.deepest.approach.powf(-0.0331);
            for share in [0.1, 0.5, 0.9, 0.999] {
                let [force, slope] = contact.force(x_r + share * (x_m - x_r));
                assert_relative_eq!(force, f_m * share.powf(exponent), max_relative = 1e-6);
                assert_relative_eq!(slope, exponent * force / (share * (x_m - x_r)), max_relative = 1e-4);
            }
            assert_eq!(contact.force(x_r), [0.0; 2]);
            let mut again = contact;
            for x in [x_r, x_m, 0.5 * (x_r + x_m), x_r] {
                again.advance(x);
            }
            assert_relative_eq!(again.depth(), x_r, max_relative = 1e-9);
            // what it gives back is less than what it took
            assert!(again.taken() < 0.8 * taken && again.taken() > 0.1 * taken);
            again.advance(1.1 * x_m);
            assert!(again.depth() > x_r);
        }
    }

    /// The contact after a `force` in N.
    fn after(contact: &DentedContact, force: f64) -> DentedContact {
        let error = |x: f64| contact.force(x)[0] - force;
        let ends = [contact.depth(), contact.depth() + 1000.0 * contact.critical_approach()];
        let mut contact = *contact;
        contact.advance(root(error, ends, ends.map(error)));
        contact
    }

    /// At first either surface bears half; once the pressure is that of a hardness test (Johnson 1985, section 6.3) it forms what yields
    /// alone.
    #[test]
    fn where_one_surface_yields_it_takes_most_of_the_dent_in_the_end() {
        let both = pair(0.01, [1.0; 2], [Some(STRENGTH); 2]);
        let one = pair(0.01, [1.0; 2], [None, Some(STRENGTH)]);
        let share = |load: f64| {
            let [one, both] =
                [&one, &both].map(|contact| after(contact, load * both.critical_force()).depth());
            one / both
        };
        assert_relative_eq!(share(1.2), 0.5, epsilon = 0.1);
        for load in [10.0, 50.0, 300.0] {
            assert!(share(load) > 0.8 && share(load) < 1.0, "{}", share(load));
        }
    }

    /// A fresh spot of the body keeps the plate's dent, which spreads the force: the body yields less than against a virgin plate. A body that
    /// has not yielded is as fresh as ever.
    #[test]
    fn a_fresh_spot_keeps_the_other_dent() {
        let virgin = pair(0.01, [1.0; 2], [Some(STRENGTH); 2]);
        let force = 100.0 * virgin.critical_force();
        let dented = after(&virgin, force);
        let fresh = dented.on_a_fresh_spot();
        assert_relative_eq!(fresh.depth(), 0.5 * dented.depth(), max_relative = 1e-9);
        let [again, first] =
            [&fresh, &virgin].map(|contact| after(contact, 0.3 * force).surfaces[0].unwrap().dent.depth);
        assert!(again < 0.9 * first && again > 0.1 * first, "{again} {first}");
        let soft = after(&pair(0.01, [1.0; 2], [Some(4.0 * STRENGTH), Some(STRENGTH)]), force);
        assert_eq!(soft.on_a_fresh_spot().depth(), soft.depth());
        let x = soft.depth() + soft.critical_approach();
        assert_eq!(soft.on_a_fresh_spot().force(x), soft.force(x));
    }
}
