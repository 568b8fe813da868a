//! The variables of a unit: the scene's numbers, what launches an impact, and what comes out of it.

use impactcheck_physics::kinds;
use impactcheck_physics::result::Quantity;
use impactcheck_physics::scene::{Field, Template};

/// Type of a variable's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Type {
    /// 64-bit floating-point number.
    Real,
    /// 32-bit whole number.
    Integer,
    /// true or false.
    Boolean,
}

/// What a variable is for.
#[derive(Debug, Clone)]
pub enum Role {
    /// The simulation's time.
    Time,
    /// A number of the scene. The next launch uses it.
    Field(Field),
    /// A voltage of the drive, which the simulation may supply. The next launch uses it.
    Voltage(Field),
    /// A rising edge puts the bodies back to where they were at the start.
    Arm,
    /// A rising edge launches the impact.
    Launch,
    /// An output.
    Output(Output),
}

/// An output.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Output {
    /// Displacement or velocity of a body: the curve of this name.
    Curve(&'static str),
    /// Impulse so far of the force of this name.
    Impulse(&'static str),
    /// Whether the impact is over.
    Over,
    /// Time of the first contact.
    Contact,
    /// Time of the last release.
    Release,
    /// A quantity of the result.
    Quantity(&'static Quantity),
    /// Whether the result has no warning and the run was not cut.
    Valid,
    /// Number of warnings.
    Warnings,
    /// Whether there are 95 % intervals.
    Predicted,
    /// Lower end of the 95 % interval of a quantity.
    Low(&'static str),
    /// Upper end of it.
    High(&'static str),
    /// Whether the sphere comes to rest in the other seat.
    Shifts,
    /// Time at which the seat in which the sphere comes to rest is certain.
    Landing,
}

/// A variable; its value reference is its place in [`variables`].
#[derive(Debug, Clone)]
pub struct UnitVariable {
    /// Name, unique.
    pub name: String,
    /// What it is, in a sentence.
    pub description: String,
    /// SI unit; "1" for a pure number.
    pub unit: &'static str,
    /// Type of its values.
    pub kind: Type,
    /// What it is for.
    pub role: Role,
    /// Value at the start, of parameters and inputs.
    pub start: f64,
}

impl UnitVariable {
    fn new(name: impl Into<String>, (unit, kind): (&'static str, Type), role: Role, start: f64) -> Self {
        let description = match &role {
            Role::Time => "Simulation time".into(),
            Role::Field(field) | Role::Voltage(field) => field.description().to_owned(),
            Role::Arm => {
                "A rising edge puts the bodies back to their start, ready for the next launch".into()
            }
            Role::Launch => "A rising edge launches the impact, if the unit is armed".into(),
            Role::Output(output) => output.description(),
        };
        Self { name: name.into(), description, unit, kind, role, start }
    }

    /// Whether it is an output.
    pub fn is_output(&self) -> bool {
        matches!(self.role, Role::Output(_))
    }
}

impl Output {
    fn description(self) -> String {
        match self {
            Output::Curve(name) => format!("Curve {name} of the impact; 0 before the first contact"),
            Output::Impulse(force) => format!("Integral of {force} since the first contact"),
            Output::Over => "Whether the impact is over, or its run; the results are 0 before".into(),
            Output::Contact => "Time of the first contact".into(),
            Output::Release => "Time of the last release; NaN if the run was cut before".into(),
            Output::Quantity(quantity) => quantity.about.to_owned(),
            Output::Valid => "Whether no result has a warning and the run was not cut".into(),
            Output::Warnings => "Number of warnings; the log has them, if it is on".into(),
            Output::Predicted => "Whether 95 % intervals are known".into(),
            Output::Low(name) => format!(
                "Lower end of the 95 % interval of what a converged reference would find for {name}; NaN if unknown"
            ),
            Output::High(name) => format!(
                "Upper end of the 95 % interval of what a converged reference would find for {name}; NaN if unknown"
            ),
            Output::Shifts => "Whether the sphere comes to rest in the other seat".into(),
            Output::Landing => "Time at which it is certain in which seat the sphere comes to rest".into(),
        }
    }
}

/// Whether a field is the voltage of a drive.
fn is_voltage(field: &Field) -> bool {
    field.path() == "outer.voltage"
}

/// The variables of a unit of `template`, in the order of their value references.
pub fn variables(template: &Template) -> Vec<UnitVariable> {
    use Type::{Boolean, Integer, Real};
    let scene = template.scene();
    let kind = kinds::of(scene);
    let mut all = vec![
        UnitVariable::new("time", ("s", Real), Role::Time, 0.0),
        UnitVariable::new("arm", ("1", Boolean), Role::Arm, 1.0),
        UnitVariable::new("launch", ("1", Boolean), Role::Launch, 0.0),
    ];
    // how the model computes is no number of the system's
    let fields = template.fields().into_iter().filter(|field| !field.path().starts_with("reduced."));
    for field in fields {
        // what the scene does not state has no value to start from
        let Some(start) = template.number(&field) else { continue };
        let name = field.path().to_owned();
        let of = (field.unit(), if field.is_count() { Integer } else { Real });
        let role = if is_voltage(&field) { Role::Voltage(field) } else { Role::Field(field) };
        all.push(UnitVariable::new(name, of, role, start));
    }
    let mut output = |name: String, unit, kind, output| {
        all.push(UnitVariable::new(name, (unit, kind), Role::Output(output), 0.0));
    };
    let curves = kind.curves().iter().filter(|curve| kind.has(scene, curve.name) && !curve.is_elastic);
    for curve in curves {
        match curve.unit {
            "m" | "m/s" => output(curve.name.into(), curve.unit, Real, Output::Curve(curve.name)),
            // forces are too stiff to be coupled
            "N" => {
                let name = curve.name.replace("force", "impulse") + "_so_far";
                output(name, "N*s", Real, Output::Impulse(curve.name));
            }
            _ => {}
        }
    }
    output("impact_over".into(), "1", Boolean, Output::Over);
    output("first_contact".into(), "s", Real, Output::Contact);
    output("last_release".into(), "s", Real, Output::Release);
    let quantities = || kind.quantities().iter().filter(|quantity| kind.has(scene, quantity.name));
    for quantity in quantities() {
        let of = if quantity.is_count { Integer } else { Real };
        // a curve of a body may have the name already
        let is_taken = kind.curves().iter().any(|curve| curve.name == quantity.name);
        let name = quantity.name.to_owned() + if is_taken { "_final" } else { "" };
        output(name, quantity.unit, of, Output::Quantity(quantity));
    }
    if scene.flight.is_some() {
        output("shifts".into(), "1", Boolean, Output::Shifts);
        output("landing".into(), "s", Real, Output::Landing);
    }
    output("valid".into(), "1", Boolean, Output::Valid);
    output("warnings".into(), "1", Integer, Output::Warnings);
    output("predicted".into(), "1", Boolean, Output::Predicted);
    for quantity in quantities().filter(|quantity| !quantity.is_count) {
        output(format!("{}_low", quantity.name), quantity.unit, Real, Output::Low(quantity.name));
        output(format!("{}_high", quantity.name), quantity.unit, Real, Output::High(quantity.name));
    }
    all
}
