//! Keys described: a page of the book in Markdown, and a JSON schema, draft 2020-12, with which an editor completes keys and
//! underlines what is wrong.
//!
//! A schema never refuses what a reader takes; a reader may refuse more.

use std::collections::BTreeMap;
use std::fmt::Write;

use condyle::parameter::unit_of;
use serde_json::{Map, Value, json};

use super::key::Kind;
use super::key::Limits;
use super::key::{Key, WhereSilent};
use super::variants::Choices;

/// The schema of a table, being made.
pub(crate) struct TableSchema {
    about: String,
    properties: Map<String, Value>,
    rules: Vec<Value>,
}

impl TableSchema {
    /// A table without keys.
    pub(crate) fn new(about: &str) -> Self {
        Self {
            about: about.to_owned(),
            properties: Map::new(),
            rules: Vec::new(),
        }
    }

    /// The same with `keys`.
    pub(crate) fn with_keys(mut self, keys: &[Key]) -> Self {
        let given = keys.iter().map(|key| (key.name.to_owned(), of_key(key)));
        self.properties.extend(given);
        self.rules.extend(required(keys));
        self
    }

    /// The same with the key of `choices`, and with the keys that each of its words brings where
    /// that word is given.
    pub(crate) fn with_choices(mut self, choices: &Choices) -> Self {
        let by = &choices.by;
        self.properties.insert(by.name.to_owned(), of_key(by));
        for (name, bearers) in bearers(choices) {
            self.properties
                .insert(name.to_owned(), of_bearers(&bearers, by.name));
            let words: Vec<&str> = bearers.iter().map(|(word, _)| *word).collect();
            self.rules.push(only_under(choices, &words, name));
        }
        for offer in &choices.offered {
            let then = required(&offer.keys);
            self.rules
                .extend(then.map(|then| rule(choices, &[offer.word], &then)));
        }
        self
    }

    /// The same with the table `name` inside.
    pub(crate) fn with_table(mut self, name: &str, table: Self) -> Self {
        self.properties.insert(name.to_owned(), table.into_schema());
        self
    }

    /// The same with the list `name` of such tables inside, of one or more.
    pub(crate) fn with_list(mut self, name: &str, table: Self) -> Self {
        let list = json!({ "type": "array", "minItems": 1, "items": table.into_schema() });
        self.properties.insert(name.to_owned(), list);
        self
    }

    /// The same where exactly one of the keys `names` is given.
    pub(crate) fn with_one_of(mut self, names: &[&str]) -> Self {
        self.rules.push(one_of(names));
        self
    }

    /// The same where exactly one of the keys `names` is given if the table has `word`.
    pub(crate) fn with_one_of_under(
        mut self,
        choices: &Choices,
        word: &str,
        names: &[&str],
    ) -> Self {
        self.rules.push(rule(choices, &[word], &one_of(names)));
        self
    }

    /// The same where `key` is given only beside `needs`.
    pub(crate) fn with_need(mut self, key: &str, needs: &str) -> Self {
        self.rules
            .push(json!({ "dependentRequired": { key: [needs] } }));
        self
    }

    /// The schema.
    pub(crate) fn into_schema(self) -> Value {
        let mut schema = json!({
            "description": self.about,
            "type": "object",
            "properties": self.properties,
            "additionalProperties": false,
        });
        if !self.rules.is_empty() {
            schema["allOf"] = self.rules.into();
        }
        schema
    }
}

/// Keys by their names, each with the words of `choices` that bring it.
fn bearers(choices: &Choices) -> BTreeMap<&'static str, Vec<(&'static str, &Key)>> {
    let mut bearers: BTreeMap<_, Vec<_>> = BTreeMap::new();
    for offer in &choices.offered {
        for key in &offer.keys {
            bearers.entry(key.name).or_default().push((offer.word, key));
        }
    }
    bearers
}

/// A key that several words bring, perhaps with other meanings.
fn of_bearers(bearers: &[(&'static str, &Key)], by: &str) -> Value {
    let mut schemas: Vec<Value> = Vec::new();
    for &(word, key) in bearers {
        let mut schema = of_key(key);
        schema["title"] = words_of(bearers, key, by, word).into();
        if !schemas.contains(&schema) {
            schemas.push(schema);
        }
    }
    match <[Value; 1]>::try_from(schemas) {
        Ok([only]) => only,
        Err(several) => json!({ "anyOf": several }),
    }
}

/// The words that bring a key like `key`, as the case has them.
fn words_of(bearers: &[(&str, &Key)], key: &Key, by: &str, own: &str) -> String {
    let alike = bearers
        .iter()
        .filter(|(word, other)| *other == key || *word == own);
    let words: Vec<String> = alike.map(|(word, _)| format!("{by} = {word:?}")).collect();
    words.join(", ")
}

/// That the key `name` is given only under some of the words, and then as it is meant there.
fn only_under(choices: &Choices, words: &[&str], name: &str) -> Value {
    let others = choices.offered.iter().map(|offer| offer.word);
    let others: Vec<&str> = others.filter(|word| !words.contains(word)).collect();
    rule(choices, &others, &json!({ "properties": { name: false } }))
}

/// What holds where a table has one of `words`, of which the default is had by silence.
fn rule(choices: &Choices, words: &[&str], then: &Value) -> Value {
    let by = choices.by.name;
    let mut condition = json!({ "properties": { by: { "enum": words } } });
    if !words.contains(&choices.default) {
        condition["required"] = json!([by]);
    }
    json!({ "if": condition, "then": then })
}

fn one_of(names: &[&str]) -> Value {
    let alone = |name: &&str| json!({ "required": [name] });
    json!({ "oneOf": names.iter().map(alone).collect::<Vec<Value>>() })
}

/// That the keys that must be given are.
fn required(keys: &[Key]) -> Option<Value> {
    let must = keys
        .iter()
        .filter(|key| key.silent == WhereSilent::MustBeGiven);
    let names: Vec<&str> = must.map(|key| key.name).collect();
    (!names.is_empty()).then(|| json!({ "required": names }))
}

/// The schema of the value behind a key, with what it means.
pub(crate) fn of_key(key: &Key) -> Value {
    let mut schema = of_kind(&key.kind, key.limits);
    schema["description"] = description(key).into();
    if let WhereSilent::Takes(text) = &key.silent {
        schema["default"] = value_of(text);
    }
    schema
}

fn of_kind(kind: &Kind, limits: Option<Limits>) -> Value {
    match kind {
        Kind::Number => limited("number", limits),
        Kind::WholeNumber => limited("integer", limits),
        Kind::Sign => json!({ "enum": [1, -1] }),
        Kind::Truth => json!({ "type": "boolean" }),
        Kind::Text | Kind::Path => json!({ "type": "string" }),
        Kind::Word(words) => json!({ "type": "string", "enum": words }),
        Kind::ThreeWords(words) => list(&json!({ "type": "string", "enum": words }), 3),
        Kind::Names => json!({ "type": "array", "items": { "type": "string" } }),
        Kind::Levels => json!({ "type": "array", "minItems": 1 }),
        Kind::TwoNumbers => list(&limited("number", limits), 2),
        Kind::ThreeNumbers => list(&limited("number", limits), 3),
        // Limits of points hold for what becomes of them, once scaled and offset.
        Kind::Pairs => json!({ "type": "array", "items": list(&json!({ "type": "number" }), 2) }),
    }
}

fn limited(number: &str, limits: Option<Limits>) -> Value {
    let mut schema = json!({ "type": number });
    if let Some(Limits { least, most }) = limits {
        schema["minimum"] = json!(least);
        schema["maximum"] = json!(most);
    }
    schema
}

fn list(item: &Value, length: usize) -> Value {
    json!({ "type": "array", "items": item, "minItems": length, "maxItems": length })
}

/// What a key means, its unit, its range and what is taken without it.
fn description(key: &Key) -> String {
    let unit = unit_of(key.name).map(|unit| format!("Unit: {unit}."));
    let range = key.limits.map(|limits| format!("Range: {limits}."));
    let default = match &key.silent {
        WhereSilent::Takes(text) => Some(format!("Default: {text}.")),
        WhereSilent::MustBeGiven => Some("Must be given.".to_owned()),
        WhereSilent::LeftOut => None,
    };
    let parts = [Some(key.doc.to_string()), unit, range, default];
    parts
        .into_iter()
        .flatten()
        .collect::<Vec<String>>()
        .join(" ")
}

/// A value of TOML as one of JSON.
fn value_of(text: &str) -> Value {
    let value: Result<toml::Value, _> = format!("x = {text}")
        .parse::<toml::Table>()
        .map(|mut table| table.remove("x").unwrap_or_else(|| text.into()));
    value.map_or_else(|_| text.into(), |value| json!(value))
}

/// A page being made.
pub(crate) struct Page {
    text: String,
}

impl Page {
    /// A page that begins with `opening`.
    pub(crate) fn new(opening: &str) -> Self {
        let text = opening.to_owned();
        Self { text }
    }

    /// Adds Markdown as it stands.
    pub(crate) fn push(&mut self, markdown: &str) {
        self.text.push_str(markdown);
    }

    /// Adds a heading, and the keys below it.
    pub(crate) fn section(&mut self, title: &str, keys: &[Key]) {
        self.push(&format!("\n## {title}\n\n"));
        self.table(keys);
    }

    /// Adds a section of `keys`, of which one is the key of `choices`, and the keys that each of
    /// its words brings.
    pub(crate) fn chosen(&mut self, title: &str, keys: &[Key], choices: &Choices) {
        let by = &choices.by;
        self.section(title, keys);
        for offer in choices
            .offered
            .iter()
            .filter(|offer| !offer.keys.is_empty())
        {
            self.push(&format!("\nWith `{} = \"{}\"`:\n\n", by.name, offer.word));
            self.table(&offer.keys);
        }
    }

    /// Adds a table of keys.
    pub(crate) fn table(&mut self, keys: &[Key]) {
        self.push("| key | unit | may be | default | meaning |\n");
        self.push("| --- | --- | --- | --- | --- |\n");
        keys.iter().for_each(|key| self.row(key));
    }

    fn row(&mut self, key: &Key) {
        let unit = unit_of(key.name).unwrap_or("");
        let range = match &key.limits {
            Some(limits) => format!("{}, {limits}", key.kind),
            None => key.kind.to_string(),
        };
        let default = match &key.silent {
            WhereSilent::Takes(text) => format!("`{text}`"),
            WhereSilent::LeftOut => "none".to_owned(),
            WhereSilent::MustBeGiven => "must be given".to_owned(),
        };
        let (name, doc) = (key.name, &key.doc);
        let row = writeln!(
            self.text,
            "| `{name}` | {unit} | {range} | {default} | {doc} |"
        );
        debug_assert!(row.is_ok(), "writing to a String does not fail");
    }

    /// The whole page.
    pub(crate) fn into_text(self) -> String {
        self.text
    }
}
