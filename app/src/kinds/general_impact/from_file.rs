//! A scene to start from, made of what is found in the CAD or mesh file of a body.

use serde_json::Value;
use std::path::Path;

/// Most names that are listed.
const LISTED: usize = 40;

/// The text of a scene `file` in which a sphere strikes the body in the file `body`, whose groups are `groups` as `fem_reference` lists
/// them. The lowest face is held and the highest one struck: a start that the user changes.
pub fn scene_of_body(file: &Path, body: &Path, unit: Option<&str>, groups: &Value) -> String {
    let same_folder = body.parent().unwrap_or(Path::new("")) == file.parent().unwrap_or(Path::new(""));
    let relative = body.file_name().filter(|_| same_folder).map(Path::new);
    let absolute = std::path::absolute(body).unwrap_or_else(|_| body.to_path_buf());
    let named = relative.unwrap_or(&absolute).to_string_lossy().replace('\\', "/");
    let all: Vec<&Value> = groups["groups"].as_array().into_iter().flatten().collect();
    let height = |group: &&&Value| group["centre"][2].as_f64().unwrap_or(f64::NAN);
    let faces = || all.iter().filter(|group| group["kind"] == "surface" && group["centre"].is_array());
    let lowest = faces().min_by(|a, b| height(a).total_cmp(&height(b)));
    let highest = faces().max_by(|a, b| height(a).total_cmp(&height(b)));
    let name = |group: Option<&&Value>| group.and_then(|group| group["name"].as_str()).map(str::to_owned);
    let fixed = name(lowest).map_or_else(String::new, |name| format!("{name:?}"));
    let struck = name(highest).map_or_else(
        || "[\"0 mm\", \"0 mm\", \"0 mm\"]   # a place on the surface".to_owned(),
        |name| format!("{name:?}"),
    );
    let unit = unit.map_or_else(String::new, |unit| format!("unit     = {unit:?}\n"));
    let mut lines = vec![format!("# {named}: {}", box_in_words(&groups["bounding_box"]))];
    for group in all.iter().take(LISTED) {
        let what = [&group["kind"], &group["shape"]].map(|text| text.as_str().unwrap_or_default());
        let centre: Vec<String> = group["centre"].as_array().into_iter().flatten().map(millimetres).collect();
        let at =
            if centre.is_empty() { String::new() } else { format!(", centre ({}) mm", centre.join(", ")) };
        let what = what.join(" ");
        lines.push(format!("#   {}: {}{at}", group["name"], what.trim()));
    }
    if all.len() > LISTED {
        lines.push(format!("#   and {} more", all.len() - LISTED));
    }
    let found = lines.join("\n");
    format!(
        r#"name        = "NAME"
description = "A steel sphere strikes {named}"
kind        = "impact"

[materials.steel]
youngs_modulus = "210 GPa"
poisson_ratio  = 0.3
density        = "7780 kg/m^3"

{found}
[body]
file     = {named:?}
{unit}material = "steel"
fixed    = [{fixed}]             # names from the list above, or points on faces; empty = free

[outer]
kind     = "sphere"              # sphere | compact | bender | stack | magnet
at       = {struck}
radius   = "2 mm"
material = "steel"
speed    = "500 mm/s"

# A body behind, which the blow reaches through the first:
# [inner]
# kind     = "sphere"
# at       = ["0 mm", "0 mm", "0 mm"]
# radius   = "2 mm"
# material = "steel"

[reduced]
frequencies = 6                  # eigenfrequencies that the result lists
"#
    )
}

/// Length, width and height of a box in mm.
fn box_in_words(corners: &Value) -> String {
    let side = |c: usize| {
        millimetres(&Value::from(
            corners[1][c].as_f64().unwrap_or(0.0) - corners[0][c].as_f64().unwrap_or(0.0),
        ))
    };
    format!("bounding box {} x {} x {} mm", side(0), side(1), side(2))
}

/// A length in m as mm, to the micrometre.
fn millimetres(length: &Value) -> String {
    let rounded = (1e6 * length.as_f64().unwrap_or(f64::NAN)).round() / 1e3;
    // no minus zero
    (rounded + 0.0).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use serde_json::json;

    #[test]
    fn a_scene_of_a_file_is_valid_and_names_what_is_in_it() {
        let folder = tempfile::tempdir().expect("folder");
        let [scene, body] = ["part.toml", "part.step"].map(|name| folder.path().join(name));
        std::fs::write(&body, "ISO-10303-21;").expect("written");
        let face = |name: &str, z: f64| json!({ "name": name, "kind": "surface", "shape": "plane", "centre": [0.0, 0.0, z] });
        let groups = json!({
            "bounding_box": [[0.0, 0.0, 0.0], [0.03, 0.02, 0.01]],
            "groups": [face("side", 0.005), face("top", 0.01), face("base", 0.0)],
        });
        let text = scene_of_body(&scene, &body, Some("mm"), &groups).replace("NAME", "part");
        assert!(text.contains("# part.step: bounding box 30 x 20 x 10 mm"), "{text}");
        let read = Scene::parse(&scene.to_string_lossy(), &text).expect("valid");
        let found = read.general_impact().expect("an impact").body().expect("a body").clone();
        assert_eq!((found.unit, found.fixed.len()), (Some(1e-3), 1));
        assert!(text.contains("at       = \"top\"") && text.contains("fixed    = [\"base\"]"), "{text}");
    }
}
