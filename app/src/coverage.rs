//! Which features of scenes have a comparator: what of the reduced models is compared with an independent solution, and how
//! far the two lie apart.
//!
//! Nothing is written by hand but the list of features, each a question to a scene. Everything else is found: scenes, models
//! that take them, stored references and the discrepancies between both.

use crate::error::Result;
use crate::kinds::{self, ClosedForm, Feature, Form, KINDS};
use crate::result::SCHEMA_VERSION;
use crate::scene::{Model, Scene};
use crate::validated::Validation;
use serde::Serialize;
use std::collections::BTreeMap;

/// Name of a comparator that is a formula.
pub const CLOSED_FORM: &str = "closed form";

/// The features of the first kind, those of any scene, those of other kinds.
pub fn features() -> impl Iterator<Item = &'static Feature> {
    static OF_ANY: [Feature; 1] = [Feature::new("run cut by its end time", |s| s.run.end_time.is_some())];
    let mut kinds = KINDS.iter().map(|kind| kind.features());
    kinds.next().into_iter().flatten().chain(&OF_ANY).chain(kinds.flatten())
}

/// A scene that a model takes, and what it was compared with.
#[derive(Debug)]
pub struct Case<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The model.
    pub model: Model,
    /// What came of it; `None`: nothing is compared with it.
    pub finding: Option<Finding>,
}

impl<'a> Case<'a> {
    /// One for each of the findings, or one without any.
    pub fn of_all(scene: &'a Scene, model: Model, findings: impl Iterator<Item = Finding>) -> Vec<Self> {
        let mut cases: Vec<Self> =
            findings.map(|finding| Case { scene, model, finding: Some(finding) }).collect();
        if cases.is_empty() {
            cases.push(Case { scene, model, finding: None });
        }
        cases
    }
}

/// A model beside an independent solution.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Name of the comparator.
    partner: String,
    /// The closed form, if it is one; then it is about some features only.
    form: Option<Form>,
    /// Largest relative discrepancy, half width of the comparator's band, and the quantity.
    largest: Option<(f64, Option<f64>, String)>,
}

impl From<&Validation> for Finding {
    fn from(validation: &Validation) -> Self {
        let largest =
            validation.largest().map(|row| (row.relative().abs(), row.relative_band(), row.quantity.clone()));
        Finding { partner: validation.partner.clone(), form: None, largest }
    }
}

/// The parts of the models beside the closed forms that there are for `scene`.
///
/// # Errors
/// Those of the models.
pub fn exact(scene: &Scene) -> Result<Vec<Case<'_>>> {
    let of = |found: &ClosedForm, &model: &Model| {
        let largest = Some((found.relative, Some(0.0), found.quantity.to_owned()));
        let finding = Finding { partner: CLOSED_FORM.into(), form: Some(found.form), largest };
        Case { scene, model, finding: Some(finding) }
    };
    let found = kinds::of(scene).closed_forms(scene)?;
    Ok(found.iter().flat_map(|found| found.models.iter().map(move |model| of(found, model))).collect())
}

/// What is known of `scenes` without running a model of theirs: by the record `known` and by closed forms.
///
/// # Errors
/// As [`exact`].
pub fn recorded(scenes: &[Scene], known: &[Validation]) -> Result<Coverage> {
    let mut cases = Vec::new();
    for scene in scenes {
        let kind = kinds::of(scene);
        for &model in kind.models().iter().filter(|model| kind.has_form(scene, **model)) {
            let found = known.iter().filter(|v| v.is_of(scene, model)).map(Finding::from);
            cases.extend(Case::of_all(scene, model, found));
        }
        cases.extend(exact(scene)?);
    }
    Ok(coverage(&cases))
}

/// The document of `coverage`.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Coverage {
    /// [`SCHEMA_VERSION`].
    pub schema_version: u32,
    /// In the order of [`features`].
    pub features: Vec<FeatureCoverage>,
}

/// Who stands for one feature.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FeatureCoverage {
    /// The feature.
    pub feature: &'static str,
    /// One entry per model that takes a scene with it and comparator; empty if no scene has it or no model takes it.
    pub partners: Vec<FeatureComparison>,
}

/// A model and what it is compared with.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct FeatureComparison {
    /// The reduced model.
    pub model: String,
    /// "axisymmetric" or "solid" finite elements, [`CLOSED_FORM`], or the name of another program; `None`: the model takes the
    /// scenes, but nothing is compared with it.
    pub partner: Option<String>,
    /// Names of the scenes.
    pub scenes: Vec<String>,
    /// Largest relative discrepancy of any quantity in them.
    pub worst_relative: Option<f64>,
    /// Half width of the comparator's 95 % band of that quantity, relative.
    pub band: Option<f64>,
    /// That quantity.
    pub quantity: Option<String>,
}

/// Whether `case` says something about `feature`.
fn is_shown_by(feature: &Feature, case: &Case) -> bool {
    let form = case.finding.as_ref().and_then(|finding| finding.form);
    feature.is_in(case.scene) && (form.is_none() || form == feature.form)
}

/// What `cases` show.
pub fn coverage(cases: &[Case]) -> Coverage {
    let features = features().map(|feature| {
        let mut partners: BTreeMap<(Model, Option<&str>), FeatureComparison> = BTreeMap::new();
        for case in cases.iter().filter(|case| is_shown_by(feature, case)) {
            let comparator = case.finding.as_ref().map(|finding| &*finding.partner);
            let new = || FeatureComparison::of(case.model, comparator);
            partners.entry((case.model, comparator)).or_insert_with(new).add(case);
        }
        // a scene without a comparator says nothing new of a model that has one elsewhere
        let whole = |key: &&(Model, Option<&str>)| key.1.is_some_and(|comparator| comparator != CLOSED_FORM);
        let compared: Vec<Model> = partners.keys().filter(whole).map(|key| key.0).collect();
        partners.retain(|(model, comparator), _| comparator.is_some() || !compared.contains(model));
        FeatureCoverage { feature: feature.name, partners: partners.into_values().collect() }
    });
    Coverage { schema_version: SCHEMA_VERSION, features: features.collect() }
}

impl FeatureComparison {
    fn of(model: Model, comparator: Option<&str>) -> Self {
        FeatureComparison {
            model: model.to_string(),
            partner: comparator.map(str::to_owned),
            scenes: Vec::new(),
            worst_relative: None,
            band: None,
            quantity: None,
        }
    }

    fn add(&mut self, case: &Case) {
        self.scenes.push(case.scene.name.clone());
        let Some((relative, band, quantity)) = case.finding.as_ref().and_then(|f| f.largest.as_ref()) else {
            return;
        };
        if Some(*relative) > self.worst_relative {
            self.worst_relative = Some(*relative);
            self.band = *band;
            self.quantity = Some(quantity.clone());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLATE: &str = include_str!("../../tests/fixtures/plate-impact.toml");

    fn names(scene: &Scene) -> Vec<&'static str> {
        features().filter(|feature| feature.is_in(scene)).map(|feature| feature.name).collect()
    }

    fn scene(text: &str) -> Scene {
        Scene::parse("plate-impact.toml", text).expect("valid")
    }

    #[test]
    fn features_are_read_from_the_scene() {
        let plain = scene(PLATE);
        assert_eq!(names(&plain), ["clamped edge"]);
        let text = PLATE.replace("edge      = \"clamped\"", "edge = \"free\"\ndamping_ratio = 0.1");
        assert_eq!(names(&scene(&text)), ["free edge", "damped plate"]);
        let seat = include_str!("../../tests/fixtures/seal-seat.toml");
        assert_eq!(names(&Scene::parse("seal-seat.toml", seat).expect("valid")), ["seal seat"]);
        let relaxing = include_str!("../../scenes/validation/seal-seat-relaxing.toml");
        assert_eq!(
            names(&Scene::parse("seal-seat.toml", relaxing).expect("valid")),
            ["seal seat", "seal seat, relaxing"]
        );
    }

    /// Closed forms are about a part, and shown where the feature is of that part.
    #[test]
    fn closed_forms_are_listed_with_their_features() {
        let text = PLATE.replace("radius   = \"10 mm\"", "radius = \"9 mm\"");
        let free = scene(&text.replace("edge      = \"clamped\"", "edge = \"free\"\ndamping_ratio = 0.1"));
        let found = recorded(std::slice::from_ref(&free), &[]).expect("closed forms");
        let of = |name: &str| found.features.iter().find(|f| f.feature == name).expect("a feature");
        let partners = |name: &str| -> Vec<_> {
            of(name).partners.iter().map(|p| (&*p.model, p.partner.as_deref())).collect()
        };
        let form = Some(CLOSED_FORM);
        // a part is no whole: the models still have not compared
        let expected = [("A", None), ("A", form), ("B", None), ("B", form), ("C", None)];
        assert_eq!(partners("free edge"), expected);
        assert_eq!(partners("damped plate"), [("A", None), ("B", None), ("C", None)]);
        assert!(partners("clamped edge").is_empty());
        let exact = &of("free edge").partners[3];
        assert!(exact.worst_relative.is_some_and(|off| off > 0.0 && off < 1e-8), "{exact:?}");
        assert_eq!((exact.band, exact.quantity.as_deref()), (Some(0.0), Some("frequencies")));
    }

    #[test]
    fn a_model_without_comparator_is_reported_and_a_feature_no_scene_has_is_empty() {
        let plain = scene(PLATE);
        let cases = [Model::B, Model::C].map(|model| Case { scene: &plain, model, finding: None });
        let found = coverage(&cases);
        assert_eq!(found.features.len(), features().count());
        for feature in found.features {
            let alone: Vec<_> =
                feature.partners.iter().map(|p| (&*p.model, p.partner.as_deref(), p.scenes.len())).collect();
            let expected: &[_] =
                if feature.feature == "clamped edge" { &[("B", None, 1), ("C", None, 1)] } else { &[] };
            assert_eq!(alone, expected, "{}", feature.feature);
        }
    }
}
