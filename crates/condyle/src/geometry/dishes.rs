//! Where the two dishes of an insert are lowest: what the places of a machine are measured from.

use std::ops::Range;

use super::bounds::bounds;
use super::triangle_mesh::TriangleMesh;
use crate::Vec3;

/// The lowest places of an insert's two dishes, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dishes {
    /// Of the dish at lower z: the medial one of a right knee.
    pub medial_mm: Vec3,
    /// Of the other one.
    pub lateral_mm: Vec3,
}

/// Dishes are looked for in this part of the length, where no rim falls off ...
const ALONG: (f64, f64) = (0.15, 0.85);
/// ... and of the width, beside the rim and the eminence or the hole of a post; mirrored for the other side.
const ACROSS: (f64, f64) = (0.1, 0.425);
/// Places so little above the lowest one are low too, mm: their middle does not jump with the mesh, as the place of
/// the lowest one does.
const LOW_MM: f64 = 0.3;

impl Dishes {
    /// The dishes of an articulating surface, from `points` that lie about evenly on it; none where a side has none.
    ///
    /// The lowest place of a side is the middle of its points less than 0.3 mm above the lowest one, rim and eminence
    /// left out.
    pub fn of(points: &[Vec3]) -> Option<Self> {
        let (low, high) = bounds(points);
        let size = high - low;
        let inside = |part: f64, (from, to): (f64, f64)| (from..=to).contains(&part);
        let in_dish = |point: &Vec3, from_side_mm: f64| {
            inside((point.x - low.x) / size.x, ALONG) && inside(from_side_mm / size.z, ACROSS)
        };
        let medial = points
            .iter()
            .filter(|point| in_dish(point, point.z - low.z));
        let lateral = points
            .iter()
            .filter(|point| in_dish(point, high.z - point.z));
        Some(Self {
            medial_mm: lowest(&medial.collect::<Vec<_>>())?,
            lateral_mm: lowest(&lateral.collect::<Vec<_>>())?,
        })
    }

    /// Half-way between the dishes, at the height of the lower one, mm.
    pub fn middle_mm(&self) -> Vec3 {
        let between = (self.medial_mm + self.lateral_mm) / 2.0;
        Vec3::new(
            between.x,
            self.medial_mm.y.min(self.lateral_mm.y),
            between.z,
        )
    }
}

fn lowest(points: &[&Vec3]) -> Option<Vec3> {
    let heights = points.iter().map(|point| point.y);
    let lowest = heights.fold(f64::INFINITY, f64::min);
    let low = points.iter().filter(|point| point.y < lowest + LOW_MM);
    let (count, sum) = low.fold((0.0, Vec3::zeros()), |(count, sum), point| {
        (count + 1.0, sum + **point)
    });
    (count > 0.0).then(|| Vec3::new(sum.x / count, lowest, sum.z / count))
}

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
pub(super) fn height_over([a, b, c]: &[Vec3; 3], (x, z): (f64, f64)) -> Option<f64> {
    let twice_area = |p: &Vec3, q: &Vec3| (p.x - x) * (q.z - z) - (p.z - z) * (q.x - x);
    let weights = [twice_area(b, c), twice_area(c, a), twice_area(a, b)];
    let whole: f64 = weights.iter().sum();
    let covers = whole != 0.0 && weights.iter().all(|weight| weight * whole >= 0.0);
    covers.then(|| (weights[0] * a.y + weights[1] * b.y + weights[2] * c.y) / whole)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{GenericInsertShape, Meshing, shell::fixtures::block};

    fn generic() -> Vec<Vec3> {
        let insert = GenericInsertShape::default().insert(Meshing::default());
        insert.unwrap().surface().positions
    }

    #[test]
    fn verify_dishes_of_the_generic_insert() {
        let dishes = Dishes::of(&generic()).unwrap();
        for (found, z) in [(dishes.medial_mm, -23.0), (dishes.lateral_mm, 23.0)] {
            assert!((found - Vec3::new(0.0, 0.0, z)).norm() < 0.5, "{found}");
        }
        assert!(dishes.middle_mm().norm() < 0.3, "{:?}", dishes.middle_mm());
    }

    #[test]
    fn dishes_move_with_the_insert() {
        let shift = Vec3::new(4.0, -30.0, 5.0);
        let moved: Vec<Vec3> = generic().iter().map(|point| point + shift).collect();
        let (here, there) = (Dishes::of(&generic()).unwrap(), Dishes::of(&moved).unwrap());
        assert!((there.middle_mm() - here.middle_mm() - shift).norm() < 1e-9);
    }

    #[test]
    fn a_block_is_seen_from_above_by_its_top() {
        let block = block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0));
        let seen = block.seen_from_above(1.0);
        assert_eq!(seen.len(), 21 * 31);
        assert!(seen.iter().all(|point| point.y == 8.0));
        assert_eq!(Dishes::of(&[]), None);
    }
}
