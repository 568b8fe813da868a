//! The group of the validation base that an impact on a body belongs to, and its numbers.

use impactcheck_physics::contact::Hertz;
use impactcheck_physics::kinds::general_impact::GeneralImpact;
use impactcheck_physics::result::Summary;
use impactcheck_physics::scene::Shape;

/// The group of `setup`, as `validation/draw.py` names it.
///
/// # Errors
/// A sentence of an impact that the base has none like.
pub(super) fn stratum(setup: &GeneralImpact) -> Result<&'static str, String> {
    let Some(body) = setup.body() else {
        return Err(
            "the validation base has no impacts on walls or of two bodies: they have a closed form".into()
        );
    };
    let inner = setup.inner.as_ref().map(|inner| &inner.shape);
    let spheres = [Some(&setup.outer.shape), inner]
        .into_iter()
        .flatten()
        .all(|shape| matches!(shape, Shape::Sphere { .. }));
    let elastic = setup
        .materials()
        .iter()
        .all(|material| material.relaxation.is_empty() && material.yield_strength.is_none());
    let uniform = body.materials.all().len() == 1;
    let single = uniform
        && !setup.rubs()
        && !setup.spins()
        && setup.series.is_none()
        && setup.outer.is_centred()
        && body.damping_ratio == 0.0;
    match spheres && elastic && single {
        true => Ok("body"),
        false => {
            Err("the validation base has single impacts of elastic spheres without friction on undamped bodies of one material only".into())
        }
    }
}

/// Numbers of `setup` that were drawn for the base.
pub(super) fn numbers(setup: &GeneralImpact) -> Vec<(&'static str, f64)> {
    let (outer, face) = (&setup.outer, setup.face());
    let mass = outer.shape.mass(&outer.material);
    let inner = setup.inner.as_ref();
    vec![
        (
            "modulus of the outer body over the struck body's",
            outer.material.youngs_modulus / face.youngs_modulus,
        ),
        (
            "modulus of the inner body over the struck body's",
            inner.map_or(&outer.material, |inner| &inner.material).youngs_modulus / face.youngs_modulus,
        ),
        ("Poisson's ratio of the struck body", face.poisson_ratio),
        ("mass of the inner body over the outer one's", setup.inner_mass().unwrap_or(0.0) / mass),
        (
            "speed of the inner body over the outer one's",
            inner.map_or(0.0, |inner| inner.speed) / outer.speed,
        ),
        (
            "gap of the inner body over the outer one's tip radius",
            inner.map_or(0.0, |inner| inner.gap) / outer.shape.tip_radius(),
        ),
        ("whether the struck body is held", f64::from(u8::from(setup.is_held() == Some(true)))),
    ]
}

/// Numbers of its result `summary`; the contact radius is that of Hertz on a flat face.
pub(super) fn result_numbers(setup: &GeneralImpact, summary: &Summary) -> Option<Vec<(&'static str, f64)>> {
    let outer = &setup.outer;
    let tip = outer.shape.tip_radius();
    let radius =
        Hertz::new(tip, &outer.material, &setup.face()).contact_radius(summary.value("outer_force_peak")?);
    let period = summary.value("outer_contact_end")? * summary.value("first_frequency")?;
    let numbers = vec![("contact/period", period), ("patch/tip radius", radius / tip)];
    numbers.iter().all(|(_, value)| value.is_finite() && *value > 0.0).then_some(numbers)
}
