//! The exporters: all formats tell the same numbers, and each is well-formed.

use crate::report_data::{Data, between};
use crate::synthetic_impact;
use crate::synthetic_impact::reduced_of;
use impactcheck::comparison::{GateRules, Verdict};
use impactcheck::kinds::plate_impact::CURVES;
use impactcheck::kinds::plate_impact::PlateQuantities;
use impactcheck::report::{
    Report, Theme, Width, curves_csv, figure, index_page, json, junit, markdown, scene_page, terminal,
};
use resvg::usvg::roxmltree::Document;
use serde_json::Value;

/// Model B is off by more than its tolerance.
fn failing() -> Data {
    let mut b = synthetic_impact::REDUCED;
    b.outer.peak *= 1.03;
    Data { reduced: vec![reduced_of(&b, "B")], ..Data::new() }
}

fn document(report: &Report) -> Value {
    serde_json::from_str(&json(report).unwrap()).unwrap()
}

/// A number as shown, in SI; `None` for a dash.
fn shown(text: &str) -> Option<f64> {
    let text = text.replace('−', "-");
    let (number, unit) = text.split_once(' ').unwrap_or((&text, ""));
    let factor = match unit {
        "µs" | "µm" => 1e-6,
        "ms" | "mm" | "mm/s" | "mN" => 1e-3,
        "kHz" => 1e3,
        "%" => 1e-2,
        "" | "s" | "m" | "m/s" | "N" | "Hz" => 1.0,
        other => panic!("unit {other}"),
    };
    number.parse::<f64>().ok().map(|n| n * factor)
}

#[test]
fn numbers_of_the_page_are_those_of_the_json() {
    let data = Data::new();
    let report = data.report();
    let (page, json) = (scene_page(&report.scenes[0]), document(&report));
    let mut compared = 0;
    for model in json["scenes"][0]["models"].as_array().unwrap() {
        let name = model["model"].as_str().unwrap();
        let start = format!("<table class=\"discrepancies\" data-model=\"{name}\">");
        let table = between(&page, &start, "</table>");
        for row in model["discrepancies"].as_array().unwrap() {
            let quantity = row["quantity"].as_str().unwrap();
            let cells = between(table, &format!("data-quantity=\"{quantity}\">"), "</tr>");
            for field in
                ["reduced", "reference", "difference", "relative", "uncertainty", "tolerance", "bias"]
            {
                let cell = between(cells, &format!("data-field=\"{field}\" "), "</td>");
                let si = between(cell, "data-si=\"", "\"");
                assert_eq!(si.parse::<f64>().ok(), row[field].as_f64(), "{name} {quantity} {field}");
                let text = &cell[cell.find('>').unwrap() + 1..];
                match row[field].as_f64() {
                    None => assert_eq!(text, "–"),
                    Some(_) if text.contains("10⁴") => {}
                    Some(value) => {
                        let found = shown(text).unwrap();
                        // Two digits at least; per cents have two decimals, one from 10 % on.
                        let decimals = if value.abs() < 0.1 { 5.1e-5 } else { 5.1e-4 };
                        let rounding = if field == "relative" { decimals } else { 0.05 * value.abs() };
                        assert!((found - value).abs() <= rounding, "{quantity} {field}: {text} for {value}");
                    }
                }
                compared += 1;
            }
            let badge = match row["verdict"].as_str().unwrap() {
                "not_gated" => "not gated".to_owned(),
                verdict => format!("<span class=\"verdict {verdict}\">{verdict}</span>"),
            };
            assert!(cells.contains(&badge));
        }
        let table = between(&page, &format!("<table class=\"curves\" data-model=\"{name}\">"), "</table>");
        for curve in model["curves"].as_array().unwrap() {
            let quantity = curve["quantity"].as_str().unwrap();
            let cells = between(table, &format!("data-quantity=\"{quantity}\">"), "</tr>");
            for field in ["sprague_geers", "russell", "iso18571", "iso18571_slope"] {
                let cell = between(cells, &format!("data-field=\"{field}\" "), "</td>");
                assert_eq!(between(cell, "data-si=\"", "\"").parse().ok(), curve[field].as_f64());
            }
            assert!(cells.contains(curve["grade"].as_str().unwrap()));
        }
    }
    assert_eq!(compared, 2 * 7 * (PlateQuantities::ALL.len() + 2 * CURVES.len() + 2));
}

/// Also what scripts and styles could load.
#[test]
fn pages_load_nothing_and_show_verdict_and_command() {
    let data = failing();
    let report = data.report();
    for page in [index_page(&report), scene_page(&report.scenes[0])] {
        assert!(!page.contains("<link") && !page.contains("src="));
        for loading in ["@import", "url(", "fetch(", "XMLHttpRequest", "import(", "WebSocket"] {
            assert!(!page.contains(loading), "{loading}");
        }
        let loads = page.matches("http").count() - page.matches("http://www.w3.org/2000/svg").count();
        assert_eq!(loads, 0);
        assert!(page.contains("<span class=\"verdict fail\">fail</span>"));
    }
    assert!(scene_page(&report.scenes[0]).contains("impactcheck compare synthetic --models A,B"));
}

#[test]
fn junit_counts_a_case_per_model_and_quantity_and_its_failures() {
    let data = failing();
    let report = data.report();
    let xml = junit(&report).unwrap();
    assert_eq!(xml, junit(&report).unwrap());
    let parsed = quick_junit::Report::deserialize_from_str(&xml).unwrap();
    assert_eq!(parsed.test_suites.len(), 1);
    let suite = &parsed.test_suites[0];
    let comparison = &report.scenes[0].comparison;
    let model = &comparison.models[0];
    let rows = model.discrepancies.iter().map(|d| d.verdict);
    let checks = comparison.integrity.iter().chain(&model.integrity).map(|c| c.verdict);
    let verdicts: Vec<Verdict> = rows.chain(checks).collect();
    let failed = verdicts.iter().filter(|v| v.failed()).count();
    assert!(failed >= 2);
    assert_eq!((suite.tests, suite.failures), (verdicts.len(), failed));
    let xml = Document::parse(&xml).unwrap();
    let case = |name: &str| xml.descendants().find(|n| n.attribute("name") == Some(name)).unwrap();
    for quantity in PlateQuantities::ALL.iter().map(|quantity| quantity.name) {
        assert_eq!(case(quantity).attribute("classname"), Some("synthetic.B"));
    }
    let failure = case("outer_force_peak").children().find(|n| n.has_tag_name("failure")).unwrap();
    let message = failure.attribute("message").unwrap();
    for number in ["245.1 N", "243.0 N", "tolerance ±1.22 N"] {
        assert!(message.contains(number), "{message}");
    }
    assert!(xml.descendants().all(|n| n.attribute("timestamp").is_none() && n.attribute("time").is_none()));
}

#[test]
fn markdown_has_all_quantities_and_curves() {
    let data = Data::new();
    let text = markdown(&data.report());
    let sections: Vec<_> = text.split("\n### Model ").skip(1).collect();
    assert!(sections[0].starts_with("A, 16 modes: ") && sections[1].starts_with("B, 16 modes: pass"));
    for section in sections {
        for name in [
            "efficiency",
            "outer velocity, final",
            "inner force, peak",
            "outer contact, end",
            "first frequency",
        ] {
            assert_eq!(section.matches(&format!("| {name} |")).count(), 1, "{name}");
        }
        let table = section.lines().filter(|l| l.starts_with("| ")).count();
        // Two headings, the quantities, two rows and one line of metrics per curve, two residuals.
        assert_eq!(table, 2 + PlateQuantities::ALL.len() + 3 * CURVES.len() + 2);
        assert!(section.lines().filter(|l| l.starts_with('|')).all(|l| l.ends_with('|')));
    }
}

#[test]
fn csv_holds_every_curve_on_the_common_axis() {
    let data = Data::new();
    let report = data.report();
    let text = curves_csv(&report.scenes[0]).unwrap();
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let headers = reader.headers().unwrap().clone();
    assert_eq!(headers.len(), 1 + 3 * CURVES.len());
    let rows: Vec<_> = reader.records().map(|r| r.unwrap()).collect();
    let window = report.scenes[0].comparison.window.unwrap();
    assert_eq!(rows.len(), window.samples);
    let aligned = &report.scenes[0].comparison.models[1].aligned;
    for curve in ["outer_force", "inner_velocity"] {
        let column = headers.iter().position(|h| h == format!("B_{curve}")).unwrap();
        let expected = &aligned.iter().find(|a| a.quantity == curve).unwrap().reduced;
        for k in [0, 300, 1500] {
            let found: f64 = rows[k][column].parse().unwrap();
            assert!((found - expected[k]).abs() <= 1e-6 * expected[k].abs());
        }
    }
    // The plate is not known beyond the end of the reduced history.
    let plate = headers.iter().position(|h| h == "B_plate_velocity").unwrap();
    assert!(!rows[0][plate].is_empty() && rows[1500][plate].is_empty());
}

#[test]
fn names_with_markup_are_escaped() {
    let mut data = Data::new();
    data.scene.name = "a<b>&\"c\"".into();
    data.scene.description = "</p><script>alert(1)</script> & | *x*".into();
    let report = data.report();
    for page in [index_page(&report), scene_page(&report.scenes[0])] {
        assert!(!page.contains("a<b>") && !page.contains("<script>"));
        assert!(page.contains("a&lt;b&gt;&amp;"));
    }
    Document::parse(&figure(&report.scenes[0], Theme::Standalone)).unwrap();
    let xml = junit(&report).unwrap();
    let parsed = quick_junit::Report::deserialize_from_str(&xml).unwrap();
    assert_eq!(parsed.test_suites[0].name.as_str(), "a<b>&\"c\"");
    assert!(!markdown(&report).contains("<script>"));
}

#[test]
fn terminal_has_a_line_per_model_and_lists_what_failed() {
    let data = Data::new();
    let text = terminal(&data.report(), Width::Narrow);
    assert_eq!(text.lines().filter(|l| l.trim_start().starts_with("reference ")).count(), 1);
    assert!(
        text.lines().any(|l| l.trim_start().starts_with("B ") && l.contains("  \u{1b}[1m\u{1b}[32mpass"))
    );
    assert!(text.contains("180.0 µs") && text.contains("243.0 N"));
    let text = terminal(&failing().report(), Width::Narrow);
    assert!(text.lines().any(|l| l.trim_start().starts_with("B: outer_force_peak: model 245.1 N")));
}

/// A damaged reference is reported, not drawn, and nothing panics.
#[test]
fn damaged_history_still_gives_a_report() {
    let mut data = Data::new();
    data.reference.history["inner_force"][40] = f64::NAN;
    let report = data.report();
    let svg = figure(&report.scenes[0], Theme::Standalone);
    Document::parse(&svg).unwrap();
    assert!(!svg.contains("NaN") && svg.contains("damaged"));
    assert!(scene_page(&report.scenes[0]).contains("contradicts itself"));
    assert_eq!(document(&report)["verdict"], "fail");
    assert_eq!(curves_csv(&report.scenes[0]).unwrap().lines().count(), 1);
    assert!(markdown(&report).contains("not finite: found 1, expected 0; difference 1, allowed ±0"));
}

#[test]
fn junit_cases_carry_their_figures() {
    let data = Data::new();
    let report = data.report();
    let xml = junit(&report).unwrap();
    let xml = Document::parse(&xml).unwrap();
    let mut compared = 0;
    for model in &report.scenes[0].comparison.models {
        for row in &model.discrepancies {
            let class = format!("synthetic.{}", model.model);
            let is_case = |n: &resvg::usvg::roxmltree::Node| {
                n.attribute("classname") == Some(&class) && n.attribute("name") == Some(&row.quantity)
            };
            let case = xml.descendants().find(is_case).unwrap();
            let property = |name: &str| {
                let found = case
                    .descendants()
                    .find(|n| n.attribute("name") == Some(name) && n.has_tag_name("property"));
                found.map(|n| n.attribute("value").unwrap().to_owned())
            };
            assert_eq!(property("unit"), Some(row.unit.clone()));
            for (name, value) in [
                ("reduced", row.reduced),
                ("reference", row.reference),
                ("tolerance", row.tolerance),
                ("tolerance_used", row.used()),
            ] {
                let value = value.filter(|v| v.is_finite());
                assert_eq!(
                    property(name).map(|v| v.parse::<f64>().unwrap()),
                    value,
                    "{} {name}",
                    row.quantity
                );
                compared += 1;
            }
        }
    }
    assert!(compared > 100);
}

/// A comment on GitHub holds 65 536 characters: as many scenes as there may be have their verdicts in it, and the worst their tables.
#[test]
fn the_document_of_many_scenes_fits_into_a_comment() {
    let data = Data::new();
    let one = data.report().scenes.remove(0);
    let many = |count: usize| {
        let scenes = (0..count).map(|k| {
            let mut scene = one.clone();
            scene.comparison.scene = format!("plate-{k:03}");
            // one fails, far behind
            scene.comparison.verdict = if k == count - 2 { Verdict::Fail } else { Verdict::Pass };
            scene
        });
        markdown(&Report { scenes: scenes.collect(), rules: GateRules::default() })
    };
    let tables = |text: &str| text.matches("| quantity | reduced |").count();
    for count in [1, 6, 47, 400] {
        let text = many(count);
        assert!(text.chars().count() < 65_536 - 2_000, "{count}: {}", text.chars().count());
        let listed = (0..count).filter(|k| text.contains(&format!("| plate-{k:03} |"))).count();
        let omitted = text.contains(&format!("{} more scenes", count - listed));
        assert!(listed == count || (count == 400 && omitted), "{listed} of {count}");
        if count > 1 {
            let failed = format!("\n## plate-{:03}: fail\n", count - 2);
            let (_, after) = text.split_once(&failed).expect("the one that fails is there");
            assert!(after.split("\n## ").next().is_some_and(|section| tables(section) == 2), "{count}");
        }
    }
    assert_eq!(tables(&many(2)), 4, "what fits is there");
    let text = many(47);
    assert!(tables(&text) >= 2 && text.contains("Its tables are on [its page](plate-044.html)."));
}
