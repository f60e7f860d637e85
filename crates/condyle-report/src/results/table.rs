//! A table of numbers from a CSV file.

use std::path::Path;

use crate::error::ReportError;

/// Columns of numbers by name; an empty cell is NaN.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    names: Vec<String>,
    columns: Vec<Vec<f64>>,
}

impl Table {
    /// Reads a table of numbers with a header; `path` is for messages only.
    ///
    /// # Errors
    /// A row does not fit the header, or a cell is not a number.
    pub fn parse(text: &str, path: &Path) -> Result<Self, ReportError> {
        let mut lines = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .from_reader(text.trim_start_matches('\u{feff}').as_bytes());
        let mut table = Self::default();
        let mut row = csv::StringRecord::new();
        // The text is valid, so that no row is an error.
        while lines.read_record(&mut row).unwrap_or_default() {
            table.push(&row, path)?;
        }
        Ok(table)
    }

    /// Returns the column called `name`.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let index = self.names.iter().position(|known| known == name)?;
        Some(&self.columns[index])
    }

    /// Names of the columns, in the order of the file.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Returns the number of rows, without the header.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    fn push(&mut self, row: &csv::StringRecord, path: &Path) -> Result<(), ReportError> {
        if self.names.is_empty() {
            self.names = row.iter().map(|name| name.trim().to_owned()).collect();
            self.columns = vec![Vec::new(); row.len()];
            return Ok(());
        }
        let fail = |problem: String| {
            let line = row.position().map(|position| position.line() as usize);
            let path = path.to_owned();
            Err(ReportError::Content {
                path,
                line,
                problem,
            })
        };
        let (found, expected) = (row.len(), self.names.len());
        if found != expected {
            return fail(format!(
                "has {found} values; its header names {expected} columns"
            ));
        }
        let cells = row.iter().map(str::trim);
        for ((cell, name), column) in cells.zip(&self.names).zip(&mut self.columns) {
            let value = if cell.is_empty() {
                Ok(f64::NAN)
            } else {
                cell.parse()
            };
            let Ok(value) = value else {
                return fail(format!(
                    "holds `{cell}` in column `{name}`, which is not a number"
                ));
            };
            column.push(value);
        }
        Ok(())
    }
}
