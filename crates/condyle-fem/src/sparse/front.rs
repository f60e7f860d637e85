//! The part of the factor that one group of nodes owns.

use wide::f64x4;

use crate::sparse::tiles::{TILE, Triangle, whole_tiles};

/// Columns of the factor that a group eliminates, in rows of tiles as in a [`Triangle`].
///
/// The rows are the freedoms of the group's own nodes, filled up to whole tiles by freedoms that nothing
/// touches, and then those of its boundary, filled up too.
pub(crate) struct Front {
    /// Freedoms eliminated, a multiple of [`TILE`].
    pub(crate) columns: usize,
    /// Where every row of tiles begins, and where the last ends.
    starts: Vec<usize>,
    vectors: Vec<f64x4>,
}

impl Front {
    /// The first `columns` of an eliminated triangle.
    pub(crate) fn of(triangle: &Triangle, columns: usize, rows: usize) -> Self {
        let (mut starts, mut vectors) = (vec![0], Vec::with_capacity(columns * rows / TILE));
        for t in 0..rows / TILE {
            let row = triangle.row(t);
            vectors.extend_from_slice(&row[..row.len().min(columns)]);
            starts.push(vectors.len());
        }
        Self {
            columns,
            starts,
            vectors,
        }
    }

    /// Row `t` of tiles.
    #[inline]
    pub(crate) fn row(&self, t: usize) -> &[f64x4] {
        &self.vectors[self.starts[t]..self.starts[t + 1]]
    }

    /// Rows of tiles of all freedoms.
    pub(crate) fn rows(&self) -> usize {
        self.starts.len() - 1
    }

    /// How many numbers it holds.
    pub(crate) fn len(&self) -> usize {
        TILE * self.vectors.len()
    }
}

/// Which rows of a front the freedoms of its nodes have.
pub(crate) struct Layout {
    /// Rows of the own freedoms, whole tiles.
    pub(crate) columns: usize,
    /// All rows, whole tiles.
    pub(crate) rows: usize,
}

impl Layout {
    /// That of so many own nodes and nodes on the boundary.
    pub(crate) fn new(own: usize, boundary: usize) -> Self {
        let columns = whole_tiles(3 * own);
        Self {
            columns,
            rows: columns + whole_tiles(3 * boundary),
        }
    }
}
