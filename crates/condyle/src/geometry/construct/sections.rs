//! Horizontal sections of a closed body.

use condyle_mesh::TriangleMesh;

use crate::Vec3;

/// Lines lie beside round numbers, where edges of triangles are, by these shares of their distance: not by the same,
/// or they would lie on diagonals.
const BESIDE: (f64, f64) = (0.137, 0.291);
/// Passes of one line that are no farther apart are one, mm: through the edge between two triangles.
const ONE_PASS_MM: f64 = 1e-6;

/// A closed body by the heights at which the vertical lines of a square grid pass its surface.
pub struct Sections {
    step_mm: f64,
    rows: usize,
    columns: usize,
    /// Of every line, heights with 1 where it goes in from above and -1 where it comes out, the highest first.
    passes: Vec<Vec<(f64, i32)>>,
}

impl Sections {
    /// Those of a body, lines `step_mm` apart; a rim of lines beside it passes nothing.
    pub fn of(body: &TriangleMesh, step_mm: f64) -> Self {
        let (low, high) = body.bounds();
        let count = |length: f64| (length / step_mm) as usize + 3;
        let (rows, columns) = (count(high.x - low.x), count(high.z - low.z));
        let mut sections = Self {
            step_mm,
            rows,
            columns,
            passes: vec![Vec::new(); rows * columns],
        };
        let origin = Vec3::new(low.x - BESIDE.0 * step_mm, 0.0, low.z - BESIDE.1 * step_mm);
        for triangle in 0..body.triangles.len() {
            sections.add(&body.corners(triangle).map(|corner| corner - origin));
        }
        for passes in &mut sections.passes {
            passes.sort_by(|a, b| b.0.total_cmp(&a.0));
            passes.dedup_by(|a, b| a.1 == b.1 && (a.0 - b.0).abs() < ONE_PASS_MM);
        }
        sections
    }

    fn add(&mut self, corners: &[Vec3; 3]) {
        let [a, b, c] = corners;
        let (least, most) = (
            a.inf(b).inf(c) / self.step_mm,
            a.sup(b).sup(c) / self.step_mm,
        );
        let lines = |from: f64, to: f64, count: usize| {
            from.ceil().max(0.0) as usize
                ..(to.floor().max(-1.0) + 1.0).min(count as f64 - 1.0) as usize
        };
        for row in lines(least.x, most.x, self.rows) {
            for column in lines(least.z, most.z, self.columns) {
                let place = (row as f64 * self.step_mm, column as f64 * self.step_mm);
                if let Some(pass) = pass(corners, place) {
                    self.passes[(row + 1) * self.columns + column + 1].push(pass);
                }
            }
        }
    }

    fn is_inside(&self, line: usize, y: f64) -> bool {
        let above = self.passes[line].iter().take_while(|pass| pass.0 > y);
        above.map(|pass| pass.1).sum::<i32>() > 0
    }

    /// Area within the outer lines of the section at a height, mm2: what is hollow inside counts.
    pub fn area_mm2(&self, y: f64) -> f64 {
        let mut is_outside = vec![false; self.passes.len()];
        let mut open = vec![0];
        let mut outside = 0;
        while let Some(line) = open.pop() {
            if !is_outside[line] && !self.is_inside(line, y) {
                is_outside[line] = true;
                outside += 1;
                let (row, column) = (line / self.columns, line % self.columns);
                let before = [
                    (row > 0).then(|| line - self.columns),
                    (column > 0).then(|| line - 1),
                ];
                let after = [
                    (row + 1 < self.rows).then_some(line + self.columns),
                    (column + 1 < self.columns).then_some(line + 1),
                ];
                open.extend(before.into_iter().chain(after).flatten());
            }
        }
        (self.passes.len() - outside) as f64 * self.step_mm * self.step_mm
    }
}

/// Where the vertical line at a place (x, z) passes a triangle, and whether it goes in from above.
fn pass([a, b, c]: &[Vec3; 3], (x, z): (f64, f64)) -> Option<(f64, i32)> {
    let twice_area = |p: &Vec3, q: &Vec3| (p.z - z) * (q.x - x) - (p.x - x) * (q.z - z);
    let weights = [twice_area(b, c), twice_area(c, a), twice_area(a, b)];
    let whole: f64 = weights.iter().sum();
    let covers = whole != 0.0 && weights.iter().all(|weight| weight * whole >= 0.0);
    let height = (weights[0] * a.y + weights[1] * b.y + weights[2] * c.y) / whole;
    covers.then_some((height, if whole > 0.0 { 1 } else { -1 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_areas_of_the_sections_of_a_block_on_a_smaller_one() {
        let body =
            TriangleMesh::block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0)).joined(
                &TriangleMesh::block(Vec3::new(-4.0, -20.0, -3.0), Vec3::new(4.0, 0.5, 3.0)),
            );
        let sections = Sections::of(&body, 0.25);
        for (y, area) in [
            (7.9, 600.0),
            (0.25, 600.0),
            (-5.0, 48.0),
            (8.1, 0.0),
            (-20.1, 0.0),
        ] {
            let found = sections.area_mm2(y);
            assert!((found - area).abs() <= 0.05 * area, "{found} at {y}");
        }
    }
}
