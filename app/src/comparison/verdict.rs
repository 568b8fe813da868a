//! What a check comes to, and what the gate makes of it.

use serde::{Deserialize, Serialize};

/// Outcome of a check, and of everything made of checks: the worst of its parts, in this order.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// No bound was given.
    NotGated,
    /// Within its bound, wherever the truth lies in the reference's band.
    Pass,
    /// The reference's band leaves open whether it is within its bound, or it has no value to compare with.
    Undecided,
    /// Outside its bound, wherever the truth lies in the reference's band; or not a number.
    Fail,
}

impl Verdict {
    /// [`Verdict::Pass`] exactly if `ok`, else [`Verdict::Fail`].
    pub fn of(ok: bool) -> Self {
        if ok { Verdict::Pass } else { Verdict::Fail }
    }

    /// Of a discrepancy of magnitude `error` that is known to within `band`, against `bound`; all in the same unit.
    pub fn within(error: f64, band: f64, bound: f64) -> Self {
        if !error.is_finite() || error - band > bound {
            Verdict::Fail
        } else if error + band <= bound {
            Verdict::Pass
        } else {
            Verdict::Undecided
        }
    }

    /// Whether this is a pass.
    pub fn passed(self) -> bool {
        self == Verdict::Pass
    }

    /// Whether this is a fail.
    pub fn failed(self) -> bool {
        self == Verdict::Fail
    }

    /// As documents have it.
    pub fn name(self) -> &'static str {
        match self {
            Verdict::NotGated => "not_gated",
            other => other.words(),
        }
    }

    /// In words.
    pub fn words(self) -> &'static str {
        match self {
            Verdict::NotGated => "not gated",
            Verdict::Pass => "pass",
            Verdict::Undecided => "undecided",
            Verdict::Fail => "fail",
        }
    }

    /// The worst of `verdicts`; not gated if there are none.
    pub fn worst(verdicts: impl IntoIterator<Item = Verdict>) -> Self {
        verdicts.into_iter().max().unwrap_or(Verdict::NotGated)
    }

    /// Of results that have to be sound whatever is gated: a fail if any check fails, and else nothing that could pass.
    pub fn of_soundness(checks: impl IntoIterator<Item = Verdict>) -> Self {
        if checks.into_iter().any(Verdict::failed) { Verdict::Fail } else { Verdict::NotGated }
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.words())
    }
}

/// How an undecided verdict counts at the gate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Undecided {
    /// As a fail.
    Fail,
    /// As a pass, and it is told.
    #[default]
    Warn,
    /// As a pass.
    Pass,
}

impl std::str::FromStr for Undecided {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "fail" => Ok(Undecided::Fail),
            "warn" => Ok(Undecided::Warn),
            "pass" => Ok(Undecided::Pass),
            _ => Err(format!("`{text}` is not one of fail, warn, pass")),
        }
    }
}

/// What the gate asks of the verdicts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct GateRules {
    /// How undecided verdicts count.
    pub undecided: Undecided,
    /// Whether a scene is refused of which nothing is gated, or whose reference has no value for a tolerance.
    pub require_tolerances: bool,
}

impl GateRules {
    /// Whether this verdict stops at the gate.
    pub fn refuse(self, verdict: Verdict) -> bool {
        match verdict {
            Verdict::NotGated => self.require_tolerances,
            Verdict::Pass => false,
            Verdict::Undecided => self.undecided == Undecided::Fail,
            Verdict::Fail => true,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{GateRules, Undecided, Verdict};

    #[test]
    fn the_band_opens_a_strip_about_the_bound() {
        for (error, band, bound, expected) in [
            (0.5, 0.0, 1.0, Verdict::Pass),
            (0.5, 0.5, 1.0, Verdict::Pass),
            (0.5, 0.51, 1.0, Verdict::Undecided),
            (1.5, 0.51, 1.0, Verdict::Undecided),
            (1.5, 0.5, 1.0, Verdict::Undecided),
            (1.5, 0.49, 1.0, Verdict::Fail),
            (1.5, 0.0, 1.0, Verdict::Fail),
            (f64::NAN, 9.0, 1.0, Verdict::Fail),
            (f64::INFINITY, 0.0, f64::INFINITY, Verdict::Fail),
            // a band that is no number proves nothing
            (0.5, f64::NAN, 1.0, Verdict::Undecided),
            (0.5, f64::INFINITY, 1.0, Verdict::Undecided),
        ] {
            assert_eq!(Verdict::within(error, band, bound), expected, "{error} {band} {bound}");
        }
    }

    #[test]
    fn a_document_has_the_worst_verdict_and_is_not_gated_only_if_nothing_is() {
        use Verdict::{Fail, NotGated, Pass, Undecided};
        assert_eq!(Verdict::worst([]), NotGated);
        assert_eq!(Verdict::worst([NotGated, NotGated]), NotGated);
        assert_eq!(Verdict::worst([NotGated, Pass]), Pass);
        assert_eq!(Verdict::worst([Undecided, Pass]), Undecided);
        assert_eq!(Verdict::worst([Undecided, Fail, NotGated]), Fail);
        assert_eq!(Verdict::of_soundness([Pass, Pass]), NotGated, "a sound result has passed no bound");
        assert_eq!(Verdict::of_soundness([Pass, Fail]), Fail);
    }

    #[test]
    fn an_option_sets_what_stops_at_the_gate() {
        let refused = |undecided, require_tolerances| {
            let rules = GateRules { undecided, require_tolerances };
            [Verdict::NotGated, Verdict::Pass, Verdict::Undecided, Verdict::Fail].map(|v| rules.refuse(v))
        };
        assert_eq!(refused(Undecided::Warn, false), [false, false, false, true]);
        assert_eq!(refused(Undecided::Pass, true), [true, false, false, true]);
        assert_eq!(refused(Undecided::Fail, false), [false, false, true, true]);
    }
}
