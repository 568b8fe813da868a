//! JSON schema of scene files, for editors; made from the same specification the reader uses.

use super::alternatives::groups;
use super::check::MAX_NAME;
use super::grammar::{Alternative, Bound, Field, Kind, MODELS, TOLERANCES};
use super::quantity::{Dimension, prefixes, symbols};
use super::tolerances::{TERMS, models};
use super::uncertainty::{CORRELATIONS, DISTRIBUTIONS};
use super::{Dialect, Grammar};
use serde_json::{Map, Value, json};

impl Grammar {
    /// The JSON schema (draft 2020-12) of scene files.
    ///
    /// It refuses what can be told without arithmetic: unknown and missing keys, wrong types,
    /// bare numbers out of range. Products of units and names of materials are checked by [`super::Scene::parse`].
    pub(crate) fn schema(&self) -> Value {
        let mut schema = table(self.keys);
        schema["$schema"] = json!("https://json-schema.org/draft/2020-12/schema");
        schema["title"] = json!("impactcheck scene");
        // What can have a tolerance depends on the scene's kind.
        schema["properties"][TOLERANCES.key] = described(json!({}), TOLERANCES.doc);
        for kind in &self.dialects {
            let own: Map<String, Value> =
                models(kind).iter().map(|m| (m.name.to_owned(), json!(true))).collect();
            let own = json!({ "properties": own, "additionalProperties": false });
            let then = json!({
                "properties": { TOLERANCES.key: tolerances(kind) },
                // names of the user's programs come with them
                "anyOf": [{ "required": ["external"] }, { "properties": { TOLERANCES.key: own } }],
            });
            if let Some(rules) = schema["allOf"].as_array_mut() {
                rules.push(json!({
                    "if": { "properties": { "kind": { "const": kind.name } }, "required": ["kind"] },
                    "then": then,
                }));
            }
        }
        if let Some(rules) = schema["allOf"].as_array_mut() {
            rules.iter_mut().for_each(|rule| self.resolve(rule));
        }
        schema
    }

    /// Lets a rule for scenes of one kind hold for those, too, that are read as such, and no more for those that are read as another.
    fn resolve(&self, rule: &mut Value) {
        let Some(name) = rule["if"]["properties"]["kind"]["const"].as_str().map(str::to_owned) else {
            return;
        };
        for dialect in &self.dialects {
            let Some(alias) = dialect.language.alias() else { continue };
            let named =
                |kind: &str| json!({ "properties": { "kind": { "const": kind } }, "required": ["kind"] });
            let meant = json!({
                "allOf": [named(dialect.name), { "required": alias.with, "not": { "required": [alias.without] } }],
            });
            if name == alias.kind {
                rule["if"] = json!({ "anyOf": [named(&name), meant] });
            } else if name == dialect.name {
                rule["if"] = json!({ "allOf": [named(&name), { "not": meant }] });
            }
        }
    }
}

fn described(mut schema: Value, doc: &str) -> Value {
    schema["description"] = json!(doc);
    schema
}

/// The form of a key's value, with what the key is and its default.
fn stated(form: Value, field: &Field) -> Value {
    let mut schema = described(form, &field.described());
    if let Some(default) = field.default {
        schema["default"] = default.parse().unwrap_or_else(|_| json!(default));
    }
    schema
}

/// A table that has these keys and no other; keys of one `kind` are refused under another.
fn table(fields: &[Field]) -> Value {
    // A key that stands in the table once per kind gets its form with the kind.
    let several = |f: &Field| fields.iter().filter(|other| other.key == f.key).count() > 1;
    let form = |f: &Field| if several(f) { json!({}) } else { value(&f.kind) };
    let properties: Map<String, Value> =
        fields.iter().map(|f| (f.key.to_owned(), stated(form(f), f))).collect();
    let required: Vec<&str> =
        fields.iter().filter(|f| f.is_needed(None) && f.alternative.is_none()).map(|f| f.key).collect();
    let mut schema = json!({
        "type": "object", "properties": properties, "required": required, "additionalProperties": false,
    });
    let mut rules: Vec<Value> = alternatives(fields, None);
    for kind in kinds(fields) {
        let needed: Vec<&str> = fields.iter().filter(|f| f.is_needed(Some(kind))).map(|f| f.key).collect();
        let mut particular: Map<String, Value> = fields
            .iter()
            .filter(|f| !f.belongs_to(Some(kind)))
            .map(|f| (f.key.to_owned(), json!(false)))
            .collect();
        let own = fields.iter().filter(|f| several(f) && f.belongs_to(Some(kind)));
        particular.extend(own.map(|f| (f.key.to_owned(), stated(value(&f.kind), f))));
        let mut then = json!({ "required": needed, "properties": particular });
        let ways = alternatives(fields, Some(kind));
        if !ways.is_empty() {
            then["allOf"] = json!(ways);
        }
        rules.push(json!({
            "if": { "properties": { "kind": { "const": kind } }, "required": ["kind"] },
            "then": then,
        }));
    }
    if !rules.is_empty() {
        schema["allOf"] = json!(rules);
    }
    schema
}

/// The kinds of a table whose keys depend on them.
fn kinds(fields: &[Field]) -> Vec<&'static str> {
    let depends = |f: &Field| !f.only.is_empty() || f.alternative.is_some_and(|a| a.kind.is_some());
    let kind = fields.iter().find(|f| f.key == "kind" && fields.iter().any(depends));
    match kind.map(|f| &f.kind) {
        Some(Kind::Choice(choices)) => choices.iter().map(|c| c.name).collect(),
        _ => Vec::new(),
    }
}

/// For each group of alternatives: one of its sets in full and none of the others.
fn alternatives(fields: &[Field], kind: Option<&str>) -> Vec<Value> {
    let rule = |sets: &Vec<(Alternative, Vec<&Field>)>| {
        let without = |chosen: Option<usize>| -> Map<String, Value> {
            let others = sets.iter().enumerate().filter(|(i, _)| Some(*i) != chosen);
            others.flat_map(|(_, (_, set))| set).map(|f| (f.key.to_owned(), json!(false))).collect()
        };
        let mut ways: Vec<Value> = (0..sets.len())
            .map(|i| {
                let needed: Vec<&str> = sets[i].1.iter().map(|f| f.key).collect();
                json!({ "required": needed, "properties": without(Some(i)) })
            })
            .collect();
        if !sets.iter().any(|(_, set)| set.iter().any(|f| f.required)) {
            ways.push(json!({ "properties": without(None) }));
        }
        json!({ "anyOf": ways })
    };
    groups(fields, kind).iter().map(rule).collect()
}

fn value(kind: &Kind) -> Value {
    match kind {
        Kind::Text | Kind::Material => json!({ "type": "string" }),
        Kind::Named(field) => json!({
            "type": "object", "additionalProperties": value(&field.kind), "minProperties": 1,
        }),
        Kind::Start => json!({ "type": ["number", "boolean", "string"] }),
        Kind::Name => json!({
            "type": "string", "pattern": "^[A-Za-z0-9_][A-Za-z0-9._-]*$", "maxLength": MAX_NAME,
        }),
        Kind::Texts(most) => json!({
            "type": "array", "items": { "type": "string" }, "minItems": 1, "maxItems": most,
        }),
        Kind::Place => json!({ "anyOf": [
            { "type": "string", "minLength": 1 },
            { "type": "array", "items": quantity(Dimension::LENGTH, Bound::ANY), "minItems": 3, "maxItems": 3 },
        ] }),
        Kind::Places(most) => json!({ "type": "array", "items": value(&Kind::Place), "maxItems": most }),
        Kind::Choice(choices) => {
            let names: Vec<&str> = choices.iter().map(|c| c.name).collect();
            json!({ "enum": names })
        }
        Kind::Quantity(dimension, bound) => quantity(*dimension, *bound),
        Kind::Quantities(dimension, bound, most) => json!({
            "type": "array", "items": quantity(*dimension, *bound), "minItems": 1, "maxItems": most,
        }),
        Kind::Count(low, high) => json!({ "type": "integer", "minimum": low, "maximum": high }),
        Kind::Flag => json!({ "type": "boolean" }),
        Kind::Table(fields) => table(fields),
        Kind::TableOf(fields) => json!({ "type": "object", "additionalProperties": table(fields) }),
        Kind::Tables(fields, most) => json!({
            "type": "array", "items": table(fields), "minItems": 1, "maxItems": most,
        }),
        Kind::Tolerances => json!({}),
        Kind::Uncertainty => uncertainty(),
    }
}

/// A number in SI, or a text: a decimal number with a unit of this dimension.
fn quantity(dimension: Dimension, bound: Bound) -> Value {
    let (_, unit, sample) = dimension.describe();
    let range = bound.describe(unit);
    let range = if dimension == Dimension::NONE { range } else { format!("in {unit}, {range}") };
    let mut number = json!({ "type": "number", "description": range });
    let high = bound.high.or(Some((dimension.span()[1], true)));
    for (end, valid, open) in
        [(bound.low, "minimum", "exclusiveMinimum"), (high, "maximum", "exclusiveMaximum")]
    {
        if let Some((at, is_valid)) = end {
            number[if is_valid { valid } else { open }] = json!(at);
        }
    }
    let sign = if bound.low.is_some_and(|(at, _)| at >= 0.0) { r"\+?" } else { "[+-]?" };
    let pattern =
        format!(r"^\s*{sign}([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*({})?\s*$", units(dimension));
    json!({ "anyOf": [number, { "type": "string", "pattern": pattern }], "examples": [sample] })
}

/// A pattern of the units that a quantity may have: single symbols of its dimension, and products of whatever symbols,
/// which only arithmetic tells apart.
fn units(dimension: Dimension) -> String {
    let prefix = prefixes().join("|");
    let symbol = |(symbol, prefixed): (&str, bool)| {
        if prefixed { format!("({prefix})?{symbol}") } else { symbol.to_owned() }
    };
    let mut ways: Vec<String> = symbols(dimension).map(symbol).collect();
    ways.push(r"[^0-9*/^\s]+\s*([*/^·⋅²³]|\s[^\s]).*".to_owned());
    if dimension.0.iter().any(|power| *power < 0) {
        ways.push(r"1\s*/.*".to_owned());
    }
    ways.join("|")
}

/// Names of fields, with dots, and how each scatters; tables within are names without quotes.
fn uncertainty() -> Value {
    let percentage = json!({ "type": "string", "pattern": r"^\s*\+?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+-]?[0-9]+)?\s*%\s*$" });
    let number = json!({ "type": ["number", "string"] });
    let bounds = json!({ "type": "array", "items": number, "minItems": 2, "maxItems": 2 });
    let form = |(name, doc): (&str, &str)| {
        let value = if name == "uniform" { &bounds } else { &number };
        let properties = json!({ name: described(value.clone(), doc) });
        json!({ "type": "object", "properties": properties, "required": [name], "additionalProperties": false })
    };
    let names: Vec<&str> = DISTRIBUTIONS.iter().map(|(name, _)| *name).collect();
    let within = json!({ "type": "object", "propertyNames": { "not": { "enum": names } } });
    let forms = [percentage].into_iter().chain(DISTRIBUTIONS.map(form)).chain([within]);
    json!({
        "type": "object",
        "properties": { CORRELATIONS.key: described(value(&CORRELATIONS.kind), CORRELATIONS.doc) },
        "additionalProperties": { "anyOf": forms.collect::<Vec<_>>() },
    })
}

fn tolerances(kind: &Dialect) -> Value {
    let text_or_number = |low: Option<f64>| {
        let mut number = json!({ "type": "number" });
        if let Some(low) = low {
            number["minimum"] = json!(low);
        }
        json!({ "anyOf": [number, { "type": "string" }] })
    };
    let terms: Map<String, Value> = TERMS
        .iter()
        .map(|(name, doc)| {
            let low = (*name != "bias").then_some(0.0);
            ((*name).to_owned(), described(text_or_number(low), doc))
        })
        .collect();
    let bounds: Vec<Value> =
        TERMS.iter().filter(|(n, _)| *n != "bias").map(|(n, _)| json!({ "required": [n] })).collect();
    let tolerance = json!({ "anyOf": [
        { "type": "number", "minimum": 0 },
        { "type": "string" },
        { "type": "object", "properties": terms, "additionalProperties": false, "anyOf": bounds },
    ] });
    let quantities: Map<String, Value> =
        kind.gated.iter().map(|g| (g.name.clone(), tolerance.clone())).collect();
    let model = json!({ "type": "object", "properties": quantities, "additionalProperties": false });
    // whatever models the kind has, programs of the user's have names of their own
    let models: Vec<&str> = models(kind).iter().map(|m| m.name).collect();
    let foreign = MODELS.iter().map(|m| m.name).filter(|name| !models.contains(name));
    let refused: Map<String, Value> = foreign.map(|name| (name.to_owned(), json!(false))).collect();
    json!({ "type": "object", "properties": refused, "additionalProperties": model })
}
