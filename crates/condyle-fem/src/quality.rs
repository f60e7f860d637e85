//! How good the shape of hexahedra is, four of them at a time.

use nalgebra::Vector3;
use wide::f64x4;

use crate::{mesh::HexMesh, vector::Vec3};

/// How many go side by side.
const LANES: usize = 4;

/// A vector of each of four hexahedra.
type Vec3x4 = Vector3<f64x4>;

impl HexMesh {
    /// The scaled Jacobian of every element, the smallest over its eight corners: 1 for a brick, 0 or
    /// less where the element is flat or inverted at a corner.
    ///
    /// At each corner with edges $e, f, h$ it is $e \cdot (f \times h)/(|e| |f| |h|)$. Taken to the end it panics
    /// if an element names a node that there is not.
    pub fn qualities(&self) -> impl Iterator<Item = f64> + '_ {
        self.hexes.chunks(LANES).flat_map(|hexes| {
            let at = |corner: usize| self.gathered(hexes, corner);
            let (bottom, top) = ([at(0), at(1), at(2), at(3)], [at(4), at(5), at(6), at(7)]);
            let squares = least_signed_squares(&bottom, &top);
            let quality = |square: f64| square.abs().sqrt().copysign(square);
            squares
                .to_array()
                .map(quality)
                .into_iter()
                .take(hexes.len())
        })
    }

    /// Smallest scaled Jacobian of all elements; 0 or less means that one is flat or inverted.
    pub fn worst_quality(&self) -> f64 {
        self.qualities().fold(f64::INFINITY, f64::min)
    }

    /// One corner of up to four hexahedra; the last stands in for those that are missing.
    #[inline(always)]
    fn gathered(&self, hexes: &[[u32; 8]], corner: usize) -> Vec3x4 {
        let at = |lane: usize| &self.nodes[hexes[lane.min(hexes.len() - 1)][corner] as usize];
        let [a, b, c, d]: [&Vec3; LANES] = [at(0), at(1), at(2), at(3)];
        let lanes = |axis: usize| f64x4::new([a[axis], b[axis], c[axis], d[axis]]);
        Vector3::new(lanes(0), lanes(1), lanes(2))
    }
}

/// The smallest square of the scaled Jacobian over all corners, with its sign: so one root is enough.
///
/// The corners of the bottom and of the top are anticlockwise seen from the top.
#[inline(always)]
fn least_signed_squares(bottom: &[Vec3x4; 4], top: &[Vec3x4; 4]) -> f64x4 {
    let upright = |i: usize| top[i] - bottom[i];
    let upright = [upright(0), upright(1), upright(2), upright(3)];
    around(bottom, &upright).min(around(top, &upright))
}

/// The same over the corners of the bottom or the top.
///
/// With e and f the edges that lead to a corner and on from it, and h the upright one, the triple
/// product is e x f . h, at the bottom as at the top.
#[inline(always)]
fn around(ring: &[Vec3x4; 4], upright: &[Vec3x4; 4]) -> f64x4 {
    let edge = |i: usize| ring[(i + 1) % 4] - ring[i];
    let edges = [edge(0), edge(1), edge(2), edge(3)];
    let length2 = |i: usize| dot(&edges[i], &edges[i]);
    let length2 = [length2(0), length2(1), length2(2), length2(3)];
    let square = |i: usize| {
        let (before, h) = ((i + 3) % 4, &upright[i]);
        let triple = dot(&cross(&edges[before], &edges[i]), h);
        let lengths2 = length2[before] * length2[i] * dot(h, h);
        // At a corner with an edge of no length, 0/0 becomes 0.
        triple * triple.abs() / lengths2.max(f64x4::splat(f64::MIN_POSITIVE))
    };
    square(0).min(square(1)).min(square(2).min(square(3)))
}

#[inline(always)]
fn dot(a: &Vec3x4, b: &Vec3x4) -> f64x4 {
    a.x * b.x + a.y * b.y + a.z * b.z
}

#[inline(always)]
fn cross(a: &Vec3x4, b: &Vec3x4) -> Vec3x4 {
    Vector3::new(
        a.y * b.z - a.z * b.y,
        a.z * b.x - a.x * b.z,
        a.x * b.y - a.y * b.x,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::tests::block;

    /// The definition, corner by corner.
    fn scaled_jacobian(corners: &[Vec3; 8]) -> f64 {
        const ENDS: [[usize; 3]; 8] = [
            [1, 3, 4],
            [2, 0, 5],
            [3, 1, 6],
            [0, 2, 7],
            [7, 5, 0],
            [4, 6, 1],
            [5, 7, 2],
            [6, 4, 3],
        ];
        let at = |corner: usize| {
            let [u, v, w] = ENDS[corner].map(|end| (corners[end] - corners[corner]).normalize());
            u.cross(&v).dot(&w)
        };
        (0..8).map(at).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn verify_quality_against_its_definition() {
        let mut mesh = block([3, 2, 1]);
        for (i, node) in mesh.nodes.iter_mut().enumerate() {
            let turn = i as f64;
            *node += Vec3::new(turn.sin(), (2.0 * turn).cos(), (3.0 * turn).sin()) * 0.3;
        }
        let found: Vec<f64> = mesh.qualities().collect();
        assert_eq!(found.len(), mesh.hexes.len());
        for (hex, quality) in found.iter().enumerate() {
            let exact = scaled_jacobian(&mesh.corners(hex));
            assert!((quality - exact).abs() < 1e-14, "{quality} {exact}");
        }
    }

    #[test]
    fn a_brick_is_perfect_and_an_inverted_element_below_zero() {
        let mut mesh = block([1, 1, 1]);
        assert!((mesh.worst_quality() - 1.0).abs() < 1e-14);
        mesh.nodes[4] = Vec3::new(0.0, 0.0, -0.2);
        assert!(mesh.worst_quality() < 0.0);
        mesh.nodes[4] = mesh.nodes[0];
        assert_eq!(mesh.worst_quality(), 0.0);
    }
}
