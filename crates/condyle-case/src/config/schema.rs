//! Declared tables described by a JSON schema, draft 2020-12, with which editors complete keys and underline errors.
//!
//! The schema accepts every file that the reader accepts; the reader may reject more.

use std::collections::BTreeMap;

use condyle::parameter::unit_of;
use serde_json::{Map, Value, json};

use super::items::{Choices, Item, keys};
use super::key::{Key, Kind, Limits, WhereSilent};

pub(crate) fn table_schema(about: &str, items: &[Item]) -> Value {
    let mut properties: Map<String, Value> = items.iter().filter_map(property).collect();
    let mut rules = rules(items);
    for item in items {
        if let Item::Choice(choices) = item {
            add_offered(choices, &mut properties, &mut rules);
        }
    }
    let mut schema = json!({
        "description": about,
        "type": "object",
        "properties": properties,
        "additionalProperties": false,
    });
    if !rules.is_empty() {
        schema["allOf"] = rules.into();
    }
    schema
}

fn property(item: &Item) -> Option<(String, Value)> {
    let schema = match item {
        Item::Key(key) => of_key(key),
        Item::Choice(choices) => of_key(&choices.by),
        Item::Table(table) if table.is_list => {
            json!({ "type": "array", "items": table_schema(&table.about, &table.items) })
        }
        Item::Table(table) => table_schema(&table.about, &table.items),
        Item::OneOf(_) | Item::AtMostOne(_) | Item::Needs(..) => return None,
    };
    Some((item.name()?.to_owned(), schema))
}

fn rules(items: &[Item]) -> Vec<Value> {
    let mut rules = Vec::new();
    let must = keys(items).into_iter();
    let must = must.filter(|key| key.silent == WhereSilent::MustBeGiven);
    let names: Vec<&str> = must.map(|key| key.name).collect();
    if !names.is_empty() {
        rules.push(json!({ "required": names }));
    }
    for item in items {
        match item {
            Item::OneOf(names) => rules.push(json!({ "oneOf": given(names) })),
            Item::AtMostOne(names) => {
                let mut ways = given(names);
                ways.push(json!({ "not": { "anyOf": given(names) } }));
                rules.push(json!({ "oneOf": ways }));
            }
            Item::Needs(key, needs) => {
                rules.push(json!({ "dependentRequired": { *key: [needs] } }));
            }
            Item::Key(_) | Item::Choice(_) | Item::Table(_) => {}
        }
    }
    rules
}

fn given(names: &[&str]) -> Vec<Value> {
    let given = names.iter().map(|name| json!({ "required": [name] }));
    given.collect()
}

/// Adds the entries that each word brings, and the rule that they are given only under such a word.
fn add_offered(choices: &Choices, properties: &mut Map<String, Value>, rules_of: &mut Vec<Value>) {
    let mut bearers: BTreeMap<String, Vec<(&str, Value)>> = BTreeMap::new();
    for offer in &choices.offered {
        for (name, schema) in offer.items.iter().filter_map(property) {
            bearers.entry(name).or_default().push((offer.word, schema));
        }
    }
    for (name, bearers) in bearers {
        let others = choices.offered.iter().map(|offer| offer.word);
        let others: Vec<&str> = others
            .filter(|word| bearers.iter().all(|(bearer, _)| bearer != word))
            .collect();
        rules_of.push(rule(
            choices,
            &others,
            &json!({ "properties": { &*name: false } }),
        ));
        properties.insert(name, of_bearers(&bearers, choices.by.name));
    }
    for offer in &choices.offered {
        let then = rules(&offer.items);
        rules_of.extend(then.iter().map(|then| rule(choices, &[offer.word], then)));
    }
}

/// Returns the schema of an entry that several words bring, perhaps with other meanings, titled with those words.
fn of_bearers(bearers: &[(&str, Value)], by: &str) -> Value {
    let mut schemas: Vec<Value> = Vec::new();
    for (_, schema) in bearers {
        let alike = bearers.iter().filter(|(_, other)| other == schema);
        let words: Vec<String> = alike.map(|(word, _)| format!("{by} = {word:?}")).collect();
        let mut schema = schema.clone();
        schema["title"] = words.join(", ").into();
        if !schemas.contains(&schema) {
            schemas.push(schema);
        }
    }
    match <[Value; 1]>::try_from(schemas) {
        Ok([only]) => only,
        Err(several) => json!({ "anyOf": several }),
    }
}

/// Returns a rule for tables with one of `words`; the default word is also chosen by silence.
fn rule(choices: &Choices, words: &[&str], then: &Value) -> Value {
    let by = choices.by.name;
    let mut condition = json!({ "properties": { by: { "enum": words } } });
    if !words.contains(&choices.default) {
        condition["required"] = json!([by]);
    }
    json!({ "if": condition, "then": then })
}

fn of_key(key: &Key) -> Value {
    let mut schema = of_kind(&key.kind, key.limits);
    schema["description"] = description(key).into();
    if let WhereSilent::Takes(text) = &key.silent {
        let value = format!("x = {text}").parse::<toml::Table>();
        let value = value.ok().and_then(|mut table| table.remove("x"));
        schema["default"] = value.map_or_else(|| text.as_str().into(), |value| json!(value));
    }
    schema
}

fn of_kind(kind: &Kind, limits: Option<Limits>) -> Value {
    let limited = |number: &str| {
        let mut schema = json!({ "type": number });
        if let Some(Limits { least, most }) = limits {
            schema["minimum"] = json!(least);
            schema["maximum"] = json!(most);
        }
        schema
    };
    let list = |item: &Value, length: usize| json!({ "type": "array", "items": item, "minItems": length, "maxItems": length });
    match kind {
        Kind::Number => limited("number"),
        Kind::WholeNumber => limited("integer"),
        Kind::Sign => json!({ "enum": [1, -1] }),
        Kind::Truth => json!({ "type": "boolean" }),
        Kind::Text | Kind::Path => json!({ "type": "string" }),
        Kind::Word(words) => json!({ "type": "string", "enum": words }),
        Kind::ThreeWords(words) => list(&json!({ "type": "string", "enum": words }), 3),
        Kind::Names => json!({ "type": "array", "items": { "type": "string" } }),
        Kind::Levels => json!({ "type": "array", "minItems": 1 }),
        Kind::Numbers(count) => list(&limited("number"), *count),
        // Limits of points hold for the points as scaled and offset, which the schema cannot compute.
        Kind::Pairs => json!({ "type": "array", "items": list(&json!({ "type": "number" }), 2) }),
    }
}

/// Returns the meaning of a key, its unit, its range and its default.
fn description(key: &Key) -> String {
    let mut text = key.doc.to_string();
    if let Some(unit) = unit_of(key.name) {
        text += &format!(" Unit: {unit}.");
    }
    if let Some(range) = key.limits {
        text += &format!(" Range: {range}.");
    }
    match &key.silent {
        WhereSilent::Takes(default) => text + &format!(" Default: {default}."),
        WhereSilent::MustBeGiven => text + " Must be given.",
        WhereSilent::LeftOut => text,
    }
}
