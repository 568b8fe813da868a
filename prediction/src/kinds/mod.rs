//! What makes scenes of each kind similar.

mod general_impact;
mod plate_impact;
mod seal_seat;

pub use plate_impact::stokes_number;

use impactcheck_physics::kinds as physics;
use impactcheck_physics::result::Summary;
use impactcheck_physics::scene::Scene;

/// Numbers by name.
pub(crate) type Numbers = Vec<(&'static str, f64)>;

/// What predictions have to know of a kind of scene.
pub(crate) trait Kind: physics::Kind {
    /// Group of the validation base that `scene` belongs to.
    ///
    /// # Errors
    /// A sentence of scenes that the base has none like.
    fn stratum(&self, _: &Scene) -> Result<&'static str, String>;

    /// Dimensionless numbers of `scene` by name that scenes of the base are drawn in.
    fn numbers(&self, _: &Scene) -> Numbers;

    /// Dimensionless numbers of `scene` by name that its result decides, with the `summary` of model C; all positive, or `None` if that
    /// does not tell.
    fn result_numbers(&self, _: &Scene, _summary: &Summary) -> Option<Numbers> {
        Some(Vec::new())
    }

    /// Speed of the outer body in m/s, the scale of velocities; NaN of kinds whose quantities have no scale of it.
    fn speed(&self, _: &Scene) -> f64 {
        f64::NAN
    }
}

impl Kind for physics::plate_impact::Kind {
    fn stratum(&self, scene: &Scene) -> Result<&'static str, String> {
        plate_impact::stratum(scene.plate_impact().map_err(|error| error.to_string())?)
    }

    fn numbers(&self, scene: &Scene) -> Numbers {
        scene.plate_impact().map(plate_impact::numbers).unwrap_or_default()
    }

    fn result_numbers(&self, scene: &Scene, summary: &Summary) -> Option<Numbers> {
        plate_impact::result_numbers(scene.plate_impact().ok()?, scene.run.end_time, summary)
    }

    fn speed(&self, scene: &Scene) -> f64 {
        scene.plate_impact().map_or(f64::NAN, |setup| setup.outer.speed)
    }
}

impl Kind for physics::seal_seat::Kind {
    fn stratum(&self, scene: &Scene) -> Result<&'static str, String> {
        seal_seat::stratum(scene.seal_seat().map_err(|error| error.to_string())?)
    }

    fn numbers(&self, scene: &Scene) -> Numbers {
        scene.seal_seat().map(seal_seat::numbers).unwrap_or_default()
    }
}

impl Kind for physics::general_impact::Kind {
    fn stratum(&self, scene: &Scene) -> Result<&'static str, String> {
        general_impact::stratum(scene.general_impact().map_err(|error| error.to_string())?)
    }

    fn numbers(&self, scene: &Scene) -> Numbers {
        scene.general_impact().map(general_impact::numbers).unwrap_or_default()
    }

    fn result_numbers(&self, scene: &Scene, summary: &Summary) -> Option<Numbers> {
        general_impact::result_numbers(scene.general_impact().ok()?, summary)
    }

    fn speed(&self, scene: &Scene) -> f64 {
        scene.general_impact().map_or(f64::NAN, |setup| setup.outer.normal_speed())
    }
}

/// The kinds that the validation base has scenes of.
const KINDS: [&dyn Kind; 3] =
    [&physics::plate_impact::Kind, &physics::seal_seat::Kind, &physics::general_impact::Kind];

/// The kind of `scene`.
///
/// # Errors
/// A sentence of a kind that the base has no scenes of.
pub(crate) fn of(scene: &Scene) -> Result<&'static dyn Kind, String> {
    let name = physics::of(scene).name();
    let found = KINDS.into_iter().find(|kind| kind.name() == name);
    found.ok_or_else(|| format!("the validation base has no scenes of kind `{name}`"))
}
