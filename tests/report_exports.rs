//! The exporters: all formats tell the same numbers, and each is well-formed.

mod synthetic_impact;

use impactcheck::comparison::{Verdict, compare_scene};
use impactcheck::impact::{CURVES, Outcome, PLATE_QUANTITIES};
use impactcheck::report::{
    Attachments, Report, SceneReport, Theme, curves_csv, figure, index_page, json, junit, markdown, png,
    scene_page, terminal,
};
use impactcheck::scene::Scene;
use resvg::usvg::roxmltree::Document;
use serde_json::Value;
use synthetic_impact::{gated_scene, reduced, reduced_of, reference};

/// Owns what a report refers to.
struct Data {
    scene: Scene,
    reference: Outcome,
    reduced: Vec<Outcome>,
}

impl Data {
    fn new() -> Self {
        let mut a = synthetic_impact::REDUCED;
        a.inner.peak *= 0.7;
        Data { scene: gated_scene(), reference: reference(), reduced: vec![reduced_of(&a, "A"), reduced()] }
    }

    /// Model B is off by more than its tolerance.
    fn failing() -> Self {
        let mut b = synthetic_impact::REDUCED;
        b.outer.peak *= 1.03;
        Data { reduced: vec![reduced_of(&b, "B")], ..Data::new() }
    }

    fn report(&self) -> Report<'_> {
        Report {
            scenes: vec![SceneReport {
                scene: &self.scene,
                comparison: compare_scene(&self.scene, &self.reference, &self.reduced),
                reference: &self.reference,
                reduced: &self.reduced,
                provenance: serde_json::json!({"created": "2026-01-01T00:00:00Z", "settings": {"courant": 0.9}}),
                command: "impactcheck compare synthetic --models A,B".into(),
                attachments: Attachments::default(),
            }],
            seats: Vec::new(),
        }
    }
}

fn document(report: &Report) -> Value {
    serde_json::from_str(&json(report).unwrap()).unwrap()
}

/// The text between `start` and the next `end`.
fn between<'a>(text: &'a str, start: &str, end: &str) -> &'a str {
    let from = text.find(start).unwrap_or_else(|| panic!("no {start}")) + start.len();
    &text[from..from + text[from..].find(end).unwrap()]
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
                "pass" if row["tolerance"].is_null() => "not gated".to_owned(),
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
    assert_eq!(compared, 2 * 7 * (PLATE_QUANTITIES.len() + 2 * CURVES.len() + 2));
}

#[test]
fn pages_load_nothing_and_show_verdict_and_command() {
    let data = Data::failing();
    let report = data.report();
    for page in [index_page(&report), scene_page(&report.scenes[0])] {
        assert!(!page.contains("<script") && !page.contains("<link") && !page.contains("src="));
        let loads = page.matches("http").count() - page.matches("http://www.w3.org/2000/svg").count();
        assert_eq!(loads, 0);
        assert!(page.contains("<span class=\"verdict fail\">fail</span>"));
    }
    assert!(scene_page(&report.scenes[0]).contains("impactcheck compare synthetic --models A,B"));
}

#[test]
fn junit_counts_a_case_per_model_and_quantity_and_its_failures() {
    let data = Data::failing();
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
    let failed = verdicts.iter().filter(|v| !v.passed()).count();
    assert!(failed >= 2);
    assert_eq!((suite.tests, suite.failures), (verdicts.len(), failed));
    let xml = Document::parse(&xml).unwrap();
    let case = |name: &str| xml.descendants().find(|n| n.attribute("name") == Some(name)).unwrap();
    for (quantity, _) in PLATE_QUANTITIES {
        assert_eq!(case(quantity).attribute("classname"), Some("synthetic.B"));
    }
    let failure = case("outer_force_peak").first_element_child().unwrap();
    let message = failure.attribute("message").unwrap();
    for number in ["245.14", "243 N", "bound 1.215 N"] {
        assert!(message.contains(number), "{message}");
    }
    assert!(xml.descendants().all(|n| n.attribute("timestamp").is_none() && n.attribute("time").is_none()));
}

#[test]
fn figure_is_well_formed_without_nan_and_holds_every_curve() {
    let data = Data::new();
    let report = data.report();
    for theme in [Theme::Standalone, Theme::Inline] {
        let svg = figure(&report.scenes[0], theme);
        assert!(!svg.contains("NaN") && !svg.contains("inf"), "{theme:?}");
        let xml = Document::parse(&svg).unwrap();
        for class in ["fig-reference", "fig-A", "fig-B"] {
            let lines = xml.descendants().filter(|n| n.attribute("class") == Some(class));
            let drawn = lines.filter(|n| n.attribute("d").is_some_and(|d| d.starts_with('M'))).count();
            // Legend, eight curves, efficiency box.
            assert_eq!(drawn, 1 + CURVES.len() + 1, "{class}");
        }
        let texts: Vec<_> = xml.descendants().filter_map(|n| n.text()).collect();
        for text in
            ["Displacement in µm", "Velocity in mm/s", "Contact force in N", "Time in µs", "FE reference"]
        {
            assert!(texts.contains(&text), "{text}");
        }
        let efficiency = |o: &Outcome| format!("{:.1}", 100.0 * o.summary.quantities.efficiency);
        for outcome in data.reduced.iter().chain([&data.reference]) {
            assert!(texts.iter().any(|t| t.starts_with(&efficiency(outcome))));
        }
    }
}

#[test]
fn png_has_the_size_of_the_figure_and_a_drawing() {
    let data = Data::new();
    let svg = figure(&data.report().scenes[0], Theme::Standalone);
    let xml = Document::parse(&svg).unwrap();
    let size = |name| xml.root_element().attribute(name).unwrap().parse::<f32>().unwrap();
    let image = resvg::tiny_skia::Pixmap::decode_png(&png(&svg, 2.0).unwrap()).unwrap();
    assert_eq!(image.width(), (2.0 * size("width")) as u32);
    assert_eq!(image.height(), (2.0 * size("height")) as u32);
    let share = |wanted: fn(u8, u8, u8) -> bool| {
        let found = image.pixels().iter().filter(|p| wanted(p.red(), p.green(), p.blue())).count();
        found as f64 / image.pixels().len() as f64
    };
    assert!(share(|r, g, b| r > 250 && g > 250 && b > 250) > 0.8);
    // Model B's blue and model A's vermilion.
    assert!(share(|r, g, b| r < 60 && g > 90 && b > 150) > 5e-4);
    assert!(share(|r, g, b| r > 190 && g < 130 && b < 60) > 5e-4);
}

/// Text is drawn with the embedded font, not with one that this machine happens to have.
#[test]
fn png_holds_text() {
    let svg = |text: &str| {
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"80\" height=\"20\"><text y=\"15\">{text}</text></svg>"
        )
    };
    assert_ne!(png(&svg("outer"), 1.0).unwrap(), png(&svg(""), 1.0).unwrap());
    assert_ne!(png(&svg("outer"), 1.0).unwrap(), png(&svg("inner"), 1.0).unwrap());
    assert!(png("<svg", 1.0).is_err());
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
        assert_eq!(table, 2 + PLATE_QUANTITIES.len() + 3 * CURVES.len() + 2);
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
fn terminal_has_a_line_per_model_and_says_what_failed() {
    let data = Data::new();
    let text = terminal(&data.report());
    assert_eq!(text.lines().filter(|l| l.trim_start().starts_with("reference ")).count(), 1);
    assert!(text.lines().any(|l| l.trim_start().starts_with("B ") && l.ends_with("pass")));
    assert!(text.contains("180.0 µs") && text.contains("243.0 N"));
    let text = terminal(&Data::failing().report());
    assert!(text.lines().any(|l| l.trim_start().starts_with("B: outer_force_peak: reduced 245.14")));
}

/// A damaged reference is reported, not drawn, and nothing panics.
#[test]
fn damaged_history_still_gives_a_report() {
    let mut data = Data::new();
    data.reference.history.inner_force[40] = f64::NAN;
    let report = data.report();
    let svg = figure(&report.scenes[0], Theme::Standalone);
    Document::parse(&svg).unwrap();
    assert!(!svg.contains("NaN") && svg.contains("damaged"));
    assert!(scene_page(&report.scenes[0]).contains("contradicts itself"));
    assert_eq!(document(&report)["verdict"], "fail");
    assert_eq!(curves_csv(&report.scenes[0]).unwrap().lines().count(), 1);
    assert!(markdown(&report).contains("not_finite: found 1 1, expected 0 1"));
}
