//! Which material each cell of a mesh is of.

use super::mesh::TetMesh;
use crate::scene::Material;

/// The materials of a mesh's cells.
#[derive(Debug, Clone, PartialEq)]
pub struct CellMaterials {
    /// One or several; Young's modulus and density of the first are the units of reduced bodies.
    pub materials: Vec<Material>,
    /// Number of each cell's material. Shape (cells), or empty: all are of the first.
    pub of_cell: Vec<usize>,
}

impl CellMaterials {
    /// All of `material`.
    pub fn one(material: Material) -> Self {
        Self { materials: vec![material], of_cell: Vec::new() }
    }

    /// The same with Young's modulus 1 Pa and density 1 kg/m^3 of the first material.
    pub(super) fn relative(&self) -> Self {
        let first = &self.materials[0];
        let of = |m: &Material| {
            let (stiffness, density) = (m.youngs_modulus / first.youngs_modulus, m.density / first.density);
            Material::elastic("relative", stiffness, m.poisson_ratio, density)
        };
        Self { materials: self.materials.iter().map(of).collect(), of_cell: self.of_cell.clone() }
    }

    /// The material of `cell`.
    pub(super) fn of(&self, cell: usize) -> &Material {
        &self.materials[self.of_cell.get(cell).copied().unwrap_or(0)]
    }

    /// Mass in kg of `mesh`.
    pub(super) fn mass(&self, mesh: &TetMesh) -> f64 {
        mesh.volumes().enumerate().map(|(cell, volume)| self.of(cell).density * volume).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::mesh::boxes;
    use super::super::{StruckPoint, StruckSolid, SurfacePoint};
    use super::*;
    use approx::assert_relative_eq;
    use nalgebra::Vector3;

    const LENGTHS: [f64; 3] = [0.25, 0.25, 2.0];

    /// A bar along z, held at z = 0 and struck at its end, whose lower and upper half are of the two `materials`.
    fn struck_bar(materials: &[Material]) -> StruckSolid {
        let mesh = boxes(LENGTHS, [4, 4, 16], 2, |p| p);
        let middle = |cell: &[usize]| cell[..4].iter().map(|n| mesh.points[*n].z).sum::<f64>() / 4.0;
        let of_cell = match materials {
            [_] => Vec::new(),
            _ => mesh.cells().map(|cell| usize::from(middle(cell) > 0.5 * LENGTHS[2])).collect(),
        };
        let fixed: Vec<bool> = mesh.points.iter().map(|p| p.z == 0.0).collect();
        let at = SurfacePoint { point: Vector3::new(0.125, 0.125, LENGTHS[2]), normal: Vector3::z() };
        let materials = CellMaterials { materials: materials.to_vec(), of_cell };
        StruckSolid::new(
            &mesh,
            &materials,
            &fixed,
            &[StruckPoint { at, circles: [0.06, 0.08, 0.1], rubs: false }],
        )
        .expect("a bar")
    }

    #[test]
    fn two_halves_of_one_material_are_one_body() {
        let steel = Material::elastic("steel", 210e9, 0.3, 7780.0);
        let again = Material { name: "again".into(), ..steel.clone() };
        assert_eq!(struck_bar(&[steel.clone(), again]), struck_bar(&[steel]));
    }

    /// Waves along a bar of two halves (Poisson's ratio 0): tan(w l/c1) tan(w l/c2) = Z1/Z2 with c = sqrt(E/rho), Z = sqrt(E rho).
    #[test]
    fn a_bar_of_two_materials_has_the_frequency_of_its_waves() {
        for (first, second) in [([210e9, 7780.0], [70e9, 2700.0]), ([3e9, 1200.0], [210e9, 7780.0])] {
            let [lower, upper] = [first, second].map(|[e, density]| Material::elastic("m", e, 0.0, density));
            let half = 0.5 * LENGTHS[2];
            let speed = |[e, density]: [f64; 2]| (e / density).sqrt();
            let impedance = |[e, density]: [f64; 2]| (e * density).sqrt();
            let excess = |omega: f64| {
                let tangent = |of| (omega * half / speed(of)).tan();
                tangent(first) * tangent(second) - impedance(first) / impedance(second)
            };
            // it grows from below 0 up to the pole of the slower half
            let pole = 0.5 * std::f64::consts::PI * speed(first).min(speed(second)) / half;
            let (mut low, mut high) = (0.0, pole);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                *if excess(middle) < 0.0 { &mut low } else { &mut high } = middle;
            }
            let struck = struck_bar(&[lower.clone(), upper]);
            let body = struck.of_material(&lower);
            // bending, which an unsymmetrical mesh excites a little, is slower
            assert!(body.omega[0] < 0.9 * low);
            let axial = 2.0 * std::f64::consts::PI * struck.first_frequency(&lower);
            assert_relative_eq!(axial, low, max_relative = 2e-3);
            let mass = half * LENGTHS[0] * LENGTHS[1] * (first[1] + second[1]);
            assert_relative_eq!(body.mass, mass, max_relative = 1e-12);
        }
    }
}
