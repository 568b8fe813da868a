//! Pass or fail.

use serde::Serialize;

/// Outcome of a check, and of everything made of checks.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Verdict {
    /// Within its bound, or not gated.
    Pass,
    /// Outside its bound, or not a number.
    Fail,
}

impl Verdict {
    /// [`Verdict::Pass`] exactly if `ok`.
    pub fn of(ok: bool) -> Self {
        if ok { Verdict::Pass } else { Verdict::Fail }
    }

    /// Whether this is a pass.
    pub fn passed(self) -> bool {
        self == Verdict::Pass
    }

    /// Fail if any of `verdicts` is a fail; pass if there are none.
    pub fn all(verdicts: impl IntoIterator<Item = Verdict>) -> Self {
        Verdict::of(verdicts.into_iter().all(Verdict::passed))
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(match self {
            Verdict::Pass => "pass",
            Verdict::Fail => "fail",
        })
    }
}
