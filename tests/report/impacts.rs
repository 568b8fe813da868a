//! Impacts in series on a scene's page: a row for each, and their course with the elastic value.

use crate::report_data::{Data, between};
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::report::scene_page;
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
