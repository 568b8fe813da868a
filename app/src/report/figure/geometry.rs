//! Measures of a figure and its panels, and how lines and numbers are put into them.

use crate::curves::SampledCurve;
use crate::plot::axis::{Plot, PlotAxis};
use crate::plot::svg::FONT_SIZE;

/// Measures of the drawing in px.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FigureGeometry {
    pub(crate) width: f64,
    pub(crate) left: f64,
    pub(crate) right: f64,
    pub(crate) panel_height: f64,
    pub(crate) gap: f64,
    /// Height of the panel of residuals below a panel; 0 = none.
    pub(crate) residual_height: f64,
    pub(crate) bottom: f64,
    /// Whether the efficiencies stand in boxes between the curves; else they stand in the legend.
    pub(crate) boxes: bool,
    /// Millimetres of a px; `None` = the page decides.
    pub(crate) millimetres: Option<f64>,
}

impl FigureGeometry {
    pub(crate) const PAGE: FigureGeometry = FigureGeometry {
        width: 760.0,
        left: 74.0,
        right: 16.0,
        panel_height: 226.0,
        gap: 16.0,
        residual_height: 0.0,
        bottom: 50.0,
        boxes: true,
        millimetres: None,
    };

    /// For a figure `width` mm wide: type of 8.5 pt, in one column of a paper (below 120 mm) of 7.5 pt.
    pub(crate) fn printed(width: f64) -> Self {
        const POINT: f64 = 25.4 / 72.0;
        let of = |geometry: FigureGeometry, points: f64| {
            let millimetres = points * POINT / FONT_SIZE;
            FigureGeometry { width: width / millimetres, millimetres: Some(millimetres), ..geometry }
        };
        if width >= 120.0 {
            return of(FigureGeometry::PAGE, 8.5);
        }
        of(
            FigureGeometry {
                left: 66.0,
                right: 10.0,
                panel_height: 158.0,
                gap: 12.0,
                boxes: false,
                ..FigureGeometry::PAGE
            },
            7.5,
        )
    }

    /// With a panel of residuals below each panel.
    pub(crate) fn with_residuals(self) -> Self {
        FigureGeometry { residual_height: 84.0, panel_height: 0.75 * self.panel_height, ..self }
    }

    /// Height of a panel with its residuals.
    pub(crate) fn pair_height(&self) -> f64 {
        self.panel_height + self.residual_height
    }

    /// A panel from `top` px on, over times in µs up to `end`, with this range of values.
    pub(crate) fn plot(&self, top: f64, height: f64, end: f64, [low, high]: [f64; 2]) -> Plot {
        let (x, y) = (PlotAxis::linear(0.0, end), PlotAxis::linear(low, high));
        Plot { left: self.left, top, width: self.inner_width(), height, x, y }
    }

    /// Marks of the time axis of a panel.
    pub(crate) fn instants(&self, plot: &Plot) -> Vec<f64> {
        plot.x.marks((plot.width / 80.0) as usize)
    }

    /// Width of a panel.
    pub(crate) fn inner_width(&self) -> f64 {
        self.width - self.left - self.right
    }
}

/// A panel: curves of one quantity over time.
#[derive(Clone, Copy)]
pub(crate) struct PanelOf {
    /// Quantity and unit, beside the axis.
    pub(crate) label: &'static str,
    /// From SI to that unit.
    pub(crate) factor: f64,
    /// What the panel calls each curve, and its name.
    pub(crate) curves: &'static [(&'static str, &'static str)],
    /// Whether the efficiencies stand in boxes between the curves, where there is room for them.
    pub(crate) boxes: bool,
}

impl PanelOf {
    /// Whether the panel shows this curve.
    pub(crate) fn holds(&self, curve: &SampledCurve) -> bool {
        self.curves.iter().any(|(_, name)| curve.quantity == *name)
    }
}
