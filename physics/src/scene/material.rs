//! Materials in a scene file: their keys, and what they say together.

use super::collision::Collision;
use super::grammar::{Bound, Field, Kind, optional, positive, pure, required};
use super::quantity::Dimension;
use super::values::Node;
use crate::material::{Material, RateHardening, Relaxation, fit_loss_factor, modulus_ratio};
use crate::{Error, Result};

const POISSON: Bound = Bound { low: Some((-1.0, false)), high: Some((0.5, false)) };
const SHARE: Bound = Bound { low: Some((0.0, false)), high: Some((1.0, false)) };
const EXPONENT: Bound = Bound { low: Some((1.0, true)), high: None };
/// Most terms of a relaxation.
const MAX_TERMS: usize = 16;

pub(crate) static MATERIAL: [Field; 9] = [
    required(
        "youngs_modulus",
        positive(Dimension::PRESSURE),
        "Young's modulus E; of a viscoelastic material the storage modulus at `modulus_frequency`, without that key the instantaneous one",
    ),
    required("poisson_ratio", pure(POISSON), "Poisson's ratio nu"),
    required("density", positive(Dimension::DENSITY), "Density rho"),
    optional(
        "yield_strength",
        positive(Dimension::PRESSURE),
        "Yield strength in uniaxial tension; without `hardening` a contact pressure above it only gives a warning; absent = not checked",
    ),
    optional(
        "hardening",
        Kind::Quantity(Dimension::PRESSURE, Bound::NOT_NEGATIVE),
        "Slope of the yield stress over the plastic strain: with it the material yields; absent = it stays elastic",
    ),
    optional(
        "rate",
        Kind::Table(&RATE),
        "Cowper and Symonds' growth of the yield stress with the strain rate",
    ),
    optional(
        "relaxation",
        Kind::Tables(&RELAXATION, MAX_TERMS),
        "Viscoelastic: terms of the Prony series E(t) = E_0 (1 - sum ratio (1 - exp(-t/time))), the same for bulk and shear",
    ),
    optional(
        "loss_factor",
        pure(SHARE),
        "Viscoelastic: loss over storage modulus, constant over two decades on either side of `modulus_frequency`",
    ),
    optional(
        "modulus_frequency",
        positive(Dimension::FREQUENCY),
        "Frequency at which `youngs_modulus` holds",
    ),
];

static RATE: [Field; 2] = [
    required("D", positive(Dimension::FREQUENCY), "Rate of plastic strain that doubles the yield stress"),
    required("q", pure(EXPONENT), "Exponent: the yield stress grows by 1 + (rate / D)^(1/q)"),
];

static RELAXATION: [Field; 2] = [
    required("ratio", pure(SHARE), "Share of the instantaneous modulus that relaxes"),
    required("time", positive(Dimension::TIME), "Time constant"),
];

/// What the materials of a scene (its checked values) say that contradicts or needs another key.
pub(crate) fn collisions(root: &Node) -> Result<Vec<Collision>> {
    let materials = root.table("materials")?;
    let mut found = Vec::new();
    for name in materials.values.keys() {
        let keys = materials.table(name)?;
        let fault = match contradiction(&keys) {
            None => unsound_relaxation(&keys, name)?,
            Some((key, message)) => Some((key, format!("`materials.{name}.{key}` {message}"), TOGETHER)),
        };
        found.extend(fault.map(|(key, message, help)| Collision {
            fields: vec![format!("materials.{name}.{key}").into()],
            message,
            help,
        }));
    }
    Ok(found)
}

/// What goes together in a material.
const TOGETHER: &str = "viscoelastic: `relaxation`, or `loss_factor` and `modulus_frequency`; plastic: `yield_strength` and `hardening`";

/// The key of a material that contradicts or lacks another, and what it does.
fn contradiction(keys: &Node) -> Option<(&'static str, &'static str)> {
    let has = |key: &str| keys.has(key);
    let viscoelastic = has("relaxation") || has("loss_factor");
    let rules = [
        (
            has("hardening") && !has("yield_strength"),
            "hardening",
            "needs `yield_strength`, from which the yield stress grows",
        ),
        (
            has("rate") && !has("hardening"),
            "rate",
            "needs `hardening`: without it the material does not yield",
        ),
        (
            has("relaxation") && has("loss_factor"),
            "loss_factor",
            "and `relaxation` specify the same: keep one of them",
        ),
        (
            has("loss_factor") && !has("modulus_frequency"),
            "loss_factor",
            "needs `modulus_frequency`, at which both hold",
        ),
        (
            has("modulus_frequency") && !viscoelastic,
            "modulus_frequency",
            "needs `loss_factor` or `relaxation`: an elastic modulus holds at any frequency",
        ),
        (
            has("hardening") && viscoelastic,
            "hardening",
            "and a relaxation together are not covered: a material is viscoelastic or plastic",
        ),
    ];
    rules.into_iter().find(|(broken, ..)| *broken).map(|(_, key, message)| (key, message))
}

/// The key that gives the material `name` a relaxation which no material has, what is said of it and what to do.
fn unsound_relaxation(keys: &Node, name: &str) -> Result<Option<(&'static str, String, &'static str)>> {
    let Some(terms) = relaxation(keys)? else {
        let loss_factor = keys.number("loss_factor")?;
        let message = format!(
            "`materials.{name}.loss_factor` is {loss_factor}, which no relaxation with a modulus above 0 holds over four decades"
        );
        return Ok(Some(("loss_factor", message, "give the material's own `relaxation`")));
    };
    let sum: f64 = terms.iter().map(|term| term.ratio).sum();
    let message =
        || format!("the ratios of `materials.{name}.relaxation` add up to {sum}, but have to stay below 1");
    Ok((sum >= 1.0).then(|| ("relaxation", message(), "what is left is the modulus after a long time")))
}

/// The terms by which a material relaxes; `None` if no terms have its loss factor.
fn relaxation(keys: &Node) -> Result<Option<Vec<Relaxation>>> {
    if let Some(loss_factor) = keys.optional_number("loss_factor")? {
        return Ok(fit_loss_factor(loss_factor, keys.number("modulus_frequency")?).map(|(terms, _)| terms));
    }
    let term = |term: Node| Ok(Relaxation { ratio: term.number("ratio")?, time: term.number("time")? });
    keys.tables("relaxation")?.into_iter().map(term).collect::<Result<_>>().map(Some)
}

/// The material `name` of `materials`, without [`collisions`].
pub(crate) fn material(materials: &Node, name: &str) -> Result<Material> {
    let keys = materials.table(name)?;
    let relaxation = relaxation(&keys)?
        .ok_or_else(|| Error::Internal(format!("the loss factor of `materials.{name}` was not checked")))?;
    let modulus = keys.number("youngs_modulus")?;
    let storage =
        keys.optional_number("modulus_frequency")?.map_or(1.0, |f| modulus_ratio(&relaxation, f)[0]);
    let rate = |rate: Node| {
        Ok::<_, Error>(RateHardening { reference_rate: rate.number("D")?, exponent: rate.number("q")? })
    };
    Ok(Material {
        yield_strength: keys.optional_number("yield_strength")?,
        hardening: keys.optional_number("hardening")?,
        rate: keys.optional_table("rate")?.map(rate).transpose()?,
        relaxation,
        ..Material::elastic(name, modulus / storage, keys.number("poisson_ratio")?, keys.number("density")?)
    })
}
