//! Circular plate as an elastic layer: in closed form what [`super::continuum`] finds by finite elements.
//!
//! Kirchhoff's modes of the plate are cylindrical waves of the wave numbers xi_k = k/R. In an infinite layer of the
//! thickness t = 2 h a pressure of wave number xi on both faces moves the faces by
//!
//!   2 h/(E* x) 2 cosh^2 x/(sinh 2x - 2x) per unit in bending,  2 h/(E* x) 2 sinh^2 x/(sinh 2x + 2x) in squeezing,
//!   2 h/(E* x) on a half-space,  x = xi h, E* = E/(1 - nu^2)
//!
//! (I. N. Sneddon, Fourier Transforms, 1951, section 52). Bending is summed over the plate's waves and, beyond the modes,
//! integrated as on an infinite plate, as squeezing is everywhere: it does not reach as far as the rim. With the modes of
//! [`super::bending`] that is the continuum plate to three digits below the frequency at which the thickness shears; what is
//! lacking are longitudinal modes.

use super::ModalBody;
use super::bending::{self, BendingMode, under_patch};
use super::continuum::{ContinuumPlate, WEIGHTED};
use super::free_sphere::patch_transform;
use crate::analytical::circular_plate::{
    centre_deflection, deflection, frequency_parameters, rigidity, share_of_rim,
};
use crate::analytical::lamb_wave::FlexuralWave;
use crate::analytical::mindlin_plate::Section;
use crate::contact::{PatchTable, RADII, Tabulated};
use crate::numerics::quadrature::gauss_legendre;
use crate::numerics::vectors::axpy;
use crate::scene::{Edge, Plate};
use std::f64::consts::PI;

/// x = xi h beyond which a layer yields as a half-space does, to 1e-9.
const DEEP: f64 = 12.0;
/// Wave number times thickness up to which the layer yields as its flexural wave, but for a constant.
const LONG: f64 = 0.2;
/// Gauss points of a panel.
const POINTS: usize = 16;
/// Largest length of a panel in radii of the patch, and in half thicknesses.
const PANEL: f64 = 3.0;

/// Kirchhoff's modes of a plate in closed form.
#[derive(Debug, Clone, PartialEq)]
pub struct Waves {
    plate: Plate,
    /// k of each elastic mode, one more than there are modes.
    parameter: Vec<f64>,
    /// Mass-normalised deflection of the centre in each, kg^(-1/2).
    centre: Vec<f64>,
}

/// A wave number with its share in a flexibility.
struct WaveShare<W> {
    /// Between patches on the same face, without the half-space, in m/N.
    own: f64,
    /// Between patches on opposite faces, in m/N.
    mutual: f64,
    /// Transforms of the patches.
    weight: W,
}

impl Waves {
    /// The `modes` lowest elastic modes of `plate`, at most 200.
    pub fn new(plate: &Plate, modes: usize) -> Self {
        let parameter = frequency_parameters(plate.edge, plate.material.poisson_ratio, modes + 1);
        let mut waves = Self { plate: plate.clone(), parameter, centre: Vec::new() };
        let amplitude = waves.amplitude();
        waves.centre =
            waves.parameter.iter().map(|k| amplitude * centre_deflection(plate.edge, *k)).collect();
        waves
    }

    /// Number of elastic modes.
    pub fn modes(&self) -> usize {
        self.parameter.len() - 1
    }

    /// k half way between the last mode and the next.
    pub fn cut(&self) -> f64 {
        let modes = self.modes();
        0.5 * (self.parameter[modes - 1] + self.parameter[modes])
    }

    /// Frequency in rad/s of about mode number `n` as [`Waves::layer`] has it, from the asymptote k = n pi.
    pub fn frequency(&self, n: usize) -> f64 {
        let Plate { radius, thickness, material, .. } = &self.plate;
        Section::new(*thickness, material).lower_wave(n as f64 * PI / radius).0
    }

    /// Kirchhoff's plate with its `modes` lowest elastic modes, and before them the rigid motion of a free one.
    pub fn kirchhoff(&self, modes: usize) -> ModalBody {
        let plate = &self.plate;
        let bending = rigidity(plate.material.youngs_modulus, plate.material.poisson_ratio, plate.thickness);
        let speed = (bending / self.mass_per_area()).sqrt() / plate.radius.powi(2);
        let mut body = self.rigid();
        for (k, centre) in self.parameter.iter().zip(&self.centre).take(modes.min(self.modes())) {
            body.omega.push(k * k * speed);
            body.damping_ratio.push(plate.damping_ratio);
            body.participation.push([*centre; 2]);
        }
        body
    }

    /// Mass-normalised deflections at `radii` in m in the modes of [`Waves::kirchhoff`], kg^(-1/2). Shape (modes, radii).
    pub fn shapes(&self, modes: usize, radii: &[f64]) -> Vec<Vec<f64>> {
        let unit: Vec<f64> = radii.iter().map(|r| (r / self.plate.radius).min(1.0)).collect();
        let mut shapes = Vec::new();
        if self.plate.edge == Edge::Free {
            shapes.push(vec![1.0 / self.plate.mass().sqrt(); radii.len()]);
        }
        for &k in &self.parameter[..modes.min(self.modes())] {
            let shape = deflection(self.plate.edge, k, &unit);
            shapes.push(shape.into_iter().map(|w| w * self.amplitude()).collect());
        }
        shapes
    }

    /// The plate as an elastic layer, for contact patches of the radii `patch` in m (outer, inner face), with its elastic
    /// modes and the next one: [`bending::modes`], and beyond them waves of Kirchhoff's wave numbers.
    pub fn layer(&self, patch: [f64; 2]) -> ContinuumPlate {
        let plate = &self.plate;
        let mut modes = bending::modes(plate, self.parameter.len());
        modes.extend(self.parameter.iter().zip(&self.centre).skip(modes.len()).map(|(k, centre)| {
            let wave_number = k / plate.radius;
            let wave = FlexuralWave::new(wave_number, plate.thickness, &plate.material);
            BendingMode { wave_number, omega: wave.omega, centre: centre * wave.face, rim: [0.0; 2] }
        }));
        elastic_layer(plate, &modes, patch)
    }

    /// Static flexibility of the layer between patches of the radii `patch` in m, and how it changes with them.
    pub fn flexibility(&self, patch: [f64; 2]) -> PatchTable {
        let mut table = PatchTable::default();
        for share in self.shares(patch[0].max(patch[1]), tabulated(patch)) {
            table.add(share.own, share.mutual, share.weight);
        }
        table
    }

    /// Flexibility of the elastic layer in m/N between patches of the `radii` in m, the widest last: of each by its own force without the
    /// half-space, shape (n), and between any two on opposite faces, shape (n, n).
    pub(super) fn flexibilities(&self, radii: &[f64]) -> (Vec<f64>, Vec<Vec<f64>>) {
        let widest = radii.last().copied().unwrap_or(0.0);
        let (mut own, mut mutual) = (vec![0.0; radii.len()], vec![vec![0.0; radii.len()]; radii.len()]);
        let all = |of: &dyn Fn(f64) -> f64| radii.iter().map(|a| of(*a)).collect::<Vec<f64>>();
        for share in self.shares(widest, all) {
            for (i, weight) in share.weight.iter().enumerate() {
                own[i] += share.own * weight * weight;
                axpy(share.mutual * weight, &share.weight, &mut mutual[i]);
            }
        }
        (own, mutual)
    }

    /// Shares of all waves in the flexibilities between patches that are `widest` m wide at most, of which `weight` takes the radii in m to
    /// what they feel of a wave.
    fn shares<W>(&self, widest: f64, weight: impl Fn(&dyn Fn(f64) -> f64) -> W) -> Vec<WaveShare<W>> {
        let half = 0.5 * self.plate.thickness;
        let waves = self.parameter.iter().zip(&self.centre).take(self.modes());
        let mut shares: Vec<WaveShare<W>> = waves
            .map(|(k, centre)| {
                let xi = k / self.plate.radius;
                let bent = half_space(&self.plate, xi) * bending_ratio(xi * half);
                let bent = centre * centre * self.mass_per_area() * bent;
                let rim = [xi, share_of_rim(self.plate.edge, *k)];
                WaveShare { own: bent, mutual: bent, weight: weight(&|a| under_patch(xi, rim, a)) }
            })
            .collect();
        shares.extend(local(&self.plate, widest, self.cut() / self.plate.radius, weight, |_| 0.0));
        shares
    }

    /// The rigid motion of a free plate, or nothing.
    fn rigid(&self) -> ModalBody {
        let free = self.plate.edge == Edge::Free;
        ModalBody {
            omega: if free { vec![0.0] } else { Vec::new() },
            damping_ratio: if free { vec![0.0] } else { Vec::new() },
            participation: if free { vec![[1.0 / self.plate.mass().sqrt(); 2]] } else { Vec::new() },
            residual: None,
        }
    }

    fn mass_per_area(&self) -> f64 {
        self.plate.material.density * self.plate.thickness
    }

    /// Amplitude of a mass-normalised mode per that of a plate of unit radius and mass per area.
    fn amplitude(&self) -> f64 {
        1.0 / (self.plate.radius * self.mass_per_area().sqrt())
    }
}

/// `plate` as an elastic layer with all but the last of its bending `modes` and that as the next, for contact patches of the radii
/// `patch` in m (outer, inner face). It has no mesh: its number of degrees of freedom is 0.
pub fn elastic_layer(plate: &Plate, modes: &[BendingMode], patch: [f64; 2]) -> ContinuumPlate {
    let participation: Vec<_> =
        modes.iter().map(|mode| patch.map(|a| WEIGHTED.map(|r| mode.under(r * a)))).collect();
    let mut flexibility = PatchTable::default();
    let last = modes.len() - 1;
    for (mode, phi) in modes[..last].iter().zip(&participation) {
        let share = mode.omega.powi(-2);
        flexibility.add(share, share, phi.map(|phi| std::array::from_fn(|m| phi[m])));
    }
    let cut = 0.5 * (modes[last.saturating_sub(1)].wave_number + modes[last].wave_number);
    for share in local(plate, patch[0].max(patch[1]), cut, tabulated(patch), |xi| beyond_waves(plate, xi)) {
        flexibility.add(share.own, share.mutual, share.weight);
    }
    ContinuumPlate {
        omega: modes.iter().map(|mode| mode.omega).collect(),
        participation,
        flexibility,
        patch_radius: patch,
        free_mass: (plate.edge == Edge::Free).then(|| plate.mass()),
        damping_ratio: plate.damping_ratio,
        degrees_of_freedom: 0,
    }
}

/// What patches of [`RADII`] times the radii `patch` in m feel of a wave, given by what one of any radius does.
fn tabulated(patch: [f64; 2]) -> impl Fn(&dyn Fn(f64) -> f64) -> [Tabulated; 2] {
    move |of| patch.map(|a| RADII.map(|r| of(r * a)))
}

/// What the infinite layer bends under a pressure of the wave number `xi` beyond its flexural wave.
fn beyond_waves(plate: &Plate, xi: f64) -> f64 {
    let Plate { thickness, material, .. } = plate;
    // long waves are nearly all, and the rest hardly changes
    let xi = xi.max(LONG / thickness);
    let wave = FlexuralWave::new(xi, *thickness, material);
    let by_waves = (wave.face / wave.omega).powi(2) / (material.density * thickness);
    half_space(plate, xi) * bending_ratio(0.5 * xi * thickness) - by_waves
}

/// What a half-space of its material yields under a pressure of the wave number `xi`.
fn half_space(plate: &Plate, xi: f64) -> f64 {
    1.0 / (plate.material.plane_strain_modulus() * xi)
}

/// Shares of the waves of the infinite layer in the flexibilities between patches that are `widest` m wide at most, of which `weight`
/// takes the radii in m to what they feel of a wave; of its bending below the wave number `cut` only what `below` gives.
fn local<W>(
    plate: &Plate,
    widest: f64,
    cut: f64,
    weight: impl Fn(&dyn Fn(f64) -> f64) -> W,
    below: impl Fn(f64) -> f64,
) -> Vec<WaveShare<W>> {
    let half = 0.5 * plate.thickness;
    let mut shares = Vec::new();
    let rule = gauss_legendre(POINTS);
    let panel = PANEL * widest.recip().min(half.recip());
    let mut integrate = |from: f64, to: f64, continuous: bool| {
        let panels = ((to - from) / panel).ceil().max(0.0) as usize;
        let step = (to - from) / panels as f64;
        for p in 0..panels {
            for (x, w) in rule.0.iter().zip(&rule.1) {
                let xi = from + step * (p as f64 + 0.5 * (x + 1.0));
                let per = 0.5 * step * w * xi / (2.0 * PI);
                let half_space = half_space(plate, xi);
                let bent = if continuous { half_space * bending_ratio(xi * half) } else { below(xi) };
                let squeezed = half_space * squeezing_ratio(xi * half);
                shares.push(WaveShare {
                    own: per * (bent + squeezed - 2.0 * half_space),
                    mutual: per * (bent - squeezed),
                    weight: weight(&|a| patch_transform(xi * a)),
                });
            }
        }
    };
    integrate(0.0, cut, false);
    integrate(cut, DEEP / half, true);
    shares
}

/// Net flexibility of a layer in bending over that of a half-space, x = xi h.
fn bending_ratio(x: f64) -> f64 {
    if x > DEEP {
        return 1.0;
    }
    let y = 2.0 * x;
    let below = if y < 0.3 {
        y.powi(3) / 6.0 * (1.0 + y * y / 20.0 * (1.0 + y * y / 42.0 * (1.0 + y * y / 72.0)))
    } else {
        y.sinh() - y
    };
    2.0 * x.cosh().powi(2) / below
}

/// Net flexibility of a layer in squeezing over that of a half-space, x = xi h.
fn squeezing_ratio(x: f64) -> f64 {
    if x > DEEP {
        return 1.0;
    }
    2.0 * x.sinh().powi(2) / ((2.0 * x).sinh() + 2.0 * x)
}
