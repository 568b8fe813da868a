#[test]
fn timing() {
    use super::*;
    use crate::body::solid::*;
    use crate::scene::*;
    use std::time::Instant;
    for (f, sc) in [("init", "scenes/examples/seal-seat-initial.toml"), ("impr", "scenes/examples/seal-seat-improved.toml")] {
    let scene = Scene::read(sc).unwrap();
    let scene = scene.seal_seat().unwrap();
    let mesh = TetMesh::read(std::path::Path::new(&format!("/tmp/seat/{f}.vtu"))).unwrap();
    let m = &scene.seat.material;
    let mut held: Vec<[bool; 3]> = mesh.points.iter().map(|p| [false, p[1].abs() < 1e-9, false]).collect();
    let rim = |p: &[f64; 3]| (p[0].hypot(p[1]) - 8e-3).abs() < 1e-7;
    let faces = mesh.outer_faces();
    for f in &faces { if f[..3].iter().all(|&n| rim(&mesh.points[n])) { for &n in f { held[n] = [true; 3]; } } }
    for ringzone in [0.08e-3, 0.15e-3,0.3e-3] {
    let c = candidates(scene, &mesh, &Zones { ring: ringzone, tip: 0.35e-3 });
    let interface: Vec<usize> = c.iter().map(|c| c.node).collect();
    let t = Instant::now();
    let solid = Solid::new(&mesh, &m, &held, &interface).unwrap();
    let b = solid.at_interface(40).unwrap();
    eprintln!("{f} zone {ringzone} candidates {} in {:?}", c.len(), t.elapsed());
    for (n, steps) in [(10, [2e-6, 1e-6, 0.5e-6, 0.25e-6]),(20,[1e-6,0.5e-6,0.25e-6,0.125e-6]),(40,[0.5e-6,0.25e-6,0.125e-6,0.0625e-6])] {
        if n > 10 && ringzone != 0.15e-3 {continue}
        let s = system::System::new(scene, &b, &c, n).unwrap();
        for step in steps {
            let t = Instant::now();
            match integrate::integrate(&s, &integrate::Options { step, end_time: None, history: false }) {
                Ok(r) => eprintln!("  N {n} dt {step:.3e} t_end {:.1} us: v {:.2} {:.2} angle {:.4} F {:?} end {:?} flank {:?} reach {:?} E {:.1e} M {:.1e} steps {} {:?}", r.time*1e6, r.state.sphere_velocity[0]*1e3, r.state.sphere_velocity[1]*1e3, r.state.sphere_velocity[0].atan2(r.state.sphere_velocity[1]).to_degrees(), r.force_peak, r.contact_end, r.flank_impulse, r.reach, r.energy_residual, r.momentum_residual, r.steps, t.elapsed()),
                Err(e) => eprintln!("  N {n} dt {step} {e}"),
            }
        }
    }
    }}
}
