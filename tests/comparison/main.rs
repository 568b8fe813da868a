//! Tests of curves, metrics, budget, verdicts and measured records.

mod curve_metrics_integral;
mod curve_metrics_iso18571;
mod curves;
mod cut_runs;
mod discrepancy_budget;
mod gate_mutations;
mod gate_updates;
mod gate_verdicts;
mod harness;
mod measured_signals;
mod prediction;
mod range_of_validity;
mod record_faults;
mod validated;

#[path = "../support/sealed.rs"]
mod sealed;
#[path = "../support/synthetic_impact.rs"]
mod synthetic_impact;
