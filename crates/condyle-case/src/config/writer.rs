//! A file, written key by key.

use super::key::Key;
use super::setting::Setting;

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
