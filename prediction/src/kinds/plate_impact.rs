//! The group of the validation base that a plate impact belongs to.

use crate::MEASURES;
use crate::similarity::FILM_ERROR;
use impactcheck_physics::contact::Hertz;
use impactcheck_physics::kinds::plate_impact::{FILM_SHARE, PlateImpact};
use impactcheck_physics::material::{Material, modulus_ratio};
use impactcheck_physics::result::Summary;
use impactcheck_physics::scene::{Edge, Fluid, Shape};
use std::f64::consts::PI;

/// The group of `setup`, as `validation/draw.py` names it.
///
/// # Errors
/// A sentence of an impact that the base has none like.
pub(super) fn stratum(setup: &PlateImpact) -> Result<&'static str, String> {
    if !matches!(setup.outer.shape, Shape::Sphere { .. } | Shape::Compact { .. }) {
        return Err("the validation base has no scenes with a bender or a stack".into());
    }
    if setup.series.is_some() {
        return Err("the validation base has no repeated impacts".into());
    }
    if !setup.outer.is_centred() && setup.plate.edge != Edge::Clamped {
        return Err("the validation base has off-centre and oblique impacts on clamped plates only".into());
    }
    if setup.spins() {
        return Err("the validation base has no spin".into());
    }
    let oblique = setup.outer.angle != 0.0;
    let is_drawn =
        |fluid: &Fluid| fluid.squeeze_film && fluid.drag_coefficient == 0.0 && fluid.shear_thinning.is_none();
    if setup.fluid.as_ref().is_some_and(|fluid| !is_drawn(fluid)) {
        return Err(
            "the validation base has Newtonian fluids with a squeeze film and without drag only".into()
        );
    }
    if setup.materials().iter().any(|material| material.rate.is_some()) {
        return Err("the validation base has no yield strength that grows with the strain rate".into());
    }
    let features = [
        (setup.fluid.is_some(), "film"),
        (oblique, "oblique"),
        (setup.rubs() && !oblique, "friction"),
        (setup.relaxes(), "relaxing"),
        (setup.yields(), "yielding"),
        (!setup.outer.is_centred() && !oblique, "off-centre"),
    ];
    let mut has = features.into_iter().filter(|(has, _)| *has).map(|(_, name)| name);
    match (has.next(), has.next()) {
        (None, _) => Ok("dry"),
        (Some(name), None) => Ok(name),
        (Some(first), Some(second)) => {
            Err(format!("the validation base has no scenes that are both `{first}` and `{second}`"))
        }
    }
}

/// Numbers of `setup` that were drawn for the base.
pub(super) fn numbers(setup: &PlateImpact) -> Vec<(&'static str, f64)> {
    let (plate, outer, inner) = (&setup.plate, &setup.outer, &setup.inner);
    let fluid = setup.fluid.as_ref();
    // at the centre either sign is the other's mirror image
    let angle = if outer.offset == 0.0 { outer.angle.abs() } else { outer.angle };
    let angle = (angle != 0.0).then_some(("angle of the velocity in rad", angle));
    let numbers = [
        ("thickness over radius of the plate", plate.thickness / plate.radius),
        ("Poisson's ratio of the plate", plate.material.poisson_ratio),
        ("damping ratio of the plate", fluid.map_or(plate.damping_ratio, |fluid| fluid.plate_damping_ratio)),
        (
            "modulus of the outer body over the plate's",
            outer.material.youngs_modulus / plate.material.youngs_modulus,
        ),
        (
            "modulus of the inner body over the plate's",
            inner.material.youngs_modulus / plate.material.youngs_modulus,
        ),
        ("speed of the inner body over the outer one's", inner.speed / outer.speed),
        ("gap of the inner body over the plate's thickness", inner.gap / plate.thickness),
        ("coefficient of friction", outer.turning.friction.max(inner.turning.friction)),
        ("offset over radius of the plate", outer.offset / plate.radius),
        (
            "minimum gap of the film over the tip radius",
            fluid.map_or(0.0, |fluid| fluid.minimum_gap / inner.shape.tip_radius()),
        ),
        (
            "first frequency of the wet plate over the dry one's",
            fluid.map_or(1.0, |fluid| fluid.added_mass_frequency_ratio),
        ),
    ];
    numbers.into_iter().chain(angle).collect()
}

/// Numbers of its result `summary`, wherever the plate is struck and whatever its materials do: patch and pressure are those of Hertz at
/// the force peak.
pub(super) fn result_numbers(
    setup: &PlateImpact,
    end_time: Option<f64>,
    summary: &Summary,
) -> Option<Vec<(&'static str, f64)>> {
    let bodies = [
        ("outer_force_peak", &setup.outer.shape, &setup.outer.material),
        ("inner_force_peak", &setup.inner.shape, &setup.inner.material),
    ];
    let (mut patch, mut overload) = (0.0_f64, 0.0_f64);
    for (peak, shape, material) in bodies {
        let force = summary.value(peak).unwrap_or(0.0);
        let law = Hertz::new(shape.tip_radius(), material, &setup.plate.material);
        let strength = [material, &setup.plate.material].into_iter().filter_map(Material::plasticity);
        let weakest = strength.map(|of| of.yield_strength).fold(f64::INFINITY, f64::min);
        patch = patch.max(law.contact_radius(force));
        overload = overload.max(law.maximum_pressure(force) / weakest);
    }
    let [outer, inner] = bodies.map(|(_, shape, material)| shape.mass(material));
    // of a run that ends during the contact: its end
    let end = summary.value("outer_contact_end").or(end_time)?;
    let contact = end * summary.value("first_frequency")?;
    let measures = [patch / setup.plate.thickness, contact, inner / outer];
    let loss_factor = |material: &&Material| {
        let [storage, loss] = modulus_ratio(&material.relaxation, 0.5 / end);
        loss / storage
    };
    let plastic = setup.materials().into_iter().filter_map(Material::plasticity);
    let growth = plastic.map(|of| of.hardening / of.yield_strength).fold(0.0, f64::max);
    let special = [
        setup.yields().then_some(("pressure over yield strength", overload)),
        setup.yields().then_some(("yield stress at a plastic strain of 1 over the first one", 1.0 + growth)),
        setup.relaxes().then(|| {
            let largest = setup.materials().iter().map(loss_factor).fold(0.0, f64::max);
            ("loss factor at the frequency of the contact", largest)
        }),
        stokes_number(setup).map(|number| ("Stokes number of the film", number)),
        summary.losses.filter(|_| stokes_number(setup).is_some()).map(|losses| {
            (FILM_ERROR, FILM_SHARE * losses.squeeze_film / (0.5 * outer * setup.outer.speed.powi(2)))
        }),
    ];
    let numbers: Vec<(&str, f64)> =
        MEASURES.into_iter().zip(measures).chain(special.into_iter().flatten()).collect();
    numbers.iter().all(|(_, value)| value.is_finite() && *value > 0.0).then_some(numbers)
}

/// Stokes number of the squeeze film, m v/(6 pi mu R^2) of the inner body at the outer one's speed; `None` without a film.
pub fn stokes_number(setup: &PlateImpact) -> Option<f64> {
    let fluid = setup.fluid.as_ref().filter(|fluid| fluid.squeeze_film)?;
    let inner = &setup.inner;
    let tip = inner.shape.tip_radius();
    let mass = inner.shape.mass(&inner.material);
    Some(mass * setup.outer.speed / (6.0 * PI * fluid.viscosity * tip * tip))
}
