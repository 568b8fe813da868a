//! The forces that act during a step, from those at its ends.
//!
//! Contacts whose forces depend on their approaches alone take exactly the work that their laws state: both forces are constant over the step,
//! their means m_i scaled so that the work sum m_i (1 + r_i) dy_i is what the contacts take (a discrete gradient: Gonzalez, J. Nonlinear Sci. 6,
//! 1996, 449). So no step makes energy, however long it is, and no contact returns more than it took. Where forces depend on time also they
//! change evenly from one end to the other.

/// Work of a step over the energy of the contacts below which its difference to what they take does not matter: where contacts turn it would
/// be rounding.
const ROUNDING: f64 = 1e-5;

/// How the forces of a step follow from those at its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum StepForce {
    /// Constant, so that the work is what the contacts take.
    Conserving,
    /// Constant means of those at the ends.
    Mean,
    /// Changing evenly.
    Linear,
}

impl StepForce {
    /// The forces at the start of a step that do not depend on those at its end, from the forces `start` in N.
    pub(super) fn known(self, start: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Conserving | Self::Mean => [0.0; 2],
            Self::Linear => start,
        }
    }

    /// The forces in N that a step is to be solved for, from those at its `ends`; the bodies approach by `moved` m, and the contacts go from the
    /// first to the second `energy` in J.
    pub(super) fn acting(self, ends: [[f64; 2]; 2], moved: [f64; 2], energy: [f64; 2]) -> [f64; 2] {
        let mean = mean(ends);
        match self {
            Self::Linear => return ends[1],
            Self::Mean => return mean,
            Self::Conserving => {}
        }
        let work = [mean[0] * moved[0], mean[1] * moved[1]];
        let rounding = ROUNDING * energy[0].max(energy[1]);
        let size = work[0] * work[0] + work[1] * work[1] + rounding * rounding;
        let missing = (energy[1] - energy[0] - work[0] - work[1]) / size;
        // without work the mean is left; no contact pulls
        let scaled = |i: usize| mean[i] * (1.0 + (missing * work[i]).clamp(-1.0, 1.0));
        [0, 1].map(|i| if work[i] == 0.0 { mean[i] } else { scaled(i) })
    }

    /// What the modes feel: the forces at start and end of a step, shape (2, contacts), from those at its `ends` and the `acting` ones.
    pub(super) fn felt(self, ends: [[f64; 2]; 2], acting: [f64; 2]) -> [[f64; 2]; 2] {
        match self {
            Self::Conserving | Self::Mean => [acting; 2],
            Self::Linear => ends,
        }
    }

    /// Change of the acting forces by those at the end, about.
    pub(super) fn share_of_end(self) -> f64 {
        match self {
            Self::Conserving | Self::Mean => 0.5,
            Self::Linear => 1.0,
        }
    }
}

/// Means of the forces at both `ends` in N.
pub(super) fn mean([start, end]: [[f64; 2]; 2]) -> [f64; 2] {
    [0, 1].map(|i| 0.5 * (start[i] + end[i]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn the_work_of_a_step_is_what_the_contacts_take() {
        for (ends, moved, taken) in [
            ([[3.0, 0.0], [5.0, 2.0]], [1e-6, -2e-7], 3.9e-6),
            ([[0.0, 1.0], [4.0, 1.0]], [1e-6, 0.0], 1.6e-6),
            ([[2.0, 7.0], [0.0, 7.5]], [-3e-6, 1e-9], -2.5e-6),
        ] {
            let [outer, inner] = StepForce::Conserving.acting(ends, moved, [4e-6, 4e-6 + taken]);
            assert_relative_eq!(outer * moved[0] + inner * moved[1], taken, max_relative = 1e-4);
            assert!(outer >= 0.0 && inner >= 0.0);
        }
        // an open contact gets no force, and none pulls
        let [_, open] = StepForce::Conserving.acting([[3.0, 0.0], [5.0, 0.0]], [1e-6, 2e-6], [0.0, 3.9e-6]);
        assert_eq!(open, 0.0);
        let [pulled, _] = StepForce::Conserving.acting([[3.0, 0.0], [5.0, 0.0]], [1e-6, 0.0], [9e-6, 0.0]);
        assert_eq!(pulled, 0.0);
        // a contact at rest presses on
        let rests = StepForce::Conserving.acting([[3.0, 0.0], [3.0, 0.0]], [1e-18, 0.0], [1e-5, 1e-5]);
        assert_relative_eq!(rests[0], 3.0, max_relative = 1e-6);
    }
}
