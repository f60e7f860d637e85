//! The flat part of a backside, which rests on the tray.

use std::collections::BTreeMap;

use condyle_fem::HexMesh;

use crate::{Vec3, geometry::bounds};

/// Cosine of 15 degrees: a face of the backside that leans further from straight down is a wall.
const MIN_COSINE: f64 = 0.966;
/// Flat faces farther than this from the median height are recesses or pegs, mm.
const MAX_OFF_MM: f64 = 0.25;

pub(crate) struct Floor {
    /// Normal of the floor, into the insert.
    pub normal: Vec3,
    pub nodes: Vec<u32>,
    /// The share of the floor that belongs to each node, mm2.
    pub share_mm2: Vec<f64>,
    /// The part of the backside, projected onto the tray, that is floor.
    pub part: f64,
}

struct Face {
    quad: [u32; 4],
    inward: Vec3,
    middle: Vec3,
}

impl Floor {
    /// Finds the floor of a backside with the given nodes, ascending.
    pub fn from_backside(mesh: &HexMesh, backside: &[u32]) -> Self {
        let is_own = |node: &u32| backside.binary_search(node).is_ok();
        let mut quads = mesh.boundary_quads();
        quads.retain(|quad| quad.iter().all(is_own));
        let faces: Vec<Face> = quads.iter().map(|quad| Face::new(mesh, *quad)).collect();
        let is_level = |face: &&Face| face.inward.y > MIN_COSINE * face.inward.norm();
        let mut level: Vec<&Face> = faces.iter().filter(is_level).collect();
        let inward: Vec3 = level.iter().map(|face| face.inward).sum();
        let normal = inward.try_normalize(0.0).unwrap_or_else(Vec3::y);
        // The median height by area: half of the level faces lie below it.
        // Along the normal, so that a tilted floor is flat, too.
        let height_mm = |face: &Face| face.middle.dot(&normal);
        level.sort_by(|a, b| height_mm(a).total_cmp(&height_mm(b)));
        let half_mm2 = level.iter().map(|face| face.inward.norm()).sum::<f64>() / 2.0;
        let mut below_mm2 = 0.0;
        let middle = level.iter().find(|face| {
            below_mm2 += face.inward.norm();
            below_mm2 >= half_mm2
        });
        let middle_mm = middle.map_or(0.0, |face| height_mm(face));
        let is_flat = |face: &&&Face| (height_mm(face) - middle_mm).abs() <= MAX_OFF_MM;
        let flat: Vec<[u32; 4]> = level.iter().filter(is_flat).map(|face| face.quad).collect();
        // Ordered by node, so that the tray is the same on every run.
        let mut shares = BTreeMap::<u32, f64>::new();
        for (node, share) in mesh.traction_forces(&flat, |_, outward| -outward) {
            *shares.entry(node).or_default() += share.dot(&normal);
        }
        let whole_mm2: f64 = faces.iter().map(|face| face.inward.dot(&normal)).sum();
        let (nodes, share_mm2): (Vec<u32>, Vec<f64>) = shares.into_iter().unzip();
        Self {
            part: share_mm2.iter().sum::<f64>() / whole_mm2,
            nodes,
            share_mm2,
            normal,
        }
    }
}

impl Face {
    fn new(mesh: &HexMesh, quad: [u32; 4]) -> Self {
        let [a, b, c, d] = quad.map(|node| mesh.nodes[node as usize]);
        Self {
            quad,
            inward: -(c - a).cross(&(d - b)) / 2.0,
            middle: (a + b + c + d) / 4.0,
        }
    }
}

/// A point with less than this part of a cell around it lies outside: a corner of a rectangle has a quarter.
const MIN_PART: f64 = 0.2;

/// Nodes that follow the motion of a point, by their places in a list, each with its weight.
pub(crate) type Around = Vec<(usize, f64)>;

/// A grid of points, anterior fastest.
pub(crate) struct Grid {
    low: Vec3,
    step_mm: [f64; 2],
    /// Cells along x and z.
    cells: [usize; 2],
}

impl Grid {
    /// Creates a grid over some nodes with cells no wider than `spacing_mm`.
    pub fn over(mesh: &HexMesh, nodes: &[u32], spacing_mm: f64) -> Self {
        let places: Vec<Vec3> = mesh.positions(nodes).collect();
        let (low, high) = bounds(&places);
        let size_mm = [high.x - low.x, high.z - low.z];
        let cells = size_mm.map(|size_mm| (size_mm / spacing_mm).ceil().max(1.0));
        Self {
            low: Vec3::new(low.x, (low.y + high.y) / 2.0, low.z),
            step_mm: [size_mm[0] / cells[0], size_mm[1] / cells[1]],
            cells: cells.map(|cells| cells as usize),
        }
    }

    fn columns(&self) -> usize {
        self.cells[0] + 1
    }

    pub fn cell_mm2(&self) -> f64 {
        self.step_mm[0] * self.step_mm[1]
    }

    pub fn place(&self, at: usize) -> Vec3 {
        let [i, k] = [at % self.columns(), at / self.columns()].map(|i| i as f64);
        self.low + Vec3::new(i * self.step_mm[0], 0.0, k * self.step_mm[1])
    }

    /// Returns the corners of a cell, and the bilinear weights there of a place in it or next to it.
    fn weights(&self, [i, k]: [usize; 2], place: &Vec3) -> [(usize, f64); 4] {
        let first = i + self.columns() * k;
        let from = place - self.place(first);
        let [x, z] = [from.x / self.step_mm[0], from.z / self.step_mm[1]];
        let above = first + self.columns();
        [
            (first, (1.0 - x) * (1.0 - z)),
            (first + 1, x * (1.0 - z)),
            (above, (1.0 - x) * z),
            (above + 1, x * z),
        ]
    }

    /// Returns for every point the nodes in the cells around it.
    pub fn around(&self, mesh: &HexMesh, nodes: &[u32]) -> Vec<Around> {
        let mut around = vec![Around::new(); self.columns() * (self.cells[1] + 1)];
        for (at, place) in mesh.positions(nodes).enumerate() {
            let from = place - self.low;
            let [x, z] = [from.x / self.step_mm[0], from.z / self.step_mm[1]];
            let cell = [x, z].map(|along| along as usize);
            // Nodes on the far boundary belong to the last cell.
            let cell = [0, 1].map(|axis| cell[axis].min(self.cells[axis] - 1));
            let weights = self.weights(cell, &place).into_iter();
            for (point, weight) in weights.filter(|(_, weight)| *weight > 0.0) {
                around[point].push((at, weight));
            }
        }
        around
    }

    /// Removes the outside points; nodes near them follow the nearest cell with all corners inside. Keeps all points if there
    /// is none.
    pub fn led_from_within(&self, around: Vec<Around>, share_mm2: &[f64]) -> Vec<Around> {
        let is_within: Vec<bool> = around
            .iter()
            .map(|around| {
                let parts = around.iter().map(|&(at, weight)| share_mm2[at] * weight);
                parts.sum::<f64>() >= MIN_PART * self.cell_mm2()
            })
            .collect();
        let columns = self.columns();
        let cells = (0..self.cells[1]).flat_map(|k| (0..self.cells[0]).map(move |i| [i, k]));
        let is_whole = |[i, k]: &[usize; 2]| {
            let first = i + columns * k;
            let corners = [first, first + 1, first + columns, first + columns + 1];
            corners.iter().all(|corner| is_within[*corner])
        };
        let whole: Vec<[usize; 2]> = cells.filter(is_whole).collect();
        let mut sums = vec![BTreeMap::<usize, f64>::new(); around.len()];
        for (point, around) in around.into_iter().enumerate() {
            let along = match self.nearest(&whole, point) {
                Some(cell) if !is_within[point] => self.weights(cell, &self.place(point)).to_vec(),
                Some(_) | None => vec![(point, 1.0)],
            };
            for (at, weight) in around {
                for &(point, part) in &along {
                    *sums[point].entry(at).or_default() += part * weight;
                }
            }
        }
        let sums = sums.into_iter();
        sums.map(|sums| sums.into_iter().collect()).collect()
    }

    fn nearest(&self, cells: &[[usize; 2]], point: usize) -> Option<[usize; 2]> {
        let middle = Vec3::new(self.step_mm[0], 0.0, self.step_mm[1]) / 2.0;
        let place = self.place(point);
        let apart = |[i, k]: &[usize; 2]| {
            (self.place(i + self.columns() * k) + middle - place).norm_squared()
        };
        let nearest = cells.iter().min_by(|a, b| apart(a).total_cmp(&apart(b)));
        nearest.copied()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Meshing, flat_insert};

    #[test]
    fn a_recess_and_a_slope_are_no_floor() {
        let meshing = Meshing {
            edge_mm: 1.0,
            layers: 2,
        };
        let insert = flat_insert((20.0, 10.0), 5.0, meshing).unwrap();
        let (mut mesh, backside) = (insert.mesh().clone(), insert.backside_nodes());
        let whole = Floor::from_backside(&mesh, backside);
        assert!((whole.normal - Vec3::y()).norm() < 1e-12 && (whole.part - 1.0).abs() < 1e-12);
        for &node in backside {
            let place = &mut mesh.nodes[node as usize];
            if place.x > 5.5 {
                place.y += place.x - 5.5;
            } else if place.x < -4.5 {
                place.y += 0.5;
            }
        }
        let floor = Floor::from_backside(&mesh, backside);
        // From -4 mm, a step inside of the recess, to 5 mm.
        assert!((floor.share_mm2.iter().sum::<f64>() - 90.0).abs() < 1e-9);
        assert!((floor.part - 0.45).abs() < 0.01, "{}", floor.part);
    }

    #[test]
    fn a_linear_motion_of_the_points_is_one_of_the_nodes_though_a_corner_is_missing() {
        let meshing = Meshing {
            edge_mm: 1.0,
            layers: 1,
        };
        let insert = flat_insert((20.0, 14.0), 5.0, meshing).unwrap();
        let mesh = insert.mesh();
        // A triangle of the backside.
        let mut nodes = insert.backside_nodes().to_vec();
        nodes.retain(|&node| {
            let place = mesh.nodes[node as usize];
            place.x / 20.0 + place.z / 14.0 < 0.3
        });
        let grid = Grid::over(mesh, &nodes, 3.0);
        let even = vec![1.0; nodes.len()];
        let around = grid.led_from_within(grid.around(mesh, &nodes), &even);
        let left_out = around.iter().filter(|around| around.is_empty()).count();
        assert!(left_out > 8, "{left_out}");
        let linear = |place: &Vec3| 0.3 + 0.1 * place.x - 0.2 * place.z;
        let mut moved = vec![0.0; nodes.len()];
        for (point, around) in around.iter().enumerate() {
            for &(at, weight) in around {
                moved[at] += weight * linear(&grid.place(point));
            }
        }
        for (moved, place) in moved.iter().zip(mesh.positions(&nodes)) {
            assert!((moved - linear(&place)).abs() < 1e-12, "{moved} {place}");
        }
    }
}
