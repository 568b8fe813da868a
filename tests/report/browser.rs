//! The report's pages in headless Chromium: no error on the console, the numbers are those of the JSON, curves are
//! switched and zoomed together, and axe-core finds nothing serious, in light and dark and on a phone.
//!
//! Without Chromium or axe-core these tests fail and say so: a page nobody opened is not tested.

use assert_cmd::Command;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command as Process, Stdio};

const PLATE: &str = "scaled-plate-r10";
const SEAT: &str = "seal-seat-improved";
const TEST: &str = include_str!("browser.js");

/// Chromium, by the environment variable `CHROMIUM` or one of its names.
fn chromium() -> PathBuf {
    let named = std::env::var_os("CHROMIUM").map(PathBuf::from);
    let path = std::env::var_os("PATH").unwrap_or_default();
    let names = ["chromium", "chromium-browser", "google-chrome"];
    let found = || {
        std::env::split_paths(&path).flat_map(|dir| names.map(|name| dir.join(name))).find(|p| p.is_file())
    };
    named
        .or_else(found)
        .expect("no chromium: `make setup` installs it, or set CHROMIUM to a Chromium or Chrome")
}

/// The text of axe-core, as `make setup` installs it.
fn axe() -> String {
    let tools = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/python-tools/lib");
    let entries = fs::read_dir(&tools).into_iter().flatten().flatten();
    let mut files = entries
        .map(|e| e.path().join("site-packages/axe_playwright_python/axe.min.js"))
        .filter(|f| f.is_file());
    let file = files.next().expect("no axe-core below target/python-tools: `make setup` installs it");
    fs::read_to_string(file).unwrap()
}

fn report(out: &Path) {
    let run = Command::cargo_bin("impactcheck")
        .unwrap()
        .args(["compare", PLATE, SEAT, "--quiet", "--out"])
        .arg(out)
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .unwrap();
    assert!(run.status.success(), "{}", String::from_utf8_lossy(&run.stderr));
}

/// Documents of a comparison and of one in which every tenth number is another.
fn two_documents(dir: &Path) -> [PathBuf; 2] {
    let text = fs::read_to_string(dir.join("comparison.json")).unwrap();
    let mut count = 0;
    let moved = text.lines().map(|line| match line.split_once("\"reduced\": 0.") {
        Some((before, digits)) => {
            count += 1;
            format!("{before}\"reduced\": 0.{}{digits}", if count % 10 == 0 { "1" } else { "" })
        }
        None => line.to_owned(),
    });
    let [one, other] = ["one.json", "other.json"].map(|name| dir.join(name));
    fs::write(
        &other,
        moved.collect::<Vec<_>>().join("\n").replace("\"verdict\": \"pass\"", "\"verdict\": \"fail\""),
    )
    .unwrap();
    fs::write(&one, text).unwrap();
    [one, other]
}

/// Opens `page` with the test inside it and gives what the test, the page and the console complain about.
///
/// On a `phone` in a frame: a window of Chromium's is not as narrow.
fn problems(dir: &Path, page: &str, phone: bool, arguments: &[&str]) -> Vec<String> {
    let text = fs::read_to_string(dir.join(page)).unwrap();
    let comparison: Value =
        serde_json::from_str(&fs::read_to_string(dir.join("comparison.json")).unwrap()).unwrap();
    let first = "<script>window.problems = []; addEventListener('error', (e) => problems.push(`error: ${e.message}`));
        const told = console.error; console.error = (...a) => { problems.push(`console: ${a.join(' ')}`); told(...a); };</script>";
    let data = |id: &str, value: &Value| {
        let text = value.to_string().replace('<', "\\u003c");
        format!("<script type=\"application/json\" id=\"{id}\">{text}</script>")
    };
    let name = page.strip_suffix(".html").unwrap();
    let scenes = comparison["scenes"].as_array().unwrap();
    let mut scene = scenes.iter().find(|s| s["scene"] == name).cloned().unwrap_or_default();
    if let Some(entry) = scene.as_object_mut() {
        entry.remove("overview");
    }
    let curves = if scene.is_null() { Value::Null } else { samples(dir, name, &text) };
    let last = format!(
        "{}{}<script>{}</script><script>{TEST}</script></body>",
        data("test-comparison", &scene),
        data("test-curves", &curves),
        axe()
    );
    let text = text.replacen("<head>", &format!("<head>{first}"), 1);
    let (before, after) = text.rsplit_once("</body>").unwrap();
    let tested = dir.join(format!("tested-{page}"));
    fs::write(&tested, format!("{before}{last}{after}")).unwrap();

    let opened = if phone { dir.join(format!("phone-{page}")) } else { tested.clone() };
    if phone {
        let name = tested.file_name().unwrap().to_string_lossy();
        let frame = format!("<iframe src=\"{name}\" width=\"400\" height=\"850\"></iframe>");
        let script = "addEventListener('message', (told) => { const result = document.createElement('pre'); result.id = 'test-result';
            result.textContent = told.data; document.body.append(result); });";
        fs::write(&opened, format!("<!DOCTYPE html><script>{script}</script>{frame}")).unwrap();
    }
    let profile = tempfile::tempdir().unwrap();
    let output = Process::new(chromium())
        .args(["--headless=new", "--no-sandbox", "--disable-gpu", "--enable-logging=stderr", "--dump-dom"])
        .args(["--virtual-time-budget=20000", "--window-size=1280,900"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .args(arguments)
        .arg(format!("file://{}", opened.display()))
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let dom = String::from_utf8_lossy(&output.stdout);
    let log = String::from_utf8_lossy(&output.stderr);
    let result = dom.rsplit_once("<pre id=\"test-result\">").and_then(|(_, rest)| rest.split_once("</pre>"));
    let (result, _) = result.unwrap_or_else(|| panic!("the test did not finish: {log}"));
    let text = result.replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    let mut problems: Vec<String> = serde_json::from_str(&text).unwrap();
    problems.extend(log.lines().filter(|line| line.contains("CONSOLE")).map(str::to_owned));
    problems
}

/// Some samples of every column of the CSV file that the page shows: `{"B_outer_force": [[row, value], ...], ...}`.
fn samples(dir: &Path, scene: &str, page: &str) -> Value {
    let mut reader = csv::Reader::from_path(dir.join(format!("{scene}.csv"))).unwrap();
    let names: Vec<String> = reader.headers().unwrap().iter().skip(1).map(str::to_owned).collect();
    let rows: Vec<csv::StringRecord> = reader.records().map(|r| r.unwrap()).collect();
    let mut columns = serde_json::Map::new();
    for (k, name) in names.into_iter().enumerate() {
        let (_, curve) = name.split_once('_').unwrap();
        if page.contains(&format!("\"name\":\"{curve}\"")) {
            let value = |row: usize| rows[row][k + 1].parse::<f64>().ok().map(|v| json!([row, v]));
            columns.insert(name, (0..rows.len()).step_by(100).filter_map(value).collect());
        }
    }
    // reference and three models, reference and one model
    assert_eq!(columns.len(), if scene == PLATE { 4 * 8 } else { 2 * 8 });
    Value::Object(columns)
}

/// The bands of the page are those of the stored history: at each instant between those of the samples around it.
fn assert_bands(scene: &str, page: &str) {
    let (_, rest) = page.split_once("id=\"curves\">").unwrap();
    let curves: Value = serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap();
    let numbers =
        |list: &Value| -> Vec<f64> { list.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect() };
    let times = numbers(&curves["time"]);
    let stored = Path::new(env!("CARGO_MANIFEST_DIR")).join("fem_reference/solutions");
    let mut reader = csv::Reader::from_path(stored.join(scene).join("paper/history.csv")).unwrap();
    let header: Vec<String> = reader.headers().unwrap().iter().map(str::to_owned).collect();
    let rows: Vec<Vec<f64>> =
        reader.records().map(|r| r.unwrap().iter().map(|x| x.parse().unwrap()).collect()).collect();
    let mut compared = 0;
    for panel in curves["panels"].as_array().unwrap() {
        // one digit more than the page shows
        let rounding = 0.5 * 10_f64.powi(-1 - panel["decimals"].as_i64().unwrap() as i32);
        for curve in panel["curves"].as_array().unwrap() {
            let name = format!("{}_band", curve["name"].as_str().unwrap());
            let column = header.iter().position(|h| *h == name).unwrap();
            let drawn = numbers(&curve["band"]);
            assert_eq!(drawn.len(), times.len());
            for (time, drawn) in times.iter().zip(drawn) {
                // the page's instants are rounded: one sample more to either side
                let next = rows.partition_point(|row| row[0] < time * 1e-6);
                let around = &rows[next.saturating_sub(2)..(next + 2).min(rows.len())];
                let widths = around.iter().map(|row| row[column] * panel["factor"].as_f64().unwrap());
                let (least, most) =
                    widths.fold((f64::MAX, 0.0), |(low, high), w| (f64::min(low, w), f64::max(high, w)));
                let fits = (least - rounding..=most + rounding).contains(&drawn);
                assert!(fits, "{name} at {time} us: {drawn}, not between {least} and {most}");
            }
            compared += 1;
        }
    }
    assert_eq!(compared, 8);
}

#[test]
fn pages_work_in_a_browser_in_light_dark_and_on_a_phone() {
    let dir = tempfile::tempdir().unwrap();
    report(dir.path());
    let [plate, seat] = [PLATE, SEAT].map(|scene| {
        let page = format!("{scene}.html");
        assert_bands(scene, &fs::read_to_string(dir.path().join(&page)).unwrap());
        page
    });
    let moved = dir.path().join("moved.html");
    let diff = Command::cargo_bin("impactcheck")
        .unwrap()
        .arg("diff")
        .args(two_documents(dir.path()))
        .arg("--out")
        .arg(&moved)
        .output();
    assert!(diff.unwrap().status.success());
    const DARK: &str = "--blink-settings=preferredColorScheme=0";
    let views: [(&str, bool, &[&str]); 6] = [
        (&plate, false, &[]),
        (&plate, true, &[DARK]),
        (&seat, false, &[DARK]),
        ("index.html", true, &[]),
        ("moved.html", false, &[DARK]),
        ("moved.html", true, &[]),
    ];
    for (page, phone, arguments) in views {
        let problems = problems(dir.path(), page, phone, arguments);
        assert!(problems.is_empty(), "{page} {phone} {arguments:?}:\n{}", problems.join("\n"));
    }
}
