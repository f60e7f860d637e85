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
        let lines = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(text.trim_start_matches('\u{feff}').as_bytes());
        let mut table = Self::default();
        for row in lines.into_records().filter_map(Result::ok) {
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
            self.names = row.iter().map(str::to_owned).collect();
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
        for ((cell, name), column) in row.iter().zip(&self.names).zip(&mut self.columns) {
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
