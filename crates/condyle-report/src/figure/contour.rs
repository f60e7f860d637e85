//! Filled contours of a field on a mesh of quads.
//!
//! Each quad becomes four triangles about its centre; the region where the field is at least a
//! level is bounded by iso-lines through triangles and by pieces of the mesh's own border. Only
//! those are collected and joined into loops, so a region is one path without inner seams.

use condyle_mesh::repair::border_sides;

use crate::results::SurfaceFields;

/// A mesh prepared for contours, seen from above: (x, y) of the picture.
pub(crate) struct Contours<'a> {
    points: Vec<(f64, f64)>,
    quads: &'a [[u32; 4]],
    /// The sides of each quad that are on the border.
    borders: Vec<[bool; 4]>,
}

pub(crate) type Loop = Vec<(f64, f64)>;

/// A corner of a loop: on the edge between two vertices, or at one when they are equal.
type Corner = (u32, u32);

impl<'a> Contours<'a> {
    /// Prepares a surface, whose nodes `place` puts into the picture from their places on maps.
    pub(crate) fn new(surface: &'a SurfaceFields, place: impl Fn(f64, f64) -> (f64, f64)) -> Self {
        let nodes = surface.flat().into_iter();
        let mut points: Vec<_> = nodes.map(|[x, z]| place(x, z)).collect();
        for quad in &surface.quads {
            let [a, b, c, d] = quad.map(|node| points[node as usize]);
            points.push(((a.0 + b.0 + c.0 + d.0) / 4.0, (a.1 + b.1 + c.1 + d.1) / 4.0));
        }
        Self {
            points,
            quads: &surface.quads,
            borders: borders(&surface.quads),
        }
    }

    /// Closed loops around the region where a field is at least a level, for each level; holes run the other way.
    pub(crate) fn regions(&self, field: &[f64], levels: &[f64]) -> Vec<Vec<Loop>> {
        let mut values = field.to_vec();
        let mean =
            |quad: &[u32; 4]| quad.map(|node| field[node as usize]).iter().sum::<f64>() / 4.0;
        values.extend(self.quads.iter().map(mean));
        let region = |level: &f64| self.region(&values, *level);
        levels.iter().map(region).collect()
    }

    fn region(&self, values: &[f64], level: f64) -> Vec<Loop> {
        let is_inside = |vertex: u32| values[vertex as usize] >= level;
        let mut pieces = Vec::new();
        for (quad, corners) in self.quads.iter().enumerate() {
            let inside = corners.map(is_inside);
            // No outline passes where all is outside, or where all is inside and away from the border.
            let is_covered = inside == [true; 4] && self.borders[quad] == [false; 4];
            if inside == [false; 4] || is_covered {
                continue;
            }
            let centre = (self.points.len() - self.quads.len() + quad) as u32;
            for side in 0..4 {
                let triangle = [corners[side], corners[(side + 1) % 4], centre];
                let is_border = self.borders[quad][side];
                outline(triangle, triangle.map(is_inside), is_border, &mut pieces);
            }
        }
        pieces.sort_unstable();
        self.loops(&pieces, values, level)
    }

    /// Joins sorted pieces, each from a corner to a corner, into loops.
    fn loops(&self, pieces: &[(Corner, Corner)], values: &[f64], level: f64) -> Vec<Loop> {
        let mut used = vec![false; pieces.len()];
        let mut loops = Vec::new();
        for start in 0..pieces.len() {
            let mut points = Vec::new();
            let mut piece = (!used[start]).then_some(start);
            while let Some(current) = piece {
                used[current] = true;
                let (from, to) = pieces[current];
                points.push(self.place(from, values, level));
                // Where loops touch, two pieces start at the corner: the first unused one.
                let first = pieces.partition_point(|piece| piece.0 < to);
                let mut same = (first..pieces.len()).take_while(|&next| pieces[next].0 == to);
                piece = same.find(|&next| !used[next]);
            }
            if !points.is_empty() {
                loops.push(points);
            }
        }
        loops
    }

    fn place(&self, (a, b): Corner, values: &[f64], level: f64) -> (f64, f64) {
        let (p, q) = (self.points[a as usize], self.points[b as usize]);
        if a == b {
            return p;
        }
        let (u, v) = (values[a as usize], values[b as usize]);
        // Next to a node without a value the region ends half-way.
        let share = Some((level - u) / (v - u)).filter(|share| share.is_finite());
        let share = share.unwrap_or(0.5);
        (p.0 + share * (q.0 - p.0), p.1 + share * (q.1 - p.1))
    }
}

/// Adds the pieces of the region's outline in a triangle, whose first edge may be on the border.
fn outline(
    triangle: [u32; 3],
    inside: [bool; 3],
    is_border: bool,
    pieces: &mut Vec<(Corner, Corner)>,
) {
    let (mut leaves, mut enters) = (None, None);
    for edge in 0..3 {
        let (a, b) = (triangle[edge], triangle[(edge + 1) % 3]);
        let (from, to) = match (inside[edge], inside[(edge + 1) % 3]) {
            (true, true) => ((a, a), (b, b)),
            (true, false) => ((a, a), *leaves.insert(crossing(a, b))),
            (false, true) => (*enters.insert(crossing(a, b)), (b, b)),
            (false, false) => continue,
        };
        if edge == 0 && is_border {
            pieces.push((from, to));
        }
    }
    pieces.extend(leaves.zip(enters));
}

/// Returns the corner on an edge, the same from both sides of the edge.
fn crossing(a: u32, b: u32) -> Corner {
    (a.min(b), a.max(b))
}

/// Returns the sides of each quad that belong to no other quad.
fn borders(quads: &[[u32; 4]]) -> Vec<[bool; 4]> {
    let mut borders = vec![[false; 4]; quads.len()];
    for (_, quad, side) in border_sides(quads) {
        borders[quad][side] = true;
    }
    borders
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;

    /// Returns a square of n by n faces over -1..1 in x and z.
    fn square(n: u32) -> SurfaceFields {
        let at = |i: u32| 2.0 * f64::from(i) / f64::from(n) - 1.0;
        let nodes = (0..=n)
            .flat_map(|i| (0..=n).map(move |j| Vec3::new(at(i), 0.0, at(j))))
            .collect();
        let id = |i, j| i * (n + 1) + j;
        let quads = (0..n)
            .flat_map(|i| {
                (0..n).map(move |j| [id(i, j), id(i, j + 1), id(i + 1, j + 1), id(i + 1, j)])
            })
            .collect();
        SurfaceFields {
            nodes,
            quads,
            ..SurfaceFields::default()
        }
    }

    fn area(loops: &[Loop]) -> f64 {
        let twice = |points: &Loop| -> f64 {
            let next = points.iter().cycle().skip(1);
            points
                .iter()
                .zip(next)
                .map(|(p, q)| p.0 * q.1 - p.1 * q.0)
                .sum()
        };
        loops.iter().map(twice).sum::<f64>() / 2.0
    }

    fn region(surface: &SurfaceFields, field: &[f64], level: f64) -> Vec<Loop> {
        Contours::new(surface, |x, z| (x, z))
            .regions(field, &[level])
            .concat()
    }

    fn cone(surface: &SurfaceFields) -> Vec<f64> {
        surface.nodes.iter().map(|node| 1.0 - node.norm()).collect()
    }

    #[test]
    fn verify_whole_surface_is_one_square_loop() {
        let surface = square(8);
        let loops = region(&surface, &cone(&surface), -10.0);
        assert_eq!(loops.len(), 1);
        assert!((area(&loops).abs() - 4.0).abs() < 1e-12);
    }

    #[test]
    fn verify_level_of_a_cone_is_a_circle() {
        let surface = square(80);
        let loops = region(&surface, &cone(&surface), 0.5);
        assert_eq!(loops.len(), 1);
        assert!((area(&loops).abs() - std::f64::consts::PI / 4.0).abs() < 1e-3);
    }

    #[test]
    fn verify_a_hole_runs_the_other_way() {
        let surface = square(80);
        let bowl: Vec<_> = cone(&surface).iter().map(|value| -value).collect();
        let loops = region(&surface, &bowl, -0.5);
        assert_eq!(loops.len(), 2);
        assert!((area(&loops).abs() - (4.0 - std::f64::consts::PI / 4.0)).abs() < 1e-3);
    }

    #[test]
    fn nothing_lies_above_the_largest_value() {
        let surface = square(4);
        assert!(region(&surface, &cone(&surface), 2.0).is_empty());
    }
}
