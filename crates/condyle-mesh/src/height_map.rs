//! Heights of a triangle mesh over a square grid.

use std::ops::Range;

use crate::{Vec3, triangle_mesh::TriangleMesh};

impl TriangleMesh {
    /// What is seen of the mesh from above: its highest point over every place of a square grid of `step_mm` that
    /// begins at its corner, mm.
    pub fn seen_from_above(&self, step_mm: f64) -> Vec<Vec3> {
        let mut heights = HeightMap::over(self.bounds(), step_mm);
        for triangle in 0..self.triangles.len() {
            heights.raise_to(&self.corners(triangle));
        }
        heights.points()
    }
}

/// Heights over a square grid, minus infinity where there is nothing.
struct HeightMap {
    low: Vec3,
    step_mm: f64,
    rows: usize,
    columns: usize,
    heights: Vec<f64>,
}

impl HeightMap {
    fn over((low, high): (Vec3, Vec3), step_mm: f64) -> Self {
        let count = |length: f64| (length.max(0.0) / step_mm).floor() as usize + 1;
        let (rows, columns) = (count(high.x - low.x), count(high.z - low.z));
        Self {
            low,
            step_mm,
            rows,
            columns,
            heights: vec![f64::NEG_INFINITY; rows * columns],
        }
    }

    /// Place (x, z) of a grid point, mm.
    fn place(&self, row: usize, column: usize) -> (f64, f64) {
        let along = |low: f64, number: usize| low + number as f64 * self.step_mm;
        (along(self.low.x, row), along(self.low.z, column))
    }

    /// Grid lines from `least` to `most`, of `count` lines that begin at `low`.
    fn lines(&self, (least, most): (f64, f64), low: f64, count: usize) -> Range<usize> {
        let number = |at: f64| (at - low) / self.step_mm;
        let first = number(least).ceil().max(0.0) as usize;
        let end = (number(most).floor() as usize + 1).min(count);
        first..end.max(first)
    }

    fn raise_to(&mut self, corners: &[Vec3; 3]) {
        let [a, b, c] = corners;
        let (least, most) = (a.inf(b).inf(c), a.sup(b).sup(c));
        for row in self.lines((least.x, most.x), self.low.x, self.rows) {
            for column in self.lines((least.z, most.z), self.low.z, self.columns) {
                if let Some(above) = height_over(corners, self.place(row, column)) {
                    let height = &mut self.heights[row * self.columns + column];
                    *height = height.max(above);
                }
            }
        }
    }

    fn points(&self) -> Vec<Vec3> {
        let seen = self
            .heights
            .iter()
            .enumerate()
            .filter(|(_, y)| y.is_finite());
        let point = |(at, y): (usize, &f64)| {
            let (x, z) = self.place(at / self.columns, at % self.columns);
            Vec3::new(x, *y, z)
        };
        seen.map(point).collect()
    }
}

/// Height of a flat triangle over a place (x, z), if it covers it.
pub fn height_over([a, b, c]: &[Vec3; 3], (x, z): (f64, f64)) -> Option<f64> {
    let twice_area = |p: &Vec3, q: &Vec3| (p.x - x) * (q.z - z) - (p.z - z) * (q.x - x);
    let weights = [twice_area(b, c), twice_area(c, a), twice_area(a, b)];
    let whole: f64 = weights.iter().sum();
    let covers = whole != 0.0 && weights.iter().all(|weight| weight * whole >= 0.0);
    covers.then(|| (weights[0] * a.y + weights[1] * b.y + weights[2] * c.y) / whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_is_seen_from_above_by_its_top() {
        let block = TriangleMesh::block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0));
        let seen = block.seen_from_above(1.0);
        assert_eq!(seen.len(), 21 * 31);
        assert!(seen.iter().all(|point| point.y == 8.0));
    }
}
