//! Tests of pages, figures, exports and the page in a browser.

mod browser;
mod exports;
mod figures;
mod files;
mod first_screen;
mod impacts;
mod validated_map;

#[path = "../support/report_data.rs"]
mod report_data;
#[path = "../support/synthetic_impact.rs"]
mod synthetic_impact;
