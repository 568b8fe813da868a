//! From the checked values of a plate impact to its types.

use super::PlateImpact;
use super::keys::DEFAULT_ELEMENTS;
use crate::Result;
use crate::kinds::body_keys::SOLID_ELEMENTS;
use crate::kinds::body_reading;
use crate::scene::material::material;
use crate::scene::read::refused;
use crate::scene::values::{Checked, Node, Values, element_order, unknown};
use crate::scene::{Edge, Fluid, Geometry, Plate, ReferenceSettings, Rigid, ShearThinning};

/// The plate that the table `plate` describes.
pub(in crate::kinds) fn plate(plate: &Node, materials: &Node) -> Result<Plate> {
    Ok(Plate {
        radius: plate.number("radius")?,
        thickness: plate.number("thickness")?,
        edge: match plate.text("edge")? {
            "clamped" => Edge::Clamped,
            "simply-supported" => Edge::SimplySupported,
            "free" => Edge::Free,
            other => return Err(unknown("edge", other)),
        },
        material: material(materials, plate.text("material")?)?,
        damping_ratio: plate.number_or("damping_ratio", 0.0)?,
    })
}

/// The bodies of a plate impact.
pub(super) fn plate_impact(root: &Node, materials: &Node) -> Result<PlateImpact> {
    let plate = plate(&root.table("plate")?, materials)?;
    let friction = root.number_or("friction", 0.0)?;
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
    let shear_thinning = fluid.0.contains_key("power_index").then(|| -> Result<ShearThinning> {
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
        squeeze_film: !matches!(fluid.0.get("squeeze_film"), Some(Checked::Flag(false))),
        added_mass_frequency_ratio: fluid.number_or("added_mass_frequency_ratio", 1.0)?,
        plate_damping_ratio: fluid.number_or("plate_damping_ratio", plate.damping_ratio)?,
        drag_coefficient: fluid.number_or("drag_coefficient", 0.0)?,
        shear_thinning,
    })
}

/// Settings of the reference of a plate impact that has an axis of symmetry, or has none.
pub(super) fn reference(settings: Option<Node>, centred: bool) -> Result<ReferenceSettings> {
    let empty = Values::new();
    let settings = settings.unwrap_or(Node(&empty));
    let geometry = match settings.0.get("geometry") {
        Some(Checked::Text(word)) if word == "solid" => Geometry::Solid,
        Some(_) if !centred => {
            return Err(refused(
                "`reference.geometry` is \"axisymmetric\", but `outer.offset` or `outer.angle` leaves no axis of symmetry",
                "set it to \"solid\", or leave it out",
            ));
        }
        None if !centred => Geometry::Solid,
        _ => Geometry::Axisymmetric,
    };
    let default = if geometry == Geometry::Solid { SOLID_ELEMENTS } else { DEFAULT_ELEMENTS };
    let rigid = match settings.0.get("rigid") {
        Some(Checked::Text(word)) if word == "outer" => Some(Rigid::Outer),
        Some(Checked::Text(word)) if word == "inner" => Some(Rigid::Inner),
        Some(Checked::Text(word)) if word == "both" => Some(Rigid::Both),
        _ => None,
    };
    Ok(ReferenceSettings {
        geometry,
        elements_per_contact_radius: Some(settings.number_or("elements_per_contact_radius", default)?),
        elements_per_ring_radius: None,
        element_order: element_order(&settings),
        rigid,
    })
}
