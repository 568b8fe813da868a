//! Surfaces on which the faces of a solid lie.

use nalgebra::Vector3;

/// A surface without end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Surface {
    /// Through `point`, across the unit vector `normal`.
    Plane {
        /// In m.
        point: Vector3<f64>,
        /// Of length 1.
        normal: Vector3<f64>,
    },
    /// Of `radius` m about the line through `point` along the unit vector `axis`.
    Cylinder {
        /// In m.
        point: Vector3<f64>,
        /// Of length 1.
        axis: Vector3<f64>,
        /// In m.
        radius: f64,
    },
    /// About the line through `point` along the unit vector `axis`, along which it widens by `half_angle` (rad) to each side; a sphere
    /// of `radius` m about `point` touches it from inside.
    Cone {
        /// In m.
        point: Vector3<f64>,
        /// Of length 1.
        axis: Vector3<f64>,
        /// In m.
        radius: f64,
        /// In rad.
        half_angle: f64,
    },
}

impl Surface {
    /// Signed distance in m of `p`, and its gradient, of length 1.
    pub fn distance(&self, p: Vector3<f64>) -> (f64, Vector3<f64>) {
        let meridian = |point: Vector3<f64>, axis: Vector3<f64>| {
            let along = (p - point).dot(&axis);
            let across = p - point - along * axis;
            (across.norm(), along, across.try_normalize(0.0).unwrap_or_else(Vector3::zeros))
        };
        match *self {
            Self::Plane { point, normal } => ((p - point).dot(&normal), normal),
            Self::Cylinder { point, axis, radius } => {
                let (across, _, outwards) = meridian(point, axis);
                (across - radius, outwards)
            }
            Self::Cone { point, axis, radius, half_angle } => {
                let (sin, cos) = half_angle.sin_cos();
                let (across, along, outwards) = meridian(point, axis);
                (across * cos - along * sin - radius, cos * outwards - sin * axis)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gradients_are_those_of_the_distances() {
        let (point, axis) = (Vector3::new(0.1, -0.2, 0.3), Vector3::new(2.0, -1.0, 2.0) / 3.0);
        let surfaces = [
            Surface::Plane { point, normal: axis },
            Surface::Cylinder { point, axis, radius: 0.4 },
            Surface::Cone { point, axis, radius: 0.4, half_angle: 0.9 },
        ];
        let p = Vector3::new(0.7, 0.5, -0.1);
        for surface in surfaces {
            let (at, gradient) = surface.distance(p);
            for c in 0..3 {
                let mut near = p;
                near[c] += 1e-6;
                assert!(((surface.distance(near).0 - at) / 1e-6 - gradient[c]).abs() < 1e-5, "{surface:?}");
            }
            assert!((gradient.norm() - 1.0).abs() < 1e-12);
        }
        // the sphere touches the cone where it says
        let cone = surfaces[2];
        let across = axis.cross(&Vector3::x()).normalize();
        let ring = point + 0.4 * (0.9f64.cos() * across - 0.9f64.sin() * axis);
        assert!(cone.distance(ring).0.abs() < 1e-15);
    }
}
