//! The course of an impact over time, the same type for reduced models and the reference.

/// The course over time of one kind of scene: curves by name over one time axis.
pub trait Curves: Clone + Default + std::fmt::Debug + PartialEq {
    /// Name and unit of every curve.
    const NAMES: &'static [(&'static str, &'static str)];
    /// The columns of its file, in this order; the first is the time.
    const COLUMNS: &'static [&'static str];

    /// Time in s, strictly increasing.
    fn time(&self) -> &[f64];

    /// The curve called `name` in [`Curves::NAMES`].
    fn values(&self, name: &str) -> Option<&[f64]>;

    /// Rate at which the curve called `name` goes on after the last sample, in free flight; `None` if a contact is
    /// closed there, or the curve is one of an elastic body, which swings on.
    fn rate_after_end(&self, name: &str) -> Option<f64>;

    /// Where the values of the column called `name` in [`Curves::COLUMNS`] go.
    fn column(&mut self, name: &str) -> Option<&mut Vec<f64>>;
}

/// Motion of one body along z.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Motion {
    /// Displacement in m since t = 0, signed along z.
    pub displacement: Vec<f64>,
    /// Velocity in m/s, signed along z.
    pub velocity: Vec<f64>,
}

/// Displacement, velocity and contact force over one time axis. All vectors have `time.len()` entries.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct History {
    /// Time in s since the first touch, strictly increasing.
    pub time: Vec<f64>,
    /// Outer body (mass average).
    pub outer: Motion,
    /// Centre of the plate (mean of both faces).
    pub plate: Motion,
    /// Inner body (mass average).
    pub inner: Motion,
    /// Force between outer body and plate in N, positive in compression.
    pub outer_force: Vec<f64>,
    /// Force between plate and inner body in N, positive in compression.
    pub inner_force: Vec<f64>,
}

/// Name, unit and symbol of a curve of the [`History`].
pub const CURVES: [(&str, &str); 8] = [
    ("outer_displacement", "m"),
    ("plate_displacement", "m"),
    ("inner_displacement", "m"),
    ("outer_velocity", "m/s"),
    ("plate_velocity", "m/s"),
    ("inner_velocity", "m/s"),
    ("outer_force", "N"),
    ("inner_force", "N"),
];

impl History {
    /// The curve called `name` in [`CURVES`].
    pub fn curve(&self, name: &str) -> Option<&[f64]> {
        Some(match name {
            "outer_displacement" => &self.outer.displacement,
            "plate_displacement" => &self.plate.displacement,
            "inner_displacement" => &self.inner.displacement,
            "outer_velocity" => &self.outer.velocity,
            "plate_velocity" => &self.plate.velocity,
            "inner_velocity" => &self.inner.velocity,
            "outer_force" => &self.outer_force,
            "inner_force" => &self.inner_force,
            _ => return None,
        })
    }

    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }
}

impl Curves for History {
    const NAMES: &'static [(&'static str, &'static str)] = &CURVES;
    const COLUMNS: &'static [&'static str] = &[
        "time",
        "outer_displacement",
        "outer_velocity",
        "outer_force",
        "plate_displacement",
        "plate_velocity",
        "inner_displacement",
        "inner_velocity",
        "inner_force",
    ];

    fn time(&self) -> &[f64] {
        &self.time
    }

    fn values(&self, name: &str) -> Option<&[f64]> {
        self.curve(name)
    }

    fn rate_after_end(&self, name: &str) -> Option<f64> {
        let last = self.len().checked_sub(1)?;
        let flies = self.outer_force[last] == 0.0 && self.inner_force[last] == 0.0;
        (flies && !name.starts_with("plate")).then(|| match name {
            "outer_displacement" => self.outer.velocity[last],
            "inner_displacement" => self.inner.velocity[last],
            _ => 0.0,
        })
    }
    fn column(&mut self, name: &str) -> Option<&mut Vec<f64>> {
        Some(match name {
            "time" => &mut self.time,
            "outer_displacement" => &mut self.outer.displacement,
            "outer_velocity" => &mut self.outer.velocity,
            "outer_force" => &mut self.outer_force,
            "plate_displacement" => &mut self.plate.displacement,
            "plate_velocity" => &mut self.plate.velocity,
            "inner_displacement" => &mut self.inner.displacement,
            "inner_velocity" => &mut self.inner.velocity,
            "inner_force" => &mut self.inner_force,
            _ => return None,
        })
    }
}
