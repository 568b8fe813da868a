//! The rows of a series of impacts; the last one, its steady state, has the summary's own.

use super::discrepancy::{Discrepancy, Scales};
use crate::result::{Impact, Summary};
use crate::scene::{Tolerance, Tolerances};

/// What is compared of every impact that both sides have, as `impact_<number>_<name>`; `impact_<name>` bounds it for all of
/// them.
pub(super) fn rows(reference: &Summary, reduced: &Summary, tolerances: &Tolerances) -> Vec<Discrepancy> {
    let pairs = reference.impacts.iter().zip(&reduced.impacts);
    pairs.flat_map(|(theirs, ours)| of_impact(theirs, ours, tolerances)).collect()
}

fn of_impact<'a>(
    theirs: &'a Impact,
    ours: &'a Impact,
    tolerances: &'a Tolerances,
) -> impl Iterator<Item = Discrepancy> + 'a {
    Impact::COMPARED.iter().map(move |(name, unit)| {
        let value = theirs.value(name);
        let size = value.map_or(f64::NAN, f64::abs);
        Discrepancy::new(
            (&format!("impact_{}_{name}", theirs.number), unit),
            (ours.value(name), value),
            Scales { value: size, peak: size },
            bound(tolerances, name),
            theirs.band(name),
        )
    })
}

/// What `summary` says of the `quantity` called as in a comparison, which may be one of an impact.
pub fn value_in(summary: &Summary, quantity: &str) -> Option<f64> {
    let of_impact = || {
        let (number, name) = quantity.strip_prefix("impact_")?.split_once('_')?;
        let number: u64 = number.parse().ok()?;
        summary.impacts.iter().find(|impact| impact.number == number)?.value(name)
    };
    summary.value(quantity).or_else(of_impact)
}

fn bound<'a>(tolerances: &'a Tolerances, name: &str) -> Option<&'a Tolerance> {
    tolerances.get(&format!("impact_{name}"))
}

/// Whether a tolerance called `tolerance` bounds `row`, which may be one of an impact.
pub(super) fn bounds(tolerance: &str, row: &Discrepancy) -> bool {
    let of_impact = || {
        let name = tolerance.strip_prefix("impact_")?;
        row.quantity.strip_prefix("impact_")?.strip_suffix(name)?.strip_suffix('_')?.parse::<u64>().ok()
    };
    row.quantity == tolerance || of_impact().is_some()
}

#[cfg(test)]
mod tests {
    use super::{bounds, of_impact};
    use crate::comparison::Verdict;
    use crate::result::{Impact, Quantity, Table};
    use crate::scene::{Scene, Tolerance, Tolerances};

    fn impact(efficiency: f64, plastic_work: f64, locked_in_energy: Option<f64>) -> Impact {
        let quantity = Quantity {
            name: "efficiency",
            about: "Eq. (1) of this impact.",
            unit: "1",
            curve: None,
            is_count: false,
            value: Some(efficiency),
        };
        let band = |half: f64| locked_in_energy.map(|_| half);
        let known = [("efficiency", 0.001), ("plastic_work", 2e-6), ("locked_in_energy", 1e-6)];
        Impact {
            number: 2,
            quantities: Table::new(&[quantity]),
            plastic_work: Some(plastic_work),
            locked_in_energy,
            uncertainty: known
                .into_iter()
                .filter_map(|(n, half)| Some((n.to_owned(), band(half)?)))
                .collect(),
        }
    }

    #[test]
    fn every_impact_is_compared_with_the_reference_by_one_bound() {
        let bound = |width| Tolerance { relative: Some(width), ..Tolerance::default() };
        let (theirs, ours) = (impact(0.65, 5e-5, Some(5e-6)), impact(0.66, 5.4e-5, None));
        let verdict = |width| {
            let tolerances: Tolerances = [("impact_efficiency".to_owned(), bound(width))].into();
            of_impact(&theirs, &ours, &tolerances).collect::<Vec<_>>()
        };
        let rows = verdict(0.02);
        assert_eq!(rows[0].quantity, "impact_2_efficiency");
        assert_eq!((rows[0].verdict, rows[0].uncertainty), (Verdict::Pass, Some(0.001)));
        assert_eq!(verdict(0.01)[0].verdict, Verdict::Fail);
        // what the contacts keep: the model does not tell what is locked in
        let energy = &rows[3];
        assert_eq!(energy.quantity, "impact_2_kept_energy");
        assert!((energy.difference.unwrap() + 1e-6).abs() < 1e-12 && energy.uncertainty == Some(2e-6 + 1e-6));
        assert_eq!(rows[1].verdict, Verdict::NotGated, "a peak that neither side tells is no failure");
    }

    #[test]
    fn a_bound_of_impacts_belongs_to_their_rows_alone() {
        let none = Tolerances::new();
        let rows: Vec<_> = of_impact(&impact(0.6, 0.0, None), &impact(0.6, 0.0, None), &none).collect();
        assert!(bounds("impact_efficiency", &rows[0]));
        assert!(!bounds("efficiency", &rows[0]) && !bounds("impact_efficiency", &rows[1]));
    }

    #[test]
    fn scenes_may_bound_their_impacts() {
        let scene = |key: &str| {
            let text = include_str!("../../../scenes/examples/repeated-impacts.toml");
            Scene::parse("repeated-impacts", &format!("{text}\n[tolerances.C]\n{key} = 0.04\n"))
        };
        let tolerances = &scene("impact_efficiency").unwrap().tolerances;
        let bounds = &tolerances["C"];
        assert_eq!(bounds["impact_efficiency"].relative, Some(0.04));
        assert!(scene("impact_inner_contact_end").is_err());
    }
}
