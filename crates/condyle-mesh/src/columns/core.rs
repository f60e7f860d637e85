//! The cells of a grid that lie well inside the outline.

use super::grid::ColumnGrid;
use super::{footprint::Footprint, outline::Place};

/// A cell lies well inside if its corners are this share of an edge away from the outline: as much
/// as the narrowest quad between them needs.
const MIN_RING: f64 = 0.5;

/// Cells of a grid that hang together by their sides, and the closed lines around them.
#[derive(Clone)]
pub struct Core {
    /// Grid points at the corners of each cell.
    pub cells: Vec<[usize; 4]>,
    /// Grid points along each line around the cells, anticlockwise seen from above; clockwise
    /// around a hole.
    pub loops: Vec<Vec<usize>>,
}

impl Core {
    /// The cells of a grid that lie well inside a footprint, each piece that hangs together by itself.
    pub fn pieces(grid: &ColumnGrid, footprint: &Footprint<'_>) -> Vec<Self> {
        let numbers = 0..grid.point_count();
        let is_deep: Vec<bool> = numbers
            .map(|number| is_well_inside(grid, footprint, number))
            .collect();
        let (nx, nz) = grid.cells;
        let corners = (0..nx).flat_map(|i| (0..nz).map(move |k| grid.corners(i, k)));
        let is_in = corners
            .map(|corners| corners.iter().all(|&corner| is_deep[corner]))
            .collect();
        let mut kept = Kept { grid, is_in };
        kept.part_pinched();
        let mut pieces = Vec::new();
        while let Some(cells) = kept.take_piece() {
            let loops = loops(grid.point_count(), &cells);
            pieces.push(Self { cells, loops });
        }
        pieces
    }
}

fn is_well_inside(grid: &ColumnGrid, footprint: &Footprint<'_>, number: usize) -> bool {
    let place = grid.place_of_mm(number);
    let ring = Place::new(grid.step_mm.0, grid.step_mm.1) * MIN_RING;
    let around = (0..8).map(|eighth| {
        let (sine, cosine) = (f64::from(eighth) * std::f64::consts::FRAC_PI_4).sin_cos();
        (place.0 + cosine * ring[0], place.1 + sine * ring[1])
    });
    footprint.holds_near(place) && { around }.all(|beside| footprint.holds_near(beside))
}

/// Which cells of a grid are kept.
struct Kept<'a> {
    grid: &'a ColumnGrid,
    is_in: Vec<bool>,
}

impl Kept<'_> {
    fn number(&self, i: usize, k: usize) -> usize {
        i * self.grid.cells.1 + k
    }

    /// Takes the first cell with all that hang together with it by their sides, in the grid's order.
    fn take_piece(&mut self) -> Option<Vec<[usize; 4]>> {
        let nz = self.grid.cells.1;
        let mut open = vec![self.is_in.iter().position(|is_in| *is_in)?];
        let mut piece = Vec::new();
        while let Some(cell) = open.pop() {
            if std::mem::replace(&mut self.is_in[cell], false) {
                piece.push(cell);
                let (i, k) = (cell / nz, cell % nz);
                let before = [(i > 0).then(|| cell - nz), (k > 0).then(|| cell - 1)];
                let after = [
                    (i + 1 < self.grid.cells.0).then_some(cell + nz),
                    (k + 1 < nz).then_some(cell + 1),
                ];
                let beside = before.into_iter().chain(after).flatten();
                open.extend(beside.filter(|&cell| self.is_in[cell]));
            }
        }
        piece.sort_unstable();
        let corners = |cell: &usize| self.grid.corners(cell / nz, cell % nz);
        Some(piece.iter().map(corners).collect())
    }

    /// Leaves out cells that meet another at a corner alone, until none does: around such a corner
    /// two lines would cross.
    fn part_pinched(&mut self) {
        let (nx, nz) = self.grid.cells;
        let mut is_done = false;
        while !is_done {
            is_done = true;
            for i in 0..nx.saturating_sub(1) {
                for k in 0..nz.saturating_sub(1) {
                    let around = [(i, k), (i, k + 1), (i + 1, k + 1), (i + 1, k)]
                        .map(|(i, k)| self.number(i, k));
                    let is_in = around.map(|cell| self.is_in[cell]);
                    if is_in[0] == is_in[2] && is_in[1] == is_in[3] && is_in[0] != is_in[1] {
                        self.is_in[around[usize::from(is_in[1])]] = false;
                        is_done = false;
                    }
                }
            }
        }
    }
}

/// The closed lines around some cells of a grid, each point once.
fn loops(point_count: usize, cells: &[[usize; 4]]) -> Vec<Vec<usize>> {
    let sides = |cell: &[usize; 4]| [0, 1, 2, 3].map(|n| (cell[n], cell[(n + 1) % 4]));
    let mut after: Vec<Vec<usize>> = vec![Vec::new(); point_count];
    for (from, to) in cells.iter().flat_map(sides) {
        after[from].push(to);
    }
    let is_outer = |from: usize, to: usize| !after[to].contains(&from);
    let mut next = vec![usize::MAX; point_count];
    for (from, to) in cells.iter().flat_map(sides) {
        if is_outer(from, to) {
            next[from] = to;
        }
    }
    let mut loops = Vec::new();
    for first in 0..point_count {
        let (mut line, mut at) = (Vec::new(), first);
        while next[at] != usize::MAX {
            line.push(at);
            at = std::mem::replace(&mut next[at], usize::MAX);
        }
        if !line.is_empty() {
            loops.push(line);
        }
    }
    loops
}
