//! The part of a body that another one can touch.

use crate::{Vec3, triangle_mesh::TriangleMesh};

/// The part of a body that can touch another one, by a simple rule that includes doubtful places.
///
/// A place belongs to it if it lies at most 1 mm below the first surface on the line of sight to it
/// along one of the directions of view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Touching {
    /// All of it.
    #[default]
    Everywhere,
    /// The part seen from above (+y): the articulating side of an insert.
    FromAbove,
    /// The part seen from 45 degrees in front of straight below, through straight behind (-x), to
    /// 30 degrees above that, every 15 degrees: the part that a femur can turn to the insert between
    /// hyperextension and deep flexion.
    FromBelowAndBehind,
}

impl Touching {
    fn directions(self) -> Vec<Vec3> {
        match self {
            Self::Everywhere => Vec::new(),
            Self::FromAbove => vec![Vec3::y()],
            Self::FromBelowAndBehind => {
                let behind_straight_down = |steps: i32| {
                    let (sine, cosine) = (f64::from(steps) * 15.0).to_radians().sin_cos();
                    Vec3::new(-sine, -cosine, 0.0)
                };
                (-3..=8).map(behind_straight_down).collect()
            }
        }
    }
}

/// Distance between lines of sight, mm: a tenth of the smallest contact.
const CELL_MM: f64 = 0.5;
/// Depth below the first surface that still counts as seen, mm: the slope of a dish within a cell.
const DEPTH_MM: f64 = 1.0;
/// Maximum number of lines of sight along one side of a view.
const MAX_CELLS: f64 = 400.0;
/// Maximum number of lines through triangles' boxes for each line or triangle of a view: the surface of a body
/// covers its view a few times.
const MAX_LAYERS: usize = 32;

pub(super) struct TouchMap {
    touching: Touching,
    /// The views; none if the mesh covers itself too often to be examined.
    views: Option<Vec<View>>,
}

impl TouchMap {
    pub(super) fn new(mesh: &TriangleMesh, touching: Touching) -> Self {
        let directions = touching.directions();
        let views = directions.iter().map(|&to_eye| View::new(mesh, to_eye));
        Self {
            touching,
            views: views.collect(),
        }
    }

    pub(super) fn contains(&self, at_mm: &Vec3) -> bool {
        // Without views, every defect matters: the rule includes doubtful places.
        let Some(views) = &self.views else {
            return true;
        };
        self.touching == Touching::Everywhere || views.iter().any(|view| view.shows(at_mm))
    }
}

struct View {
    /// Two directions across the view, and the one to the eye.
    axes: [Vec3; 3],
    origin_mm: [f64; 2],
    cell_mm: f64,
    cells: [usize; 2],
    /// Along the direction to the eye, mm; minus infinity where a line meets nothing.
    reach_mm: Vec<f64>,
}

impl View {
    fn new(mesh: &TriangleMesh, to_eye: Vec3) -> Option<Self> {
        let axes = [Vec3::z().cross(&to_eye), Vec3::z(), to_eye];
        let seen = |axis: usize| mesh.vertices.iter().map(move |at| at.dot(&axes[axis]));
        let low = [0, 1].map(|axis| seen(axis).fold(f64::INFINITY, f64::min));
        let high = [0, 1].map(|axis| seen(axis).fold(f64::NEG_INFINITY, f64::max));
        let size_mm = [0, 1].map(|axis| (high[axis] - low[axis]).max(0.0));
        let cell_mm = CELL_MM.max(size_mm[0].max(size_mm[1]) / MAX_CELLS);
        let cells = size_mm.map(|size| (size / cell_mm) as usize + 1);
        let mut view = Self {
            axes,
            origin_mm: low,
            cell_mm,
            cells,
            reach_mm: vec![f64::NEG_INFINITY; cells[0] * cells[1]],
        };
        let mut left = MAX_LAYERS * (view.reach_mm.len() + mesh.triangles.len());
        for triangle in 0..mesh.triangles.len() {
            left = view.draw(&mesh.corners(triangle), left)?;
        }
        Some(view)
    }

    /// Raises the reach over a triangle; returns the number of lines that may still be tried.
    fn draw(&mut self, corners: &[Vec3; 3], left: usize) -> Option<usize> {
        let [a, b, c] = corners.map(|corner| self.axes.map(|axis| axis.dot(&corner)));
        let range = |axis: usize| {
            let (low, high) = (
                a[axis].min(b[axis]).min(c[axis]),
                a[axis].max(b[axis]).max(c[axis]),
            );
            // Less a half: the lines run through the middles of the cells.
            let place = |at: f64| (at - self.origin_mm[axis]) / self.cell_mm - 0.5;
            let first = place(low).ceil().max(0.0) as usize;
            first..((place(high).floor() + 1.0) as usize).min(self.cells[axis])
        };
        let (along, across) = (range(0), range(1));
        let left = left.checked_sub(along.len() * across.len())?;
        let cross = |p: [f64; 2], q: [f64; 3], r: [f64; 3]| {
            (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        };
        let all = cross([a[0], a[1]], b, c);
        for i in along {
            for k in across.clone() {
                let at = [self.middle(0, i), self.middle(1, k)];
                let parts = [cross(at, b, c), cross(at, c, a), cross(at, a, b)];
                let weights = parts.map(|part| part / all);
                // With a small tolerance, so that no line passes between two triangles.
                if weights.iter().all(|&weight| weight >= -1e-9) {
                    let reach = weights[0] * a[2] + weights[1] * b[2] + weights[2] * c[2];
                    let cell = &mut self.reach_mm[i * self.cells[1] + k];
                    *cell = cell.max(reach);
                }
            }
        }
        Some(left)
    }

    fn middle(&self, axis: usize, cell: usize) -> f64 {
        self.origin_mm[axis] + (cell as f64 + 0.5) * self.cell_mm
    }

    /// Returns whether a place is visible. The lowest reach of the lines around it counts, so that a slope hides nothing.
    fn shows(&self, at_mm: &Vec3) -> bool {
        let around = |axis: usize| {
            let place = (at_mm.dot(&self.axes[axis]) - self.origin_mm[axis]) / self.cell_mm;
            let cell = (place.max(0.0) as usize).min(self.cells[axis] - 1);
            cell.saturating_sub(1)..(cell + 2).min(self.cells[axis])
        };
        let lines = around(0).flat_map(|i| around(1).map(move |k| i * self.cells[1] + k));
        let reaches = lines.map(|line| self.reach_mm[line]);
        let lowest = reaches
            .filter(|reach| reach.is_finite())
            .fold(f64::INFINITY, f64::min);
        lowest == f64::INFINITY || at_mm.dot(&self.axes[2]) >= lowest - DEPTH_MM
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn body() -> TriangleMesh {
        TriangleMesh::block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0))
    }

    #[test]
    fn an_insert_is_touched_on_its_upper_side_only() {
        let map = TouchMap::new(&body(), Touching::FromAbove);
        assert!(map.contains(&Vec3::new(0.0, 8.0, 0.0)));
        assert!(map.contains(&Vec3::new(10.0, 7.5, 15.0)));
        assert!(!map.contains(&Vec3::new(0.0, 0.0, 0.0)));
        assert!(!map.contains(&Vec3::new(10.0, 4.0, 3.0)));
    }

    #[test]
    fn a_femur_is_touched_below_and_behind() {
        let map = TouchMap::new(&body(), Touching::FromBelowAndBehind);
        assert!(map.contains(&Vec3::new(0.0, 0.0, 0.0)));
        assert!(map.contains(&Vec3::new(-10.0, 4.0, 0.0)));
        assert!(!map.contains(&Vec3::new(2.0, 4.0, 0.0)));
    }

    #[test]
    fn a_mesh_that_covers_itself_a_thousand_times_is_touched_anywhere() {
        let mut mesh = body();
        let once = mesh.triangles.clone();
        for _ in 0..1000 {
            mesh.triangles.extend(once.iter().copied());
        }
        let map = TouchMap::new(&mesh, Touching::FromAbove);
        assert!(map.contains(&Vec3::zeros()));
    }
}
