//! Whether the bands that a reference states follow from the series of meshes that it states too.
//!
//! The rule is that of `fem_reference/common/uncertainty.py`: values on meshes of the size h over the finest one's are fitted by
//! v + c h^1.5 (least squares, weighted with h^-2); the band is the distance to v and 2.5 of its standard errors.

use crate::numerics::least_squares::{Fit, fit};
use crate::result::Summary;
use serde::Deserialize;
use std::collections::BTreeMap;

/// Power of the element size with which errors fall.
pub const ORDER: f64 = 1.5;
/// Power with which the values scatter.
const SCATTER_ORDER: f64 = 2.0;
/// Standard errors in a band, beside the error fitted.
pub const STANDARD_ERRORS: f64 = 2.5;
/// Meshes that a fit with its scatter needs.
const LEAST_MESHES: usize = 4;
/// Relative difference of two computations of one band.
const ROUNDING: f64 = 1e-6;

/// A summary's `convergence`, as far as it is looked at.
#[derive(Deserialize)]
struct Series {
    meshes: Vec<SeriesMesh>,
    quantities: BTreeMap<String, SeriesValues>,
}

#[derive(Deserialize)]
struct SeriesMesh {
    /// On the number of elements along a length; the finest first.
    factor: f64,
    energy_residual: f64,
    steps: u64,
}

#[derive(Deserialize)]
struct SeriesValues {
    values: Vec<f64>,
}

/// Number of values, bands, residuals and steps of `summary` that its series contradicts; `None` without a series. One that can't be
/// read contradicts itself.
pub(super) fn contradictions(summary: &Summary) -> Option<usize> {
    let stated = summary.convergence.as_ref()?;
    let Ok(Series { meshes, quantities }) = Series::deserialize(stated) else { return Some(1) };
    let sizes: Vec<f64> = meshes.iter().map(|mesh| meshes[0].factor / mesh.factor).collect();
    // curves have bands without values on the other meshes
    let of_curve = |name: &str| name.ends_with("_rms") || name.ends_with("_max");
    let unfounded = |name: &&String| !of_curve(name) && !quantities.contains_key(*name);
    let unfounded = summary.uncertainty.keys().filter(unfounded).count();
    let measured =
        summary.quantities.iter().filter(|quantity| !quantity.is_count && quantity.value.is_some());
    let without_series = measured.filter(|quantity| !quantities.contains_key(quantity.name)).count();
    let contradicts = |(name, series): &(&String, &SeriesValues)| {
        let values = &series.values;
        values.len() < LEAST_MESHES
            || values.len() != sizes.len()
            || summary.value(name).is_some_and(|value| value != values[0])
            || !summary.band(name).is_some_and(|stated| agree(stated, band(values, &sizes)))
    };
    let run = |finest: &SeriesMesh| (Some(finest.energy_residual), Some(finest.steps));
    let run_differs = meshes.first().map(run) != Some((summary.energy_residual, summary.steps));
    let contradicting = quantities.iter().filter(contradicts).count();
    Some(unfounded + without_series + contradicting + usize::from(run_differs))
}

fn agree(a: f64, b: f64) -> bool {
    (a - b).abs() <= ROUNDING * a.abs().max(b.abs())
}

/// A quantity on the meshes of a reference, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshValues {
    /// Element size over that of the finest mesh, and the value there. Shape (meshes).
    pub values: Vec<(f64, f64)>,
    /// v and c of the fit v + c h^1.5.
    pub fit: [f64; 2],
    /// Half width of the 95 % band about the value on the finest mesh.
    pub band: f64,
}

/// The quantities of `summary` on its meshes, by name; empty without a series that can be read.
pub fn mesh_values(summary: &Summary) -> BTreeMap<String, MeshValues> {
    let series = summary.convergence.as_ref().map(Series::deserialize);
    let Some(Ok(Series { meshes, quantities })) = series else { return BTreeMap::new() };
    let sizes: Vec<f64> = meshes.iter().map(|mesh| meshes[0].factor / mesh.factor).collect();
    let of = |(name, SeriesValues { values }): (String, SeriesValues)| {
        if values.len() != sizes.len() || values.len() < LEAST_MESHES {
            return None;
        }
        let line = fitted(&values, &sizes)?;
        let [limit, slope] = line.coefficients;
        let fit = [values[0] + limit, slope];
        let band = band(&values, &sizes);
        Some((name, MeshValues { values: sizes.iter().copied().zip(values).collect(), fit, band }))
    };
    quantities.into_iter().filter_map(of).collect()
}

/// Half width of the 95 % band about `values[0]` from the `values` on meshes of the `sizes`; infinite if they tell none.
fn band(values: &[f64], sizes: &[f64]) -> f64 {
    fitted(values, sizes)
        .map_or(f64::INFINITY, |line| line.coefficients[0].abs() + STANDARD_ERRORS * line.errors[0])
}

/// The differences of the `values` to the first one.
fn fitted(values: &[f64], sizes: &[f64]) -> Option<Fit<2>> {
    let rows: Vec<([f64; 2], f64)> = values
        .iter()
        .zip(sizes)
        .map(|(value, h)| {
            let weight = h.powf(-SCATTER_ORDER);
            ([weight, weight * h.powf(ORDER)], weight * (value - values[0]))
        })
        .collect();
    fit(&rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// As `fem_reference` computed it, of `scaled-plate-r10`.
    #[test]
    fn the_band_of_a_stored_efficiency_is_found_again() {
        let sizes: Vec<f64> = (0..5).map(|k| 0.84_f64.powi(-k)).collect();
        let values = [
            0.6946664858039147,
            0.6947185842803126,
            0.6947881168407569,
            0.6948457518628599,
            0.6949945758902547,
        ];
        assert_relative_eq!(band(&values, &sizes), 1.972_612_123_794_128_4e-4, max_relative = 1e-9);
    }

    #[test]
    fn a_line_has_its_end_and_no_deviation() {
        let sizes: Vec<f64> = (0..5).map(|k| 1.19_f64.powi(k)).collect();
        let values: Vec<f64> = sizes.iter().map(|h| 2.0 + 0.01 * h.powf(ORDER)).collect();
        assert_relative_eq!(band(&values, &sizes), 0.01, max_relative = 1e-9);
        let mut perturbed = values.clone();
        perturbed[2] += 1e-3;
        assert!(band(&perturbed, &sizes) > 0.011);
    }
}
