//! Columns of the table as numbers.

use rusqlite::types::ValueRef;

use super::super::{error::StudyError, plan::Plan};
use super::database::{Store, name};

/// A column of the table, a value a test; of a test that failed or is not there, not a number.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in super::super) struct Column {
    /// Of words the place of each among `words`.
    pub values: Vec<f64>,
    /// In the order of the alphabet; none where all are numbers.
    pub words: Vec<String>,
}

impl Store {
    /// The column called `called` of every test that is done.
    pub(in super::super) fn column(&self, plan: &Plan, called: &str) -> Result<Column, StudyError> {
        let words = self.words(called)?;
        let query = format!(
            "SELECT \"row\", {} FROM tests WHERE status = 'done'",
            name(called)
        );
        self.checked(|connection| {
            let mut values = vec![f64::NAN; plan.tests() as usize];
            let mut statement = connection.prepare(&query)?;
            let mut rows = statement.query([])?;
            while let Some(row) = rows.next()? {
                let value = match row.get_ref(1)? {
                    ValueRef::Real(number) => number,
                    ValueRef::Integer(whole) => whole as f64,
                    ValueRef::Text(text) => {
                        let text = String::from_utf8_lossy(text);
                        words
                            .iter()
                            .position(|word| *word == text)
                            .map_or(f64::NAN, |place| place as f64)
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

    fn words(&self, called: &str) -> Result<Vec<String>, StudyError> {
        let column = name(called);
        let query = format!(
            "SELECT DISTINCT {column} FROM tests WHERE typeof({column}) = 'text' ORDER BY {column}"
        );
        self.checked(|connection| {
            let mut statement = connection.prepare(&query)?;
            let words = statement.query_map([], |row| row.get(0))?;
            words.collect()
        })
    }

    /// Tests that failed: how many by each reason, the most frequent first.
    pub(in super::super) fn reasons(&self) -> Result<Vec<(String, u64)>, StudyError> {
        let query = "SELECT coalesce(reason, ''), count(*) AS many FROM tests WHERE status = 'failed' \
                     GROUP BY reason ORDER BY many DESC, reason";
        self.checked(|connection| {
            let mut statement = connection.prepare(query)?;
            let reasons =
                statement.query_map([], |row| Ok((row.get(0)?, row.get::<_, i64>(1)? as u64)))?;
            reasons.collect()
        })
    }

    /// Tests that are kept.
    pub fn count(&self) -> Result<u64, StudyError> {
        self.checked(|connection| {
            let count = |row: &rusqlite::Row<'_>| row.get::<_, i64>(0);
            Ok(connection.query_row("SELECT count(*) FROM tests", [], count)? as u64)
        })
    }
}
