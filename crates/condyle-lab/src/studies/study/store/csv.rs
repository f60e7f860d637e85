//! The table of a study as CSV.

use std::io::{self, Write};

use rusqlite::types::ValueRef;

use super::super::error::StudyError;
use super::database::Store;

impl Store {
    /// Writes every test that is kept, in the order of their numbers: the same bytes whoever ran them, and in which order.
    ///
    /// # Errors
    /// A database that cannot be read; what `out` says.
    pub fn write_csv(&self, out: &mut dyn Write) -> Result<io::Result<()>, StudyError> {
        self.checked(|connection| {
            let mut statement = connection.prepare("SELECT * FROM tests ORDER BY \"row\"")?;
            let names: Vec<String> = statement.column_names().map(cell).collect();
            let mut written = writeln!(out, "{}", names.join(","));
            let mut rows = statement.query([])?;
            while let Some(row) = rows.next()? {
                let cells = (0..names.len()).map(|place| Ok(text(row.get_ref(place)?)));
                let cells: Vec<String> = cells.collect::<rusqlite::Result<_>>()?;
                written = written.and_then(|()| writeln!(out, "{}", cells.join(",")));
                if written.is_err() {
                    break;
                }
            }
            Ok(written)
        })
    }
}

fn text(value: ValueRef<'_>) -> String {
    match value {
        ValueRef::Null => String::new(),
        ValueRef::Integer(whole) => whole.to_string(),
        ValueRef::Real(number) => number.to_string(),
        ValueRef::Text(bytes) | ValueRef::Blob(bytes) => cell(&String::from_utf8_lossy(bytes)),
    }
}

/// A cell of CSV, in quotes where it must be.
fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
