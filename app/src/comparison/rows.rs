//! The rows of a comparison: quantities, impacts of a series, landing, curves and residuals of one model against the reference.

use super::discrepancy::{Discrepancy, Scales};
use super::{impacts, landing};
use crate::curves::{AlignedCurve, peak};
use crate::kinds::{self, Kind};
use crate::result::{Curve, FlightSummary, Outcome, Quantity, Source, Summary};
use crate::scene::{Scene, Tolerances};

/// All rows of `reduced` against `reference`, whose launch flies as `flight` says; `aligned` holds the curves of both.
pub(super) fn rows(
    scene: &Scene,
    (reference, flight): (&Outcome, Option<&FlightSummary>),
    reduced: &Outcome,
    aligned: &[AlignedCurve],
    tolerances: &Tolerances,
) -> Vec<Discrepancy> {
    let kind = kinds::of(scene);
    let (m, c) = (&reference.summary, &reduced.summary);
    let mut rows = quantities(kind, reference, c, tolerances);
    rows.extend(motion(m, c));
    rows.extend(impacts::rows(m, c, tolerances));
    rows.extend(landing::row([flight, c.flight.as_ref()], tolerances));
    let curves: Vec<Curve> = kind.curves().iter().filter(|c| kind.has(scene, c.name)).cloned().collect();
    rows.extend(curve_distances(&curves, [reference, reduced], aligned, tolerances));
    rows.extend(residuals(m, c, tolerances));
    rows
}

/// The rows of the summary's quantities.
fn quantities(
    kind: &dyn Kind,
    reference: &Outcome,
    reduced: &Summary,
    tolerances: &Tolerances,
) -> Vec<Discrepancy> {
    let row = |&Quantity { name, unit, curve, .. }: &Quantity| {
        let value = reference.summary.value(name);
        let size = value.map_or(f64::NAN, f64::abs);
        // a quantity that belongs to no curve is its own peak
        let peak = curve.and_then(|curve| reference.history.curve(curve)).map_or(size, peak);
        // another program's result need not state it
        let is_open = value.is_none() && reference.summary.source == Source::External;
        let tolerance = tolerances.get(name);
        let row = Discrepancy::new(
            (name, unit),
            (reduced.value(name), value),
            Scales { value: size, peak },
            tolerance.filter(|_| !is_open),
            reference.summary.band(name),
        );
        if is_open && tolerance.is_some() { row.undecided() } else { row }
    };
    kind.quantities().iter().map(row).collect()
}

/// The rows of the motion along the surfaces, if both sides have it; relative to the largest velocity and spin of the reference.
fn motion(reference: &Summary, reduced: &Summary) -> Vec<Discrepancy> {
    if reduced.motion().next().is_none() {
        return Vec::new();
    }
    let row = |(name, value, unit): (&'static str, f64, &'static str)| {
        let of_unit = reference.motion().filter(|row| row.2 == unit);
        let scale = of_unit.map(|row| row.1.abs()).fold(0.0, f64::max);
        let own = reduced.motion().find(|row| row.0 == name).map(|row| row.1);
        let scales = Scales { value: scale, peak: scale };
        Discrepancy::new((name, unit), (own, Some(value)), scales, None, reference.band(name))
    };
    reference.motion().map(row).collect()
}

/// The rows of root mean square and largest distance of every curve; NaN where it can't be measured, undetermined where
/// another program does not give the curve.
fn curve_distances(
    curves: &[Curve],
    sides: [&Outcome; 2],
    aligned: &[AlignedCurve],
    tolerances: &Tolerances,
) -> Vec<Discrepancy> {
    let mut rows = Vec::new();
    for Curve { name, unit, .. } in curves {
        let found = aligned.iter().find(|a| a.quantity == *name);
        let peak = found.map_or(f64::NAN, AlignedCurve::peak);
        let is_undetermined =
            |side: &Outcome| side.summary.source == Source::External && side.history.curve(name).is_none();
        let is_given = !sides.into_iter().any(is_undetermined);
        let is_judged = !is_undetermined(sides[0]);
        let distances = [
            ("rms", found.map_or(f64::NAN, AlignedCurve::rms)),
            ("max", found.map_or(f64::NAN, AlignedCurve::largest_difference)),
        ];
        for (kind, distance) in distances {
            let quantity = format!("{name}_{kind}");
            let tolerance = tolerances.get(&quantity);
            let row = Discrepancy::new(
                (&quantity, unit),
                (Some(distance).filter(|_| is_given), Some(0.0).filter(|_| is_judged)),
                Scales { value: peak, peak },
                tolerance.filter(|_| is_judged),
                sides[0].summary.band(&quantity),
            );
            rows.push(if !is_judged && tolerance.is_some() { row.undecided() } else { row });
        }
    }
    rows
}

/// The rows of the conservation residuals.
fn residuals(m: &Summary, c: &Summary, tolerances: &Tolerances) -> [Discrepancy; 2] {
    let row = |quantity, reduced, reference| {
        Discrepancy::of_residual(quantity, (reduced, reference), tolerances.get(quantity))
    };
    [
        row("energy_residual", c.energy_residual, m.energy_residual),
        row("momentum_residual", c.momentum_residual, m.momentum_residual),
    ]
}
