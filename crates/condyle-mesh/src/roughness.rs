//! The scatter of the vertices of a mesh about a smooth surface, as by the noise of a scan.

use nalgebra::{SMatrix, SVector};

use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Number of vertices that are examined: more do not change the result.
const EXAMINED: usize = 1000;
/// Share of the vertices that is smoother than the measured one ...
const SMOOTHEST: f64 = 0.1;
/// ... and its scatter under even noise, as a share of the noise: about a dozen vertices estimate it to a fifth.
const OF_SMOOTHEST: f64 = 0.8;
/// Deviation of a sphere from its quadratic surface, as a share of (reach)^4 / (radius)^3: that of its term of fourth order, three times
/// to allow for other shapes and few vertices.
const OF_CURVATURE: f64 = 3.0 * 0.0095;
/// Coefficients of a quadratic surface.
const COEFFICIENTS: usize = 6;
/// Fewest vertices that a quadratic surface is fitted to: some more than its coefficients, so that a scatter is left.
const FEWEST: usize = 11;

impl TriangleMesh {
    /// Returns the standard deviation of vertices from the quadratic surfaces through those around them, mm, where the mesh is
    /// smoothest: edges and coarse facets are somewhere, noise is everywhere. The part that the curvature of coarse facets
    /// explains does not count. None if too few have enough neighbours.
    pub fn scatter_mm(&self) -> Option<f64> {
        let (around, normals) = (self.neighbours(), self.vertex_normals());
        let every = self.vertices.len().div_ceil(EXAMINED).max(1);
        let scatter = |at: usize| {
            let near = two_rings(&around, at);
            let places = near
                .iter()
                .map(|&other| self.vertices[other as usize] - self.vertices[at]);
            scatter_of(&places.collect::<Vec<_>>(), &normals[at])
        };
        let examined = (0..self.vertices.len()).step_by(every);
        let mut scatters: Vec<(f64, f64)> = examined.filter_map(scatter).collect();
        scatters.sort_by(|a, b| a.0.total_cmp(&b.0));
        let smooth = (SMOOTHEST * scatters.len() as f64) as usize;
        let scatter = scatters.get(smooth)?.0 / OF_SMOOTHEST;
        let mut curved: Vec<f64> = scatters[..=smooth]
            .iter()
            .map(|(_, curved)| *curved)
            .collect();
        curved.sort_by(f64::total_cmp);
        let curved = curved[curved.len() / 2];
        Some((scatter.powi(2) - curved.powi(2)).max(0.0).sqrt())
    }

    fn neighbours(&self) -> Vec<Vec<u32>> {
        let mut around = vec![Vec::new(); self.vertices.len()];
        for &[a, b, c] in &self.triangles {
            for (from, to) in [(a, b), (b, c), (c, a)] {
                around[from as usize].push(to);
                around[to as usize].push(from);
            }
        }
        around
    }
}

/// Returns a vertex, its neighbours and theirs.
fn two_rings(around: &[Vec<u32>], at: usize) -> Vec<u32> {
    let first = &around[at];
    let second = first.iter().flat_map(|&next| &around[next as usize]);
    let mut near: Vec<u32> = first.iter().chain(second).copied().collect();
    near.push(at as u32);
    near.sort_unstable();
    near.dedup();
    near
}

/// Returns the standard deviation of heights along a normal from a quadratic surface, and that of a smooth body of its curvature.
fn scatter_of(places: &[Vec3], normal: &Vec3) -> Option<(f64, f64)> {
    if places.len() < FEWEST {
        return None;
    }
    let across = normal.cross(&Vec3::ith(normal.iamin(), 1.0)).normalize();
    let along = normal.cross(&across);
    let rows = places.iter().map(|place| {
        let (u, v) = (place.dot(&across), place.dot(&along));
        let row = SVector::<f64, COEFFICIENTS>::from([1.0, u, v, u * u, u * v, v * v]);
        (row, place.dot(normal))
    });
    let mut matrix = SMatrix::<f64, COEFFICIENTS, COEFFICIENTS>::zeros();
    let mut right = SVector::<f64, COEFFICIENTS>::zeros();
    for (row, height) in rows.clone() {
        matrix += row * row.transpose();
        right += row * height;
    }
    let fitted = matrix.cholesky()?.solve(&right);
    let squares: f64 = rows
        .map(|(row, height)| (height - row.dot(&fitted)).powi(2))
        .sum();
    let scatter = (squares / (places.len() - COEFFICIENTS) as f64).sqrt();
    let [_, _, _, uu, uv, vv]: [f64; COEFFICIENTS] = fitted.into();
    let curvature = (uu + vv).abs() + (uu - vv).hypot(uv);
    let reach = places.iter().map(Vec3::norm).fold(0.0, f64::max);
    Some((scatter, OF_CURVATURE * curvature.powi(3) * reach.powi(4)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sphere of 20 mm with edges of about 1.5 mm, each vertex moved along z by a part of `by_mm` that repeats every so often.
    fn sphere(by_mm: f64) -> TriangleMesh {
        let mut ball = TriangleMesh::block(Vec3::repeat(-1.0), Vec3::repeat(1.0));
        for _ in 0..4 {
            ball = ball.in_four(|a, b| (a + b) / 2.0);
        }
        let mut ball = ball.mapped(|vertex| 20.0 * vertex.normalize());
        for (at, vertex) in ball.vertices.iter_mut().enumerate() {
            // Multiples of the golden section are spread evenly over 0 to 1: their deviation is 1 / sqrt(12).
            let part = (at as f64 * 0.618_033_988_75).fract() - 0.5;
            *vertex += vertex.normalize() * (part * by_mm * 12f64.sqrt());
        }
        ball
    }

    #[test]
    fn verify_a_smooth_surface_does_not_scatter_and_noise_is_measured() {
        let of = |by_mm: f64| sphere(by_mm).scatter_mm().unwrap();
        assert!(of(0.0) < 0.005, "{}", of(0.0));
        for noise_mm in [0.02, 0.05] {
            let found = of(noise_mm);
            assert!((found / noise_mm - 1.0).abs() < 0.3, "{noise_mm} {found}");
        }
    }

    /// Returns a saddle z = x2 / 30 - y2 / 36 in squares of an edge, whose vertices are moved along z by golden parts.
    fn saddle(edge: f64, by_mm: f64) -> TriangleMesh {
        let count = (24.0 / edge) as u32;
        let at = |n: u32| f64::from(n) * edge - 12.0;
        let places = (0..=count).flat_map(|i| (0..=count).map(move |j| (at(i), at(j))));
        let arc = |radius: f64, x: f64| radius - (radius * radius - x * x).sqrt();
        let vertices = places.enumerate().map(|(n, (x, y))| {
            let part = (n as f64 * 0.618_033_988_75).fract() - 0.5;
            Vec3::new(
                x,
                y,
                arc(15.0, x) - arc(18.0, y) + part * by_mm * 12f64.sqrt(),
            )
        });
        let vertices = vertices.collect();
        let corner = |i: u32, j: u32| i * (count + 1) + j;
        let triangles = (0..count).flat_map(|i| {
            (0..count).flat_map(move |j| {
                let [a, b, c, d] =
                    [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(u, v)| corner(i + u, j + v));
                [[a, b, c], [a, c, d]]
            })
        });
        let triangles = triangles.collect();
        TriangleMesh {
            vertices,
            triangles,
        }
    }

    #[test]
    fn coarse_facets_of_a_saddle_are_no_noise_and_the_noise_of_a_fine_one_is_measured() {
        for edge_mm in [4.0, 3.0, 2.0, 1.0] {
            let found = saddle(edge_mm, 0.0).scatter_mm().unwrap();
            assert!(found < 0.002, "{edge_mm} {found}");
        }
        let found = saddle(1.0, 0.01).scatter_mm().unwrap();
        assert!((found / 0.01 - 1.0).abs() < 0.3, "{found}");
    }

    #[test]
    fn a_block_has_too_few_vertices() {
        let block = TriangleMesh::block(Vec3::zeros(), Vec3::repeat(1.0));
        assert_eq!(block.scatter_mm(), None);
    }
}
