//! A mesh of hexahedra: nodes, elements, boundary.

use std::sync::Arc;

use nalgebra::Vector3;
use wide::f64x4;

use crate::Vec3;

/// A mesh of 8-node hexahedra.
///
/// Clones share the node numbers of the elements, which do not change when nodes move.
#[derive(Clone, Debug, PartialEq)]
pub struct HexMesh {
    /// Node positions.
    pub nodes: Vec<Vec3>,
    /// Node numbers of each hexahedron, from 0, in VTK order.
    pub hexes: Arc<[[u32; 8]]>,
}

impl HexMesh {
    /// Returns the positions of the eight corners of a hexahedron.
    ///
    /// # Panics
    /// If there is no such hexahedron, or it names a missing node.
    pub fn corners(&self, hex: usize) -> [Vec3; 8] {
        self.hexes[hex].map(|node| self.nodes[node as usize])
    }

    /// Returns the positions of some nodes.
    pub fn positions(&self, nodes: &[u32]) -> impl Iterator<Item = Vec3> {
        nodes.iter().map(|&node| self.nodes[node as usize])
    }

    /// Returns the volume of the mesh, each element with bilinear faces.
    ///
    /// # Panics
    /// If an element names a missing node.
    pub fn volume(&self) -> f64 {
        (0..self.hexes.len())
            .map(|hex| trilinear_volume(&self.corners(hex)))
            .sum()
    }

    /// Returns the quads that belong to one hexahedron only, anticlockwise seen from outside,
    /// in the order of the elements.
    ///
    /// # Panics
    /// If an element names a missing node.
    pub fn boundary_quads(&self) -> Vec<[u32; 4]> {
        self.boundary_quads_where(|_| true)
    }

    /// Returns those of the boundary quads for which `is_chosen`, which must not depend on the order of the nodes.
    ///
    /// # Panics
    /// If an element names a missing node.
    pub fn boundary_quads_where(&self, is_chosen: impl Fn(&[u32; 4]) -> bool) -> Vec<[u32; 4]> {
        // Every quad is compared with the few earlier quads that have the same lowest node. Chained lists in two flat arrays: several times faster than a map of sorted quads.
        const NONE: u32 = u32::MAX;
        let count = HEX_FACES.len() * self.hexes.len();
        let mut is_left_out = vec![false; count];
        let mut newest = vec![NONE; self.nodes.len()];
        let mut older = vec![NONE; count];
        for here in 0..count {
            let quad = self.quad(here);
            if !is_chosen(&quad) {
                is_left_out[here] = true;
                continue;
            }
            let quad = sorted(quad);
            older[here] = std::mem::replace(&mut newest[quad[0] as usize], here as u32);
            let mut other = older[here];
            while other != NONE {
                let at = other as usize;
                if sorted(self.quad(at)) == quad {
                    (is_left_out[at], is_left_out[here]) = (true, true);
                }
                other = older[at];
            }
        }
        let left = (0..count).filter(|&quad| !is_left_out[quad]);
        left.map(|quad| self.quad(quad)).collect()
    }

    /// Returns a quad by its number; each element has six.
    fn quad(&self, number: usize) -> [u32; 4] {
        let (hex, face) = (number / HEX_FACES.len(), number % HEX_FACES.len());
        HEX_FACES[face].map(|corner| self.hexes[hex][corner])
    }
}

/// Returns the nodes of quads, ascending, and the quads in numbers of these nodes.
pub fn numbered(quads: &[[u32; 4]]) -> (Vec<u32>, Vec<[u32; 4]>) {
    let mut nodes: Vec<u32> = quads.iter().flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    let number = |node: u32| nodes.partition_point(|&other| other < node) as u32;
    let faces = quads.iter().map(|quad| quad.map(number)).collect();
    (nodes, faces)
}

fn sorted(mut quad: [u32; 4]) -> [u32; 4] {
    quad.sort_unstable();
    quad
}

/// The edges of a hexahedron as corners in VTK order.
pub const HEX_EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [1, 2],
    [2, 3],
    [3, 0],
    [4, 5],
    [5, 6],
    [6, 7],
    [7, 4],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
];

/// The six faces of a hexahedron as corners in VTK order, each anticlockwise seen from outside.
pub const HEX_FACES: [[usize; 4]; 6] = [
    [0, 3, 2, 1],
    [4, 5, 6, 7],
    [0, 1, 5, 4],
    [1, 2, 6, 5],
    [2, 3, 7, 6],
    [3, 0, 4, 7],
];

/// Exact volume enclosed by a hexahedron with bilinear faces.
///
/// `corners` are in VTK order (bottom quad anticlockwise seen from the top, then the top quad).
/// The volume integral becomes one over the six faces, $V = \tfrac{1}{3} \sum \int x \cdot n dA$, and on a
/// bilinear face with corners $a, b, c, d$ and vector area $A$ that integral is
/// $\tfrac{1}{4} (a + b + c + d) \cdot A$ plus a twist term; summing the four tetrahedral splits of a face,
/// weighted one half, gives it exactly.
///
/// ```
/// use condyle_fem::{Vec3, trilinear_volume};
///
/// let bottom = [[0., 0.], [2., 0.], [2., 3.], [0., 3.]];
/// let corner = |i: usize| Vec3::new(bottom[i % 4][0], bottom[i % 4][1], if i < 4 { 0.0 } else { 0.5 });
/// assert_eq!(trilinear_volume(&std::array::from_fn(corner)), 3.0);
/// ```
pub fn trilinear_volume(corners: &[Vec3; 8]) -> f64 {
    // From a corner, so that a mesh far from the origin loses no digits.
    let origin = corners[0];
    HEX_FACES
        .iter()
        .map(|face| volume_below(&face.map(|i| corners[i] - origin)))
        .sum()
}

/// Returns the volume of the cone from the origin to a bilinear quad; positive if it is anticlockwise seen from
/// outside. Over a closed surface these add up to the volume inside.
pub fn volume_below([a, b, c, d]: &[Vec3; 4]) -> f64 {
    // Mean of the two ways to cut the quad into triangles.
    let triple = |p: &Vec3, q: &Vec3, r: &Vec3| p.dot(&q.cross(r));
    (triple(a, b, c) + triple(a, c, d) + triple(a, b, d) + triple(b, c, d)) / 12.0
}

/// The number of hexahedra side by side.
const LANES: usize = 4;

/// A vector of each of four hexahedra.
type Vec3x4 = Vector3<f64x4>;

impl HexMesh {
    /// Returns the scaled Jacobian of every element, the smallest over its eight corners: 1 for a brick, 0 or less
    /// where the element is flat or inverted at a corner.
    ///
    /// At each corner with edges $e, f, h$ it is $e \cdot (f \times h)/(|e| |f| |h|)$. The iterator panics at an
    /// element that names a missing node.
    pub fn qualities(&self) -> impl Iterator<Item = f64> + '_ {
        self.hexes.chunks(LANES).flat_map(|hexes| {
            let at = |corner: usize| self.gathered(hexes, corner);
            let (bottom, top) = ([at(0), at(1), at(2), at(3)], [at(4), at(5), at(6), at(7)]);
            let upright = |i: usize| top[i] - bottom[i];
            let upright = [upright(0), upright(1), upright(2), upright(3)];
            // The least of the signed squares belongs to the least value: one root per element is enough.
            let squares = around(&bottom, &upright).min(around(&top, &upright));
            let quality = |square: f64| square.abs().sqrt().copysign(square);
            let qualities = squares.to_array().map(quality);
            qualities.into_iter().take(hexes.len())
        })
    }

    /// Returns the smallest scaled Jacobian of all elements; 0 or less means that one is flat or inverted.
    pub fn worst_quality(&self) -> f64 {
        self.qualities().fold(f64::INFINITY, f64::min)
    }

    /// Returns one corner of up to four hexahedra; the last one replaces missing ones.
    #[inline(always)]
    fn gathered(&self, hexes: &[[u32; 8]], corner: usize) -> Vec3x4 {
        let at = |lane: usize| &self.nodes[hexes[lane.min(hexes.len() - 1)][corner] as usize];
        let [a, b, c, d]: [&Vec3; LANES] = [at(0), at(1), at(2), at(3)];
        let lanes = |axis: usize| f64x4::new([a[axis], b[axis], c[axis], d[axis]]);
        Vector3::new(lanes(0), lanes(1), lanes(2))
    }
}

/// Returns the smallest square of the scaled Jacobian, with its sign, over the corners of the bottom or the top, which
/// are anticlockwise seen from the top.
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

/// Signs of the natural coordinates of the corners of a quad.
const SIGNS: [[f64; 2]; 4] = [[-1., -1.], [1., -1.], [1., 1.], [-1., 1.]];

impl HexMesh {
    /// Returns the nodal forces that are equivalent to a traction on some quads; a node occurs once for every quad.
    ///
    /// `traction`: force per area as a function of place and unit normal, which for [`Self::boundary_quads`] is
    /// outward, so that a pressure p is `-n * p`. Two by two points of Gauss on each bilinear quad.
    ///
    /// # Panics
    /// If a quad names a missing node.
    pub fn traction_forces(
        &self,
        quads: &[[u32; 4]],
        traction: impl Fn(Vec3, Vec3) -> Vec3,
    ) -> Vec<(u32, Vec3)> {
        let mut forces = Vec::with_capacity(4 * quads.len());
        for quad in quads {
            let corners = quad.map(|node| self.nodes[node as usize]);
            let mut own = [Vec3::zeros(); 4];
            for at in SIGNS.map(|sign| sign.map(|s| s / 3f64.sqrt())) {
                let shape = SIGNS.map(|[a, b]| (1.0 + a * at[0]) * (1.0 + b * at[1]) / 4.0);
                let along = |[a, b]: [f64; 2]| a * (1.0 + b * at[1]) / 4.0;
                let across = |[a, b]: [f64; 2]| b * (1.0 + a * at[0]) / 4.0;
                let sum = |weights: [f64; 4]| -> Vec3 {
                    let parts = std::iter::zip(corners, weights);
                    parts.map(|(corner, weight)| corner * weight).sum()
                };
                let area = sum(SIGNS.map(along)).cross(&sum(SIGNS.map(across)));
                let force = traction(sum(shape), area.normalize()) * area.norm();
                for (sum, shape) in own.iter_mut().zip(shape) {
                    *sum += force * shape;
                }
            }
            forces.extend(quad.iter().copied().zip(own));
        }
        forces
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{block, distorted};

    #[test]
    fn verify_block_volume_boundary_and_quality() {
        let mesh = block([3, 2, 4]);
        assert!((mesh.volume() - 24.0).abs() < 1e-12);
        assert!((mesh.worst_quality() - 1.0).abs() < 1e-12);
        assert_eq!(mesh.boundary_quads().len(), 2 * (6 + 8 + 12));
    }

    #[test]
    fn boundary_quads_face_outwards() {
        let mesh = block([2, 2, 2]);
        let centre = Vec3::repeat(1.0);
        for quad in mesh.boundary_quads() {
            let [a, b, c, _] = quad.map(|n| mesh.nodes[n as usize]);
            assert!((b - a).cross(&(c - b)).dot(&(a - centre)) > 0.0);
        }
    }

    fn brick(size: [f64; 3]) -> [Vec3; 8] {
        [
            [0., 0., 0.],
            [1., 0., 0.],
            [1., 1., 0.],
            [0., 1., 0.],
            [0., 0., 1.],
            [1., 0., 1.],
            [1., 1., 1.],
            [0., 1., 1.],
        ]
        .map(|c| Vec3::new(c[0] * size[0], c[1] * size[1], c[2] * size[2]))
    }

    #[test]
    fn verify_brick_volume() {
        let corners = brick([2.0, 3.0, 0.5]);
        assert!((trilinear_volume(&corners) - 3.0).abs() < 1e-14);
    }

    #[test]
    fn verify_twisted_volume_against_gauss_quadrature() {
        let mut corners = brick([1.0, 1.0, 1.0]);
        corners[6] += Vec3::new(0.3, 0.2, 0.4);
        corners[1] += Vec3::new(-0.1, 0.15, 0.2);
        let volume = trilinear_volume(&corners);
        // det J of a trilinear map is at most quadratic in each coordinate: 2-point Gauss is exact.
        let g = 0.5 / 3f64.sqrt();
        let signs = brick([1.0, 1.0, 1.0]).map(|c| c.map(|v| 2.0 * v - 1.0));
        let mut exact = 0.0;
        for p in signs {
            let at = p * g + Vec3::repeat(0.5);
            let mut jacobian = nalgebra::Matrix3::zeros();
            for (corner, s) in corners.iter().zip(&signs) {
                let n = |i: usize| if s[i] > 0.0 { at[i] } else { 1.0 - at[i] };
                let gradient =
                    Vec3::new(s[0] * n(1) * n(2), s[1] * n(0) * n(2), s[2] * n(0) * n(1));
                jacobian += corner * gradient.transpose();
            }
            exact += jacobian.determinant() / 8.0;
        }
        assert!((volume - exact).abs() < 1e-13, "{volume} {exact}");
    }

    /// Returns the definition, corner by corner.
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

    #[test]
    fn verify_pressure_all_around_is_in_balance_and_a_fluid_bears_the_volume() {
        let mesh = distorted([3, 3, 2]);
        let quads = mesh.boundary_quads();
        let sum = |forces: Vec<(u32, Vec3)>| forces.iter().map(|(_, force)| force).sum::<Vec3>();
        let pressed = mesh.traction_forces(&quads, |_, normal| -normal);
        assert!(sum(pressed).norm() < 1e-13);
        let buoyed = mesh.traction_forces(&quads, |place, normal| normal * place.z);
        assert!((sum(buoyed) - Vec3::new(0.0, 0.0, 18.0)).norm() < 1e-12);
    }
}
