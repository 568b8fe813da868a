//! The scene of a page, and what its models give.

use crate::curves;
use crate::flown;
use crate::request::{Numbers, PageRequest};
use impactcheck_physics::kinds::{self, FollowedMesh, Kind, Series};
use impactcheck_physics::result::{Outcome, Summary, Table};
use impactcheck_physics::scene::{Field, Model, Scene, Template};
use impactcheck_physics::{Error, Result};
use impactcheck_prediction::{MEASURES, Similarity, predict_of_any};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// Relative step of a field in a sensitivity: far above the error of the time integration, far below the width of a page's range.
const STEP: f64 = 2e-3;
/// What messages call the scene file.
const SOURCE: &str = "the scene of the page";

/// What a page shows: nothing, until a scene is opened.
#[derive(Debug, Default)]
pub struct LivePage {
    opened: Option<Opened>,
}

#[derive(Debug)]
struct Opened {
    template: Template,
    fields: BTreeMap<String, Field>,
    /// Bodies that runs share.
    series: Box<dyn Series>,
    tolerance: f64,
}

impl LivePage {
    /// The answer to a `request` in JSON, in JSON: `{"ok": ...}` or `{"error": "a sentence"}`.
    pub fn answer(&mut self, request: &[u8]) -> String {
        let answer = match serde_json::from_slice(request) {
            Ok(request) => self.of(request).map_err(|error| error.to_string()),
            Err(error) => Err(format!("the request is not one: {error}")),
        };
        match answer {
            Ok(value) => json!({ "ok": value }),
            Err(error) => json!({ "error": error }),
        }
        .to_string()
    }

    fn of(&mut self, request: PageRequest) -> Result<Value> {
        if let PageRequest::Open { scene, mesh, tolerance } = request {
            let opened = Opened::new(&scene, mesh.as_deref(), tolerance)?;
            let described = opened.described();
            self.opened = Some(opened);
            return Ok(described);
        }
        let opened = self.opened.as_ref().ok_or_else(|| Error::Usage("no scene is open".into()))?;
        match request {
            PageRequest::Open { .. } => unreachable!("answered above"),
            PageRequest::Run { model, numbers, end, samples } => opened.run(&model, &numbers, (end, samples)),
            PageRequest::Course { model, numbers, end, samples } => {
                opened.course(&model, &numbers, (end, samples))
            }
            PageRequest::Values { model, quantity, points } => opened.values(&model, &quantity, &points),
            PageRequest::Sensitivity { model, quantity, field, numbers } => {
                opened.sensitivity(&model, &quantity, &field, &numbers)
            }
            PageRequest::Csv { model, numbers } => {
                Ok(curves::csv(&opened.outcome(&model, opened.scene(&numbers)?)?.history).into())
            }
            PageRequest::Text { numbers } => {
                let template = &opened.template;
                Ok(template.text_with(&template.scene().name, &opened.named(&numbers)?)?.into())
            }
            PageRequest::Parse { field, text } => {
                let field = opened.field(&field)?;
                checked(field, field.parse(&text)?)
            }
            PageRequest::Check { field, value } => checked(opened.field(&field)?, value),
        }
    }
}

impl Opened {
    fn new(text: &str, mesh: Option<&str>, tolerance: f64) -> Result<Self> {
        let template = Template::parse(SOURCE, text)?;
        let mesh = mesh.map(|mesh| FollowedMesh::parse(SOURCE, mesh.as_bytes())).transpose()?;
        let series = kinds::series([], template.scene(), mesh.as_ref(), 1)?;
        let fields = template.fields().into_iter().map(|field| (field.path().to_owned(), field)).collect();
        Ok(Self { template, fields, series, tolerance })
    }

    fn kind(&self) -> &'static dyn Kind {
        kinds::of(self.template.scene())
    }

    /// The fields that the scene states, and the models it has.
    fn described(&self) -> Value {
        let scene = self.template.scene();
        let fields: Vec<Value> = self
            .template
            .fields()
            .iter()
            .filter(|field| !field.path().starts_with("reduced."))
            .filter_map(|field| {
                let [low, high] = field.limits();
                Some(json!({
                    "path": field.path(), "unit": field.unit(), "value": self.template.number(field)?,
                    "about": field.description(), "count": field.is_count(), "low": low, "high": high,
                }))
            })
            .collect();
        let models = self.kind().models().iter().filter(|model| self.kind().has_form(scene, **model));
        let models: Vec<String> = models.map(Model::to_string).collect();
        json!({"fields": fields, "models": models, "measures": MEASURES})
    }

    fn field(&self, path: &str) -> Result<&Field> {
        self.fields.get(path).ok_or_else(|| Error::Usage(format!("the scene has no numeric field `{path}`")))
    }

    fn named(&self, numbers: &Numbers) -> Result<Vec<(&Field, f64)>> {
        numbers.iter().map(|(path, value)| Ok((self.field(path)?, *value))).collect()
    }

    fn scene(&self, numbers: &Numbers) -> Result<Scene> {
        let numbers = self.named(numbers)?;
        self.template.with(&numbers).map_err(|rejected| Error::Usage(rejected.to_string()))
    }

    fn model(&self, model: &str, scene: Scene) -> Result<Box<dyn kinds::SeriesModel>> {
        let model: Model = model.parse().map_err(Error::Usage)?;
        self.series.model(scene, model, None)
    }

    fn outcome(&self, model: &str, scene: Scene) -> Result<Outcome> {
        self.model(model, scene)?.run_with_history(self.tolerance)
    }

    fn course(&self, model: &str, numbers: &Numbers, (end, samples): (Option<f64>, usize)) -> Result<Value> {
        let scene = self.scene(numbers)?;
        let (table, history) = self.model(model, scene.clone())?.course(self.tolerance)?;
        Ok(json!({"values": self.table(&scene, &table), "curves": curves::drawn(&history, end, samples)}))
    }

    fn run(&self, model: &str, numbers: &Numbers, (end, samples): (Option<f64>, usize)) -> Result<Value> {
        let scene = self.scene(numbers)?;
        let outcome = self.outcome(model, scene.clone())?;
        let summary = &outcome.summary;
        let mut answer = json!({
            "summary": summary, "values": self.table(&scene, &summary.quantities),
            "curves": curves::drawn(&outcome.history, end, samples), "flight": flown::drawn(&scene, summary),
        });
        if model == "C" {
            // the base predicts the errors of model C as it is by default
            let run = |scene: &Scene| self.model("C", scene.clone())?.run(self.tolerance);
            let prediction = predict_of_any(&scene, (summary, scene.reduced.modes.is_none()), run);
            answer["prediction"] = prediction.map_or_else(Value::from, |intervals| json!(intervals));
            answer["similarity"] = json!(Similarity::of(&scene, summary).ok());
        }
        Ok(answer)
    }

    /// The quantities that results of `scene` have, by name.
    fn table(&self, scene: &Scene, found: &Table) -> Map<String, Value> {
        let has = |name: &str| self.kind().has(scene, name);
        let quantities = self.kind().quantities().iter().filter(|quantity| has(quantity.name));
        quantities.map(|quantity| (quantity.name.to_owned(), json!(found.value(quantity.name)))).collect()
    }

    /// The result with these `numbers`, and its scene; `None` where there is none.
    fn result(&self, model: &str, numbers: &Numbers) -> Option<(Scene, Summary)> {
        let scene = self.scene(numbers).ok()?;
        let (table, _) = self.model(model, scene.clone()).ok()?.course(self.tolerance).ok()?;
        let summary = Summary::of_reduced(&scene, model.parse().ok()?, 0, table);
        Some((scene, summary))
    }

    fn values(&self, model: &str, quantity: &str, points: &[Numbers]) -> Result<Value> {
        let of = |numbers: &Numbers| {
            let Some((scene, summary)) = self.result(model, numbers) else { return json!([null, null]) };
            let similarity = Similarity::of(&scene, &summary).ok();
            let [_, contact_over_period, _] = MEASURES;
            json!([
                summary.value(quantity),
                similarity.and_then(|s| s.results.get(contact_over_period).copied())
            ])
        };
        Ok(points.iter().map(of).collect())
    }

    fn sensitivity(&self, model: &str, quantity: &str, path: &str, numbers: &Numbers) -> Result<Value> {
        let field = self.field(path)?;
        let value = numbers.get(path).copied().or_else(|| self.template.number(field));
        let Some(value) = value.filter(|value| *value != 0.0 && !field.is_count()) else {
            return Ok(Value::Null);
        };
        let at = |factor: f64| {
            let mut moved = numbers.clone();
            moved.insert(path.to_owned(), value * factor);
            self.result(model, &moved)?.1.value(quantity)
        };
        let change = at(1.0 - STEP).zip(at(1.0 + STEP)).map(|(below, above)| {
            let middle = 0.5 * (below.abs() + above.abs());
            (above - below) / (2.0 * STEP * middle)
        });
        Ok(json!(change.filter(|change| change.is_finite())))
    }
}

/// `value`, if it may stand in `field`.
fn checked(field: &Field, value: f64) -> Result<Value> {
    field.check(value).map_err(|rejected| Error::Usage(rejected.to_string()))?;
    Ok(value.into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    const TOLERANCE: f64 = 1e-7;

    fn scene(name: &str) -> String {
        fs::read_to_string(format!("../scenes/{name}.toml")).expect("shipped scene")
    }

    fn opened(name: &str) -> LivePage {
        let mut page = LivePage::default();
        let answer =
            ask(&mut page, json!({"do": "open", "scene": scene(name), "mesh": null, "tolerance": TOLERANCE}));
        assert!(answer["ok"]["fields"].is_array(), "{answer}");
        page
    }

    fn ask(page: &mut LivePage, request: Value) -> Value {
        serde_json::from_str(&page.answer(request.to_string().as_bytes())).expect("JSON")
    }

    /// What is drawn while a number is dragged is what the model gives at rest, and what it gives outside the page.
    #[test]
    fn quick_and_whole_runs_give_the_values_of_the_model() {
        for name in ["scaled-plate-r6.35", "validation/oblique-friction", "examples/wet-valve-plate"] {
            let text = scene(name);
            let mut page = opened(name);
            let template = Template::parse(name, &text).expect("shipped scene");
            let thickness = template.field("plate.thickness").expect("a plate");
            let changed = 1.1 * template.number(&thickness).expect("stated");
            let scene = template.with(&[(&thickness, changed)]).expect("valid");
            for model in ["A", "B", "C"] {
                let own =
                    kinds::of(&scene).model(&scene, model.parse().expect("a model"), None).expect("a model");
                let own = own.run(TOLERANCE).expect("a run");
                for kind in ["course", "run"] {
                    let request = json!({
                        "do": kind, "model": model, "numbers": {"plate.thickness": changed}, "end": null, "samples": 50,
                    });
                    let answer = ask(&mut page, request);
                    assert!(answer["ok"].is_object(), "{name} {model} {kind}: {answer}");
                    for quantity in own.quantities.iter().filter(|quantity| quantity.value.is_some()) {
                        let (found, expected) =
                            (answer["ok"]["values"][quantity.name].as_f64(), quantity.value);
                        let (found, expected) = (found.expect(quantity.name), expected.expect("some"));
                        let near = (found - expected).abs() <= 1e-9 * expected.abs();
                        assert!(near, "{name} {model} {kind} {}: {found} {expected}", quantity.name);
                    }
                    assert_eq!(
                        answer["ok"]["curves"]["values"]["outer_force"].as_array().map(Vec::len),
                        Some(50)
                    );
                }
            }
        }
    }

    #[test]
    fn a_sensitivity_is_the_exponent_of_a_power_law() {
        let mut page = opened("scaled-plate-r6.35");
        for (field, exponent) in [("plate.thickness", 1.0), ("plate.radius", -2.0), ("outer.speed", 0.0)] {
            let request = json!({"do": "sensitivity", "model": "B", "quantity": "first_frequency", "field": field, "numbers": {}});
            let value = ask(&mut page, request)["ok"].as_f64().expect(field);
            assert!((value - exponent).abs() < 1e-4, "{field}: {value}");
        }
    }

    #[test]
    fn what_can_not_be_answered_is_a_sentence() {
        let mut empty = LivePage::default();
        let run = |value: f64| json!({"do": "course", "model": "B", "numbers": {"plate.radius": value}, "end": null, "samples": 9});
        assert_eq!(ask(&mut empty, run(0.03))["error"], "no scene is open");
        let mut page = opened("scaled-plate-r10");
        let parse = |text: &str| json!({"do": "parse", "field": "plate.radius", "text": text});
        for (request, part) in [
            (run(-1.0), "`plate.radius` is -1 m, but it must be greater than 0 m"),
            (parse("3 kg"), "is not the unit of a length"),
            (json!({"do": "course", "model": "D", "numbers": {}, "end": null, "samples": 9}), "D"),
            (json!({"do": "run"}), "the request is not one"),
            (json!({"do": "text", "numbers": {"plate.raduis": 1.0}}), "no numeric field `plate.raduis`"),
        ] {
            let answer = ask(&mut page, request);
            assert!(answer["error"].as_str().is_some_and(|error| error.contains(part)), "{answer}");
        }
        assert_eq!(ask(&mut page, parse("31 mm"))["ok"], 0.031);
        let text = ask(&mut page, json!({"do": "text", "numbers": {"plate.radius": 0.031}}));
        let scene = Scene::parse("written", text["ok"].as_str().expect("text")).expect("valid");
        assert_eq!(scene.plate_impact().expect("a plate").plate.radius, 0.031);
    }
}
