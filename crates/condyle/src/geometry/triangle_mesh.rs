//! A surface of triangles.

use crate::Vec3;

/// A surface of triangles, each anticlockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// Vertex positions, mm.
    pub vertices: Vec<Vec3>,
    /// Vertex numbers of each triangle, from 0.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// Positions of the three corners of triangle `triangle`.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|vertex| self.vertices[vertex as usize])
    }

    /// Volume inside a closed surface; negative where the triangles face inwards.
    pub fn signed_volume(&self) -> f64 {
        let origin = self.vertices.first().copied().unwrap_or_default();
        (0..self.triangles.len())
            .map(|triangle| {
                let [a, b, c] = self.corners(triangle).map(|corner| corner - origin);
                a.dot(&b.cross(&c)) / 6.0
            })
            .sum()
    }
}
