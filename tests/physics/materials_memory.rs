//! Materials with memory: impacts of yielding and relaxing bodies against elastic ones, closed forms and finite elements.

use crate::common;
use approx::assert_relative_eq;
use impactcheck::body::{ModalBody, kirchhoff};
use impactcheck::dynamics::integration::{Integration, Options};
use impactcheck::dynamics::integrator;
use impactcheck::dynamics::memory::integrate;
use impactcheck::dynamics::system::System;
use impactcheck::kinds::plate_impact::reduced::Reduced;

use impactcheck::kinds::plate_impact::PlateImpact;
use impactcheck::scene::{Material, Model, Relaxation, Scene, resolve};

fn with(setup: PlateImpact, change: impl Fn(&mut Material)) -> PlateImpact {
    let mut setup = setup;
    for material in [&mut setup.plate.material, &mut setup.outer.material, &mut setup.inner.material] {
        change(material);
    }
    setup
}

fn yielding(strength: f64) -> impl Fn(&mut Material) {
    move |material| (material.yield_strength, material.hardening) = (Some(strength), Some(2.1e9))
}

fn run(setup: &PlateImpact, system: &System) -> Integration {
    let memory = setup.memory(system).unwrap().expect("a material with memory");
    integrate(system, &memory, &Options::default()).unwrap().0
}

/// With a yield strength that nothing reaches the steps of one length give what the elastic integrator gives, with the residual
/// flexibility of model C too.
#[test]
fn an_impact_that_nothing_remembers_is_the_elastic_one() {
    let setup = with(common::scaled_plate(0.01, 0.55), yielding(1e12));
    let bending = setup.rigid_system(&kirchhoff::modes(&setup.plate, 16).unwrap(), [0.0; 2]);
    let scene = Scene::read(resolve("scaled-plate-r10").unwrap()).unwrap();
    let continuum = Reduced::new(&scene, Model::C, None).unwrap();
    for system in [&bending, continuum.system()] {
        let exact = integrator::integrate(system, &Options::default()).unwrap();
        let ours = run(&setup, system);
        for i in 0..2 {
            assert_relative_eq!(ours.velocity[i], exact.velocity[i], epsilon = 3e-5 * system.speed);
            assert_relative_eq!(
                ours.contacts[i].force_peak,
                exact.contacts[i].force_peak,
                max_relative = 5e-5
            );
            assert_relative_eq!(ours.contacts[i].end, exact.contacts[i].end, max_relative = 1e-3);
            assert_eq!(ours.contacts[i].contacts, exact.contacts[i].contacts);
            assert!(
                ours.losses.contacts.unwrap()[i].abs() < 1e-4 * system.initial_energy(),
                "{:?}",
                ours.losses
            );
        }
        assert!(ours.energy_residual < 2e-5 && ours.momentum_residual < 1e-9, "{ours:?}");
    }
}

/// The curves of such a run, thinned out between the contacts, are those of the elastic integrator.
#[test]
fn the_history_of_an_impact_that_nothing_remembers_is_the_elastic_one() {
    let setup = with(common::scaled_plate(0.01, 0.55), yielding(1e12));
    let scene = Scene::read(resolve("scaled-plate-r10").unwrap()).unwrap();
    let continuum = Reduced::new(&scene, Model::C, None).unwrap();
    let system = continuum.system();
    let duration = system.hertz_impact().duration();
    let every = |interval: f64| Options {
        sample_interval: Some(interval),
        end_time: Some(4e-4),
        ..Options::default()
    };
    let memory = setup.memory(system).unwrap().unwrap();
    let ours = integrate(system, &memory, &every(duration / 10.0)).unwrap().0.history.unwrap();
    let exact = integrator::integrate(system, &every(duration / 500.0)).unwrap().history.unwrap();
    // the contacts' part of the plate's velocity is a difference quotient, half a step late where they touch
    let bounds = [
        ("plate_displacement", 0.01),
        ("plate_velocity", 0.04),
        ("inner_velocity", 0.01),
        ("outer_force", 0.01),
    ];
    for (name, bound) in bounds {
        let [ours_of, exact_of] = [&ours, &exact].map(|history| history.curve(name).unwrap());
        let peak = exact_of.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
        for (time, value) in ours.time.iter().zip(ours_of) {
            let k = exact.time.partition_point(|t| t < time).clamp(1, exact.len() - 1);
            let share = (time - exact.time[k - 1]) / (exact.time[k] - exact.time[k - 1]);
            let expected = exact_of[k - 1] + share * (exact_of[k] - exact_of[k - 1]);
            assert!(
                (value - expected).abs() < bound * peak,
                "{name} at {time:e}: {value}, {expected}, {peak}"
            );
        }
    }
}

/// A Maxwell sphere on a rigid wall loses (4/9) T/tau of its speed in a contact that is short against tau (Hunter, The Hertz contact
/// problem, J. Mech. Phys. Solids 8, 1960, 219).
#[test]
fn a_viscoelastic_sphere_rebounds_as_in_hunters_theory() {
    let rigid_plate =
        ModalBody { omega: vec![], damping_ratio: vec![], participation: vec![], residual: None };
    let mut setup = common::scaled_plate(0.01, 0.55);
    setup.plate.material.youngs_modulus = 1e17;
    let duration = setup.rigid_system(&rigid_plate, [0.0; 2]).hertz_impact().duration();
    for ratio in [0.01, 0.02] {
        setup.outer.material.relaxation = vec![Relaxation { ratio: 1.0, time: duration / ratio }];
        let system = setup.rigid_system(&rigid_plate, [0.0; 2]);
        let result = run(&setup, &system);
        let lost = 1.0 - result.velocity[0] / setup.outer.speed;
        // the next order in T/tau is left out
        assert_relative_eq!(lost, 4.0 / 9.0 * ratio, max_relative = 0.005 + 0.5 * ratio);
        assert!(result.energy_residual < 1e-4);
    }
}

/// Restitution on a rigid wall at multiples of the speed at which yield begins, against finite elements of a throw-away prototype, from
/// which Jackson, Green & Marghitu's law (Nonlinear Dynamics 60, 2010, 217) differs by 1 to 8 %; the size of the sphere has no part in it.
#[test]
fn a_yielding_sphere_rebounds_as_in_finite_elements() {
    let rigid_plate =
        ModalBody { omega: vec![], damping_ratio: vec![], participation: vec![], residual: None };
    let restitution = |radius: f64, ratio: f64| {
        let mut setup = common::scaled_plate(radius, 1.0);
        setup.plate.material.youngs_modulus = 1e17;
        yielding(600e6)(&mut setup.outer.material);
        let system = setup.rigid_system(&rigid_plate, [0.0; 2]);
        let critical = setup.memory(&system).unwrap().unwrap().critical_forces([0.0; 2])[0];
        // Hertz: 2/5 F_c x_c is the energy at the onset
        let energy = 0.4 * critical * system.laws[0].approach(critical);
        setup.outer.speed = ratio * (2.0 * energy / system.masses[0]).sqrt();
        let system = setup.rigid_system(&rigid_plate, [0.0; 2]);
        run(&setup, &system).velocity[0] / setup.outer.speed
    };
    for (ratio, found) in
        [(2.1, 0.975), (5.3, 0.898), (10.5, 0.829), (26.0, 0.730), (53.0, 0.654), (105.0, 0.572)]
    {
        let large = restitution(0.01, ratio);
        assert_relative_eq!(large, found, max_relative = 0.08);
        assert_relative_eq!(large, restitution(0.001, ratio), max_relative = 2e-3);
    }
    assert_relative_eq!(restitution(0.01, 0.9), 1.0, epsilon = 1e-4);
}

/// A polymer plate between steel spheres with a loss factor of 0.02: explicit finite elements of a throw-away prototype lose 1.88
/// points of efficiency, mostly in contacts and plate alike.
#[test]
fn a_polymer_plate_loses_two_points() {
    let scene = |loss: &str| {
        let text = format!(
            r#"
            name = "polymer"
            kind = "plate-impact"
            materials.polymer = {{ youngs_modulus = "2.6 GPa", poisson_ratio = 0.38, density = 1320 {loss} }}
            materials.steel = {{ youngs_modulus = "210 GPa", poisson_ratio = 0.3, density = 7780 }}
            plate = {{ radius = "5.5 mm", thickness = "0.5 mm", edge = "clamped", material = "polymer" }}
            outer = {{ kind = "sphere", radius = "1.5 mm", material = "steel", speed = "550 mm/s" }}
            inner = {{ kind = "sphere", radius = "1.5 mm", material = "steel" }}
            "#
        );
        Scene::parse("polymer", &text).unwrap()
    };
    let run = |loss: &str, model| Reduced::new(&scene(loss), model, None).unwrap().run(1e-7).unwrap();
    for model in [Model::B, Model::C] {
        let (elastic, lossy) =
            (run("", model), run(", loss_factor = 0.02, modulus_frequency = \"10 kHz\"", model));
        let points = 100.0 * (elastic.value("efficiency").unwrap() - lossy.value("efficiency").unwrap());
        assert!((points - 1.88).abs() < 0.1, "{model}: {points}");
        let losses = lossy.losses.unwrap();
        assert!(
            losses.plate_damping > 0.0 && losses.contacts.unwrap().iter().all(|loss| *loss > 0.0),
            "{losses:?}"
        );
    }
}

/// Far beyond the loads its law was found for a contact that yields is warned of, and then refused.
#[test]
fn a_yield_strength_far_below_the_pressure_has_a_warning() {
    let memory = |strength: f64| {
        let setup = with(common::scaled_plate(0.01, 0.55), yielding(strength));
        let system = setup.rigid_system(&kirchhoff::modes(&setup.plate, 4).unwrap(), [0.0; 2]);
        setup.memory(&system)
    };
    let warnings_of = |strength: f64| memory(strength).unwrap().unwrap().warnings.join("; ");
    assert!(
        !warnings_of(600e6).contains("up to 110 times")
            && warnings_of(1e8).contains("compared with finite elements up to 110 times"),
        "{}",
        warnings_of(1e8)
    );
    assert!(memory(1e6).unwrap_err().to_string().contains("yield_strength"));
}

fn scene_of(materials: &str, outer: &str, plate: &str, more: &str) -> Result<Scene, impactcheck::Error> {
    let text = format!(
        r#"
        name = "materials"
        kind = "plate-impact"
        materials.a = {{ youngs_modulus = "210 GPa", poisson_ratio = 0.3, density = 7780 }}
        {materials}
        plate = {{ radius = "33 mm", thickness = "2 mm", edge = "clamped", material = "{plate}" }}
        outer = {{ kind = "sphere", radius = "10 mm", material = "{outer}", speed = "550 mm/s" }}
        inner = {{ kind = "sphere", radius = "1 mm", material = "a" }}
        {more}
        "#
    );
    Scene::parse("materials", &text)
}

/// Springs are laid as each contact needs them: a relaxation of nothing changes nothing, also where the outer body is soft and the inner
/// tip small.
#[test]
fn a_relaxation_of_nothing_is_elastic_however_unlike_the_contacts() {
    let soft = |relaxation: &str| {
        let soft = format!(
            "materials.b = {{ youngs_modulus = 1e8, poisson_ratio = 0.4, density = 1200 {relaxation} }}"
        );
        let plate = format!(
            "materials.c = {{ youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7780 {relaxation} }}"
        );
        let scene = scene_of(&format!("{soft}\n{plate}"), "b", "c", "").unwrap();
        Reduced::new(&scene, Model::B, None).unwrap().run(1e-7).unwrap()
    };
    let [elastic, ours] = ["", ", relaxation = [{ ratio = 1e-12, time = 1 }]"].map(soft);
    for name in ["efficiency", "outer_force_peak", "inner_force_peak", "inner_contacts", "first_frequency"] {
        let [a, b] = [&elastic, &ours].map(|summary| summary.value(name).unwrap());
        assert_relative_eq!(a, b, max_relative = 5e-3);
    }
}

/// The plate vibrates at the storage modulus of its own frequency.
#[test]
fn a_relaxing_plate_has_the_frequency_of_its_storage_modulus() {
    let at = |loss: &str| {
        let plate =
            format!("materials.b = {{ youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7780 {loss} }}");
        let scene = scene_of(&plate, "a", "b", "").unwrap();
        Reduced::new(&scene, Model::B, None).unwrap().run(1e-7).unwrap().value("first_frequency").unwrap()
    };
    let elastic = at("");
    for loss in [0.02, 0.3] {
        let lossy = at(&format!(", loss_factor = {loss}, modulus_frequency = {elastic}"));
        assert_relative_eq!(lossy, elastic, max_relative = 1e-6);
    }
}

/// What the models do not cover is no scene, and what they leave open they say.
#[test]
fn uncovered_materials_are_refused_and_open_questions_have_a_warning() {
    let plastic = "materials.b = { youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7780, yield_strength = 6e8, hardening = 0 }";
    let relaxing = "materials.c = { youngs_modulus = 2e9, poisson_ratio = 0.3, density = 1000, relaxation = [{ ratio = 0.1, time = 1e-5 }] }";
    let fluid = "fluid = { viscosity = 1e-3, density = 1e3, minimum_gap = 1e-6 }";
    for (materials, plate, more, words) in [
        (plastic.to_owned(), "b", fluid, "fluid"),
        (format!("{plastic}\n{relaxing}"), "c", "", "joins a plastic"),
    ] {
        let error = scene_of(&materials, "b", plate, more).unwrap_err();
        assert_eq!(error.exit_status(), impactcheck::ExitStatus::InvalidScene);
        assert!(error.to_string().contains(words), "{error}");
    }
    let scene = scene_of(plastic, "b", "b", "series = { impacts = 1 }").unwrap();
    let summary = Reduced::new(&scene, Model::B, None).unwrap().run(1e-7).unwrap();
    assert!(summary.warnings.iter().any(|w| w.contains("is not reached")), "{:?}", summary.warnings);
    assert!(summary.contact_pressure.is_none());
}

/// Where nothing touches time passes in long steps, before the first contact and after the last one.
#[test]
fn a_flight_is_a_few_steps() {
    let ending = |end_time: Option<f64>| Options { end_time, ..Options::default() };
    for (gap, end_time) in [(0.02, None), (0.0, Some(10.0))] {
        let mut setup = common::scaled_plate(0.01, 0.55);
        setup.inner.gap = gap;
        setup.outer.material.relaxation = vec![Relaxation { ratio: 0.1, time: 1e3 }];
        let system = setup.rigid_system(&kirchhoff::modes(&setup.plate, 16).unwrap(), [0.0; 2]);
        let exact = integrator::integrate(&system, &ending(end_time)).unwrap();
        let memory = setup.memory(&system).unwrap().unwrap();
        let ours = integrate(&system, &memory, &ending(end_time)).unwrap().0;
        for i in 0..2 {
            assert_relative_eq!(ours.velocity[i], exact.velocity[i], epsilon = 1e-4 * system.speed);
            assert_eq!(ours.contacts[i].contacts, exact.contacts[i].contacts);
        }
        assert!(
            ours.energy_residual < 5e-5 && ours.steps < 8000,
            "{gap} {} {}",
            ours.energy_residual,
            ours.steps
        );
    }
}

/// A contact that relaxes ends where its force does, wherever the steps lie.
#[test]
fn a_relaxing_contact_ends_between_two_steps() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes/validation/relaxing-plate.toml");
    let text = std::fs::read_to_string(scene).unwrap();
    let ends = [2.0e-4, 2.0005e-4, 2.001e-4].map(|end| {
        let scene = Scene::parse("relaxing", &format!("run.end_time = {end:e}\n{text}")).unwrap();
        let outcome = Reduced::new(&scene, Model::A, None).unwrap().run_with_history(1e-4).unwrap();
        let (time, force) = (&outcome.history.time, outcome.history.curve("inner_force").unwrap());
        let last = force.iter().rposition(|force| *force > 0.0).unwrap();
        let end = outcome.summary.value("inner_contact_end").unwrap();
        assert!(end > time[last] && end < time[last + 1], "{end} {} {}", time[last], time[last + 1]);
        (end, time[last + 1] - time[last])
    });
    for (end, step) in &ends[1..] {
        assert!((end - ends[0].0).abs() < 0.25 * step, "{ends:?}");
    }
}

/// A plate that loses all but a ten thousandth of its modulus recovers over 0.2 s, its contacts are over after 3 ms: what follows are few
/// steps, and nothing happens in them.
#[test]
fn a_plate_that_relaxes_nearly_all_of_its_modulus_is_solved_to_its_end() {
    let summary = |end: &str| {
        let text = format!(
            r#"
            name = "relaxes"
            kind = "plate-impact"
            materials.polymer = {{ youngs_modulus = 2.6e9, poisson_ratio = 0.38, density = 1320, relaxation = [{{ ratio = 0.5999, time = 1e-6 }}, {{ ratio = 0.4, time = 2e-5 }}] }}
            materials.steel = {{ youngs_modulus = 210e9, poisson_ratio = 0.3, density = 7780 }}
            plate = {{ radius = "5.5 mm", thickness = "0.5 mm", edge = "free", material = "polymer" }}
            outer = {{ kind = "sphere", radius = "1.5 mm", material = "steel", speed = "0.5 m/s" }}
            inner = {{ kind = "sphere", radius = "1.2 mm", material = "steel" }}
            {end}
            "#
        );
        Reduced::new(&Scene::parse("relaxes", &text).unwrap(), Model::A, None).unwrap().run(1e-7).unwrap()
    };
    let [cut, whole] = ["run.end_time = \"3 ms\"", ""].map(summary);
    for name in ["efficiency", "outer_velocity_final", "outer_contact_end", "inner_contact_end"] {
        assert_relative_eq!(whole.value(name).unwrap(), cut.value(name).unwrap(), max_relative = 1e-4);
    }
    assert!(whole.steps.unwrap() < 200_000, "{:?}", whole.steps);
    assert!(whole.energy_residual.unwrap() < 1e-4, "{:?}", whole.energy_residual);
}
