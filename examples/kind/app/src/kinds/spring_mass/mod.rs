//! A sphere strikes a mass on a spring.

pub use impactcheck_physics::kinds::spring_mass::*;

use super::{Feature, Starter};

impl super::Kind for Kind {
    fn starter(&self) -> Starter {
        Starter { about: "A sphere strikes a mass on a spring", text: include_str!("starter.toml") }
    }

    fn features(&self) -> &'static [Feature] {
        static FEATURES: [Feature; 1] =
            [Feature::new("mass on a spring", |scene| scene.setup.kind() == NAME)];
        &FEATURES
    }

    fn has_mesh(&self) -> bool {
        false
    }
}
