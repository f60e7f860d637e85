//! Filled contours of a field on a mesh of quads.
//!
//! Each quad becomes four triangles about its centre; the region where the field is at least a
//! level is bounded by iso-lines through triangles and by pieces of the mesh's own border. Only
//! those are collected and joined into loops, so a region is one path without inner seams.

use std::collections::{BTreeMap, BTreeSet};

use crate::results::SurfaceFields;

/// A mesh prepared for contours, seen from above: (x, y) of the picture.
pub(crate) struct Contours<'a> {
    points: Vec<(f64, f64)>,
    values: Vec<f64>,
    quads: &'a [[u32; 4]],
    border: BTreeSet<(u32, u32)>,
}

/// A corner of a loop: on the edge between two vertices, or at one when they are equal.
type Corner = (u32, u32);

impl<'a> Contours<'a> {
    /// A field on a surface, its nodes placed in the picture by `place`.
    pub(crate) fn new(
        surface: &'a SurfaceFields,
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
            let quad = quad.map(|node| node as usize);
            let [x, y] = [|p: (f64, f64)| p.0, |p: (f64, f64)| p.1]
                .map(|axis| quad.iter().map(|&n| axis(points[n])).sum::<f64>() / 4.0);
            points.push((x, y));
            values.push(quad.iter().map(|&n| field[n]).sum::<f64>() / 4.0);
        }
        Self {
            points,
            values,
            quads: &surface.quads,
            border: border(&surface.quads),
        }
    }

    /// Closed loops around the region where the field is at least `level`; holes run the other way.
    pub(crate) fn region(&self, level: f64) -> Vec<Vec<(f64, f64)>> {
        let mut next: BTreeMap<Corner, Vec<Corner>> = BTreeMap::new();
        for triangle in self.triangles() {
            self.outline(triangle, level, &mut |from, to| {
                next.entry(from).or_default().push(to);
            });
        }
        self.loops(next, level)
    }

    fn triangles(&self) -> impl Iterator<Item = [u32; 3]> + '_ {
        let first_centre = self.points.len() - self.quads.len();
        self.quads
            .iter()
            .enumerate()
            .flat_map(move |(place, &[a, b, c, d])| {
                let centre = (first_centre + place) as u32;
                [
                    [a, b, centre],
                    [b, c, centre],
                    [c, d, centre],
                    [d, a, centre],
                ]
            })
    }

    /// Reports the pieces of the region's outline that a triangle holds.
    fn outline(&self, triangle: [u32; 3], level: f64, add: &mut impl FnMut(Corner, Corner)) {
        let inside = triangle.map(|vertex| self.values[vertex as usize] >= level);
        if !inside.contains(&true) {
            return;
        }
        let (mut leaves, mut enters) = (None, None);
        for side in 0..3 {
            let (a, b) = (triangle[side], triangle[(side + 1) % 3]);
            let (from, to) = match (inside[side], inside[(side + 1) % 3]) {
                (true, true) => ((a, a), (b, b)),
                (true, false) => ((a, a), *leaves.insert(crossing(a, b))),
                (false, true) => (*enters.insert(crossing(a, b)), (b, b)),
                (false, false) => continue,
            };
            if side == 0 && self.border.contains(&(a, b)) {
                add(from, to);
            }
        }
        if let (Some(from), Some(to)) = (leaves, enters) {
            add(from, to);
        }
    }

    fn loops(&self, mut next: BTreeMap<Corner, Vec<Corner>>, level: f64) -> Vec<Vec<(f64, f64)>> {
        let mut loops = Vec::new();
        while let Some(&start) = next.keys().next() {
            let mut points = Vec::new();
            let mut corner = start;
            while let Some(to) = take(&mut next, corner) {
                points.push(self.place(corner, level));
                corner = to;
            }
            loops.push(points);
        }
        loops
    }

    fn place(&self, (a, b): Corner, level: f64) -> (f64, f64) {
        let (p, q) = (self.points[a as usize], self.points[b as usize]);
        if a == b {
            return p;
        }
        let (u, v) = (self.values[a as usize], self.values[b as usize]);
        let share = (level - u) / (v - u);
        (p.0 + share * (q.0 - p.0), p.1 + share * (q.1 - p.1))
    }
}

/// The same corner from both sides of an edge.
fn crossing(a: u32, b: u32) -> Corner {
    (a.min(b), a.max(b))
}

fn take(next: &mut BTreeMap<Corner, Vec<Corner>>, from: Corner) -> Option<Corner> {
    let ways = next.get_mut(&from)?;
    let to = ways.pop();
    if ways.is_empty() {
        next.remove(&from);
    }
    to
}

/// Directed edges that belong to one quad only.
fn border(quads: &[[u32; 4]]) -> BTreeSet<(u32, u32)> {
    let mut edges: Vec<_> = quads
        .iter()
        .flat_map(|&[a, b, c, d]| [(a, b), (b, c), (c, d), (d, a)])
        .collect();
    edges.sort_unstable_by_key(|&(a, b)| crossing(a, b));
    edges
        .chunk_by(|&(a, b), &(c, d)| crossing(a, b) == crossing(c, d))
        .filter_map(|same| (same.len() == 1).then_some(same[0]))
        .collect()
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

    fn cone(surface: &SurfaceFields) -> Vec<f64> {
        surface.nodes.iter().map(|node| 1.0 - node.norm()).collect()
    }

    #[test]
    fn verify_whole_surface_is_one_square_loop() {
        let surface = square(8);
        let loops = Contours::new(&surface, &cone(&surface), |x, z| (x, z)).region(-10.0);
        assert_eq!(loops.len(), 1);
        assert!((area(&loops).abs() - 4.0).abs() < 1e-12);
    }

    #[test]
    fn verify_level_of_a_cone_is_a_circle() {
        let surface = square(80);
        let loops = Contours::new(&surface, &cone(&surface), |x, z| (x, z)).region(0.5);
        assert_eq!(loops.len(), 1);
        assert!((area(&loops).abs() - std::f64::consts::PI / 4.0).abs() < 1e-3);
    }

    #[test]
    fn verify_a_hole_runs_the_other_way() {
        let surface = square(80);
        let bowl: Vec<_> = cone(&surface).iter().map(|value| -value).collect();
        let loops = Contours::new(&surface, &bowl, |x, z| (x, z)).region(-0.5);
        assert_eq!(loops.len(), 2);
        assert!((area(&loops).abs() - (4.0 - std::f64::consts::PI / 4.0)).abs() < 1e-3);
    }

    #[test]
    fn nothing_lies_above_the_largest_value() {
        let surface = square(4);
        assert!(
            Contours::new(&surface, &cone(&surface), |x, z| (x, z))
                .region(2.0)
                .is_empty()
        );
    }
}
