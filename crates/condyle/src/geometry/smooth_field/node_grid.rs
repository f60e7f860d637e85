//! The regular grid at whose nodes the gap to a mesh is known.

use serde::{Deserialize, Serialize};

use crate::Vec3;

/// Distance between grid nodes, mm: the spline's error on a ball of radius 20 mm is then below
/// 0.1 micrometre.
pub const SPACING_MM: f64 = 1.25;

/// Grid nodes this close to the surface get a true gap, mm: the deepest overclosure that a run
/// may reach, and the spline's footprint around it.
pub const BAND_MM: f64 = 3.5;

/// A regular grid of nodes around a surface, [`SPACING_MM`] apart.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NodeGrid {
    /// Position of node (0, 0, 0), mm.
    pub origin: Vec3,
    /// Nodes along x, y, z; x runs fastest.
    pub counts: [usize; 3],
}

impl NodeGrid {
    /// The grid around a surface from `low` to `high`: it reaches two nodes beyond the band.
    pub fn around((low, high): (Vec3, Vec3)) -> Self {
        let margin = Vec3::repeat(BAND_MM + 2.0 * SPACING_MM);
        let origin = low - margin;
        let size = high + margin - origin;
        let count = |axis: usize| ((size[axis] / SPACING_MM).ceil() as usize).saturating_add(1);
        Self {
            origin,
            counts: [0, 1, 2].map(count),
        }
    }

    /// How far apart the numbers of neighbours along x, y and z are.
    #[inline]
    pub fn strides(&self) -> [usize; 3] {
        [1, self.counts[0], self.counts[0] * self.counts[1]]
    }

    /// How many nodes there are; of more than a number can hold, that number.
    pub fn node_count(&self) -> usize {
        let counts = self.counts.iter();
        counts.fold(1, |product: usize, &count| product.saturating_mul(count))
    }

    /// Where node (i, j, k) is, mm.
    #[inline]
    pub fn position(&self, i: usize, j: usize, k: usize) -> Vec3 {
        self.origin + Vec3::new(i as f64, j as f64, k as f64) * SPACING_MM
    }

    /// Numbers and positions of the nodes that have neighbours on all sides.
    pub fn inner_nodes(&self) -> impl Iterator<Item = (usize, Vec3)> {
        let [nx, ny, nz] = self.counts;
        let [sx, sy, sz] = self.strides();
        let rows = (1..nz - 1).flat_map(move |k| (1..ny - 1).map(move |j| (j, k)));
        rows.flat_map(move |(j, k)| {
            (1..nx - 1).map(move |i| (i * sx + j * sy + k * sz, self.position(i, j, k)))
        })
    }

    /// First and one past the last node along each axis within the band of a triangle.
    pub fn band_around(&self, corners: [Vec3; 3]) -> [[usize; 3]; 2] {
        let [a, b, c] = corners.map(|corner| (corner - self.origin) / SPACING_MM);
        let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
        let band = BAND_MM / SPACING_MM;
        let first = |axis: usize| (low[axis] - band).ceil().max(0.0) as usize;
        let end = |axis: usize| ((high[axis] + band).floor() as usize + 1).min(self.counts[axis]);
        [[0, 1, 2].map(first), [0, 1, 2].map(end)]
    }

    /// How far from the frame's origin the grid reaches, mm.
    pub fn reach_mm(&self) -> f64 {
        let size = Vec3::from(self.counts.map(|count| count as f64)) * SPACING_MM;
        self.origin.abs().sup(&(self.origin + size).abs()).norm()
    }
}
