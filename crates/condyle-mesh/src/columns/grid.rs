//! Hexahedra in columns below a surface over a rectangular grid.

use condyle_fem::HexMesh;
use thiserror::Error;

use crate::Vec3;

/// Nodes have numbers of 32 bits, of which the last says that a column has none.
const MAX_NODES: u32 = u32::MAX - 1;

/// More nodes than can be numbered.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error(
    "the insert would have {nodes:.0} nodes, and more than {max} cannot be numbered; use a larger edge_mm or fewer layers"
)]
pub struct TooManyNodes {
    /// The number of nodes.
    pub nodes: f64,
    /// The largest number of nodes that can be numbered.
    pub max: u32,
}

/// How finely a body is meshed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meshing {
    /// Length of an edge along the surface, mm.
    pub edge_mm: f64,
    /// Hexahedra through the thickness.
    pub layers: usize,
}

impl Default for Meshing {
    fn default() -> Self {
        Self {
            edge_mm: 1.05,
            layers: 3,
        }
    }
}

/// A rectangular grid over the transverse plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColumnGrid {
    /// Place (x, z) of grid point (0, 0), mm.
    pub origin_mm: (f64, f64),
    /// Distance between grid points along x and z, mm.
    pub step_mm: (f64, f64),
    /// Cells along x and z.
    pub cells: (usize, usize),
}

/// What stands over a place: the heights of the backside and of the articulating surface, mm.
pub type Column = (f64, f64);

/// An insert seen from above: where its columns stand, and the quads between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Places (x, z) of the columns, mm.
    pub places_mm: Vec<(f64, f64)>,
    /// Columns at the corners of each quad, anticlockwise seen from above.
    pub quads: Vec<[u32; 4]>,
}

/// A column mesh with its two faces.
pub struct ColumnMesh {
    /// The hexahedra.
    pub mesh: HexMesh,
    /// The articulating surface, quads facing up.
    pub articulating: Vec<[u32; 4]>,
    /// The backside, quads facing down.
    pub backside: Vec<[u32; 4]>,
}

impl ColumnGrid {
    /// A grid of cells of about `edge_mm` that fills the rectangle from `low` to `high`, (x, z), for columns of
    /// `layers` hexahedra.
    ///
    /// # Errors
    /// [`TooManyNodes`] where these cannot be numbered.
    pub fn filling(
        low: (f64, f64),
        high: (f64, f64),
        edge_mm: f64,
        layers: usize,
    ) -> Result<Self, TooManyNodes> {
        let cells = |length: f64| (length / edge_mm).round().max(1.0);
        let (width, depth) = (high.0 - low.0, high.1 - low.1);
        let (nx, nz) = (cells(width), cells(depth));
        let nodes = (nx + 1.0) * (nz + 1.0) * (layers as f64 + 1.0);
        if nodes > f64::from(MAX_NODES) {
            let max = MAX_NODES;
            return Err(TooManyNodes { nodes, max });
        }
        Ok(Self {
            origin_mm: low,
            step_mm: (width / nx, depth / nz),
            cells: (nx as usize, nz as usize),
        })
    }

    /// Place (x, z) of grid point (i, k), mm.
    pub fn place_mm(&self, i: usize, k: usize) -> (f64, f64) {
        (
            self.origin_mm.0 + self.step_mm.0 * i as f64,
            self.origin_mm.1 + self.step_mm.1 * k as f64,
        )
    }

    /// Place (x, z) of the grid point with a number, mm.
    pub fn place_of_mm(&self, number: usize) -> (f64, f64) {
        let per_row = self.cells.1 + 1;
        self.place_mm(number / per_row, number % per_row)
    }

    /// Number of grid point (i, k); z runs fastest.
    pub fn number(&self, i: usize, k: usize) -> usize {
        i * (self.cells.1 + 1) + k
    }

    /// How many grid points there are.
    pub fn point_count(&self) -> usize {
        (self.cells.0 + 1) * (self.cells.1 + 1)
    }

    /// Grid points beside the one with a number, in its row and its column.
    pub fn around(&self, number: usize) -> impl Iterator<Item = usize> + use<> {
        let per_row = self.cells.1 + 1;
        let (i, k) = (number / per_row, number % per_row);
        let before = [
            (i > 0).then(|| number - per_row),
            (k > 0).then(|| number - 1),
        ];
        let after = [
            (i < self.cells.0).then_some(number + per_row),
            (k < self.cells.1).then_some(number + 1),
        ];
        before.into_iter().chain(after).flatten()
    }

    /// Grid points of cell (i, k), anticlockwise seen from above.
    pub fn corners(&self, i: usize, k: usize) -> [usize; 4] {
        [
            self.number(i, k),
            self.number(i, k + 1),
            self.number(i + 1, k + 1),
            self.number(i + 1, k),
        ]
    }

    /// The whole rectangle seen from above, its places in the order of [`ColumnGrid::number`].
    pub fn plan(&self) -> Plan {
        let (nx, nz) = self.cells;
        let places = (0..=nx).flat_map(|i| (0..=nz).map(move |k| self.place_mm(i, k)));
        let cells = (0..nx).flat_map(|i| (0..nz).map(move |k| self.corners(i, k)));
        Plan {
            places_mm: places.collect(),
            quads: cells.map(|cell| cell.map(|point| point as u32)).collect(),
        }
    }
}

impl Plan {
    /// Hexahedra in `layers` layers over every quad; `columns`: one a place.
    pub fn hexahedra(&self, columns: &[Column], layers: usize) -> ColumnMesh {
        let mut first_node = vec![u32::MAX; columns.len()];
        let mut nodes = Vec::new();
        for &column in self.quads.iter().flatten() {
            let column = column as usize;
            if first_node[column] == u32::MAX {
                first_node[column] = nodes.len() as u32;
                nodes.extend(stack(self.places_mm[column], columns[column], layers));
            }
        }
        let quad = |corners: &[u32; 4], layer: usize| {
            corners.map(|column| first_node[column as usize] + layer as u32)
        };
        let hex = |corners: &[u32; 4], layer: usize| {
            let ([a, b, c, d], [e, f, g, h]) = (quad(corners, layer), quad(corners, layer + 1));
            [a, b, c, d, e, f, g, h]
        };
        let quads = self.quads.iter();
        let hexes = quads.flat_map(|corners| (0..layers).map(move |layer| hex(corners, layer)));
        let hexes = hexes.collect();
        let quads = self.quads.iter();
        let backside = quads.clone().map(|corners| reversed(quad(corners, 0)));
        ColumnMesh {
            articulating: quads.map(|corners| quad(corners, layers)).collect(),
            backside: backside.collect(),
            mesh: HexMesh { hexes, nodes },
        }
    }
}

/// The nodes of one column, from the backside up.
fn stack((x, z): (f64, f64), (low, high): Column, layers: usize) -> impl Iterator<Item = Vec3> {
    (0..=layers)
        .map(move |layer| Vec3::new(x, low + (high - low) * layer as f64 / layers as f64, z))
}

fn reversed([a, b, c, d]: [u32; 4]) -> [u32; 4] {
    [d, c, b, a]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_block_of_columns() {
        let grid = ColumnGrid::filling((-2.0, 0.0), (2.0, 3.0), 0.9, 2).unwrap();
        assert_eq!(grid.cells, (4, 3));
        let block = grid
            .plan()
            .hexahedra(&vec![(-5.0, 1.0); grid.point_count()], 2);
        assert_eq!(block.mesh.hexes.len(), 4 * 3 * 2);
        assert!((block.mesh.volume() - 4.0 * 3.0 * 6.0).abs() < 1e-9);
        assert!((block.mesh.worst_quality() - 1.0).abs() < 1e-12);
        let up = |quad: &[u32; 4]| {
            let [a, b, c, _] = quad.map(|n| block.mesh.nodes[n as usize]);
            (b - a).cross(&(c - b)).y
        };
        assert!(block.articulating.iter().all(|quad| up(quad) > 0.0));
        assert!(block.backside.iter().all(|quad| up(quad) < 0.0));
    }

    #[test]
    fn places_that_no_quad_names_have_no_nodes() {
        let grid = ColumnGrid::filling((0.0, 0.0), (3.0, 1.0), 1.0, 1).unwrap();
        let mut plan = grid.plan();
        plan.quads.pop();
        let part = plan.hexahedra(&vec![(0.0, 1.0); grid.point_count()], 1);
        assert_eq!(part.mesh.hexes.len(), 2);
        assert_eq!(part.mesh.nodes.len(), 12);
    }
}
