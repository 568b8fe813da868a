//! What strikes what: the bodies of a scene, whatever its kind.

use super::collision::Collision;
use super::{Flight, Flyer};
use serde::{Serialize, Serializer};
use std::any::Any;
use std::fmt::Debug;

/// Bodies and their motion, as a kind of scene has them.
pub(crate) trait Bodies: Any + Debug + Send + Sync + erased_serde::Serialize + Value {
    /// Name of the kind in scene files.
    fn kind(&self) -> &'static str;

    /// Geometry that can't be.
    fn collisions(&self) -> Vec<Collision> {
        Vec::new()
    }

    /// Numbers that are admissible and yet hardly meant.
    fn doubts(&self) -> Vec<String> {
        Vec::new()
    }

    /// The sphere of a `flight` after the impact, and its chamber; of kinds that have the key.
    ///
    /// # Errors
    /// A sentence if the sphere has no room in the chamber, or is none.
    fn flyer(&self, _: &Flight) -> Result<Flyer, String> {
        Err(format!("a scene of kind `{}` has no flight", self.kind()))
    }
}

/// What can be copied and compared behind a reference.
pub(crate) trait Value {
    fn copy(&self) -> Box<dyn Bodies>;
    fn equals(&self, other: &dyn Bodies) -> bool;
}

impl<T: Bodies + Clone + PartialEq> Value for T {
    fn copy(&self) -> Box<dyn Bodies> {
        Box::new(self.clone())
    }

    fn equals(&self, other: &dyn Bodies) -> bool {
        (other as &dyn Any).downcast_ref::<T>() == Some(self)
    }
}

/// Bodies and their motion: one of the types that the kinds of scene have for them, such as
/// [`PlateImpact`](crate::kinds::plate_impact::PlateImpact).
#[derive(Debug)]
pub struct Setup(Box<dyn Bodies>);

impl Setup {
    pub(crate) fn new(bodies: impl Bodies) -> Self {
        Self(Box::new(bodies))
    }

    /// Name of the kind in scene files.
    pub fn kind(&self) -> &'static str {
        self.0.kind()
    }

    pub(crate) fn bodies(&self) -> &dyn Bodies {
        &*self.0
    }

    /// The bodies as those of one kind; `None` if they are another's.
    pub(crate) fn get<T: Bodies>(&self) -> Option<&T> {
        (&*self.0 as &dyn Any).downcast_ref()
    }
}

impl Clone for Setup {
    fn clone(&self) -> Self {
        Self(self.0.copy())
    }
}

impl PartialEq for Setup {
    fn eq(&self, other: &Self) -> bool {
        self.0.equals(&*other.0)
    }
}

impl Serialize for Setup {
    /// A map: the kind's name under `kind`, and the bodies.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Tagged<'a> {
            kind: &'static str,
            #[serde(flatten)]
            bodies: Erased<'a>,
        }
        struct Erased<'a>(&'a dyn Bodies);
        impl Serialize for Erased<'_> {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                erased_serde::serialize(self.0, serializer)
            }
        }
        Tagged { kind: self.0.kind(), bodies: Erased(&*self.0) }.serialize(serializer)
    }
}
