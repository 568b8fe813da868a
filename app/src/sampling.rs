//! Samples of the unit cube.

/// Latin hypercube (McKay, Beckman & Conover, Technometrics 21, 1979): `samples` points of `dimensions`
/// coordinates in 0..1, one in each of `samples` equal slices of every coordinate. The same seed gives the same
/// points. Shape (samples, dimensions).
pub fn latin_hypercube(samples: usize, dimensions: usize, seed: u64) -> Vec<Vec<f64>> {
    let mut random = fastrand::Rng::with_seed(seed);
    let mut points = vec![Vec::with_capacity(dimensions); samples];
    let mut slices: Vec<usize> = (0..samples).collect();
    for _ in 0..dimensions {
        random.shuffle(&mut slices);
        for (point, slice) in points.iter_mut().zip(&slices) {
            point.push((*slice as f64 + random.f64()) / samples as f64);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::latin_hypercube;

    #[test]
    fn every_slice_of_every_coordinate_has_one_point() {
        let points = latin_hypercube(37, 3, 5);
        for axis in 0..3 {
            let mut slices: Vec<usize> = points.iter().map(|p| (p[axis] * 37.0) as usize).collect();
            slices.sort_unstable();
            assert_eq!(slices, (0..37).collect::<Vec<_>>());
        }
        assert_eq!(points, latin_hypercube(37, 3, 5));
        assert_ne!(points, latin_hypercube(37, 3, 6));
    }
}
