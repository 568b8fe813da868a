//! The map of validated scenes: where models were compared with references, how right they were there, and where a scene lies
//! among them. Two views per model share the axis of the patch, so that what is near in both is near in all three numbers.

use crate::format::{percent, percent_above, significant, words};
use crate::plot::axis::{Plot, PlotAxis};
use crate::plot::svg::{FONT_SIZE, Svg, Theme, x2};
use crate::report::page::discrepancy_picture::mark;
use crate::report::page::html::scrolled;
use crate::report::trust::size_class;
use crate::validated::{MEASURES, Place, Row, Validation};
use maud::{Markup, html};

/// Name of the drawing beside a report.
pub(crate) const FILE: &str = "validated.svg";
/// Models of plates that are trusted for numbers, in the order of the map.
const MODELS: [&str; 2] = ["B", "C"];
/// Size of a view, and the room around its axes, px.
const WIDTH: f64 = 380.0;
const HEIGHT: f64 = 234.0;
const LEFT: f64 = 52.0;
const RIGHT: f64 = 10.0;
const TOP: f64 = 26.0;
const BOTTOM: f64 = 46.0;
/// Factor up to which each of the numbers may differ of scenes in the dashed frame.
const NEAR: f64 = 2.0;
/// Most marks on an axis.
const MARKS: usize = 10;
/// What the axes reach beyond the outermost scene, as a factor.
const ROOM: f64 = 1.7;

/// The validations that can be drawn, and where the scene of the page lies.
pub(crate) struct ValidatedMap<'a> {
    placed: Vec<(&'a Validation, Place)>,
    here: Option<Place>,
}

impl<'a> ValidatedMap<'a> {
    /// `None` if there is nothing to draw.
    pub(crate) fn of(validations: &'a [Validation], here: Option<Place>) -> Option<Self> {
        let placed: Vec<_> = validations.iter().filter_map(|v| v.place.map(|place| (v, place))).collect();
        (!placed.is_empty()).then_some(ValidatedMap { placed, here })
    }

    /// For a page: views, what they show, and the same in numbers.
    pub(crate) fn html(&self) -> Markup {
        html! {
            div.map { @for (model, measure) in views() { (self.view(model, measure, None)) } }
            p.soft.note {
                "Every mark is a scene in which the model was compared with a reference: it differs in efficiency and peak forces by "
                @for (shape, size, label) in [(2, "small", "up to 1 %, "), (1, "medium", "up to 5 %, "), (0, "large", "more. ")] {
                    svg.key viewBox="-6 -6 12 12" aria-hidden="true" { (mark(shape, &format!("size-{size}"))) } " " (label)
                }
                @if self.here.is_some() { "Ring: this scene; dashed: within a factor of " (NEAR) " of it. " }
                "Patch: the larger contact patch's radius at the force peak; contact: end of the outer contact; period: the plate's first; "
                "mass ratio: inner body over outer body."
            }
            details { summary { "The " (self.scenes().len()) " scenes in numbers" } (scrolled("Compared scenes", &self.table())) }
        }
    }

    /// As a file of its own.
    pub(crate) fn svg(&self) -> String {
        let views: Vec<_> = views().collect();
        let place = |k: usize| ((k % 2) as f64 * WIDTH, (k / 2) as f64 * HEIGHT);
        let (width, height) = (2.0 * WIDTH, HEIGHT * MODELS.len() as f64);
        let drawing = html! {
            @for (k, (model, measure)) in views.into_iter().enumerate() { (self.view(model, measure, Some(place(k)))) }
        };
        let title = "Scenes in which models were compared with references";
        Svg::new(title, [width, height], Theme::Standalone).around(&drawing).into_string()
    }

    /// One view: `measure` over the first one, of `model`.
    fn view(&self, model: &str, measure: usize, at: Option<(f64, f64)>) -> Markup {
        let plot = Plot {
            left: LEFT,
            top: TOP,
            width: WIDTH - LEFT - RIGHT,
            height: HEIGHT - TOP - BOTTOM,
            x: self.axis(0),
            y: self.axis(measure),
        };
        let measures = |place: &Place| (place.measures()[0], place.measures()[measure]);
        let (x_marks, y_marks) = (plot.x.marks(MARKS), plot.y.marks(MARKS));
        let own = self.placed.iter().filter(|(v, _)| v.model == model);
        let description = format!(
            "Model {model}: {} over {} of {} scenes",
            MEASURES[measure],
            MEASURES[0],
            own.clone().count()
        );
        html! {
            svg viewBox=(format!("0 0 {WIDTH} {HEIGHT}")) x=[at.map(|at| at.0)] y=[at.map(|at| at.1)] width=[at.map(|_| WIDTH)]
                height=[at.map(|_| HEIGHT)] font-size=(FONT_SIZE) role="img" aria-label=(description) {
                (plot.grid(&x_marks, &y_marks))
                (plot.below(&x_marks, MEASURES[0]))
                (plot.left_labels(&y_marks, ""))
                (plot.outline())
                text x=(LEFT) y="17" { tspan font-weight="600" { (model) } ": " (MEASURES[measure]) }
                @if let Some(here) = &self.here {
                    @let (x, y) = plot.at(measures(here));
                    @let [left, right] = [1.0 / NEAR, NEAR].map(|f| plot.x(f * measures(here).0).clamp(LEFT, WIDTH - RIGHT));
                    @let [bottom, top] = [1.0 / NEAR, NEAR].map(|f| plot.y(f * measures(here).1).clamp(TOP, HEIGHT - BOTTOM));
                    rect.fig-frame stroke-dasharray="4 3" x=(x2(left)) y=(x2(top)) width=(x2(right - left)) height=(x2(bottom - top)) {}
                    circle.fig-frame.here cx=(x2(x)) cy=(x2(y)) r="8" stroke-width="2" {}
                }
                @for (validation, at) in own {
                    @if let Some(worst) = validation.worst() {
                        @let (x, y) = plot.at(measures(at));
                        g transform=(format!("translate({} {})", x2(x), x2(y))) data-scene=(validation.scene) data-off=(worst.relative()) {
                            title { (validation.scene) ": " (words(&worst.quantity)) " " (percent(Some(worst.relative()))) (band(worst)) }
                            (mark(shape(worst), &format!("size-{}", size_class(worst.relative()))))
                        }
                    }
                }
            }
        }
    }

    /// The axis of a measure, the same in all views.
    fn axis(&self, measure: usize) -> PlotAxis {
        let places = self.placed.iter().map(|(_, place)| place).chain(&self.here);
        let values = places.map(|place| place.measures()[measure]);
        PlotAxis::over(values.flat_map(|value| [value / ROOM, value * ROOM]), true)
    }

    /// The scenes with their validations, the nearest first, or by the first measure.
    fn scenes(&self) -> Vec<&[(&'a Validation, Place)]> {
        let mut scenes: Vec<_> = self.placed.chunk_by(|one, other| one.0.scene == other.0.scene).collect();
        let order = |place: &Place| self.here.map_or(place.measures()[0], |here| here.factor(place));
        scenes.sort_by(|a, b| order(&a[0].1).total_cmp(&order(&b[0].1)));
        scenes
    }

    fn table(&self) -> Markup {
        let mut models: Vec<&str> = self.placed.iter().map(|(v, _)| &*v.model).collect();
        models.sort_unstable();
        models.dedup();
        html! { table.validated {
            thead { tr {
                th scope="col" { "scene" }
                @for measure in MEASURES { th scope="col" { (measure) } }
                @if self.here.is_some() { th scope="col" { "away by a factor of" } }
                @for model in &models { th scope="col" { (model) " differs by (uncertainty, 95 %)" } }
            } }
            tbody { @for scene in self.scenes() { @let place = &scene[0].1; tr {
                th scope="row" { (scene[0].0.scene) }
                @for measure in place.measures() { td { (significant(measure, 3)) } }
                @if let Some(here) = &self.here { td { (significant(here.factor(place), 3)) } }
                @for model in &models {
                    @match scene.iter().find(|(v, _)| v.model == *model).and_then(|(v, _)| v.worst()) {
                        Some(worst) => td title=(words(&worst.quantity)) {
                            span class=(format!("off {}", size_class(worst.relative()))) { (percent(Some(worst.relative()))) } (band(worst))
                        },
                        None => td { "–" },
                    }
                }
            } } }
        } }
    }
}

/// The views: a model, and the measure that is drawn over the first one.
fn views() -> impl Iterator<Item = (&'static str, usize)> {
    MODELS.into_iter().flat_map(|model| [(model, 1), (model, 2)])
}

/// The reference's band, in brackets.
fn band(row: &Row) -> String {
    row.relative_band().map_or(String::new(), |band| format!(" (±{})", percent_above(band)))
}

/// Shape of the mark, so that the sizes are told apart without colours.
fn shape(row: &Row) -> usize {
    match size_class(row.relative()) {
        "large" => 0,
        "medium" => 1,
        _ => 2,
    }
}
