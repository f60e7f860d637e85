//! A case: what is exact, and the rows that hold condyle against it.

use crate::Row;

/// A verification case, of a folder of its own.
#[derive(Clone, Copy)]
pub struct Case {
    /// Name of its folder.
    pub name: &'static str,
    /// Its README: a title, what is exact, and what else there is to say.
    pub readme: &'static str,
    /// Computes the rows.
    pub rows: fn() -> Vec<Row>,
}

impl Case {
    /// The title of its README.
    pub fn title(&self) -> &'static str {
        let first = self.readme.lines().next().unwrap_or_default();
        first.trim_start_matches("# ")
    }

    /// What the README says between its title and its first heading.
    pub fn introduction(&self) -> &'static str {
        let below = self.readme.split_once('\n').map_or("", |(_, below)| below);
        below.split("\n## ").next().unwrap_or_default().trim()
    }
}
