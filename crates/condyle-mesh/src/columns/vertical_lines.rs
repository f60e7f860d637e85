//! Where vertical lines go through a shell.

use std::ops::RangeInclusive;

use crate::{
    Vec3,
    curved_mesh::{CurvedMesh, Over},
    triangle_mesh::TriangleMesh,
};

/// Edge of the bins that sort the triangles over the transverse plane, mm.
const BIN_MM: f64 = 1.0;
/// A line that slips between two triangles is tried this far beside, mm: much more than numbers
/// are rounded by, and much less than a node's place needs to be known.
const BESIDE_MM: f64 = 1e-4;

/// The vertical lines through a shell, whose triangles are sorted into square bins.
pub struct VerticalLines<'a> {
    curved: CurvedMesh<'a>,
    corner_normals: Vec<[Vec3; 3]>,
    is_closed: bool,
    low: (f64, f64),
    counts: (usize, usize),
    bins: Vec<Vec<u32>>,
}

/// Where a vertical line goes through a shell first and last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Through {
    /// Lowest crossing, mm.
    pub bottom: f64,
    /// Highest crossing, mm.
    pub top: f64,
    /// Cosine of the slope at the highest.
    pub upward: f64,
}

impl<'a> VerticalLines<'a> {
    /// Those through `shell`; a line through a closed one goes in and out.
    pub fn new(shell: &'a TriangleMesh, is_closed: bool) -> Self {
        let (low, high) = shell.bounds();
        let count = |length: f64| (length / BIN_MM) as usize + 1;
        let counts = (count(high.x - low.x), count(high.z - low.z));
        let curved = CurvedMesh::new(shell);
        let mut lines = Self {
            corner_normals: curved.corner_normals(),
            curved,
            is_closed,
            low: (low.x, low.z),
            counts,
            bins: vec![Vec::new(); counts.0 * counts.1],
        };
        for triangle in 0..shell.triangles.len() {
            let [a, b, c] = shell.corners(triangle);
            let (low, high) = (a.inf(&b).inf(&c), a.sup(&b).sup(&c));
            let (along_x, along_z) = lines.bins_between((low.x, low.z), (high.x, high.z));
            for i in along_x {
                for k in along_z.clone() {
                    lines.bins[i * counts.1 + k].push(triangle as u32);
                }
            }
        }
        lines
    }

    /// Where the line over a place (x, z) goes through the shell, if it does.
    pub fn at(&self, (x, z): (f64, f64)) -> Option<Through> {
        let beside = [
            (x, z),
            (x - BESIDE_MM, z),
            (x + BESIDE_MM, z),
            (x, z - BESIDE_MM),
            (x, z + BESIDE_MM),
        ];
        beside.into_iter().find_map(|place| self.exactly_at(place))
    }

    /// The same without a try beside it.
    pub fn exactly_at(&self, place: (f64, f64)) -> Option<Through> {
        let (i, k) = self.bin_of(place);
        let bin = &self.bins[i * self.counts.1 + k];
        let over = |&triangle: &u32| {
            let triangle = triangle as usize;
            self.curved
                .over(triangle, &self.corner_normals[triangle], place)
        };
        let crossings = bin.iter().filter_map(over);
        let through = crossings.fold(None, |through: Option<Through>, over| {
            Some(through.map_or_else(|| Through::once(over), |all| all.and(over)))
        });
        through.filter(|all| !self.is_closed || all.top > all.bottom)
    }

    /// Numbers along x and z of the bins that cover a rectangle.
    fn bins_between(
        &self,
        low: (f64, f64),
        high: (f64, f64),
    ) -> (RangeInclusive<usize>, RangeInclusive<usize>) {
        let beyond = BESIDE_MM;
        let first = self.bin_of((low.0 - beyond, low.1 - beyond));
        let last = self.bin_of((high.0 + beyond, high.1 + beyond));
        (first.0..=last.0, first.1..=last.1)
    }

    fn bin_of(&self, (x, z): (f64, f64)) -> (usize, usize) {
        let number = |value: f64, low: f64, count: usize| {
            (((value - low) / BIN_MM).floor().max(0.0) as usize).min(count - 1)
        };
        (
            number(x, self.low.0, self.counts.0),
            number(z, self.low.1, self.counts.1),
        )
    }
}

impl Through {
    fn once(over: Over) -> Self {
        Self {
            bottom: over.height,
            top: over.height,
            upward: over.upward,
        }
    }

    fn and(self, over: Over) -> Self {
        let is_higher = over.height > self.top;
        Self {
            bottom: self.bottom.min(over.height),
            top: self.top.max(over.height),
            upward: if is_higher { over.upward } else { self.upward },
        }
    }
}
