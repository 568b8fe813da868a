//! Impacts in series on a scene's page: a row for each, and their course with the elastic value.

use crate::report_data::{Data, between};
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::reference::{Dents, FieldMesh};
use impactcheck::report::scene_page;
use impactcheck::result::{ElasticLimit, Limit};
use impactcheck::scene::{Model, Scene};

#[test]
fn every_impact_has_a_row_on_both_sides_and_the_elastic_value_a_line() {
    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/validation/repeated-r6.35.toml");
    let run = Reduced::new(&Scene::read(file).unwrap(), Model::B, None).unwrap().run(1e-4).unwrap();
    let elastic = run.elastic_efficiency.unwrap();
    assert!(run.impacts.len() > 3 && run.value("efficiency").unwrap() > elastic);
    let mut data = Data::new();
    assert!(!scene_page(&data.report().scenes[0]).contains("Number of the impact"));
    data.reference.summary.impacts = run.impacts.clone();
    data.reference.summary.impacts[1].uncertainty.insert("efficiency".into(), 0.0021);
    data.reduced[1].summary.impacts = run.impacts[..3].to_vec();
    data.reduced[1].summary.elastic_efficiency = Some(elastic);
    let page = scene_page(&data.report().scenes[0]);
    let table = between(&page, "<table class=\"impacts\">", "</table>");
    let rows: Vec<&str> = between(table, "<tbody>", "</tbody>").split("<tr>").skip(1).collect();
    assert_eq!(rows.len(), run.impacts.len());
    let percent = |k: usize| format!("{:.2}", 100.0 * run.impacts[k].value("efficiency").unwrap());
    assert!(rows[0].matches(&percent(0)).count() == 2, "{}", rows[0]);
    assert!(rows[1].contains(&format!("{} ± 0.21 %", percent(1))), "{}", rows[1]);
    // where a model has stopped
    assert!(rows[3].contains(&percent(3)) && rows[3].contains('–'), "{}", rows[3]);
    assert!(page.contains("Number of the impact") && page.contains("model B, elastic"));
}

#[test]
fn dents_of_the_first_impacts_and_the_last_are_drawn_with_the_plastic_strain() {
    let data = Data::new();
    let mut report = data.report();
    let scene = &mut report.scenes[0];
    assert!(!scene_page(scene).contains("id=\"dents\""));
    let dents = |impact: u64| Dents {
        impact,
        radius: vec![0.0, 1e-4, 2e-4],
        heights: [1.0, 2.0, 3.0, 4.0].map(|depth| vec![-1e-6 * depth * impact as f64, 0.0, 1e-8]),
    };
    scene.attachments.dents = (1..=6).map(dents).collect();
    let section = |page: &str| between(page, "<section id=\"dents\">", "</section>").to_owned();
    let page = section(&scene_page(scene));
    let named: Vec<bool> = (1..=6).map(|k| page.contains(&format!("after impact {k}<"))).collect();
    assert_eq!(named, [true, true, true, false, false, true]);
    assert!(page.contains("Plate, inner face in µm") && !page.contains("<image"), "{page}");
    scene.provenance["settings"]["contact_zone"] = 1e-3.into();
    scene.attachments.mesh = Some(FieldMesh {
        points: vec![[0.0, -1e-3], [5e-3, -1e-3], [5e-3, 1e-3], [0.0, 1e-3]],
        quads: vec![[0, 1, 2, 3]],
        bodies: vec![1],
        von_mises: None,
        plastic_strain: Some(vec![0.04]),
    });
    let page = section(&scene_page(scene));
    assert_eq!(page.matches("<image").count(), 2);
    // the scale ends at 4 %
    let label = "plastic strain in %";
    assert!(page.contains(label) && between(&page, "strain-0-scale", label).contains(">4<"), "{page}");
}

#[test]
fn the_elastic_limit_of_a_model_stands_in_its_range_of_validity() {
    let mut data = Data::new();
    let limit = Limit { measure: "outer_shear_strain".into(), value: 0.01, bound: 0.02 };
    data.reduced[1].summary.limits = vec![limit];
    assert!(scene_page(&data.report().scenes[0]).contains("Elastic limit not checked"));
    data.reduced[1].summary.elastic_limit = Some(ElasticLimit { outer: Some(0.0123), inner: None });
    let page = scene_page(&data.report().scenes[0]);
    let sentence = "nothing yields in the outer contact up to 12.3 mm/s, in the inner one at no speed found";
    assert!(
        page.contains(sentence) && !page.contains("Elastic limit not checked"),
        "{}",
        between(&page, "Elastic limit", "</p>")
    );
}
