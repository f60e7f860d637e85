//! A table of a run, from the text of its file: one source of names and numbers, whether it was written or not.

use pyo3::prelude::*;

use crate::arrays::array;

/// Columns of numbers under their names.
#[derive(Default)]
pub struct Table {
    columns: Vec<String>,
    /// Row after row.
    values: Vec<f64>,
}

impl Table {
    /// Reads what a run writes as CSV; none where a row does not fit the header, or a cell is no number.
    pub fn parse(csv: &str) -> Option<Self> {
        let mut lines = csv.lines();
        let header = lines.next()?;
        let columns: Vec<String> = header.split(',').map(str::to_owned).collect();
        let mut values = Vec::new();
        for line in lines {
            let before = values.len();
            for cell in line.split(',') {
                values.push(cell.parse().ok()?);
            }
            if values.len() - before != columns.len() {
                return None;
            }
        }
        Some(Self { columns, values })
    }

    /// Names of the columns, and an array of rows and columns.
    pub fn into_python(self, py: Python<'_>) -> PyResult<(Vec<String>, Bound<'_, PyAny>)> {
        let shape = [
            self.values.len() / self.columns.len().max(1),
            self.columns.len(),
        ];
        Ok((self.columns, array(py, self.values, shape)?))
    }
}
