//! The requests of the page.

use serde::Deserialize;
use std::collections::BTreeMap;

/// Numbers that differ from the scene's, by field, SI.
pub type Numbers = BTreeMap<String, f64>;

/// A request, as JSON: `{"do": "run", "model": "A", ...}`.
#[derive(Debug, Clone, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case")]
pub enum PageRequest {
    /// Takes a scene; all other requests are about it. The answer: its fields.
    Open {
        /// Content of the scene file.
        scene: String,
        /// Mesh of a seal seat, the content of a VTU file.
        mesh: Option<String>,
        /// Relative error of the time integration.
        tolerance: f64,
    },
    /// Runs a model for its values and curves alone, which is quick.
    Course {
        /// A, B or C.
        model: String,
        /// What differs from the scene.
        numbers: Numbers,
        /// End of the curves, s; null: the model's own.
        end: Option<f64>,
        /// Samples of the curves, over equal steps.
        samples: usize,
    },
    /// Runs a model. The answer: its summary, values and curves, of model C also what a converged reference would find.
    Run {
        /// A, B or C.
        model: String,
        /// What differs from the scene.
        numbers: Numbers,
        /// End of the curves, s; null: the model's own.
        end: Option<f64>,
        /// Samples of the curves, over equal steps.
        samples: usize,
    },
    /// Runs a model for several settings. The answer: for each a quantity, and the duration of the contact over the plate's period;
    /// null where there is none.
    Values {
        /// A, B or C.
        model: String,
        /// Name of the quantity.
        quantity: String,
        /// What differs from the scene, per run.
        points: Vec<Numbers>,
    },
    /// How a quantity depends on a field. The answer: percent that it changes by for a percent of the field; null where that is not known.
    Sensitivity {
        /// A, B or C.
        model: String,
        /// Name of the quantity.
        quantity: String,
        /// Name of the field.
        field: String,
        /// What differs from the scene.
        numbers: Numbers,
    },
    /// The curves of a model at all its samples. The answer: a CSV file, as `impactcheck reduced --history` writes it.
    Csv {
        /// A, B or C.
        model: String,
        /// What differs from the scene.
        numbers: Numbers,
    },
    /// The scene file with these numbers.
    Text {
        /// What differs from the scene.
        numbers: Numbers,
    },
    /// Whether a number, in SI, may stand in a field. The answer: it.
    Check {
        /// Name of the field.
        field: String,
        /// The number.
        value: f64,
    },
    /// Reads a number with a unit. The answer: it in SI.
    Parse {
        /// Name of the field.
        field: String,
        /// The text.
        text: String,
    },
}
