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

    /// The column called `name`.
    pub fn column(&self, name: &str) -> Option<&[f64]> {
        let index = self.names.iter().position(|known| known == name)?;
        Some(&self.columns[index])
    }

    /// Names of the columns.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, Vec::len)
    }

    fn push(&mut self, row: &csv::StringRecord, path: &Path) -> Result<(), ReportError> {
        if self.names.is_empty() {
            self.names = row.iter().map(str::to_owned).collect();
            self.columns = vec![Vec::new(); row.len()];
            return Ok(());
        }
        let line = row
            .position()
            .map_or(0, |position| position.line() as usize);
        self.check_length(row.len(), line, path)?;
        for (index, cell) in row.iter().enumerate() {
            let value = number(cell).ok_or_else(|| ReportError::NotANumber {
                path: path.to_owned(),
                line,
                column: self.names[index].clone(),
                text: cell.to_owned(),
            })?;
            self.columns[index].push(value);
        }
        Ok(())
    }

    fn check_length(&self, found: usize, line: usize, path: &Path) -> Result<(), ReportError> {
        let expected = self.names.len();
        if found == expected {
            return Ok(());
        }
        Err(ReportError::RaggedRow {
            path: path.to_owned(),
            line,
            found,
            expected,
        })
    }
}

fn number(cell: &str) -> Option<f64> {
    if cell.is_empty() {
        return Some(f64::NAN);
    }
    cell.parse().ok()
}
