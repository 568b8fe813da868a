//! The first screen of a scene's page: what it says is what was computed, drawn where and as large as it is.

use crate::report_data::{Data, between};
use impactcheck::comparison::Discrepancy;
use impactcheck::report::{Width, scene_page, terminal};
use impactcheck::scene::Edge;
use resvg::usvg::roxmltree::{Document, Node};

/// The part of a page that is well-formed XML by itself.
fn part<'a>(page: &'a str, start: &str, end: &str) -> String {
    let text: &'a str = between(page, start, end);
    format!("{start}{text}{end}").replace(" hidden>", ">")
}

fn classed<'a>(xml: &'a Document, class: &str) -> Vec<Node<'a, 'a>> {
    let has = |n: &Node| n.attribute("class").is_some_and(|c| c.split(' ').any(|one| one == class));
    xml.descendants().filter(has).collect()
}

#[test]
fn every_mark_stands_where_its_discrepancy_is() {
    let data = Data::new();
    let report = data.report();
    let comparison = &report.scenes[0].comparison;
    let page = scene_page(&report.scenes[0]);
    let mut seen = 0;
    for (k, ending) in ["", "_rms"].into_iter().enumerate() {
        let start = "<table class=\"discrepancy-picture\"";
        let text = page.split(start).nth(1 + k).unwrap().split("</table>").next().unwrap();
        let table = format!("{start}{text}</table>");
        let xml = Document::parse(&table).unwrap();
        let number = |name: &str| xml.root_element().attribute(name).unwrap().parse::<f64>().unwrap();
        let (linear, limit) = (number("data-linear"), number("data-limit"));
        for row in xml.descendants().filter(|n| n.attribute("data-quantity").is_some()) {
            let quantity = row.attribute("data-quantity").unwrap();
            assert!(quantity.ends_with(ending));
            let place = |v: f64| (1.0 + v.abs() / linear).ln().copysign(v) / (1.0 + limit / linear).ln();
            let place = |v: f64| 100.0 * if k == 0 { 0.5 + 0.5 * place(v) } else { place(v).max(0.0) };
            for mark in row.descendants().filter(|n| n.attribute("data-si").is_some()) {
                let model = comparison.models.iter().find(|m| mark.attribute("data-model") == Some(&m.model));
                let relative = model.unwrap().discrepancy(quantity).unwrap().relative.unwrap();
                assert_eq!(mark.attribute("data-si").unwrap().parse(), Ok(relative), "{quantity}");
                let x: f64 = mark.attribute("x").unwrap().trim_end_matches('%').parse().unwrap();
                assert!((x - place(relative)).abs() < 1e-3, "{quantity}: {x} for {relative}");
                seen += 1;
            }
            // the tolerance's bar reaches as far as the tolerance
            for (bar, model) in row
                .descendants()
                .filter(|n| n.attribute("class").is_some_and(|c| c.starts_with("fig-tolerance")))
                .zip(
                    comparison
                        .models
                        .iter()
                        .filter(|m| m.discrepancy(quantity).is_some_and(|d| d.tolerance.is_some())),
                )
            {
                let d = model.discrepancy(quantity).unwrap();
                let end = (d.bias.unwrap_or(0.0) + d.tolerance.unwrap()) / d.scale().unwrap();
                let of =
                    |name: &str| bar.attribute(name).unwrap().trim_end_matches('%').parse::<f64>().unwrap();
                assert!((of("x") + of("width") - place(end).min(100.0)).abs() < 0.31, "{quantity}");
            }
        }
    }
    let is_shown = |d: &&Discrepancy| {
        let counted = ["outer_contacts", "inner_contacts"].contains(&&*d.quantity);
        d.relative.is_some() && !counted && !d.is_residual() && !d.quantity.ends_with("_max")
    };
    let all: usize = comparison.models.iter().map(|m| m.discrepancies.iter().filter(is_shown).count()).sum();
    assert_eq!(seen, all);
}

#[test]
fn the_scene_is_drawn_to_scale_with_its_numbers() {
    let mut data = Data::new();
    let mut setup = data.scene.plate_impact().unwrap().clone();
    setup.inner.gap = 4e-3;
    setup.plate.edge = Edge::SimplySupported;
    let (plate, outer, inner) = (setup.plate.clone(), setup.outer.clone(), setup.inner.clone());
    data.scene.setup = setup.into();
    let report = data.report();
    let page = scene_page(&report.scenes[0]);
    let figure = part(&page, "<figure class=\"scene\">", "</figure>");
    let xml = Document::parse(&figure).unwrap();
    let number = |n: &Node, name: &str| n.attribute(name).unwrap().parse::<f64>().unwrap();
    let [disc, above, below] = ["plate", "outer", "inner"].map(|class| classed(&xml, class)[0]);
    let scale = number(&disc, "width") / (2.0 * plate.radius);
    for (sphere, shape) in [(above, &outer.shape), (below, &inner.shape)] {
        assert!((number(&sphere, "r") / scale / shape.tip_radius() - 1.0).abs() < 1e-3);
    }
    assert!((number(&disc, "height") / scale / plate.thickness - 1.0).abs() < 1e-2);
    // the outer sphere touches the plate, the inner one is as far from it as the scene says
    let (top, height) = (number(&disc, "y"), number(&disc, "height"));
    let distance = number(&above, "cy") + number(&above, "r") - top;
    let gap = number(&below, "cy") - number(&below, "r") - top - height;
    assert!(distance.abs() < 0.1 && (gap / scale - 4e-3).abs() < 1e-4, "{distance} {gap}");
    for fact in ["radius 33 mm", "thickness 2 mm", "simply supported", "550 mm/s", "gap 4 mm", "E 210 GPa"] {
        assert!(figure.contains(fact), "{fact}");
    }
}

#[test]
fn the_answer_is_the_terminals_and_no_better_than_the_discrepancies() {
    let data = Data::new();
    let report = data.report();
    let (page, printed) = (scene_page(&report.scenes[0]), terminal(&report, Width::Wide));
    let table = part(&page, "<table class=\"short\">", "</table>");
    let xml = Document::parse(&table).unwrap();
    let mut compared = 0;
    for cell in xml.descendants().filter(|n| n.attribute("data-field").is_some()) {
        let texts: Vec<&str> =
            cell.descendants().filter(Node::is_text).filter_map(|n| n.text()).map(str::trim).collect();
        let texts: Vec<&str> = texts.into_iter().filter(|t| !t.is_empty()).collect();
        let expected = if let [value, off] = texts[..] { format!("{value} ({off})") } else { texts.concat() };
        assert!(printed.contains(&expected), "{expected}: {printed}");
        compared += 1;
    }
    assert_eq!(compared, 5 * 3);
    for model in &report.scenes[0].comparison.models {
        let sentence = between(&page, &format!("<li data-model=\"{}\">", model.model), "</li>");
        let of = |group: &str| {
            let stated = sentence.split(&format!("{group} ")).nth(1).unwrap().split(" %").next().unwrap();
            stated.split(' ').next_back().unwrap().parse::<f64>().unwrap()
        };
        let worst = |names: &[&str]| {
            let sizes = names.iter().map(|n| 100.0 * model.discrepancy(n).unwrap().relative.unwrap().abs());
            sizes.fold(0.0, f64::max)
        };
        for (group, names) in [
            ("efficiency", &["efficiency"][..]),
            ("peak force", &["outer_force_peak", "inner_force_peak"]),
            ("end of contact", &["outer_contact_end", "inner_contact_end"]),
        ] {
            let (stated, found) = (of(group), worst(names));
            assert!(stated >= found && stated <= 1.11 * found + 1e-9, "{group}: {stated} for {found}");
        }
    }
    // what nothing computed backs is not said
    assert!(!page.contains("assumptions hold"));
}

/// A reference of displacements alone has none of the columns: the models have their results for all that.
#[test]
fn a_reference_without_values_is_no_model_without_a_result() {
    let mut data = Data::new();
    data.reference.summary.quantities = data.reference.summary.quantities.clone().cut();
    let printed = terminal(&data.report(), Width::Wide);
    for model in ["A", "B"] {
        let said =
            format!("Model {model} is not compared: the reference has no value for its main quantities.");
        assert!(printed.contains(&said), "{printed}");
    }
}
