//! The page inside a unit for co-simulation that says what it does.

use crate::format::{model_name, prefixed, with_unit};
use crate::report::page::html::{page, scrolled};
use crate::result::Summary;
use crate::scene::Scene;
use impactcheck_fmu::variables::{Role, Type, UnitVariable};
use maud::{Markup, html};

/// The page of a unit of `scene` with these `variables`, by the `version` of the standard; `summary` is the result with the scene's numbers.
pub fn unit_page(scene: &Scene, summary: &Summary, version: &str, variables: &[UnitVariable]) -> String {
    let model = model_name(summary.model.as_deref().unwrap_or("?"), summary.modes);
    let machine = format!("{} {}", std::env::consts::OS, std::env::consts::ARCH);
    let delay = summary.strike_delay();
    let body = html! {
        h1 { (scene.name) }
        p.soft { (scene.description) }
        p { "Functional Mock-up Unit for co-simulation, FMI " (version) ". It runs reduced model " (model) " of impactcheck." }
        h2 { "How to use it" }
        ol {
            li { "Set the parameters. All are tunable: the next launch uses their values." }
            li { "Set " code { "launch" } " to true. The next communication step begins with the launch." }
            li { "Wait until " code { "impact_over" } " is true. Then read the results and " code { "valid" } "." }
            li { "For another launch set " code { "launch" } " and " code { "arm" } " to false for one step, then both to true." }
        }
        p { "The unit computes the whole impact at its launch, with an integrator of its own. So results do not depend on the communication "
            "steps, and an impact may begin and end within one step." }
        @if delay > 0.0 {
            p { "At the launch the bender is released. It strikes " (with_unit(delay, prefixed("s", delay), 4)) " later." }
        }
        h2 { "What a simulation must not do" }
        ul {
            li { "Do not couple contact forces across units: they are too stiff. The unit gives velocities and impulses." }
            li { "Do not change parameters to change an impact that is under way: they count for the next launch." }
            li { "Do not use results while " code { "impact_over" } " is false: they are 0." }
            li { "Do not ignore " code { "valid" } ". If it is false, turn the log on: it has the warnings." }
            li { "Do not step back in time without restoring a state of the unit." }
        }
        h2 { "Variables" }
        (table("Inputs", variables, |role| matches!(role, Role::Arm | Role::Launch | Role::Voltage(_))))
        (table("Parameters", variables, |role| matches!(role, Role::Field(_))))
        (table("Outputs", variables, |role| matches!(role, Role::Output(_))))
        @if !summary.warnings.is_empty() {
            h2 { "Warnings with these numbers" }
            ul { @for warning in &summary.warnings { li { (warning) } } }
        }
        h2 { "Machine and licences" }
        p { "The unit holds a binary for " (machine) ", and no sources. For another machine write the unit there: "
            code { "impactcheck fmu SCENE -o FILE.fmu" } ". The scene file is " code { "resources/scene.toml" } "." }
        p { a href="licenses/license.txt" { "Licences" } }
    };
    page(&format!("{} · impactcheck", scene.name), &[], &body, &html! {})
}

/// Where the text of a cell begins.
const TOP: &str = "vertical-align:top";

/// A number, with an exponent where it has many zeros.
fn number(value: f64) -> String {
    match value.abs() {
        size if size != 0.0 && !(1e-3..1e6).contains(&size) => format!("{value:e}"),
        _ => value.to_string(),
    }
}

fn table(title: &str, variables: &[UnitVariable], belongs: fn(&Role) -> bool) -> Markup {
    let own: Vec<&UnitVariable> = variables.iter().filter(|variable| belongs(&variable.role)).collect();
    let start = |variable: &UnitVariable| match variable.kind {
        Type::Boolean => (variable.start != 0.0).to_string(),
        _ => number(variable.start),
    };
    html! {
        @if !own.is_empty() {
            h3 { (title) }
            (scrolled(title, &html! { table.facts {
                thead { tr {
                    th scope="col" { "Name" } th scope="col" { "Unit" }
                    @if !own[0].is_output() { th scope="col" { "Start" } }
                    th scope="col" style="width:60%" { "What it is" }
                } }
                tbody { @for variable in own { tr {
                    th scope="row" { code { (variable.name) } }
                    td style=(TOP) { @if variable.unit != "1" { (variable.unit) } }
                    @if !variable.is_output() { td style=(TOP) { (start(variable)) } }
                    td style=(TOP) { (variable.description) }
                } } }
            } }))
        }
    }
}
