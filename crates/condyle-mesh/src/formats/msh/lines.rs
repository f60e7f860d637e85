//! Lines of a Gmsh mesh, with their numbers.

use std::path::Path;

use super::super::error::{FileLine, MeshFileError};
use super::super::text;

/// Lines that are not empty, with their numbers.
pub(super) struct Lines<'t> {
    pub path: &'t Path,
    lines: std::iter::Enumerate<std::str::Lines<'t>>,
}

impl<'t> Lines<'t> {
    pub(super) fn new(path: &'t Path, content: &'t str) -> Self {
        let lines = content.lines().enumerate();
        Self { path, lines }
    }

    pub(super) fn next(&mut self) -> Option<(usize, &'t str)> {
        let mut filled = self
            .lines
            .by_ref()
            .map(|(index, row)| (index + 1, row.trim()));
        filled.find(|(_, row)| !row.is_empty())
    }

    pub(super) fn expect_row(&mut self) -> Result<(usize, &'t str), MeshFileError> {
        let end =
            || FileLine::file(self.path).error("ends in the middle of a section; was it cut off?");
        self.next().ok_or_else(end)
    }

    pub(super) fn at(&self, line: usize) -> FileLine {
        FileLine::line(self.path, line)
    }

    /// The next row as whole numbers, at least `least` of them.
    pub(super) fn integers(&mut self, least: usize) -> Result<(usize, Vec<i64>), MeshFileError> {
        let (line, row) = self.expect_row()?;
        let words = row.split_ascii_whitespace();
        let numbers: Result<Vec<i64>, _> = words
            .map(|word| text::number(self.path, line, word))
            .collect();
        let numbers = numbers?;
        if numbers.len() < least {
            let what = format!("this row has {} numbers; it needs {least}", numbers.len());
            return Err(self.at(line).error(what));
        }
        Ok((line, numbers))
    }

    pub(super) fn skip_to_end_of(&mut self, section: &str) {
        let end = section.replacen('$', "$End", 1);
        while self.next().is_some_and(|(_, row)| row != end) {}
    }
}
