//! Discrepancy budget: how much of the difference between model B and the reference each simplification causes.
//!
//! One simplification of model B is given up after the other, along one fixed chain:
//!
//! | cause | from | to |
//! |---|---|---|
//! | time step | model B at its tolerance | the same at 1e-11, as everything below |
//! | mode truncation | its modes | many Kirchhoff modes |
//! | Kirchhoff kinematics | Kirchhoff plate | continuum plate seen through the mean of its faces, with C's modes |
//! | half-space contact | | the plate's full residual flexibility |
//! | rigid spheres | | the spheres' residual flexibility: model C |
//! | mode truncation of C | C's modes | many modes: the best model C |
//!
//! [`crate::kinds::plate_impact::variants`] has the formulas. A part is the value with the simplification less the value without
//! it; the remainder is the best model C less the reference. Parts and remainder add up to model B less the reference
//! by construction. The claim that can fail is that the remainder is within the uncertainties of the two.
//!
//! The effects are not additive: another order of giving up would share the difference out otherwise. The
//! parts belong to this order.
//!
//! Many modes: what N Kirchhoff modes leave out of the static deflection under a central force falls as 1/N^2
//! (omega_k ~ k^2, participation^2 ~ k), to some 1e-4 of it at 64. The change to half as many modes is three
//! times what is left then, and stands as the uncertainty. Continuum modes converge faster, their residual has the
//! static deflection already; 40 suffice, with the change to half as many as the uncertainty again.
//!
//! Uncertainty of a part from the continuum: its change when the bodies are meshed coarser, and its change for
//! contact patches half as wide. Model C holds the patch at its width under the peak force; half of that is its
//! width under an eighth of the force. All are added as independent ones, by the root of the sum of squares (ASME V&V
//! 20, 2009, section 5).

use crate::body::continuum::MeshOptions;
use crate::comparison::Verdict;
use crate::comparison::budget::{Part, QuantityBudget, root_of_squares};
use crate::error::{Error, Result};
use crate::kinds::plate_impact::variants::{ContinuumSetup, Simplification, Variants};
use crate::result::{CUT, Outcome, Summary};
use crate::scene::Scene;

/// The quantities of the budget.
pub const BUDGET_QUANTITIES: [&str; 5] =
    ["efficiency", "outer_force_peak", "inner_force_peak", "outer_contact_end", "inner_contact_end"];
/// The causes, in the order in which they are given up.
pub const CAUSES: [&str; 6] = [
    "time_step",
    "mode_truncation",
    "kirchhoff_kinematics",
    "half_space_contact",
    "rigid_spheres",
    "mode_truncation_of_c",
];
/// Kirchhoff modes that stand for all of them, unless model B has more than half as many.
pub const MANY_KIRCHHOFF_MODES: usize = 64;
/// Continuum modes, with residual, that stand for all of them, unless model C has more than half as many.
pub const MANY_CONTINUUM_MODES: usize = 40;
/// Relative error of the efficiency from the time integration, from the second cause on.
pub const TIGHT: f64 = 1e-11;
/// The same where round-off forbids [`TIGHT`], as on a membrane that moves far more than the contacts yield.
const LOOSEST: f64 = 1e-8;

/// Refinement of the mesh for the estimate of the discretisation error: coarser.
const COARSER: f64 = 0.7;
/// Patch radius for the estimate of its influence, relative to that of model C.
const NARROWER: f64 = 0.5;

/// The quantities at the links of the chain, of which there is one more than causes.
type Chain = [[f64; BUDGET_QUANTITIES.len()]; CAUSES.len() + 1];

/// Links with a continuum plate and model C's number of modes: mean of both faces, rigid spheres, model C.
const CONTINUUM: [Simplification; 3] =
    [Simplification::MeanOfFaces, Simplification::RigidTips, Simplification::None];
/// Index of the first of them in the chain.
const FIRST_CONTINUUM: usize = 3;
/// Index of the last link, the best model C.
const BEST: usize = CAUSES.len();

/// Number of modes of the models, and those that stand for all.
#[derive(Debug, Clone, Copy)]
struct ModeCounts {
    b: usize,
    c: usize,
    many_kirchhoff: usize,
    many_continuum: usize,
}

/// The budget of `scene` if models B and C are both among the results `reduced`; else empty.
///
/// # Errors
/// As [`budget`].
pub fn of_results(scene: &Scene, reference: &Summary, reduced: &[Outcome]) -> Result<Vec<QuantityBudget>> {
    let summary = |name: &str| {
        let mut summaries = reduced.iter().map(|outcome| &outcome.summary);
        summaries.find(|summary| summary.model.as_deref() == Some(name))
    };
    let pair = summary("B").zip(summary("C"));
    pair.map_or(Ok(Vec::new()), |(b, c)| budget(scene, reference, b, c))
}

/// The budget of the difference between model `b` and `reference`; `c` is model C's result for the same scene.
///
/// # Errors
/// [`crate::Error::Solver`] if a model of the chain can't be set up or integrated, or a run was cut during a contact.
pub fn budget(scene: &Scene, reference: &Summary, b: &Summary, c: &Summary) -> Result<Vec<QuantityBudget>> {
    let [start, end] = [values(|name| b.value(name))?, values(|name| reference.value(name))?];
    let own = |summary: &Summary| summary.modes.unwrap_or(1);
    let modes = ModeCounts {
        b: own(b),
        c: own(c),
        many_kirchhoff: MANY_KIRCHHOFF_MODES.max(2 * own(b)),
        many_continuum: MANY_CONTINUUM_MODES.max(2 * own(c)),
    };
    let many = [modes.many_kirchhoff, modes.many_continuum];
    let variants = Variants::new(scene, many, modes.c, &ContinuumSetup::default())?;
    let kirchhoff = |modes, tolerance| tightest(&variants, Simplification::KirchhoffPlate, modes, tolerance);
    let best = |modes| tightest(&variants, Simplification::None, modes, TIGHT);

    let mut chain: Chain = [start; CAUSES.len() + 1];
    chain[1] = kirchhoff(modes.b, TIGHT)?;
    chain[2] = kirchhoff(many[0], TIGHT)?;
    for (link, simplification) in chain[FIRST_CONTINUUM..].iter_mut().zip(CONTINUUM) {
        *link = tightest(&variants, simplification, modes.c, TIGHT)?;
    }
    chain[BEST] = best(many[1])?;

    // where the links would be with another choice of what ought not to matter
    let mut larger_steps = chain;
    larger_steps[1] = kirchhoff(modes.b, 100.0 * TIGHT)?;
    let mut fewer_modes = chain;
    fewer_modes[2] = kirchhoff(many[0] / 2, TIGHT)?;
    fewer_modes[BEST] = best(many[1] / 2)?;
    let mut shifted = vec![larger_steps, fewer_modes];
    for other in [
        ContinuumSetup { mesh: MeshOptions::default().refined(COARSER), ..ContinuumSetup::default() },
        ContinuumSetup { patch_factor: NARROWER, ..ContinuumSetup::default() },
    ] {
        let variants = Variants::new(scene, [modes.c; 2], modes.c, &other)?;
        let mut links = chain;
        for (link, simplification) in links[FIRST_CONTINUUM..].iter_mut().zip(CONTINUUM) {
            *link = tightest(&variants, simplification, modes.c, TIGHT)?;
        }
        // more modes leave as much to mesh and patch
        for q in 0..BUDGET_QUANTITIES.len() {
            links[BEST][q] += links[BEST - 1][q] - chain[BEST - 1][q];
        }
        shifted.push(links);
    }
    Ok((0..BUDGET_QUANTITIES.len())
        .map(|q| quantity_budget(q, modes, &chain, &shifted, (reference, end[q])))
        .collect())
}

/// Runs a link at `tolerance` or, where round-off forbids it, at ten times that, up to [`LOOSEST`].
fn tightest(
    variants: &Variants,
    simplification: Simplification,
    modes: usize,
    tolerance: f64,
) -> Result<[f64; BUDGET_QUANTITIES.len()]> {
    match variants.run(simplification, modes, tolerance) {
        Err(Error::Solver(_)) if tolerance < LOOSEST => {
            tightest(variants, simplification, modes, 10.0 * tolerance)
        }
        other => {
            let quantities = other?;
            values(|name| quantities.get(name))
        }
    }
}

/// The values of [`BUDGET_QUANTITIES`] by their names.
///
/// # Errors
/// [`Error::Solver`] if one of them is not determined.
fn values(value: impl Fn(&str) -> Option<f64>) -> Result<[f64; BUDGET_QUANTITIES.len()]> {
    let mut values = [0.0; BUDGET_QUANTITIES.len()];
    for (slot, name) in values.iter_mut().zip(BUDGET_QUANTITIES) {
        *slot = value(name).ok_or_else(|| Error::Solver(format!("`{name}` is not determined: {CUT}")))?;
    }
    Ok(values)
}

/// The budget of quantity number `q`, from the links as they are and as other choices would shift them.
fn quantity_budget(
    q: usize,
    modes: ModeCounts,
    chain: &Chain,
    shifted: &[Chain],
    (reference, reference_value): (&Summary, f64),
) -> QuantityBudget {
    let quantity = BUDGET_QUANTITIES[q];
    let part = |links: &Chain, i: usize| links[i][q] - links[i + 1][q];
    let parts = CAUSES.iter().zip(switches(modes)).enumerate().map(|(i, (cause, switch))| Part {
        cause: (*cause).into(),
        switch,
        value: part(chain, i),
        uncertainty: root_of_squares(shifted.iter().map(|links| part(links, i) - part(chain, i))),
    });
    let remainder = chain[BEST][q] - reference_value;
    let reference_uncertainty = reference.band(quantity);
    let model_uncertainty = root_of_squares(shifted.iter().map(|links| links[BEST][q] - chain[BEST][q]));
    let bound = reference_uncertainty.unwrap_or(0.0).hypot(model_uncertainty);
    QuantityBudget {
        quantity: quantity.into(),
        model: "B".into(),
        unit: reference.quantities.get(quantity).map_or("", |quantity| quantity.unit).into(),
        reference: reference_value,
        difference: chain[0][q] - reference_value,
        parts: parts.collect(),
        remainder,
        reference_uncertainty,
        model_uncertainty,
        bound,
        explained: Verdict::of(remainder.abs() <= bound),
    }
}

/// What each cause switches, in words.
fn switches(modes: ModeCounts) -> [String; CAUSES.len()] {
    let ModeCounts { b, c, many_kirchhoff, many_continuum } = modes;
    [
        format!("model B unchanged → relative error {TIGHT:e}"),
        format!("{b} → {many_kirchhoff} Kirchhoff modes"),
        format!("Kirchhoff plate → mean of both faces of the continuum plate ({c} modes and residual)"),
        "contact with half-spaces → contact with the plate, loaded on both faces".into(),
        "rigid → elastic spheres: model C".into(),
        format!("{c} → {many_continuum} continuum modes"),
    ]
}
