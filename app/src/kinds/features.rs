//! What scenes can have that a comparison may or may not cover.

use super::Form;
use crate::scene::Scene;

/// Something a scene can have.
#[derive(Debug, Clone, Copy)]
pub struct Feature {
    /// For people.
    pub name: &'static str,
    has: fn(&Scene) -> bool,
    /// The closed form that is about it, if there is one.
    pub form: Option<Form>,
}

impl Feature {
    /// What `has` finds.
    pub const fn new(name: &'static str, has: fn(&Scene) -> bool) -> Self {
        Self { name, has, form: None }
    }

    /// The same with a closed form about it.
    pub const fn by(self, form: Form) -> Self {
        Self { form: Some(form), ..self }
    }

    /// Whether `scene` has it.
    pub fn is_in(&self, scene: &Scene) -> bool {
        (self.has)(scene)
    }
}
