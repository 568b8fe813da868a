//! What drawings have in common: font size, coordinates, widths of text.

/// Font size in px of a drawing.
pub(crate) const FONT_SIZE: f64 = 13.0;

/// Width in px of `text` in DejaVu Sans, estimated from above.
pub(crate) fn text_width(text: &str) -> f64 {
    0.62 * FONT_SIZE * text.chars().count() as f64
}

/// Coordinate with two decimals.
pub(crate) fn x2(value: f64) -> String {
    format!("{value:.2}")
}
