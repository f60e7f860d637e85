//! Files written key by key, with the meaning of each key as a comment.

#[derive(Default)]
pub(crate) struct Writer {
    text: String,
    path: Vec<String>,
    /// Waveforms are written by their names rather than by their points.
    pub(crate) names_waveforms: bool,
}

/// Column at which comments start, if the value is short enough.
const COMMENT_COLUMN: usize = 40;

impl Writer {
    /// Returns a writer of waveforms by their names or by their points.
    pub(crate) fn new(names_waveforms: bool) -> Self {
        Self {
            names_waveforms,
            ..Self::default()
        }
    }

    /// Writes the table `name` inside the one being written.
    pub(crate) fn table(&mut self, name: &str, write: impl FnOnce(&mut Self)) {
        self.headed(name, ["[", "]"], write);
    }

    /// Writes the next table of the list `name`.
    pub(crate) fn table_of_list(&mut self, name: &str, write: impl FnOnce(&mut Self)) {
        self.headed(name, ["[[", "]]"], write);
    }

    fn headed(&mut self, name: &str, [open, close]: [&str; 2], write: impl FnOnce(&mut Self)) {
        self.path.push(name.to_owned());
        let path = self.path.join(".");
        self.text.push_str(&format!("\n{open}{path}{close}\n"));
        write(self);
        self.path.pop();
    }

    pub(crate) fn comment(&mut self, text: &str) {
        self.text.push_str(&format!("# {text}\n"));
    }

    /// Writes an assignment followed by its meaning.
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

    pub(crate) fn into_text(self) -> String {
        self.text
    }
}
