//! A page that lists keys with their units, ranges, defaults and meanings, as Markdown.

use std::fmt::Write;

use super::choices::Choices;
use super::key::{Key, WhereSilent};
use super::unit::unit_of;

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
