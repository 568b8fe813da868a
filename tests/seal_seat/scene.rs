//! Seal-seat scenes: what is valid arrives exactly, geometry that can't be is refused with the two features that
//! collide, the ring lies where cone and sphere touch, and the hashes tell what matters.

use impactcheck::kinds::seal_seat::{Notch, SealSeat, SphereBody};
use impactcheck::scene::{Fault, Scene, Template, faults};
use impactcheck::{Error, ExitStatus};

const VALID: &str = include_str!("../fixtures/seal-seat.toml");

fn parse(text: &str) -> Scene {
    Scene::parse("scene.toml", text).expect("valid scene")
}

fn seat(text: &str) -> SealSeat {
    parse(text).seal_seat().expect("a seal seat").clone()
}

/// The valid scene with the value of `key` replaced; fails if there is no such key.
fn with(changes: &[(&str, &str)]) -> String {
    let mut text = VALID.to_owned();
    for (key, value) in changes {
        let line = VALID.lines().find(|l| l.split('=').next().is_some_and(|k| k.trim() == *key));
        let line = line.unwrap_or_else(|| panic!("no key `{key}`"));
        text = text.replacen(line, &format!("{key} = {value}"), 1);
    }
    text
}

/// The faults of `text`, which has to be refused.
fn refused(text: &str) -> Vec<Fault> {
    let error = Scene::parse("scene.toml", text).expect_err("refused");
    assert_eq!(error.exit_status(), ExitStatus::InvalidScene);
    let Error::Scene(report) = error else { panic!("not a scene error") };
    faults(&report)
}

/// The one fault of the scene with `changes` says all of `words` and stands at one of the keys it names.
#[track_caller]
fn collides(changes: &[(&str, &str)], words: &[&str]) {
    let text = with(changes);
    let found = refused(&text);
    assert_eq!(found.len(), 1, "{found:#?}");
    for word in words {
        assert!(found[0].message.contains(word), "`{word}` is not in: {}", found[0].message);
    }
    let line = text.lines().nth(found[0].line - 1).unwrap_or_default();
    let key = line.split('=').next().unwrap_or_default().trim();
    assert!(found[0].message.contains(&format!(".{key}`")), "{line}: {}", found[0].message);
}

#[test]
fn values_arrive_in_si() {
    let setup = seat(VALID);
    let degree = std::f64::consts::PI / 180.0;
    assert_eq!((setup.seat.membrane_radius, setup.seat.island_height), (0.008, 0.00295));
    assert_eq!((setup.seat.tilt, setup.seat.aperture_angle), (15.0 * degree, 120.0 * degree));
    assert_eq!(setup.seat.notch, Some(Notch { width: 0.0014, floor: 0.0005 }));
    assert_eq!(setup.actuator.tip_positions, [-0.0045, 0.0045]);
    assert_eq!((setup.actuator.mass, setup.actuator.speed), (0.002, 1.0));
    assert_eq!((setup.intended_angle, setup.sphere.body), (15.0 * degree, SphereBody::Rigid));
    let full = 4.0 / 3.0 * std::f64::consts::PI * 0.0015_f64.powi(3) * 7780.0;
    assert!((setup.sphere.mass / full - 1.0).abs() < 1e-15);
    let other = VALID.replace("[actuator]", "mass = \"0.2 g\"\nbody = \"elastic\"\n[actuator]");
    let sphere = seat(&other).sphere;
    assert_eq!((sphere.mass, sphere.body), (0.0002, SphereBody::Elastic));
    let settings = parse(VALID).reference;
    assert_eq!((settings.elements_per_contact_radius, settings.elements_per_ring_radius), (None, Some(10.0)));
}

/// The ring's points lie on the sphere, and the sphere's normal there is that of the cone.
#[test]
fn the_ring_is_where_cone_and_sphere_meet() {
    for (tilt, aperture) in [(15.0, 120.0), (0.0, 90.0), (30.0, 60.0_f64)] {
        let mut setup = seat(VALID);
        setup.seat.tilt = f64::to_radians(tilt);
        setup.seat.aperture_angle = aperture.to_radians();
        let (ring, r) = (setup.ring(), setup.sphere.radius);
        let [cx, cz] = ring.sphere_centre;
        for k in 0..12 {
            let point = ring.point(f64::from(k) * std::f64::consts::TAU / 12.0);
            let normal = [(point[0] - cx) / r, point[1] / r, (point[2] - cz) / r];
            let length = normal.iter().map(|n| n * n).sum::<f64>().sqrt();
            assert!((length - 1.0).abs() < 1e-12);
            // The cone's surface makes the angle gamma/2 with the axis, its normal 90 deg - gamma/2.
            let along = normal[0] * ring.axis[0] + normal[2] * ring.axis[1];
            assert!((along + (0.5 * aperture.to_radians()).sin()).abs() < 1e-12);
        }
        assert!(ring.point(0.0)[0] > ring.point(std::f64::consts::PI)[0]);
    }
    // Fig. 18's ring at 120 deg: radius half of the sphere's.
    assert!((seat(VALID).ring().radius - 0.00075).abs() < 1e-15);
}

#[test]
fn bounds_of_an_angle_are_stated_in_the_unit_of_the_value() {
    for (value, said) in [
        ("\"-3 deg\"", "at least 0 deg and less than 90 deg"),
        ("\"2 rad\"", "at least 0 rad and less than 1.57"),
        ("2.0", "at least 0 rad and less than 1.57"),
    ] {
        let found = refused(&with(&[("tilt", value)]));
        assert!(found.iter().any(|fault| fault.message.contains(said)), "{value}: {found:#?}");
    }
}

#[test]
fn colliding_features_are_named() {
    collides(
        &[("bore_depth", "\"3.2 mm\"")],
        &["bore", "underside", "seat.seated_height", "3.2 mm", "0.059 mm"],
    );
    collides(&[("bore_depth", "\"1.5 mm\"")], &["sphere", "floor of the bore", "1.5 mm"]);
    collides(&[("bore_radius", "\"0.8 mm\"")], &["bore", "contact ring", "0.8 mm", "0.75 mm"]);
    collides(&[("notch_width", "\"4.5 mm\"")], &["notch", "contact ring", "-2.111"]);
    collides(&[("notch_floor", "\"0.4 mm\"")], &["notch", "membrane", "0.4 mm", "0.5 mm"]);
    collides(&[("notch_floor", "\"3 mm\"")], &["notch", "island", "3 mm", "2.95 mm"]);
    collides(&[("seat_distance", "\"0.7 mm\""), ("notch_floor", "\"2.5 mm\"")], &["two seats overlap"]);
    collides(&[("seat_distance", "\"9 mm\"")], &["contact ring", "end of the island"]);
    collides(&[("island_width", "\"1.5 mm\"")], &["contact ring", "side of the island", "0.691 mm"]);
    collides(&[("seated_height", "\"4.2 mm\"")], &["contact ring", "above the island", "2.95 mm"]);
    collides(&[("tilt", "\"31 deg\"")], &["cones", "web", "91", "90 deg"]);
    collides(&[("island_length", "\"15 mm\"")], &["island", "rim of the membrane", "8 mm"]);
    collides(&[("tip_positions", "[\"-8 mm\", \"2 mm\"]")], &["tip", "beyond the membrane", "-8 mm"]);
    collides(&[("tip_positions", "[0.001, 0.0012]")], &["two tips", "same place", "1.2 mm", "0.3 mm"]);
    collides(&[("tip_radius", "\"1 um\"")], &["too narrow", "1 m/s", "0.001 mm", "0.0851"]);
    collides(&[("speed", "\"300 m/s\"")], &["too narrow", "300 m/s", "3 mm"]);
    // The membrane as thick as the island swallows its notch, too.
    let found = refused(&with(&[("membrane_thickness", "\"2.95 mm\"")]));
    assert!(
        found.iter().any(|p| p.message.contains("island does not rise above the membrane")),
        "{found:#?}"
    );
}

#[test]
fn sound_neighbours_of_the_collisions_are_accepted() {
    for changes in [
        vec![("bore_depth", "\"3.0 mm\"")],
        vec![("bore_radius", "\"0.74 mm\"")],
        vec![("notch_width", "\"4 mm\"")],
        vec![("seat_distance", "\"7 mm\"")],
        vec![("tilt", "\"25 deg\"")],
        vec![("tip_positions", "[-0.0079, 0.0]")],
        vec![("seat_distance", "\"2.6 mm\""), ("notch_width", "\"0.2 mm\"")],
    ] {
        parse(&with(&changes));
    }
}

#[test]
fn the_geometry_hash_is_what_a_mesh_depends_on() {
    let hash = |changes: &[(&str, &str)]| seat(&with(changes)).geometry_hash();
    let (original, scene) = (hash(&[]), parse(VALID).hash());
    assert_eq!(original.len(), 64);
    for same in [("speed", "2"), ("mass", "0.003"), ("youngs_modulus", "3e9"), ("angle", "0")] {
        assert_eq!(hash(&[same]), original, "{}", same.0);
        assert_ne!(parse(&with(&[same])).hash(), scene, "{}", same.0);
    }
    for other in
        [("notch_width", "0.0015"), ("tilt", "0.2"), ("tip_positions", "[0]"), ("bore_depth", "0.0017")]
    {
        assert_ne!(hash(&[other]), original, "{}", other.0);
    }
}

#[test]
fn numbers_of_a_seal_seat_can_be_varied() {
    let template = Template::parse("seat", VALID).expect("valid scene");
    let [tilt, tip, notch] =
        ["seat.tilt", "actuator.tip_positions.2", "seat.notch_width"].map(|f| template.field(f).expect(f));
    assert_eq!((tilt.unit(), tip.unit()), ("rad", "m"));
    let scene = template.with(&[(&tilt, 0.3), (&tip, 0.003), (&notch, 0.001)]).expect("valid");
    let setup = scene.seal_seat().expect("a seal seat");
    assert_eq!(
        (setup.seat.tilt, setup.actuator.tip_positions.as_slice()),
        (0.3, [-0.0045, 0.003].as_slice())
    );
    let text = template.text_with("other", &[(&tilt, 0.3), (&tip, 0.003), (&notch, 0.001)]).expect("text");
    assert_eq!(parse(&text), Scene { name: "other".into(), ..scene });
    let said = template.with(&[(&notch, 0.0045)]).expect_err("collides").to_string();
    assert!(said.contains("notch") && said.contains("contact ring"), "{said}");
    assert!(template.field("actuator.tip_positions.3").is_err() && template.field("plate.radius").is_err());
    assert!(tip.parse("3 mm").is_ok_and(|x| x == 0.003) && tip.check(f64::NAN).is_err());
}

#[test]
fn what_knows_plates_only_refuses_a_seal_seat() {
    let scene = parse(VALID);
    let error =
        impactcheck::kinds::plate_impact::reduced::Reduced::new(&scene, impactcheck::scene::Model::B, None);
    let Err(error) = error else { panic!("accepted") };
    assert_eq!(error.exit_status(), ExitStatus::InvalidScene);
    let said = error.to_string();
    assert!(said.contains("`seal-seat`") && said.contains("`plate-impact`"), "{said}");
}

#[test]
fn the_shipped_scenes_are_the_two_designs() {
    let read = |name: &str| {
        let path = format!("{}/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        Scene::read(path).expect("valid scene").seal_seat().expect("a seal seat").clone()
    };
    let (initial, improved) = (read("seal-seat-initial"), read("seal-seat-improved"));
    assert_eq!((initial.seat.notch, initial.actuator.tip_positions.len()), (None, 1));
    assert!(improved.seat.notch.is_some() && improved.actuator.tip_positions.len() == 2);
    let mut same = improved.clone();
    same.seat.notch = None;
    same.actuator.tip_positions = initial.actuator.tip_positions.clone();
    assert_eq!(same, initial);
}
