//! Kernels of the reduced models, by criterion: `cargo bench --bench kernels`.

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use impactcheck::body::cache::Cache;
use impactcheck::body::kirchhoff::UnitPlate;
use impactcheck::contact::{Hertz, PatchFlexibility, PatchTable, RADII, Residual};
use impactcheck::kinds::Series;
use impactcheck::kinds::plate_impact::reduced::Reduced;
use impactcheck::kinds::plate_impact::shared::SharedBodies;
use impactcheck::kinds::seal_seat::{SeatMesh, SeatModel};
use impactcheck::numerics::duhamel::Oscillator;
use impactcheck::scene::{Edge, Model, Scene, Template};
use std::hint::black_box;
use std::time::Duration;

const SCENE: &str = include_str!("../scenes/scaled-plate-r10.toml");

fn scene(from: &str, to: &str) -> Scene {
    Scene::parse("scene.toml", &SCENE.replacen(from, to, 1)).expect("a valid scene")
}

/// Answer of one oscillator to polynomial forces, by power series and in closed form.
fn moments(c: &mut Criterion) {
    let mut group = c.benchmark_group("duhamel_moments");
    for (name, angle, damping) in
        [("series", 0.5, 0.0), ("closed_form", 20.0, 0.0), ("overdamped", 20.0, 3.0)]
    {
        let oscillator = Oscillator { omega: angle, alpha: damping * angle };
        group.bench_function(name, |b| b.iter(|| black_box(oscillator).moments(black_box(1.0))));
    }
}

/// Forces of both contacts, with Hertz alone and with the bodies' residual flexibility.
fn contact(c: &mut Criterion) {
    let laws =
        [Hertz { stiffness: 1.5e10, tip_radius: 0.01 }, Hertz { stiffness: 0.9e10, tip_radius: 0.005 }];
    let table = PatchTable {
        own: [RADII.map(|r| 2e-9 - 3e-10 * r), RADII.map(|r| 1e-9 + 2e-10 * r)],
        mutual: RADII.map(|r| RADII.map(|s| -6e-10 + 1e-10 * (r + s))),
    };
    let patch = laws.map(|law| (law.tip_radius * 8e-6).sqrt());
    let residual = Residual::new(&PatchFlexibility::through(&table, patch), &laws);
    let approach = [8e-6, 5e-6];
    let mut group = c.benchmark_group("contact");
    group.bench_function("hertz", |b| {
        b.iter(|| [0, 1].map(|i| laws[i].force(black_box(approach[i]))));
    });
    group.bench_function("residual_newton", |b| {
        let patches = black_box([7e-6, 4e-6]);
        b.iter(|| residual.state(&laws, black_box(patches)).newton([0.0; 3], black_box(approach), patches));
    });
    group.bench_function("residual_solve", |b| {
        b.iter(|| residual.solve(&laws, black_box(approach), black_box([7e-6, 4e-6])));
    });
}

/// Eigenproblem of a plate, solved once for all plates of one edge and Poisson's ratio.
fn plate(c: &mut Criterion) {
    let mut group = c.benchmark_group("plate_frequencies");
    for modes in [1, 16, 64] {
        group.bench_with_input(BenchmarkId::from_parameter(modes), &modes, |b, modes| {
            b.iter(|| UnitPlate::new(Edge::Clamped, 0.3, *modes).expect("modes"));
        });
    }
}

/// One impact with model B at a tolerance of 1e-6, and one with a free flight before its second contact.
fn impact(c: &mut Criterion) {
    let mut group = c.benchmark_group("impact");
    for modes in [1, 16, 64] {
        let reduced = Reduced::new(&scene("", ""), Model::B, Some(modes)).expect("a model");
        group.bench_with_input(BenchmarkId::from_parameter(modes), &reduced, |b, reduced| {
            b.iter(|| reduced.point(1e-6).expect("an impact"));
        });
    }
    let apart = scene("[inner]\n", "[inner]\ngap = \"0.1 mm\"\n");
    let flight = Reduced::new(&apart, Model::B, Some(16)).expect("a model");
    group.bench_function("with_free_flight", |b| b.iter(|| flight.point(1e-6).expect("an impact")));
}

/// A smooth and a rough seal seat.
fn seat(c: &mut Criterion) {
    let mut group = c.benchmark_group("seat");
    for name in ["seal-seat-initial", "seal-seat-improved"] {
        let text = std::fs::read_to_string(format!("scenes/{name}.toml")).expect("a scene");
        let mesh = SeatMesh::open(format!("meshes/{name}.vtu").as_ref()).expect("a mesh");
        for friction in [0.0, 0.1, 0.3] {
            let scene =
                Scene::parse("scene.toml", &format!("friction = {friction}\n{text}")).expect("a valid scene");
            let model = SeatModel::new(&scene, Model::C, Some(16), &mesh, &Cache::off()).expect("a model");
            group.bench_function(format!("{name}_{friction}"), |b| {
                b.iter(|| model.point(1e-3).expect("an impact"));
            });
        }
    }
}

/// Oblique impacts with friction and without, at the centre of a plate and off it.
fn friction(c: &mut Criterion) {
    let mut group = c.benchmark_group("friction");
    for (place, text) in [
        ("centre", include_str!("../scenes/validation/oblique-friction.toml")),
        ("off_centre", include_str!("../scenes/validation/off-centre-oblique.toml")),
    ] {
        for (name, text) in [("smooth", text.replace("friction ", "# ")), ("rough", text.to_owned())] {
            let scene = Scene::parse("scene.toml", &text).expect("a valid scene");
            let reduced = Reduced::new(&scene, Model::B, None).expect("a model");
            group.bench_function(format!("{place}_{name}"), |b| {
                b.iter(|| reduced.point(1e-6).expect("an impact"));
            });
        }
    }
}

/// A point of a sweep to 1e-3: the model of a scene whose speed and radius are not those of the points before, and its impact.
fn sweep_point(c: &mut Criterion) {
    let varied = [("outer.speed", [0.3, 0.9]), ("outer.radius", [6e-3, 14e-3])];
    let template = Template::parse("scene.toml", SCENE).expect("a valid scene");
    let fields = varied.map(|(name, _)| template.field(name).expect("a field"));
    let setup = template.scene().plate_impact().expect("a plate");
    let bodies = SharedBodies::for_varied(varied, setup, 20_000);
    let mut group = c.benchmark_group("sweep_point");
    for model in [Model::A, Model::B, Model::C] {
        let mut share = 0.0;
        let mut solve = || {
            share = (share + 0.618) % 1.0;
            let number = |k: usize| (&fields[k], varied[k].1[0] + share * (varied[k].1[1] - varied[k].1[0]));
            let scene = template.with(&[number(0), number(1)]).expect("a valid scene");
            bodies.model(scene, model, None).and_then(|model| model.point(1e-3)).expect("an impact")
        };
        solve();
        group.bench_function(model.to_string(), |b| b.iter(&mut solve));
    }
}

criterion_group! {
    name = kernels;
    config = Criterion::default()
        .without_plots()
        .sample_size(20)
        .warm_up_time(Duration::from_millis(200))
        .measurement_time(Duration::from_millis(500));
    targets = moments, contact, plate, impact, friction, seat, sweep_point
}
criterion_main!(kernels);
