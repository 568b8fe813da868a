//! A reference and a reduced model side by side over time: the fields of the one, the deflection of the other.

use crate::curves::{CommonAxis, at};
use crate::error::{Error, Result};
use crate::kinds::{self, Use};
use crate::reference::{FieldMesh, Stored};
use crate::result::{Outcome, Source};
use crate::scene::{Geometry, Scene};

/// Instants, as far as the reference's fields don't give them.
const INSTANTS: usize = 40;
/// More fields than these are thinned out, fewer don't show a movement.
const FIELDS: std::ops::RangeInclusive<usize> = 8..=60;
/// Places along the radius at which the deflection is known.
const RADII: usize = 121;

/// What moves, at a few dozen instants; displacements in m, signed along z.
#[derive(Debug, Clone, PartialEq)]
pub struct Movement {
    /// The instants, s.
    pub times: Vec<f64>,
    /// The reference's fields at the instants; none if none are stored.
    pub fields: Vec<FieldMesh>,
    /// Which of the reduced outcomes it is: the one that says most of the plate.
    pub model: usize,
    /// Places along the plate's radius, m.
    pub radii: Vec<f64>,
    /// Deflection of the model's plate. Shape (times, radii).
    pub deflection: Vec<Vec<f64>>,
    /// Displacement of outer and inner body in the model. Each of shape (times).
    pub bodies: [Vec<f64>; 2],
}

impl Movement {
    /// Whether enough fields are stored to show a movement; those of solid references are not drawn.
    pub fn has_fields(scene: &Scene, stored: &Stored) -> bool {
        scene.reference.geometry == Geometry::Axisymmetric
            && stored.fields_over_time().is_ok_and(|series| series.len() >= *FIELDS.start())
    }

    /// Of the `reduced` outcomes of `scene` the most exact beside the reference in the store.
    ///
    /// # Errors
    /// [`Error::Usage`] if it can't be told for this scene, [`Error::Reference`] for fields that can't be read, and those of
    /// the model.
    pub fn of(scene: &Scene, stored: &Stored, reduced: &[Outcome]) -> Result<Self> {
        let kind = kinds::serving(scene, Use::Animation)?;
        let own = reduced.iter().enumerate().filter(|(_, outcome)| outcome.summary.source == Source::Reduced);
        let ranked = own.max_by(|a, b| a.1.summary.model.cmp(&b.1.summary.model));
        let named = |outcome: &Outcome| outcome.summary.model.as_deref().and_then(|name| name.parse().ok());
        let (model, outcome, name) =
            ranked.and_then(|(k, outcome)| Some((k, outcome, named(outcome)?))).ok_or_else(|| {
                Error::Usage("an animation needs a reduced model, of which there is none".into())
            })?;
        let fields = if Self::has_fields(scene, stored) { fields(stored) } else { Ok(Vec::new()) };
        let (mut times, fields): (Vec<f64>, Vec<FieldMesh>) =
            fields.map_err(Error::Reference)?.into_iter().unzip();
        if fields.is_empty() {
            times = evenly(&stored.outcome);
        }
        let model_of = (name, outcome.summary.modes);
        let (radii, deflection) = kind.deflection(scene, model_of, &outcome.history, RADII, &times)?;
        let body = |name| at(name, &outcome.history, times.iter().copied());
        let bodies = [body("outer_displacement"), body("inner_displacement")];
        Ok(Movement { times, fields, model, radii, deflection, bodies })
    }
}

fn evenly(reference: &Outcome) -> Vec<f64> {
    let end = CommonAxis::of_reference(reference).map_or(0.0, |axis| axis.end);
    (0..INSTANTS).map(|k| end * k as f64 / (INSTANTS - 1) as f64).collect()
}

/// The stored fields, if all have displacement and stress.
fn fields(stored: &Stored) -> std::result::Result<Vec<(f64, FieldMesh)>, String> {
    let series = stored.fields_over_time()?;
    let every = series.len().div_ceil(*FIELDS.end());
    let read =
        series.into_iter().step_by(every).map(|(instant, file)| Ok((instant, FieldMesh::read(&file)?)));
    let fields: Vec<(f64, FieldMesh)> = read.collect::<std::result::Result<_, String>>()?;
    let whole = |mesh: &FieldMesh| mesh.displacement.is_some() && mesh.von_mises.is_some();
    Ok(if fields.iter().all(|(_, mesh)| whole(mesh)) { fields } else { Vec::new() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinds::plate_impact::reduced::Reduced;
    use crate::scene::Model;
    use std::fs;
    use std::path::Path;

    /// A field of one element that has moved by `time` * 1 m/s upwards.
    fn write_field(file: &Path, time: f64) {
        let moved = format!("0 {time} 0 ").repeat(4);
        let text = format!(
            r#"<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>
<Piece NumberOfPoints="4" NumberOfCells="1">
<PointData><DataArray type="Float64" Name="displacement" NumberOfComponents="3" format="ascii">{moved}</DataArray></PointData>
<Points><DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">0 0 0 1 0 0 1 2 0 0 2 0</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int64" Name="types" format="ascii">9</DataArray></Cells>
<CellData><DataArray type="Int32" Name="body" format="ascii">1</DataArray>
<DataArray type="Float64" Name="von_mises" format="ascii">5</DataArray></CellData>
</Piece></UnstructuredGrid></VTKFile>"#
        );
        fs::write(file, text).expect("field");
    }

    /// What a store with `count` fields, listed backwards, gives.
    fn movement(count: usize) -> (Movement, Vec<Outcome>) {
        let folder = tempfile::tempdir().expect("folder");
        let mut entries = String::new();
        for k in (0..count).rev() {
            let time = 1e-6 * k as f64;
            write_field(&folder.path().join(format!("stress_{k}.vtu")), time);
            entries += &format!("<DataSet timestep=\"{time:e}\" file=\"stress_{k}.vtu\"/>");
        }
        let series = format!("<VTKFile><Collection>{entries}</Collection></VTKFile>");
        fs::write(folder.path().join("stress.pvd"), series).expect("series");
        let text = include_str!("../tests/fixtures/plate-impact.toml");
        let scene = Scene::parse("plate-impact.toml", text).expect("valid");
        let run =
            |model| Reduced::new(&scene, model, None).and_then(|r| r.run_with_history(1e-6)).expect("runs");
        let reduced = vec![run(Model::B), run(Model::A)];
        let stored = Stored {
            outcome: reduced[0].clone(),
            bands: None,
            provenance: serde_json::Value::Null,
            folder: folder.path().to_owned(),
            earlier: None,
        };
        assert_eq!(Movement::has_fields(&scene, &stored), count >= 8);
        (Movement::of(&scene, &stored, &reduced).expect("movement"), reduced)
    }

    #[test]
    fn fields_stand_in_their_order_with_the_models_state_at_their_instants() {
        let (movement, reduced) = movement(70);
        // more than sixty: every second
        assert_eq!((movement.times.len(), movement.fields.len(), movement.model), (35, 35, 0));
        for (k, (time, field)) in movement.times.iter().zip(&movement.fields).enumerate() {
            assert!((time - 2e-6 * k as f64).abs() < 1e-15, "{time}");
            assert_eq!(field.displacement, Some(vec![[0.0, *time]; 4]));
        }
        // the curve has the dents under the contacts as well, a twentieth of it at most
        let history = &reduced[0].history;
        let expected = at("plate_displacement", history, movement.times.iter().copied());
        let largest = expected.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
        assert!(largest > 1e-6);
        for (row, expected) in movement.deflection.iter().zip(expected) {
            assert!((row[0] - expected).abs() < 0.06 * largest, "{} is not {expected}", row[0]);
        }
        assert!(movement.bodies[0].last() < movement.bodies[0].first());
    }

    #[test]
    fn with_few_fields_or_none_the_instants_are_even_and_the_model_alone() {
        for count in [0, 7] {
            let (movement, _) = movement(count);
            assert_eq!((movement.times.len(), movement.fields.len()), (INSTANTS, 0));
            assert!(movement.times[0] == 0.0 && movement.times.is_sorted());
        }
    }
}
