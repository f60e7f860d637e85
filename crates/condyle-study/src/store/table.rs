//! The stored tests in columns, and as a CSV file.

use std::{
    io::{self, Write},
    path::Path,
};

use condyle_results::replace_file;
use rusqlite::types::ValueRef;

use super::{CHECKSUM, Store, quoted};
use crate::{error::StudyError, plan::Plan};

/// A column of the table, a value for each test; NaN for a test that is missing, and for outputs of one that failed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Column {
    /// For words, the place of each among `words`.
    pub values: Vec<f64>,
    /// The words in alphabetical order; empty for numbers.
    pub words: Vec<String>,
}

impl Store {
    /// Returns the column called `name` for every test.
    pub(crate) fn column(&self, plan: &Plan, name: &str) -> Result<Column, StudyError> {
        let column = quoted(name);
        self.checked(|connection| {
            // Words are numbered in alphabetical order, which does not depend on the order of the tests.
            let words = format!(
                "SELECT DISTINCT {column} FROM tests WHERE typeof({column}) = 'text' ORDER BY {column}"
            );
            let mut statement = connection.prepare(&words)?;
            let words = statement.query_map([], |row| row.get(0))?;
            let words: Vec<String> = words.collect::<rusqlite::Result<_>>()?;
            let mut values = vec![f64::NAN; plan.tests() as usize];
            // The reason of a test that is done is its doubt, that of another its failure.
            let of_done = if name == "reason" { " WHERE status = 'done'" } else { "" };
            let query = format!("SELECT \"row\", {column} FROM tests{of_done}");
            let mut statement = connection.prepare(&query)?;
            let mut rows = statement.query([])?;
            while let Some(row) = rows.next()? {
                let value = match row.get_ref(1)? {
                    ValueRef::Real(number) => number,
                    ValueRef::Integer(whole) => whole as f64,
                    ValueRef::Text(text) => {
                        let place = words.iter().position(|word| word.as_bytes() == text);
                        place.map_or(f64::NAN, |place| place as f64)
                    }
                    ValueRef::Null | ValueRef::Blob(_) => f64::NAN,
                };
                if let Some(place) = values.get_mut(row.get::<_, i64>(0)? as usize) {
                    *place = value;
                }
            }
            Ok(Column { values, words })
        })
    }

    /// Writes every stored test in the order of the rows: the bytes depend neither on machines nor on the order of runs.
    ///
    /// # Errors
    /// A database that cannot be read; the inner error is that of `out`.
    pub fn write_csv(&self, out: &mut dyn Write) -> Result<io::Result<()>, StudyError> {
        self.checked(|connection| {
            let mut statement = connection.prepare("SELECT * FROM tests ORDER BY \"row\"")?;
            let mut names: Vec<String> = statement.column_names().map(csv_cell).collect();
            names.retain(|name| name != CHECKSUM);
            let mut written = writeln!(out, "{}", names.join(","));
            let mut rows = statement.query([])?;
            while let Some(row) = rows.next()? {
                let cells = (0..names.len()).map(|place| {
                    Ok(match row.get_ref(place)? {
                        ValueRef::Null => String::new(),
                        ValueRef::Integer(whole) => whole.to_string(),
                        ValueRef::Real(number) => number.to_string(),
                        ValueRef::Text(bytes) | ValueRef::Blob(bytes) => {
                            csv_cell(&String::from_utf8_lossy(bytes))
                        }
                    })
                });
                let cells: Vec<String> = cells.collect::<rusqlite::Result<_>>()?;
                written = written.and_then(|()| writeln!(out, "{}", cells.join(",")));
                if written.is_err() {
                    break;
                }
            }
            Ok(written)
        })
    }

    /// Writes the table into a file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn export_csv(&self, path: &Path) -> Result<(), StudyError> {
        let refused = StudyError::refused(path);
        let mut table = Vec::new();
        self.write_csv(&mut table)?.map_err(&refused)?;
        replace_file(path, &table).map_err(&refused)
    }
}

fn csv_cell(text: &str) -> String {
    // A spreadsheet would take it for a formula.
    if text.starts_with(['=', '+', '-', '@']) {
        return csv_cell(&format!("'{text}"));
    }
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_no_formula_of_a_spreadsheet() {
        assert_eq!(csv_cell("=cmd|' /C calc'!A0"), "'=cmd|' /C calc'!A0");
        assert_eq!(csv_cell("-1,5"), "\"'-1,5\"");
        assert_eq!(csv_cell("a=b"), "a=b");
    }
}
