//! What can't be: which two features of a scene collide.

use std::borrow::Cow;

/// Two features of a scene that can't both be as they are.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Collision {
    /// The fields to change, as in the scene file; the first one is pointed at.
    pub(super) fields: Vec<Cow<'static, str>>,
    /// What collides, with values, bound and unit.
    pub(super) message: String,
    /// What to do.
    pub(super) help: &'static str,
}

/// A condition on two features; what is said if it does not hold.
pub(super) struct Rule {
    pub(super) fields: Vec<&'static str>,
    pub(super) holds: bool,
    pub(super) message: String,
    pub(super) help: &'static str,
}

/// The collisions where a rule does not hold.
pub(super) fn broken(rules: Vec<Rule>) -> Vec<Collision> {
    let collision = |r: Rule| {
        let fields = r.fields.into_iter().map(Cow::from).collect();
        Collision { fields, message: r.message, help: r.help }
    };
    rules.into_iter().filter(|r| !r.holds).map(collision).collect()
}
