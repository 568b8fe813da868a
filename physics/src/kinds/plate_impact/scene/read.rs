//! From the checked values of a plate impact to its types.

use super::PlateImpact;
use super::keys::{DEFAULT_ELEMENTS, THROUGH};
use crate::Result;
use crate::kinds::body_keys::SOLID_ELEMENTS;
use crate::kinds::body_reading;
use crate::scene::material::material;
use crate::scene::read::refused;
use crate::scene::values::Node;
use crate::scene::{Fluid, Geometry, Plate, ReferenceSettings, ShearThinning};

/// The plate that the table `plate` describes.
pub(in crate::kinds) fn plate(plate: &Node, materials: &Node) -> Result<Plate> {
    Ok(Plate {
        radius: plate.number("radius")?,
        thickness: plate.number("thickness")?,
        edge: plate.word("edge")?,
        material: material(materials, plate.text("material")?)?,
        damping_ratio: plate.number("damping_ratio")?,
    })
}

/// The bodies of a plate impact.
pub(super) fn plate_impact(root: &Node, materials: &Node) -> Result<PlateImpact> {
    let plate = plate(&root.table("plate")?, materials)?;
    let friction = root.number("friction")?;
    Ok(PlateImpact {
        fluid: root.optional_table("fluid")?.map(|f| fluid(&f, &plate)).transpose()?,
        friction,
        outer: body_reading::outer(&root.table("outer")?, materials, friction)?,
        inner: body_reading::inner(&root.table("inner")?, materials, friction)?,
        plate,
        series: body_reading::series(root)?,
    })
}

fn fluid(fluid: &Node, plate: &Plate) -> Result<Fluid> {
    let shear_thinning = fluid.has("power_index").then(|| -> Result<ShearThinning> {
        Ok(ShearThinning {
            infinite_shear_viscosity: fluid.number("infinite_shear_viscosity")?,
            relaxation_time: fluid.number("relaxation_time")?,
            power_index: fluid.number("power_index")?,
        })
    });
    let shear_thinning = shear_thinning.transpose()?;
    if let Some(law) = &shear_thinning
        && law.infinite_shear_viscosity > fluid.number("viscosity")?
    {
        return Err(refused(
            &format!(
                "`fluid.infinite_shear_viscosity` is {} Pa*s, but it must be at most `fluid.viscosity`, {} Pa*s",
                law.infinite_shear_viscosity,
                fluid.number("viscosity")?
            ),
            "a shear-thinning fluid is the thinner the faster it is sheared",
        ));
    }
    Ok(Fluid {
        viscosity: fluid.number("viscosity")?,
        density: fluid.number("density")?,
        minimum_gap: fluid.number("minimum_gap")?,
        squeeze_film: fluid.flag("squeeze_film")?,
        added_mass_frequency_ratio: fluid.number("added_mass_frequency_ratio")?,
        plate_damping_ratio: fluid.optional_number("plate_damping_ratio")?.unwrap_or(plate.damping_ratio),
        drag_coefficient: fluid.number("drag_coefficient")?,
        shear_thinning,
    })
}

/// Geometry of the reference of a plate impact that has an axis of symmetry, or has none.
pub(super) fn geometry(settings: &Node, centred: bool) -> Result<Geometry> {
    match settings.optional_word("geometry")? {
        Some(Geometry::Axisymmetric) if !centred => Err(refused(
            "`reference.geometry` is \"axisymmetric\", but `outer.offset` or `outer.angle` leaves no axis of symmetry",
            "set it to \"solid\", or leave it out",
        )),
        Some(geometry) => Ok(geometry),
        None if centred => Ok(Geometry::Axisymmetric),
        None => Ok(Geometry::Solid),
    }
}

/// Settings of the reference of a plate impact that has an axis of symmetry, or has none.
pub(super) fn reference(settings: &Node, centred: bool) -> Result<ReferenceSettings> {
    let geometry = geometry(settings, centred)?;
    let elements = settings.optional_number("elements_per_contact_radius")?;
    let through = settings.optional_number("elements_per_thickness")?;
    let element_order = settings.optional_count("element_order")?;
    let rigid = if settings.text("rigid")? == "none" { None } else { Some(settings.word("rigid")?) };
    if geometry == Geometry::Axisymmetric {
        return Ok(ReferenceSettings {
            elements_per_contact_radius: Some(elements.unwrap_or(DEFAULT_ELEMENTS)),
            ..ReferenceSettings::of(geometry)
        });
    }
    Ok(ReferenceSettings {
        elements_per_contact_radius: Some(elements.unwrap_or(SOLID_ELEMENTS)),
        elements_per_thickness: Some(through.unwrap_or(THROUGH)),
        element_order,
        rigid,
        ..ReferenceSettings::of(geometry)
    })
}
