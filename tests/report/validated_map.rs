//! The map of validated scenes: every mark stands where its scene lies, and the sentence says what the map shows.

use crate::report_data::between;
use impactcheck::comparison::compare_scene;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::reference::{Lookup, Resolution, Store};
use impactcheck::report::{Attachments, Report, SceneReport, index_page, markdown, scene_page};
use impactcheck::scene::{Model, Scene, resolve};
use impactcheck::validated::{Place, Validation, shipped};
use resvg::usvg::roxmltree::{Document, Node};

/// The page of the paper's first scene among the scenes `known`, its index, its Markdown and where it lies.
fn pages(known: Vec<Validation>) -> ([String; 3], Place) {
    let scene = Scene::read(resolve("scaled-plate-r10").unwrap()).unwrap();
    let Lookup::Found(stored) = Store::shipped().unwrap().find(&scene, Resolution::Paper) else {
        panic!("stored")
    };
    let reduced = [Model::B, Model::C]
        .map(|model| Reduced::new(&scene, model, None).unwrap().run_with_history(1e-7).unwrap());
    let report = SceneReport {
        scene: &scene,
        comparison: compare_scene(&scene, &stored.outcome, &reduced),
        reference: &stored.outcome,
        reduced: &reduced,
        provenance: serde_json::Value::Null,
        command: String::new(),
        attachments: Attachments { validated: known.into(), ..Attachments::default() },
    };
    let page = scene_page(&report);
    let place = Place::of(&scene, &stored.outcome.summary).unwrap();
    let report = Report { scenes: vec![report], rules: Default::default() };
    ([page, index_page(&report), markdown(&report)], place)
}

/// What the project knows of plates.
fn known() -> Vec<Validation> {
    shipped().unwrap().into_iter().filter(|v| v.place.is_some()).collect()
}

fn number(node: &Node, name: &str) -> f64 {
    node.attribute(name).unwrap().parse().unwrap()
}

fn classed<'a>(node: Node<'a, 'a>, class: &'a str) -> impl Iterator<Item = Node<'a, 'a>> {
    node.descendants()
        .filter(move |n| n.attribute("class").is_some_and(|c| c.split(' ').any(|one| one == class)))
}

/// The place in px of a value on the axis whose grid lines have a varying coordinate `name`, from two of its labels.
fn axis(view: Node, name: &str) -> impl Fn(f64) -> f64 {
    let across = name == "x";
    let lines = classed(view, "fig-grid").filter(|l| (l.attribute("x1") == l.attribute("x2")) == across);
    let places: Vec<f64> = lines.map(|line| number(&line, &format!("{name}1"))).collect();
    let anchor = if across { "middle" } else { "end" };
    let labels =
        view.descendants().filter(|t| t.has_tag_name("text") && t.attribute("text-anchor") == Some(anchor));
    let values: Vec<f64> = labels.filter_map(|t| t.text()?.parse().ok()).collect();
    assert!(places.len() >= 2 && places.len() == values.len(), "{values:?}");
    let last = places.len() - 1;
    let decade = (places[last] - places[0]) / (values[last] / values[0]).log10();
    move |value| places[0] + decade * (value / values[0]).log10()
}

#[test]
fn every_mark_stands_where_its_scene_lies() {
    let known = known();
    let ([page, index, text], here) = pages(known.clone());
    let map = between(&page, "<div class=\"map\">", "</div>");
    let map = format!("<div>{map}</div>");
    let xml = Document::parse(&map).unwrap();
    let views: Vec<Node> = xml.root_element().children().filter(Node::is_element).collect();
    assert_eq!(views.len(), 4);
    for (view, (model, measure)) in views.into_iter().zip([("B", 1), ("B", 2), ("C", 1), ("C", 2)]) {
        let (x, y) = (axis(view, "x"), axis(view, "y"));
        let expected = |place: &Place| [x(place.measures()[0]), y(place.measures()[measure])];
        let near = |found: [f64; 2], place: &Place| {
            found.iter().zip(expected(place)).all(|(found, expected)| (found - expected).abs() < 0.02)
        };
        let marks: Vec<Node> = view.descendants().filter(|n| n.has_attribute("data-scene")).collect();
        let own: Vec<&Validation> = known.iter().filter(|v| v.model == model && v.place.is_some()).collect();
        assert_eq!(marks.len(), own.len());
        for (mark, validation) in marks.into_iter().zip(own) {
            assert_eq!(mark.attribute("data-scene"), Some(&*validation.scene));
            let moved = mark.attribute("transform").unwrap();
            let moved = moved.trim_start_matches("translate(").trim_end_matches(')');
            let (left, down) = moved.split_once(' ').unwrap();
            let found = [left, down].map(|text| text.parse().unwrap());
            assert!(near(found, &validation.place.unwrap()), "{model} {}: {found:?}", validation.scene);
            // the mark tells by shape and colour how far off the model is
            let off = number(&mark, "data-off").abs();
            let decisive = validation
                .rows
                .iter()
                .filter(|r| r.quantity == "efficiency" || r.quantity.ends_with("_peak"));
            assert_eq!(off, decisive.map(|r| r.relative().abs()).fold(0.0, f64::max));
            let (size, shape) = match off {
                o if o <= 0.01 => ("size-small", "circle"),
                o if o <= 0.05 => ("size-medium", "path"),
                _ => ("size-large", "path"),
            };
            assert!(classed(mark, size).any(|n| n.has_tag_name(shape)), "{model} {}", validation.scene);
        }
        let ring = classed(view, "here").next().unwrap();
        assert!(near([number(&ring, "cx"), number(&ring, "cy")], &here));
        let frame = classed(view, "fig-frame").find(|n| n.has_attribute("stroke-dasharray")).unwrap();
        let ends = [number(&frame, "x"), number(&frame, "x") + number(&frame, "width")];
        for (end, factor) in ends.into_iter().zip([0.5, 2.0]) {
            assert!((end - x(factor * here.measures()[0])).abs() < 0.02);
        }
    }
    // the index has the map too, without a scene of its own
    assert!(index.contains("<div class=\"map\">") && !index.contains("fig-frame here"));
    assert!(text.contains("](validated.svg)"));
}

/// What other scenes let expect holds what the reference finds.
#[test]
fn the_sentence_predicts_what_the_reference_finds() {
    let ([page, ..], _) = pages(known());
    let errors = |model: &str| {
        let stated = between(&page, &format!("<li data-model=\"{model}\">"), "</li>");
        let (_, predicted) =
            stated.split_once("predicted by other scenes (95 %): efficiency within ").unwrap();
        let (efficiency, rest) = predicted.split_once(" %, force peaks within ").unwrap();
        [efficiency, rest.split_once(" %").unwrap().0].map(|text| text.parse::<f64>().unwrap())
    };
    // the reference: B is 0.20 % off in the efficiency and up to 11 % in force peaks, C 0.02 and 0.18 %
    let ([b, b_peaks], [c, c_peaks]) = (errors("B"), errors("C"));
    assert!((0.2..0.5).contains(&b) && (11.0..16.0).contains(&b_peaks), "{b} {b_peaks}");
    assert!((0.02..0.3).contains(&c) && (0.18..3.0).contains(&c_peaks), "{c} {c_peaks}");
}
