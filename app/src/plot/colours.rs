//! Colours of the drawings: Okabe and Ito's for models, which colour-blind readers can tell apart, and a map for fields.

/// Of models A, B and C.
pub const MODELS: [(&str, [u8; 3]); 3] = [("A", [213, 94, 0]), ("B", [0, 114, 178]), ("C", [0, 158, 115])];
/// How a model is drawn: colour, dashes and the shape of its marks each tell it apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Look {
    /// Class of its colour.
    pub(crate) class: &'static str,
    /// As SVG has them.
    pub(crate) dash: &'static str,
    /// Number of its mark.
    pub(crate) shape: usize,
}

const OWN: [Look; 3] = [
    Look { class: "fig-A", dash: "2 2.6", shape: 0 },
    Look { class: "fig-B", dash: "7 3", shape: 1 },
    Look { class: "fig-C", dash: "9 2.5 2 2.5", shape: 2 },
];
/// Of the user's programs, in turn.
const OTHERS: [Look; 4] = [
    Look { class: "fig-other", dash: "3 2", shape: 3 },
    Look { class: "fig-other-2", dash: "12 3", shape: 4 },
    Look { class: "fig-other-3", dash: "6 2 2 2 2 2", shape: 5 },
    Look { class: "fig-other-4", dash: "1.5 1.5", shape: 6 },
];

/// That of the model called `name`: a program of the user's has it by its place among the `models` that are shown together.
pub(crate) fn look<'m>(name: &str, models: impl IntoIterator<Item = &'m str>) -> Look {
    let own = |name: &str| MODELS.iter().position(|(model, _)| *model == name);
    if let Some(place) = own(name) {
        return OWN[place];
    }
    let place = models.into_iter().filter(|model| own(model).is_none()).position(|other| other == name);
    OTHERS[place.unwrap_or(0) % OTHERS.len()]
}

/// As SVG has it.
pub fn hex([r, g, b]: [u8; 3]) -> String {
    format!("#{r:02x}{g:02x}{b:02x}")
}

/// Cividis (Nunez, Anderton & Renslow 2018), a map that looks alike to colour-blind readers; `share` within 0 to 1.
/// Polynomials of d3-scale-chromatic.
pub(crate) fn cividis(share: f64) -> [u8; 3] {
    let t = share.clamp(0.0, 1.0);
    let horner = |c: [f64; 6]| c.iter().rev().fold(0.0, |sum, c| sum * t + c).round().clamp(0.0, 255.0) as u8;
    [
        horner([-4.54, -35.34, 2381.73, -6402.7, 7024.72, -2710.57]),
        horner([32.49, 170.73, 52.82, -131.46, 176.58, -67.37]),
        horner([81.24, 442.36, -2482.43, 6167.24, -6614.94, 2475.67]),
    ]
}

#[cfg(test)]
mod tests {
    use super::look;

    #[test]
    fn models_that_are_shown_together_differ_in_colour_dashes_and_marks() {
        let models = ["A", "mine", "B", "yours", "C", "hers", "theirs"];
        let looks = models.map(|model| look(model, models));
        for (k, one) in looks.iter().enumerate() {
            for other in &looks[..k] {
                let same = [one.class == other.class, one.dash == other.dash, one.shape == other.shape];
                assert_eq!(same, [false; 3], "{one:?} {other:?}");
            }
        }
        // whoever else is there does not change the looks of the program's own
        assert_eq!((look("B", []), look("mine", ["mine"])), (looks[2], looks[1]));
    }
}
