//! Colours of the drawings: Okabe and Ito's for models, which colour-blind readers can tell apart, and pale ones for bodies.

/// Of models A, B and C.
pub const MODELS: [(&str, [u8; 3]); 3] = [("A", [213, 94, 0]), ("B", [0, 114, 178]), ("C", [0, 158, 115])];
/// Of the outer body, plate and inner body.
pub(super) const BODIES: [[u8; 3]; 3] = [[191, 216, 236], [226, 226, 220], [244, 217, 178]];

/// The class of what is drawn of the model called `name`.
pub(super) fn class_of(name: &str) -> &'static str {
    match name {
        "A" => "fig-A",
        "B" => "fig-B",
        "C" => "fig-C",
        _ => "fig-other",
    }
}

/// As SVG has it.
pub fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Of the model called `name`; of any other that of C.
pub(super) fn of_model(name: &str) -> [u8; 3] {
    MODELS.iter().find(|(model, _)| *model == name).unwrap_or(&MODELS[2]).1
}
