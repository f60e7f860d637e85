//! Keys written: to a file with their values, and to a page of the book.

use std::fmt::Write;

use super::key::{Key, WhereSilent, unit_of};
use super::setting::Setting;
use super::variants::Choices;

/// A file being written.
#[derive(Default)]
pub struct Writer {
    text: String,
}

/// Column at which comments start, where the value is short enough.
const COMMENT_COLUMN: usize = 40;

impl Writer {
    /// Starts a table.
    pub(crate) fn table(&mut self, path: &str) {
        self.text.push_str(&format!("\n[{path}]\n"));
    }

    /// Starts the next table of a list.
    pub(crate) fn table_of_list(&mut self, path: &str) {
        self.text.push_str(&format!("\n[[{path}]]\n"));
    }

    /// Writes a remark on a line of its own.
    pub(crate) fn comment(&mut self, text: &str) {
        self.text.push_str(&format!("# {text}\n"));
    }

    /// Writes a key with its value and what it means; a value that is left out only as a remark.
    pub(crate) fn setting<T: Setting>(&mut self, key: &Key, value: &T) {
        match value.text() {
            Some(text) => self.line(&format!("{} = {text}", key.name), &key.doc),
            None => self.line(&format!("# {} =", key.name), &key.doc),
        }
    }

    /// Writes the word that chooses which other keys a table has.
    pub(crate) fn word(&mut self, key: &Key, word: &str) {
        self.line(&format!("{} = {word:?}", key.name), &key.doc);
    }

    /// Writes an assignment, and what it means behind it.
    pub(crate) fn line(&mut self, assignment: &str, doc: &str) {
        let doc = doc.trim();
        let line = format!("{assignment:<COMMENT_COLUMN$} # {doc}\n");
        self.text.push_str(&line);
    }

    /// Writes pairs of numbers, a few on each line.
    pub(crate) fn pairs(&mut self, key: &str, pairs: &[(f64, f64)]) {
        const PAIRS_ON_A_LINE: usize = 4;
        self.text.push_str(&format!("{key} = [\n"));
        for some in pairs.chunks(PAIRS_ON_A_LINE) {
            let some: Vec<String> = some
                .iter()
                .map(|(a, b)| format!("[{a:?}, {b:?}]"))
                .collect();
            self.text.push_str(&format!("    {},\n", some.join(", ")));
        }
        self.text.push_str("]\n");
    }

    /// All that was written.
    pub(crate) fn into_text(self) -> String {
        self.text
    }
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
