//! A report of the synthetic impact, for the tests of what is made of it.

use crate::synthetic_impact::{self, gated_scene, reduced, reduced_of, reference};
use impactcheck::comparison::{GateRules, compare_scene};
use impactcheck::report::{Attachments, Report, SceneReport};
use impactcheck::result::Outcome;
use impactcheck::scene::Scene;

/// Owns what a report refers to.
pub struct Data {
    pub scene: Scene,
    pub reference: Outcome,
    pub reduced: Vec<Outcome>,
}

impl Data {
    pub fn new() -> Self {
        let mut a = synthetic_impact::REDUCED;
        a.inner.peak *= 0.7;
        Data { scene: gated_scene(), reference: reference(), reduced: vec![reduced_of(&a, "A"), reduced()] }
    }

    pub fn report(&self) -> Report<'_> {
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
            rules: GateRules::default(),
        }
    }
}

/// The text between `start` and the next `end`.
pub fn between<'a>(text: &'a str, start: &str, end: &str) -> &'a str {
    let from = text.find(start).unwrap_or_else(|| panic!("no {start}")) + start.len();
    &text[from..from + text[from..].find(end).unwrap()]
}
