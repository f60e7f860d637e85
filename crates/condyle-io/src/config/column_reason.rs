//! What is wrong with the columns of a CSV file.

use thiserror::Error;

use super::reason::Reason;

/// Why columns of numbers cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum ColumnReason {
    /// A CSV file without a header.
    #[error("{file} has no header that names its columns")]
    NoHeader {
        /// The file.
        file: String,
        /// What the header could be.
        example: String,
    },
    /// A CSV file of one column.
    #[error("{file} has one column where two or more are needed")]
    OneColumn {
        /// The file.
        file: String,
        /// What the header could be.
        example: String,
    },
    /// A first column that is no place in the cycle.
    #[error("the first column must be the percent of the cycle, this one is `{column}`")]
    NoPercent {
        /// Name of the first column.
        column: String,
    },
    /// A header with another unit.
    #[error("column `{column}` is in another unit than {unit}, which is needed here")]
    OtherUnit {
        /// The column.
        column: String,
        /// The unit that is needed.
        unit: &'static str,
        /// How its name should end.
        suffix: &'static str,
    },
    /// A column that is not there.
    #[error("there is no column `{column}` in {file}")]
    NoColumn {
        /// As written.
        column: String,
        /// The file.
        file: String,
        /// Columns there are.
        columns: Vec<String>,
    },
    /// More than one column to choose from.
    #[error("{file} has several columns and the case does not say which to take")]
    WhichColumn {
        /// The file.
        file: String,
        /// Columns there are.
        columns: Vec<String>,
    },
    /// A row that is too short, or holds no number.
    #[error("`{text}` in column `{column}` is not a finite number")]
    NotNumber {
        /// As written; empty where the row is short.
        text: String,
        /// The column.
        column: String,
    },
}

impl Reason for ColumnReason {
    fn advice(&self) -> Option<String> {
        Some(match self {
            Self::NoHeader { example, .. } => format!(
                "write one above the numbers, with the unit in the name, such as `{example}`"
            ),
            Self::OneColumn { example, .. } => {
                format!("put commas between the columns, as in `{example}`")
            }
            Self::NoPercent { .. } => "name it `percent`, and let it run from 0 to 100".to_owned(),
            Self::OtherUnit { suffix, unit, .. } => {
                format!("let its name end in `{suffix}`, with values in {unit}")
            }
            Self::NoColumn { columns, .. } => format!("it has {}", columns.join(", ")),
            Self::WhichColumn { columns, .. } => {
                format!("add `column = `, one of {}", columns.join(", "))
            }
            Self::NotNumber { .. } => "write a number there, or remove the row".to_owned(),
        })
    }
}
