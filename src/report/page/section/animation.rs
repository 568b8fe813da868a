//! The impact moving: a still in the page, the animation beside it.

use crate::format::{prefixed, with_unit};
use crate::report::SceneReport;
use crate::scene::Scene;
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::{Markup, html};

/// The animation's file beside the page.
pub(crate) fn file(scene: &str) -> String {
    format!("{scene}-impact.gif")
}

/// The command that stores the fields which an animation of `scene` shows.
pub fn fields_command(scene: &Scene) -> String {
    format!("impactcheck reference {} --fields 40", scene.name)
}

/// Section of the page; nothing if there is no animation. It plays when it is asked for, and is loaded then.
pub(crate) fn animation_html(report: &SceneReport) -> Markup {
    let Some(film) = &report.attachments.film else { return html! {} };
    let instant = with_unit(film.instant, prefixed("s", film.instant), 3);
    let megabytes = film.gif.len() as f64 / 1e6;
    html! {
        figure.pictures {
            img.film src=(format!("data:image/png;base64,{}", BASE64_STANDARD.encode(&film.still)))
                alt=(format!("{} At {instant}.", film.told));
            figcaption { (film.told) " Shown: " (instant) "." }
        }
        details.film {
            summary { "Play (GIF, " (format!("{megabytes:.1}")) " MB)" }
            img.film src=(file(&report.comparison.scene)) loading="lazy" alt=(film.told);
        }
    }
}
