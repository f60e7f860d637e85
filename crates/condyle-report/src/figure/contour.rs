//! Filled contours of a field on a mesh of quads.
//!
//! Each quad becomes four triangles about its centre; the region where the field is at least a
//! level is bounded by iso-lines through triangles and by pieces of the mesh's own border. Only
//! those are collected and joined into loops, so a region is one path without inner seams.

use crate::results::surface::SurfaceFields;

/// A mesh prepared for contours, seen from above: (x, y) of the picture.
pub(crate) struct Contours<'a> {
    /// The nodes, then the centre of each quad.
    points: Vec<(f64, f64)>,
    /// A value a point.
    values: Vec<f64>,
    quads: &'a [[u32; 4]],
    /// Of each quad, which of its sides are on the border.
    borders: &'a [[bool; 4]],
}

/// A corner of a loop: on the edge between two vertices, or at one when they are equal.
type Corner = (u32, u32);

impl<'a> Contours<'a> {
    /// A field on a surface, its nodes placed in the picture by `place`; `borders` as from [`borders`].
    pub(crate) fn new(
        surface: &'a SurfaceFields,
        borders: &'a [[bool; 4]],
        field: &[f64],
        place: impl Fn(f64, f64) -> (f64, f64),
    ) -> Self {
        let mut points: Vec<_> = surface
            .nodes
            .iter()
            .map(|node| place(node.x, node.z))
            .collect();
        let mut values = field.to_vec();
        for quad in &surface.quads {
            let corners = quad.map(|node| points[node as usize]);
            let (x, y) = corners.iter().fold((0.0, 0.0), |sum, corner| {
                (sum.0 + corner.0, sum.1 + corner.1)
            });
            points.push((x / 4.0, y / 4.0));
            values.push(quad.map(|node| field[node as usize]).iter().sum::<f64>() / 4.0);
        }
        let quads = &surface.quads;
        Self {
            points,
            values,
            quads,
            borders,
        }
    }

    /// Closed loops around the region where the field is at least `level`; holes run the other way.
    pub(crate) fn region(&self, level: f64) -> Vec<Vec<(f64, f64)>> {
        let mut pieces = Vec::new();
        let mut add = |from, to| pieces.push((from, to));
        for quad in (0..self.quads.len()).filter(|&quad| self.touches_outline(quad, level)) {
            for side in 0..4 {
                self.outline(quad, side, level, &mut add);
            }
        }
        pieces.sort_unstable();
        self.loops(&pieces, level)
    }

    /// False where all of a quad is outside, or all of it inside and away from the border.
    fn touches_outline(&self, quad: usize, level: f64) -> bool {
        let inside = self.quads[quad].map(|node| self.values[node as usize] >= level);
        let all_inside = inside == [true; 4];
        inside != [false; 4] && !(all_inside && self.borders[quad] == [false; 4])
    }

    /// Reports the pieces of the region's outline in the triangle on one side of a quad.
    fn outline(&self, quad: usize, side: usize, level: f64, add: &mut impl FnMut(Corner, Corner)) {
        let corners = self.quads[quad];
        let centre = self.points.len() - self.quads.len() + quad;
        let triangle = [corners[side], corners[(side + 1) % 4], centre as u32];
        let inside = triangle.map(|vertex| self.values[vertex as usize] >= level);
        if !inside.contains(&true) {
            return;
        }
        let (mut leaves, mut enters) = (None, None);
        for edge in 0..3 {
            let (a, b) = (triangle[edge], triangle[(edge + 1) % 3]);
            let (from, to) = match (inside[edge], inside[(edge + 1) % 3]) {
                (true, true) => ((a, a), (b, b)),
                (true, false) => ((a, a), *leaves.insert(crossing(a, b))),
                (false, true) => (*enters.insert(crossing(a, b)), (b, b)),
                (false, false) => continue,
            };
            if edge == 0 && self.borders[quad][side] {
                add(from, to);
            }
        }
        if let (Some(from), Some(to)) = (leaves, enters) {
            add(from, to);
        }
    }

    /// Joins sorted pieces, each from a corner to a corner, into loops.
    fn loops(&self, pieces: &[(Corner, Corner)], level: f64) -> Vec<Vec<(f64, f64)>> {
        let mut used = vec![false; pieces.len()];
        let mut loops = Vec::new();
        for start in 0..pieces.len() {
            let mut points = Vec::new();
            let mut piece = (!used[start]).then_some(start);
            while let Some(current) = piece {
                used[current] = true;
                points.push(self.place(pieces[current].0, level));
                piece = unused_from(pieces, &used, pieces[current].1);
            }
            if !points.is_empty() {
                loops.push(points);
            }
        }
        loops
    }

    fn place(&self, (a, b): Corner, level: f64) -> (f64, f64) {
        let (p, q) = (self.points[a as usize], self.points[b as usize]);
        if a == b {
            return p;
        }
        let (u, v) = (self.values[a as usize], self.values[b as usize]);
        // Next to a place without a value the region ends half-way.
        let share = Some((level - u) / (v - u)).filter(|share| share.is_finite());
        let share = share.unwrap_or(0.5);
        (p.0 + share * (q.0 - p.0), p.1 + share * (q.1 - p.1))
    }
}

/// The same corner from both sides of an edge.
fn crossing(a: u32, b: u32) -> Corner {
    (a.min(b), a.max(b))
}

/// The first piece from a corner that is not used yet; there are two where loops touch.
fn unused_from(pieces: &[(Corner, Corner)], used: &[bool], from: Corner) -> Option<usize> {
    let first = pieces.partition_point(|piece| piece.0 < from);
    let same = pieces[first..]
        .iter()
        .take_while(|piece| piece.0 == from)
        .count();
    (first..first + same).find(|&piece| !used[piece])
}

/// Of each quad, which of its sides belong to no other quad.
pub(crate) fn borders(quads: &[[u32; 4]]) -> Vec<[bool; 4]> {
    let mut edges: Vec<_> = (0usize..)
        .zip(quads)
        .flat_map(|(quad, &nodes)| {
            (0..4).map(move |side| (crossing(nodes[side], nodes[(side + 1) % 4]), quad, side))
        })
        .collect();
    edges.sort_unstable();
    let mut borders = vec![[false; 4]; quads.len()];
    for same in edges.chunk_by(|one, other| one.0 == other.0) {
        if let &[(_, quad, side)] = same {
            borders[quad][side] = true;
        }
    }
    borders
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vec3;

    /// A square of n by n faces over -1..1 in x and z.
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
            fields: Vec::new(),
        }
    }

    fn area(loops: &[Vec<(f64, f64)>]) -> f64 {
        let twice = |points: &Vec<(f64, f64)>| -> f64 {
            let next = points.iter().cycle().skip(1);
            points
                .iter()
                .zip(next)
                .map(|(p, q)| p.0 * q.1 - p.1 * q.0)
                .sum()
        };
        loops.iter().map(twice).sum::<f64>() / 2.0
    }

    fn region(surface: &SurfaceFields, field: &[f64], level: f64) -> Vec<Vec<(f64, f64)>> {
        let borders = borders(&surface.quads);
        Contours::new(surface, &borders, field, |x, z| (x, z)).region(level)
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
