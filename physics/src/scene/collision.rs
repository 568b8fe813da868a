//! What can't be: which two features of a scene collide.

use std::borrow::Cow;

/// Two features of a scene that can't both be as they are.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Collision {
    /// The fields to change, as in the scene file; the first one is pointed at.
    pub(crate) fields: Vec<Cow<'static, str>>,
    /// What collides, with values, bound and unit.
    pub(crate) message: String,
    /// What to do.
    pub(crate) help: &'static str,
}

/// A condition on two features; what is said if it does not hold.
pub(crate) struct Rule {
    pub(crate) fields: Vec<&'static str>,
    pub(crate) holds: bool,
    pub(crate) message: String,
    pub(crate) help: &'static str,
}

/// The collisions where a rule does not hold.
pub(crate) fn broken(rules: Vec<Rule>) -> Vec<Collision> {
    let collision = |r: Rule| {
        let fields = r.fields.into_iter().map(Cow::from).collect();
        Collision { fields, message: r.message, help: r.help }
    };
    rules.into_iter().filter(|r| !r.holds).map(collision).collect()
}
