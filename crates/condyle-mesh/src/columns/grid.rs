//! Hexahedra in columns below a surface over a rectangular grid.

use condyle_fem::HexMesh;
use nalgebra::Vector2;
use thiserror::Error;

use crate::Vec3;

/// Largest number of nodes: they are numbered with 32 bits, and the last number marks a column without nodes.
const MAX_NODES: u32 = u32::MAX - 1;

/// A place (x, z) in the transverse plane, mm.
pub type Place = Vector2<f64>;

/// More nodes than can be numbered.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error(
    "the insert would have {nodes:.0} nodes, and more than {max} cannot be numbered; use a larger edge_mm or fewer layers"
)]
pub struct TooManyNodes {
    /// Number of nodes that the grid would have.
    pub nodes: f64,
    /// Largest number of nodes that can be numbered.
    pub max: u32,
}

impl TooManyNodes {
    /// Rejects columns of `layers` hexahedra whose nodes cannot be numbered.
    pub(super) fn check(columns: f64, layers: usize) -> Result<(), Self> {
        let (nodes, max) = (columns * (layers as f64 + 1.0), MAX_NODES);
        if nodes > f64::from(max) {
            return Err(Self { nodes, max });
        }
        Ok(())
    }
}

/// Fineness of the mesh of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Meshing {
    /// Length of an edge along the surface, mm.
    pub edge_mm: f64,
    /// Number of hexahedra through the thickness.
    pub layers: usize,
}

impl Default for Meshing {
    fn default() -> Self {
        Self {
            edge_mm: 1.05,
            layers: 4,
        }
    }
}

/// Largest ratio of the thicknesses of two layers: a thicker layer at the bottom would be too stiff.
const MAX_GROWTH: f64 = 2.0;

impl Meshing {
    /// Returns the depths of the boundaries of the layers as parts of the thickness, from the backside (1) to the articulating
    /// surface (0).
    ///
    /// Stress varies most within a contact's width below the surface. The top layer is therefore as thick as an edge is
    /// long, if the layers suffice, and each layer below is thicker by the same ratio. On the default knee, four such layers
    /// are as accurate as six of equal thickness.
    fn depths(&self, thickness_mm: f64) -> Vec<f64> {
        let (mut low, mut high) = (1.0, MAX_GROWTH);
        let mut middle = 0.5 * (low + high);
        // The bisection ends at the resolution of numbers.
        while low < middle && middle < high {
            match self.edge_mm * in_top_layers(middle, self.layers) < thickness_mm {
                true => low = middle,
                false => high = middle,
            }
            middle = 0.5 * (low + high);
        }
        let all = in_top_layers(low, self.layers);
        let bounds = (0..=self.layers).rev();
        bounds
            .map(|above| in_top_layers(low, above) / all)
            .collect()
    }
}

/// Returns the thickness of some layers together, in units of the topmost.
fn in_top_layers(growth: f64, layers: usize) -> f64 {
    (0..layers as i32).map(|layer| growth.powi(layer)).sum()
}

/// A rectangular grid over the transverse plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColumnGrid {
    /// Place of grid point (0, 0), mm.
    pub origin_mm: Place,
    /// Distance between grid points along x and z, mm.
    pub step_mm: Place,
    /// Cells along x and z.
    pub cells: (usize, usize),
}

/// Heights of the backside and of the articulating surface at a place, mm.
pub type Column = (f64, f64);

/// An insert seen from above: the places of its columns, and the quads between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Places of the columns, mm.
    pub places_mm: Vec<Place>,
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
    /// Error that the triangles leave in the smooth surface at each node of the articulating surface, in the order of the nodes,
    /// mm; empty for a shape without triangles.
    pub mesh_error_mm: Vec<f64>,
    /// Height of the voids below these nodes that the hexahedra fill, such as a slot for a lock, mm; empty for a shape without
    /// triangles.
    pub void_mm: Vec<f64>,
}

impl ColumnGrid {
    /// Creates a grid of cells of about `edge_mm` that fills the rectangle from `low` to `high`, (x, z), for columns
    /// of `layers` hexahedra.
    ///
    /// # Errors
    /// [`TooManyNodes`] if these cannot be numbered.
    pub fn filling(
        low: impl Into<[f64; 2]>,
        high: impl Into<[f64; 2]>,
        edge_mm: f64,
        layers: usize,
    ) -> Result<Self, TooManyNodes> {
        let (low, high) = (low.into(), high.into());
        let size = [high[0] - low[0], high[1] - low[1]];
        let [nx, nz] = size.map(|length| (length / edge_mm).round().max(1.0));
        TooManyNodes::check((nx + 1.0) * (nz + 1.0), layers)?;
        Ok(Self {
            origin_mm: low.into(),
            step_mm: Place::new(size[0] / nx, size[1] / nz),
            cells: (nx as usize, nz as usize),
        })
    }

    /// Returns the place of grid point (i, k), mm.
    pub fn place_mm(&self, i: usize, k: usize) -> Place {
        let steps = Place::new(i as f64, k as f64);
        self.origin_mm + self.step_mm.component_mul(&steps)
    }

    /// Returns the place of the grid point with a number, mm.
    pub fn place_of_mm(&self, number: usize) -> Place {
        let per_row = self.cells.1 + 1;
        self.place_mm(number / per_row, number % per_row)
    }

    /// Returns the number of grid point (i, k); z runs fastest.
    pub fn number(&self, i: usize, k: usize) -> usize {
        i * (self.cells.1 + 1) + k
    }

    /// Returns the count of grid points.
    pub fn point_count(&self) -> usize {
        (self.cells.0 + 1) * (self.cells.1 + 1)
    }

    pub(super) fn around(&self, number: usize) -> impl Iterator<Item = usize> + use<> {
        neighbours(number, self.cells.0 + 1, self.cells.1 + 1)
    }

    /// Returns grid points and those connected with them through neighbours that may join, in the order in which they are
    /// found.
    pub(super) fn connected(
        &self,
        from: Vec<usize>,
        may_join: impl Fn(usize) -> bool,
    ) -> Vec<usize> {
        let mut is_found = vec![false; self.point_count()];
        from.iter().for_each(|&point| is_found[point] = true);
        let mut found = from;
        let mut at = 0;
        while let Some(&point) = found.get(at) {
            at += 1;
            for other in self.around(point).filter(|&other| may_join(other)) {
                if !std::mem::replace(&mut is_found[other], true) {
                    found.push(other);
                }
            }
        }
        found
    }

    /// Returns the grid points of cell (i, k), anticlockwise seen from above.
    pub(super) fn corners(&self, i: usize, k: usize) -> [usize; 4] {
        [(i, k), (i, k + 1), (i + 1, k + 1), (i + 1, k)].map(|(i, k)| self.number(i, k))
    }

    /// Returns the cells as (i, k), in the order of their numbers.
    pub(super) fn all_cells(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (nx, nz) = self.cells;
        (0..nx).flat_map(move |i| (0..nz).map(move |k| (i, k)))
    }

    /// Returns the column of every grid point, in the order of their numbers, from its place x and z, mm.
    pub fn columns(&self, column: impl Fn(f64, f64) -> (f64, f64)) -> Vec<(f64, f64)> {
        let places = (0..self.point_count()).map(|number| self.place_of_mm(number));
        places.map(|place| column(place.x, place.y)).collect()
    }

    /// Returns the whole rectangle seen from above, its places in the order of [`ColumnGrid::number`].
    pub fn plan(&self) -> Plan {
        let places = (0..self.point_count()).map(|number| self.place_of_mm(number));
        let corners = self.all_cells().map(|(i, k)| self.corners(i, k));
        Plan {
            places_mm: places.collect(),
            quads: corners.map(|cell| cell.map(|point| point as u32)).collect(),
        }
    }
}

/// Returns the neighbours along both axes of an item of a grid of `rows` by `columns`.
pub(super) fn neighbours(
    number: usize,
    rows: usize,
    columns: usize,
) -> impl Iterator<Item = usize> + use<> {
    let (i, k) = (number / columns, number % columns);
    let before = [
        (i > 0).then(|| number - columns),
        (k > 0).then(|| number - 1),
    ];
    let after = [
        (i + 1 < rows).then_some(number + columns),
        (k + 1 < columns).then_some(number + 1),
    ];
    before.into_iter().chain(after).flatten()
}

impl Plan {
    /// Returns the area of all quads, mm2.
    pub fn area_mm2(&self) -> f64 {
        let area = |quad: &[u32; 4]| {
            let [a, b, c, d] = quad.map(|place| self.places_mm[place as usize]);
            ((c - a).perp(&(d - b)) / 2.0).abs()
        };
        self.quads.iter().map(area).sum()
    }

    /// Fills the space over every quad with hexahedra in layers that grow with the depth; `columns`: one per place.
    pub fn hexahedra(&self, columns: &[Column], meshing: Meshing) -> ColumnMesh {
        let thickness_mm = columns.iter().map(|(low, high)| high - low).sum::<f64>();
        let parts = meshing.depths(thickness_mm / columns.len() as f64);
        let layers = meshing.layers;
        let mut first_node = vec![u32::MAX; columns.len()];
        let mut nodes = Vec::new();
        for &column in self.quads.iter().flatten() {
            let column = column as usize;
            if first_node[column] == u32::MAX {
                first_node[column] = nodes.len() as u32;
                let (place, (low, high)) = (self.places_mm[column], columns[column]);
                nodes.extend(parts.iter().map(|part| {
                    let height = high - (high - low) * part;
                    Vec3::new(place[0], height, place[1])
                }));
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
        let hexes = quads.clone();
        let hexes = hexes.flat_map(|corners| (0..layers).map(move |layer| hex(corners, layer)));
        let hexes = hexes.collect();
        let backside = quads.clone().map(|corners| {
            let [a, b, c, d] = quad(corners, 0);
            [d, c, b, a]
        });
        ColumnMesh {
            articulating: quads.map(|corners| quad(corners, layers)).collect(),
            backside: backside.collect(),
            mesh_error_mm: Vec::new(),
            void_mm: Vec::new(),
            mesh: HexMesh { hexes, nodes },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_block_of_columns() {
        let grid = ColumnGrid::filling((-2.0, 0.0), (2.0, 3.0), 0.9, 2).unwrap();
        assert_eq!(grid.cells, (4, 3));
        let block = grid.plan().hexahedra(
            &vec![(-5.0, 1.0); grid.point_count()],
            Meshing {
                edge_mm: 0.9,
                layers: 2,
            },
        );
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
    fn the_top_layer_is_as_thick_as_an_edge_is_long_and_the_others_grow() {
        let parts = |edge_mm, layers, thickness_mm| {
            let depths = Meshing { edge_mm, layers }.depths(thickness_mm);
            let pairs = depths.windows(2).rev();
            pairs.map(|pair| pair[0] - pair[1]).collect::<Vec<f64>>()
        };
        let near = |found: &[f64], exact: &[f64]| {
            let pairs = found.iter().zip(exact);
            found.len() == exact.len() && pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12)
        };
        // 1 + 1.5 + 2.25 + 3.375 = 8.125.
        let four = [1.0, 1.5, 2.25, 3.375].map(|layer| layer / 8.125);
        assert!(near(&parts(1.0, 4, 8.125), &four));
        assert!(near(&parts(3.0, 4, 8.0), &[0.25; 4]));
        assert!(near(
            &parts(0.1, 3, 8.0),
            &[1.0, 2.0, 4.0].map(|layer| layer / 7.0)
        ));
    }

    #[test]
    fn places_that_no_quad_names_have_no_nodes() {
        let grid = ColumnGrid::filling((0.0, 0.0), (3.0, 1.0), 1.0, 1).unwrap();
        let mut plan = grid.plan();
        plan.quads.pop();
        let part = plan.hexahedra(
            &vec![(0.0, 1.0); grid.point_count()],
            Meshing {
                edge_mm: 1.0,
                layers: 1,
            },
        );
        assert_eq!(part.mesh.hexes.len(), 2);
        assert_eq!(part.mesh.nodes.len(), 12);
    }
}
