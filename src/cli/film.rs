//! The animation of a comparison.

use super::Context;
use crate::error::Result;
use crate::movement::Movement;
use crate::reference::Stored;
use crate::report::{self, Animation};
use crate::result::Outcome;
use crate::scene::{Geometry, Scene};

/// The impact of `scene` moving, if the reference has fields over time or an animation is `asked` for.
///
/// # Errors
/// If one is asked for, those of [`Movement::of`] and [`report::film`].
pub(super) fn film(
    context: &Context,
    scene: &Scene,
    (stored, reduced): (&Stored, &[Outcome]),
    asked: bool,
) -> Result<Option<Animation>> {
    if !asked && !Movement::has_fields(scene, stored) {
        return Ok(None);
    }
    let film = Movement::of(scene, stored, reduced).and_then(|movement| {
        if movement.fields.is_empty() {
            // fields without displacement are no reason for a film of the model alone
            if !asked {
                return Ok(None);
            }
            context.note(alone(scene));
        }
        report::film(scene, &stored.outcome, reduced, &movement).map(Some)
    });
    match film {
        Err(error) if !asked => {
            context.note(format_args!("scene `{}` has no animation: {error}", scene.name));
            Ok(None)
        }
        film => film,
    }
}

/// That there is no field to show, and which command makes some.
fn alone(scene: &Scene) -> String {
    let alone = format!("{}: the animation shows the reduced model alone", scene.name);
    match scene.reference.geometry {
        Geometry::Axisymmetric => {
            format!("{alone}; `{}` stores fields of the reference", report::fields_command(scene))
        }
        Geometry::Solid => format!("{alone}; fields of a solid reference are not drawn"),
    }
}
