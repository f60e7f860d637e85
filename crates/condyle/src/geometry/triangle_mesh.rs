//! A surface of triangles.

use serde::{Deserialize, Serialize};

use super::bounds::bounds;
use crate::Vec3;

/// A surface of triangles, each anticlockwise seen from outside.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct TriangleMesh {
    /// Vertex positions, mm.
    pub vertices: Vec<Vec3>,
    /// Vertex numbers of each triangle, from 0.
    pub triangles: Vec<[u32; 3]>,
}

impl TriangleMesh {
    /// The surface of quads, each cut from its first corner to its third.
    pub fn of_quads(vertices: Vec<Vec3>, quads: impl IntoIterator<Item = [u32; 4]>) -> Self {
        let halves = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
        let triangles = quads.into_iter().flat_map(halves).collect();
        Self {
            vertices,
            triangles,
        }
    }

    /// Positions of the three corners of triangle `triangle`.
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        self.triangles[triangle].map(|vertex| self.vertices[vertex as usize])
    }

    /// Volume inside a closed surface; negative where the triangles face inwards.
    pub fn signed_volume(&self) -> f64 {
        self.volume_of(0..self.triangles.len())
    }

    /// The same of some of its triangles.
    pub(super) fn volume_of(&self, triangles: impl Iterator<Item = usize>) -> f64 {
        let origin = self.vertices.first().copied().unwrap_or_default();
        triangles
            .map(|triangle| {
                let [a, b, c] = self.corners(triangle).map(|corner| corner - origin);
                a.dot(&b.cross(&c)) / 6.0
            })
            .sum()
    }

    /// Lowest and highest coordinate along each axis.
    pub fn bounds(&self) -> (Vec3, Vec3) {
        bounds(&self.vertices)
    }

    /// Unit normal at each vertex: the sum over the triangles around of a x b / (a^2 b^2), with a
    /// and b the two edges that leave the vertex; exact for vertices on a ball (Max 1999).
    pub fn vertex_normals(&self) -> Vec<Vec3> {
        let mut normals = vec![Vec3::zeros(); self.vertices.len()];
        for (triangle, &numbers) in self.triangles.iter().enumerate() {
            let corners = self.corners(triangle);
            for i in 0..3 {
                let (a, b) = (
                    corners[(i + 1) % 3] - corners[i],
                    corners[(i + 2) % 3] - corners[i],
                );
                let weight = a.norm_squared() * b.norm_squared();
                if weight > 0.0 {
                    normals[numbers[i] as usize] += a.cross(&b) / weight;
                }
            }
        }
        normals
            .iter()
            .map(|normal| normal.try_normalize(0.0).unwrap_or_default())
            .collect()
    }

    /// The mesh with every vertex moved by `map`, which keeps left and right.
    pub fn mapped(mut self, map: impl Fn(&Vec3) -> Vec3) -> Self {
        self.vertices
            .iter_mut()
            .for_each(|vertex| *vertex = map(vertex));
        self
    }

    /// Centre (x, y) of the circle that fits the posterior condyles in the sagittal plane, mm.
    ///
    /// The support h(d), how far the surface reaches in direction d, is c . d + r for a circle of
    /// centre c and radius r, so a straight least-squares fit over the directions from 30 to
    /// 90 degrees behind straight down gives the centre.
    pub fn posterior_arc_centre_mm(&self) -> (f64, f64) {
        let mut normal_matrix = crate::Mat3::zeros();
        let mut right_side = Vec3::zeros();
        for behind_deg in (30..=90).step_by(2) {
            let (sine, cosine) = f64::from(behind_deg).to_radians().sin_cos();
            let (x, y) = (-sine, -cosine);
            let reach = self
                .vertices
                .iter()
                .map(|v| v.x * x + v.y * y)
                .fold(f64::NEG_INFINITY, f64::max);
            let row = Vec3::new(x, y, 1.0);
            normal_matrix += row * row.transpose();
            right_side += row * reach;
        }
        let solved = normal_matrix.lu().solve(&right_side).unwrap_or_default();
        (solved.x, solved.y)
    }
}

#[cfg(test)]
mod tests {
    use crate::geometry::{GenericFemur, GenericFemurShape};

    #[test]
    fn verify_posterior_arc_of_the_generic_femur_is_its_origin() {
        let mesh = GenericFemur::new(GenericFemurShape::default()).surface_mesh(0.5);
        let (x, y) = mesh.posterior_arc_centre_mm();
        assert!(x.abs() < 0.05 && y.abs() < 0.05, "{x} {y}");
    }
}
