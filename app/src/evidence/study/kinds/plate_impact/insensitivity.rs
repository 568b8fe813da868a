//! How little model C depends on what the user does not choose by physics: number of modes, patch radius over which
//! loads are weighted, mesh of the continuum bodies. Both scenes of Table 1.

use crate::body::continuum::MeshOptions;
use crate::error::Result;
use crate::evidence::study::{Cell, Claim, Note, Study};
use crate::kinds::plate_impact::PlateQuantities;
use crate::kinds::plate_impact::variants::{ContinuumSetup, Simplification, Variants};
use crate::scene::{self, Scene};

/// Scenes of Table 1 of the paper.
const SCENES: [&str; 2] = ["scaled-plate-r10", "scaled-plate-r6.35"];
/// Numbers of modes; the first is that of the other rows.
const MODES: [usize; 6] = [16, 4, 6, 8, 32, 64];
/// Modes that model C takes the patch radius from.
const PATCH_MODES: usize = 16;
/// Error bound of the time integration, far below the differences looked at.
const TOLERANCE: f64 = 1e-8;
/// Largest change allowed: efficiency (absolute), force peaks and contact ends (relative). The largest found are 0.0007,
/// 0.5 % (four modes end below the contacts' frequencies) and 0.2 %.
const BOUNDS: [(&str, f64); 3] = [("efficiency", 1e-3), ("force peaks", 6e-3), ("contact ends", 3e-3)];

/// One way to set model C up.
struct ModelVariant {
    name: &'static str,
    setup: ContinuumSetup,
    modes: &'static [usize],
}

fn cases() -> [ModelVariant; 5] {
    let normal = ContinuumSetup::default();
    let case = |name, patch_factor, mesh| ModelVariant {
        name,
        setup: ContinuumSetup { patch_factor, mesh },
        modes: &MODES[..1],
    };
    [
        ModelVariant { name: "modes", setup: normal, modes: &MODES },
        case("patch x 0.5", 0.5, normal.mesh),
        case("patch x 2", 2.0, normal.mesh),
        case("mesh coarser by 1.5", 1.0, normal.mesh.refined(1.0 / 1.5)),
        case("mesh finer by 1.5, order 4", 1.0, MeshOptions { order: 4, ..normal.mesh.refined(1.5) }),
    ]
}

/// The study.
///
/// # Errors
/// As [`Variants::new`] and [`Variants::run`].
pub fn run(note: &mut Note) -> Result<Study> {
    let (mut rows, mut claims) = (Vec::new(), Vec::new());
    for name in SCENES {
        note(name);
        let scene = Scene::read(scene::resolve(name)?)?;
        let mut normal = None;
        for case in cases() {
            let most = case.modes.iter().copied().max().unwrap_or(PATCH_MODES);
            let variants = Variants::new(&scene, [PATCH_MODES, most], PATCH_MODES, &case.setup)?;
            for &modes in case.modes {
                let result = variants.run(Simplification::None, modes, TOLERANCE)?;
                let normal = normal.get_or_insert(result);
                rows.push(row(name, case.name, case.setup.patch_factor, modes, &result, normal));
                let what = if case.modes.len() > 1 { format!("{modes} modes") } else { case.name.to_owned() };
                claims.extend(change(&result, normal).into_iter().zip(BOUNDS).map(
                    |(change, (quantity, bound))| {
                        Claim::new(
                            format!("{name}, {what}: change of the {quantity}"),
                            "1",
                            None,
                            Some(change),
                            bound,
                        )
                    },
                ));
            }
        }
    }
    Ok(Study::new(
        "insensitivity",
        "Model C on both scenes of Table 1 with other numbers of modes, other patch radii and other meshes \
                      of its bodies; changes against 16 modes on the default mesh. The columns efficiency_change is \
                      absolute, the other changes are relative (the larger of both contacts).",
        "scene, varied, patch_factor, modes, efficiency, outer_force_peak [N], inner_force_peak [N], \
         outer_contact_end [s], inner_contact_end [s], efficiency_change, force_change, \
         contact_end_change",
        rows,
        claims,
    ))
}

/// Changes of the efficiency (absolute) and of the force peaks and contact ends (relative, the larger of both).
fn change(a: &PlateQuantities, b: &PlateQuantities) -> [f64; 3] {
    let larger =
        |pairs: [(f64, f64); 2]| pairs.map(|(a, b)| (a / b - 1.0).abs()).into_iter().fold(0.0, f64::max);
    [
        (a.efficiency - b.efficiency).abs(),
        larger([(a.outer_force_peak, b.outer_force_peak), (a.inner_force_peak, b.inner_force_peak)]),
        larger([(a.outer_contact_end, b.outer_contact_end), (a.inner_contact_end, b.inner_contact_end)]),
    ]
}

fn row(
    scene: &'static str,
    varied: &'static str,
    patch_factor: f64,
    modes: usize,
    result: &PlateQuantities,
    normal: &PlateQuantities,
) -> Vec<Cell> {
    let mut row = vec![Cell::Text(scene), Cell::Text(varied), patch_factor.into(), modes.into()];
    let values = [
        result.efficiency,
        result.outer_force_peak,
        result.inner_force_peak,
        result.outer_contact_end,
        result.inner_contact_end,
    ];
    row.extend(values.into_iter().chain(change(result, normal)).map(Cell::Number));
    row
}
