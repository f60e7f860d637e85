//! Triangles that close loops of vertices in a plane.

use earcut::Earcut;

use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Adds the triangles inside the loops, of which those within others are holes, seen in a plane of this normal;
/// the triangles face along it.
pub(super) fn fill(mesh: &mut TriangleMesh, loops: &[Vec<u32>], normal: &Vec3) {
    let axes = across(normal);
    let rings: Vec<Ring> = loops
        .iter()
        .map(|around| Ring::new(mesh, around, &axes))
        .collect();
    let depths: Vec<usize> = rings.iter().map(|ring| ring.depth(&rings)).collect();
    let of_depth = |depth: usize| {
        rings
            .iter()
            .zip(&depths)
            .filter(move |(_, own)| **own == depth)
    };
    for (outer, &depth) in rings
        .iter()
        .zip(&depths)
        .filter(|(_, depth)| *depth % 2 == 0)
    {
        let holes = of_depth(depth + 1)
            .map(|(ring, _)| ring)
            .filter(|ring| outer.contains(ring));
        add_polygon(mesh, outer, &holes.collect::<Vec<_>>());
    }
}

/// Two directions across a normal, right-handed with it.
fn across(normal: &Vec3) -> [Vec3; 2] {
    let first = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
    [first, normal.cross(&first).normalize()]
}

/// A loop seen in the plane.
struct Ring {
    vertices: Vec<u32>,
    places: Vec<[f64; 2]>,
    low: [f64; 2],
    high: [f64; 2],
}

impl Ring {
    fn new(mesh: &TriangleMesh, around: &[u32], axes: &[Vec3; 2]) -> Self {
        let place = |&vertex: &u32| axes.map(|axis| axis.dot(&mesh.vertices[vertex as usize]));
        let places: Vec<[f64; 2]> = around.iter().map(place).collect();
        let end = |pick: fn(f64, f64) -> f64, from: f64| {
            [0, 1].map(|axis| places.iter().map(|at| at[axis]).fold(from, pick))
        };
        Self {
            low: end(f64::min, f64::INFINITY),
            high: end(f64::max, f64::NEG_INFINITY),
            vertices: around.to_vec(),
            places,
        }
    }

    /// In how many others it lies.
    fn depth(&self, all: &[Self]) -> usize {
        all.iter().filter(|other| other.contains(self)).count()
    }

    fn contains(&self, other: &Self) -> bool {
        !std::ptr::eq(self, other) && self.surrounds(other.places[0])
    }

    /// By the parity of the edges that a ray from the point crosses.
    fn surrounds(&self, [x, y]: [f64; 2]) -> bool {
        let is_beside = |axis: usize, at: f64| at < self.low[axis] || at > self.high[axis];
        if is_beside(0, x) || is_beside(1, y) {
            return false;
        }
        let next = self.places.iter().cycle().skip(1);
        let crosses = |[x1, y1]: [f64; 2], [x2, y2]: [f64; 2]| {
            (y1 > y) != (y2 > y) && x < x1 + (y - y1) / (y2 - y1) * (x2 - x1)
        };
        let crossed = self
            .places
            .iter()
            .zip(next)
            .filter(|&(&one, &other)| crosses(one, other));
        crossed.count() % 2 == 1
    }
}

fn add_polygon(mesh: &mut TriangleMesh, outer: &Ring, holes: &[&Ring]) {
    let mut vertices = outer.vertices.clone();
    let mut places = outer.places.clone();
    let mut starts = Vec::new();
    for hole in holes {
        starts.push(vertices.len() as u32);
        vertices.extend(&hole.vertices);
        places.extend(&hole.places);
    }
    let mut corners: Vec<u32> = Vec::new();
    Earcut::new().earcut(places.iter().copied(), &starts, &mut corners);
    for triangle in corners.chunks_exact(3) {
        let [a, b, c] = [triangle[0], triangle[1], triangle[2]];
        let [p, q, r] = [a, b, c].map(|corner| places[corner as usize]);
        let twice_area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        let facing = if twice_area > 0.0 {
            [a, b, c]
        } else {
            [a, c, b]
        };
        mesh.triangles
            .push(facing.map(|corner| vertices[corner as usize]));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_a_frame_is_filled_but_for_its_hole() {
        let square = |half: f64| [[-half, -half], [half, -half], [half, half], [-half, half]];
        let places = square(3.0)
            .into_iter()
            .chain(square(2.0))
            .chain(square(1.0));
        let mut mesh = TriangleMesh {
            vertices: places.map(|[x, z]| Vec3::new(x, 5.0, z)).collect(),
            triangles: Vec::new(),
        };
        let loops = [vec![0, 1, 2, 3], vec![4, 5, 6, 7], vec![8, 9, 10, 11]];
        fill(&mut mesh, &loops, &-Vec3::y());
        let areas = (0..mesh.triangles.len()).map(|t| {
            let [a, b, c] = mesh.corners(t);
            (b - a).cross(&(c - a)).y / 2.0
        });
        let area: f64 = areas.sum();
        assert!((area + 36.0 - 16.0 + 4.0).abs() < 1e-12, "{area}");
    }
}
