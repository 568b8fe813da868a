//! The drawings: figures of the report and for papers, mesh and stress.

use crate::report_data::{Data, between};
use impactcheck::kinds::plate_impact::CURVES;
use impactcheck::plot::png;
use impactcheck::reference::{CurveBands, FieldMesh};
use impactcheck::report::{
    FigureFile, SceneReport, Theme, figure, figure_format, printed_figure, scene_page,
};
use impactcheck::result::Outcome;
use resvg::usvg::roxmltree::Document;
use std::path::Path;

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
            // below the panels of the page what the models are off by, and nothing in a file of its own
            let residuals = svg.matches(&format!("class=\"residual {class}\"")).count();
            let is_model = class != "fig-reference";
            let expected = if theme == Theme::Inline && is_model { CURVES.len() } else { 0 };
            assert_eq!(residuals, expected, "{class}");
        }
        let texts: Vec<_> = xml.descendants().filter_map(|n| n.text()).collect();
        for text in
            ["Displacement in µm", "Velocity in mm/s", "Contact force in N", "Time in µs", "FE reference"]
        {
            assert!(texts.contains(&text), "{text}");
        }
        let efficiency = |o: &Outcome| format!("{:.1}", 100.0 * o.summary.value("efficiency").unwrap());
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
        assert_inside(&svg, &format!("{width} mm"));
        let texts: Vec<_> = xml.descendants().filter_map(|n| n.text()).collect();
        for text in ["Displacement in µm", "Velocity in mm/s", "Contact force in N", "Time in µs"] {
            assert!(texts.contains(&text), "{width} mm: {text}");
        }
        assert!(texts.iter().any(|t| t.contains("69.") || t.contains(" %")), "efficiencies at {width} mm");
    }
}

/// Nothing leaves the drawing, text as the embedded font draws it.
fn assert_inside(svg: &str, what: &str) {
    let mut options = resvg::usvg::Options { font_family: "DejaVu Sans".into(), ..Default::default() };
    let font = concat!(env!("CARGO_MANIFEST_DIR"), "/app/src/plot/fonts/DejaVuSans.ttf");
    options.fontdb_mut().load_font_data(std::fs::read(font).unwrap());
    let tree = resvg::usvg::Tree::from_str(svg, &options).unwrap();
    let inside = tree.root().abs_stroke_bounding_box();
    assert!(inside.left() > -0.5 && inside.right() < tree.size().width() + 0.5, "{what}: {inside:?}");
    assert!(inside.top() > -0.5 && inside.bottom() < tree.size().height() + 0.5, "{what}: {inside:?}");
}

/// A figure that is called so.
fn file(scene: &SceneReport, width: f64, name: &str) -> Vec<u8> {
    let figure = FigureFile { title: scene.scene.name.clone(), svg: printed_figure(scene, width) };
    figure_format(Path::new(name)).unwrap().bytes(&figure).unwrap()
}

/// The page has its figure once. On a phone it scrolls by itself, and its type is not shrunk to the screen.
#[test]
fn a_page_has_one_figure_with_readable_type_on_a_phone() {
    let data = Data::new();
    let page = scene_page(&data.report().scenes[0]);
    let drawn = between(&page, "<figure class=\"drawn\"><div class=\"scroll detailed\"", "</figure>");
    let svg = format!("<svg{}</svg>", between(drawn, "<svg", "</svg>"));
    let xml = Document::parse(&svg).unwrap();
    let title =
        xml.descendants().find(|node| node.has_tag_name("title")).and_then(|node| node.text()).unwrap();
    assert_eq!(page.matches(&format!(">{title}<")).count(), 1);
    let root = xml.root_element();
    let width: f64 = root.attribute("viewBox").unwrap().split(' ').nth(2).unwrap().parse().unwrap();
    let size: f64 = root.attribute("font-size").unwrap().parse().unwrap();
    let least: f64 = between(&page, ".detailed svg{min-width:", "rem}").parse().unwrap();
    assert!(size * 16.0 * least / width >= 12.0, "{size} px in {width}");
}

/// Paths and colours of the PDF are those of the SVG, counted in what the file says itself.
#[test]
fn pdf_holds_every_line_of_the_svg_on_a_page_of_its_size() {
    use std::io::Read;
    let data = Data::new();
    let report = data.report();
    let scene = &report.scenes[0];
    let pdf = file(scene, 85.0, "figure.pdf");
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

/// What a reader of PDF files finds: every word of the SVG once, each where it stands.
#[test]
fn text_of_a_pdf_can_be_searched() {
    let data = Data::new();
    let report = data.report();
    let scene = &report.scenes[0];
    for width in [85.0, 175.0] {
        let pdf = file(scene, width, "figure.pdf");
        let streams = streams(&pdf);
        let (content, cmap) = (&streams[0], &streams[2]);
        // ToUnicode: <glyph> <text in UTF-16>
        let mut text_of = std::collections::BTreeMap::new();
        for line in String::from_utf8_lossy(cmap).lines() {
            let hex: Vec<&str> = line.split(['<', '>', ' ']).filter(|part| !part.is_empty()).collect();
            if let [glyph, text] = hex[..]
                && line.starts_with('<')
                && glyph.len() == 4
            {
                let units: Vec<u16> = (0..text.len() / 4)
                    .map(|k| u16::from_str_radix(&text[4 * k..4 * k + 4], 16).unwrap())
                    .collect();
                text_of.insert(u16::from_str_radix(glyph, 16).unwrap(), String::from_utf16(&units).unwrap());
            }
        }
        assert!(text_of.len() > 20, "{text_of:?}");
        let mut found: Vec<String> = vec![];
        let mut place = 0;
        while let Some(start) = position(content, b"BT\n", place) {
            place = position(content, b"ET", start).unwrap();
            let mut text = String::new();
            for glyph in shown(&content[start..place]) {
                text += &text_of[&glyph];
            }
            found.push(text);
        }
        let svg = printed_figure(scene, width);
        let xml = Document::parse(&svg).unwrap();
        let texts = xml.descendants().filter(|n| {
            n.has_tag_name("text") && !n.attribute("class").is_some_and(|c| c.contains("fig-halo"))
        });
        let expected: Vec<String> = texts.map(|n| n.text().unwrap_or_default().to_owned()).collect();
        assert!(expected.contains(&"Contact force in N".to_owned()));
        assert_eq!(found, expected, "{width} mm");
    }
}

/// Two bytes a glyph in the strings that are shown: `(..) Tj` with escapes, or `<..> Tj`.
fn shown(content: &[u8]) -> Vec<u16> {
    let mut bytes = vec![];
    let mut k = 0;
    while k < content.len() {
        match content[k] {
            b'(' => {
                k += 1;
                while content[k] != b')' {
                    if content[k] == b'\\' {
                        k += 1;
                        bytes.push(match content[k] {
                            b'0'..=b'7' => {
                                let octal = std::str::from_utf8(&content[k..k + 3]).unwrap();
                                k += 2;
                                u8::from_str_radix(octal, 8).unwrap()
                            }
                            b'n' => b'\n',
                            b'r' => b'\r',
                            b't' => b'\t',
                            b'b' => 8,
                            b'f' => 12,
                            other => other,
                        });
                    } else {
                        bytes.push(content[k]);
                    }
                    k += 1;
                }
            }
            b'<' => {
                let end = k + content[k..].iter().position(|b| *b == b'>').unwrap();
                let hex = std::str::from_utf8(&content[k + 1..end]).unwrap();
                bytes.extend(
                    (0..hex.len() / 2).map(|j| u8::from_str_radix(&hex[2 * j..2 * j + 2], 16).unwrap()),
                );
                k = end;
            }
            _ => {}
        }
        k += 1;
    }
    assert_eq!(bytes.len() % 2, 0);
    bytes.chunks(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect()
}

fn position(bytes: &[u8], what: &[u8], from: usize) -> Option<usize> {
    bytes[from..].windows(what.len()).position(|w| w == what).map(|at| from + at)
}

/// The streams of a PDF file, unpacked: the page, the font, what its glyphs read as.
fn streams(pdf: &[u8]) -> Vec<Vec<u8>> {
    use std::io::Read;
    let mut found = vec![];
    let mut place = 0;
    while let Some(start) = position(pdf, b"\nstream\n", place) {
        place = position(pdf, b"endstream", start + 8).unwrap();
        let mut bytes = vec![];
        flate2::read::ZlibDecoder::new(&pdf[start + 8..place]).read_to_end(&mut bytes).unwrap();
        found.push(bytes);
    }
    found
}

#[test]
fn png_for_papers_states_its_resolution() {
    let data = Data::new();
    let report = data.report();
    let bytes = file(&report.scenes[0], 85.0, "figure.png");
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
    let mut mesh = FieldMesh {
        points: Vec::new(),
        quads: Vec::new(),
        bodies: Vec::new(),
        von_mises: None,
        plastic_strain: None,
    };
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
