//! Rows and numbers of text files, and the places that errors name.

use std::{borrow::Cow, fmt::Display, iter::Enumerate, path::Path, str::FromStr, str::Lines};

use super::error::MeshFileError;
use crate::Vec3;

pub(crate) fn decode(bytes: &[u8]) -> Cow<'_, str> {
    // Bytes that are not UTF-8 can only be in names and comments.
    String::from_utf8_lossy(bytes)
}

/// A place in a file that errors name: a line where the format is text, else the file alone.
#[derive(Clone, Copy)]
pub(crate) struct At<'p> {
    pub(crate) path: &'p Path,
    pub(crate) line: Option<usize>,
}

impl<'p> At<'p> {
    pub(crate) fn file(path: &'p Path) -> Self {
        Self { path, line: None }
    }

    pub(crate) fn line(path: &'p Path, line: usize) -> Self {
        let line = Some(line);
        Self { path, line }
    }

    pub(crate) fn error(self, problem: impl Into<String>) -> MeshFileError {
        MeshFileError::Content {
            path: self.path.to_path_buf(),
            line: self.line,
            problem: problem.into(),
        }
    }

    pub(crate) fn number<T: FromStr>(self, word: &str) -> Result<T, MeshFileError> {
        let word = word.trim();
        let number = word.parse();
        number.map_err(|_| self.error(format!("{word:?} is not a number here")))
    }

    pub(crate) fn numbers<'w, T: FromStr>(
        self,
        words: impl IntoIterator<Item = &'w str>,
    ) -> Result<Vec<T>, MeshFileError> {
        let words = words.into_iter();
        words.map(|word| self.number(word)).collect()
    }

    /// Parses the next three words.
    pub(crate) fn coordinates<'w>(
        self,
        mut words: impl Iterator<Item = &'w str>,
    ) -> Result<[f64; 3], MeshFileError> {
        let mut point = [0.0; 3];
        for coordinate in &mut point {
            let word = words.next();
            let word = word.ok_or_else(|| self.error("a point needs three coordinates"))?;
            *coordinate = self.number(word)?;
        }
        Ok(point)
    }

    /// Returns the position of a vertex or node if it is finite.
    pub(crate) fn position(
        self,
        vertex: impl Display,
        point: [f64; 3],
    ) -> Result<Vec3, MeshFileError> {
        if point.iter().all(|coordinate| coordinate.is_finite()) {
            return Ok(Vec3::from(point));
        }
        let problem =
            format!("{vertex} has a coordinate that is not a finite number; repair the mesh");
        Err(self.error(problem))
    }

    /// Returns the `N` corners of an element or cell as labels of nodes.
    pub(crate) fn corners<const N: usize>(
        self,
        element: impl Display,
        nodes: &[i64],
    ) -> Result<[u64; N], MeshFileError> {
        let corners = <[i64; N]>::try_from(nodes).map_err(|_| {
            let count = nodes.len();
            self.error(format!("{element} has {count} corners; its type has {N}"))
        })?;
        Ok(corners.map(i64::cast_unsigned))
    }

    /// Error of a polygon or element that names a vertex that the file does not have.
    ///
    /// `numbering` names those that it has: "from 0 to 11".
    pub(crate) fn no_such_vertex(
        self,
        element: impl Display,
        vertex: i64,
        numbering: impl Display,
    ) -> MeshFileError {
        self.error(format!(
            "{element} names vertex {vertex}, but the file numbers its vertices {numbering}"
        ))
    }
}

/// The rows of a text file that are not blank, trimmed, each with its place.
pub(crate) struct Rows<'t> {
    path: &'t Path,
    lines: Enumerate<Lines<'t>>,
}

impl<'t> Rows<'t> {
    pub(crate) fn new(path: &'t Path, content: &'t str) -> Self {
        let lines = content.lines().enumerate();
        Self { path, lines }
    }

    /// Returns the next row; its absence is an error.
    pub(crate) fn required(&mut self) -> Result<(At<'t>, &'t str), MeshFileError> {
        let path = self.path;
        self.next()
            .ok_or_else(|| At::file(path).error("ends in the middle of a section; was it cut off?"))
    }
}

impl<'t> Iterator for Rows<'t> {
    type Item = (At<'t>, &'t str);

    fn next(&mut self) -> Option<Self::Item> {
        let path = self.path;
        let rows = self.lines.by_ref();
        rows.map(|(index, row)| (At::line(path, index + 1), row.trim()))
            .find(|(_, row)| !row.is_empty())
    }
}
