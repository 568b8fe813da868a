//! The exporters: all formats tell the same numbers, and each is well-formed.

mod synthetic_impact;

use impactcheck::comparison::{Verdict, compare_scene};
use impactcheck::impact::{CURVES, Outcome, PLATE_QUANTITIES};
use impactcheck::reference::{CurveBands, FieldMesh};
use impactcheck::report::{
    Attachments, FigureFormat, Report, SceneReport, Theme, curves_csv, figure, figure_file, index_page, json,
    junit, markdown, png, printed_figure, scene_page, terminal,
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

/// Also what scripts and styles could load.
#[test]
fn pages_load_nothing_and_show_verdict_and_command() {
    let data = Data::failing();
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
    let failure = case("outer_force_peak").children().find(|n| n.has_tag_name("failure")).unwrap();
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
    assert!(
        text.lines().any(|l| l.trim_start().starts_with("B ") && l.contains("  \u{1b}[1m\u{1b}[32mpass"))
    );
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

/// The lengths in mm of a figure's root.
fn size_in_mm(svg: &str) -> (f64, f64) {
    let xml = Document::parse(svg).unwrap();
    let length =
        |name| xml.root_element().attribute(name).unwrap().strip_suffix("mm").unwrap().parse().unwrap();
    (length("width"), length("height"))
}

#[test]
fn figures_for_papers_have_their_width_readable_type_and_everything_inside() {
    let data = Data::new();
    let report = data.report();
    for width in [75.0, 85.0, 119.0, 120.0, 175.0, 300.0] {
        let svg = printed_figure(&report.scenes[0], width);
        let (found, _) = size_in_mm(&svg);
        assert!((found - width).abs() < 1e-2, "{found} mm for {width} mm");
        let xml = Document::parse(&svg).unwrap();
        let units: f64 =
            xml.root_element().attribute("viewBox").unwrap().split(' ').nth(2).unwrap().parse().unwrap();
        let points = |px: f64| px * width / units * 72.0 / 25.4;
        let sizes =
            xml.descendants().filter_map(|n| n.attribute("font-size")).map(|s| s.parse::<f64>().unwrap());
        let smallest = sizes.fold(f64::INFINITY, f64::min);
        assert!(points(smallest) >= 7.0, "{} pt at {width} mm", points(smallest));
        // nothing leaves the drawing, text as the embedded font draws it
        let mut options = resvg::usvg::Options { font_family: "DejaVu Sans".into(), ..Default::default() };
        let font = concat!(env!("CARGO_MANIFEST_DIR"), "/src/report/fonts/DejaVuSans.ttf");
        options.fontdb_mut().load_font_data(std::fs::read(font).unwrap());
        let tree = resvg::usvg::Tree::from_str(&svg, &options).unwrap();
        let inside = tree.root().abs_stroke_bounding_box();
        assert!(inside.left() > -0.5 && inside.right() < tree.size().width() + 0.5, "{width} mm: {inside:?}");
        assert!(
            inside.top() > -0.5 && inside.bottom() < tree.size().height() + 0.5,
            "{width} mm: {inside:?}"
        );
        let texts: Vec<_> = xml.descendants().filter_map(|n| n.text()).collect();
        for text in ["Displacement in µm", "Velocity in mm/s", "Contact force in N", "Time in µs"] {
            assert!(texts.contains(&text), "{width} mm: {text}");
        }
        assert!(texts.iter().any(|t| t.contains("69.") || t.contains(" %")), "efficiencies at {width} mm");
    }
}

/// Paths and colours of the PDF are those of the SVG, counted in what the file says itself.
#[test]
fn pdf_holds_every_line_of_the_svg_on_a_page_of_its_size() {
    use std::io::Read;
    let data = Data::new();
    let report = data.report();
    let scene = &report.scenes[0];
    let pdf = figure_file(scene, 85.0, FigureFormat::Pdf).unwrap();
    let find = |what: &[u8], from: usize| {
        from + pdf[from..].windows(what.len()).position(|w| w == what).unwrap_or_else(|| panic!("{what:?}"))
    };
    assert!(pdf.starts_with(b"%PDF-1."));
    let text = String::from_utf8_lossy(&pdf);
    let box_of_page: Vec<f64> =
        between(&text, "/MediaBox [", "]").split(' ').map(|n| n.parse().unwrap()).collect();
    let svg = printed_figure(scene, 85.0);
    let (width, height) = size_in_mm(&svg);
    assert!(
        (box_of_page[2] - width * 72.0 / 25.4).abs() < 0.5
            && (box_of_page[3] - height * 72.0 / 25.4).abs() < 0.5
    );
    let start = find(b"stream\n", 0) + 7;
    let end = find(b"endstream", start);
    let mut content = String::new();
    flate2::read::ZlibDecoder::new(&pdf[start..end]).read_to_string(&mut content).unwrap();
    let xml = Document::parse(&svg).unwrap();
    for (class, colour) in
        [("fig-reference", [26, 26, 26]), ("fig-A", [213, 94, 0]), ("fig-B", [0, 114, 178])]
    {
        let lines = xml.descendants().filter(|n| {
            n.attribute("class") == Some(class) && n.attribute("d").is_some_and(|d| !d.is_empty())
        });
        let is_colour = |line: &&str| {
            let numbers: Vec<f64> = line.split(' ').filter_map(|n| n.parse().ok()).collect();
            line.ends_with(" RG")
                && numbers.iter().zip(colour).all(|(n, c)| (n * 255.0 - f64::from(c)).abs() < 0.6)
        };
        assert_eq!(content.lines().filter(is_colour).count(), lines.count(), "{class}");
    }
}

#[test]
fn png_for_papers_states_its_resolution() {
    let data = Data::new();
    let report = data.report();
    let bytes = figure_file(&report.scenes[0], 85.0, FigureFormat::Png).unwrap();
    let reader = ::png::Decoder::new(std::io::Cursor::new(&bytes)).read_info().unwrap();
    let info = reader.info();
    // 85 mm at 600 dots per inch
    assert!(info.width.abs_diff(2008) <= 2, "{}", info.width);
    assert_eq!(info.pixel_dims.unwrap().xppu, 23622);
}

/// A band of 10 N about a force: the drawn outline is that much higher than the curve.
#[test]
fn the_band_is_drawn_about_the_reference_as_wide_as_it_is() {
    let data = Data::new();
    let mut report = data.report();
    let time = data.reference.history.time.clone();
    let width = 10.0;
    let widths = vec![("outer_force", vec![width; time.len()])];
    report.scenes[0].attachments.bands = Some(CurveBands::new(time, widths));
    let svg = figure(&report.scenes[0], Theme::Standalone);
    let xml = Document::parse(&svg).unwrap();
    let path = |class: &str, k: usize| -> Vec<f64> {
        let found =
            xml.descendants().filter(|n| n.attribute("class") == Some(class) && n.attribute("d").is_some());
        let data = found.map(|n| n.attribute("d").unwrap()).nth(k).unwrap().trim_end_matches('Z').to_owned();
        data.split(['M', 'L']).filter_map(|p| p.split(' ').nth(1)?.parse().ok()).collect()
    };
    let highest = |y: &[f64]| y.iter().copied().fold(f64::INFINITY, f64::min);
    let lowest = |y: &[f64]| y.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let bands = xml.descendants().filter(|n| n.attribute("class") == Some("fig-band")).count();
    assert_eq!(bands, 1);
    // legend, three displacements, three velocities, the efficiency's box, then the forces
    let (curve, band) = (path("fig-reference", 8), path("fig-band", 0));
    let scale = (lowest(&curve) - highest(&curve)) / 243.0;
    assert!((highest(&curve) - highest(&band) - width * scale).abs() < 1.0, "above");
    assert!(lowest(&band) > lowest(&curve), "below");
}

#[test]
fn mesh_and_stress_are_shown_where_there_are_any() {
    let data = Data::new();
    let mut report = data.report();
    assert!(!scene_page(&report.scenes[0]).contains("<image"));
    let mut mesh = FieldMesh { points: Vec::new(), quads: Vec::new(), bodies: Vec::new(), von_mises: None };
    for (body, (z, radius, height)) in
        [(1e-3, 1e-2, 2e-2), (-1e-3, 3e-2, 2e-3), (-2.1e-2, 1e-2, 2e-2)].into_iter().enumerate()
    {
        let first = mesh.points.len();
        mesh.points.extend([[0.0, z], [radius, z], [radius, z + height], [0.0, z + height]]);
        mesh.quads.push([first, first + 1, first + 2, first + 3]);
        mesh.bodies.push(body);
    }
    report.scenes[0].attachments.mesh = Some(mesh.clone());
    assert_eq!(scene_page(&report.scenes[0]).matches("<image").count(), 2);
    mesh.von_mises = Some(vec![1e8, 2e8, 3e8]);
    report.scenes[0].attachments.stress = Some((47e-6, mesh));
    let page = scene_page(&report.scenes[0]);
    assert_eq!(page.matches("<image").count(), 4);
    assert!(page.contains("47.00 µs") && page.contains("von Mises stress in MPa"));
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
                ("reduced", Some(row.reduced)),
                ("reference", Some(row.reference)),
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
