//! A mesh of hexahedra: nodes, elements, boundary.

use std::sync::Arc;

use crate::{
    hex::{HEX_FACES, trilinear_volume},
    vector::Vec3,
};

/// A mesh of 8-node hexahedra.
///
/// Clones share the numbers of the nodes, which stay when nodes move.
#[derive(Clone, Debug, PartialEq)]
pub struct HexMesh {
    /// Node positions.
    pub nodes: Vec<Vec3>,
    /// Node numbers of each hexahedron, from 0, in VTK order.
    pub hexes: Arc<[[u32; 8]]>,
}

impl HexMesh {
    /// Positions of the eight corners of hexahedron `hex`.
    ///
    /// # Panics
    /// If there is no such hexahedron, or it names a node that there is not.
    pub fn corners(&self, hex: usize) -> [Vec3; 8] {
        self.hexes[hex].map(|node| self.nodes[node as usize])
    }

    /// Positions of some nodes.
    pub fn positions(&self, nodes: &[u32]) -> impl Iterator<Item = Vec3> {
        nodes.iter().map(|&node| self.nodes[node as usize])
    }

    /// Volume of the whole mesh, each element with bilinear faces.
    ///
    /// # Panics
    /// If an element names a node that there is not.
    pub fn volume(&self) -> f64 {
        (0..self.hexes.len())
            .map(|hex| trilinear_volume(&self.corners(hex)))
            .sum()
    }

    /// The quads that belong to one hexahedron only, anticlockwise seen from outside,
    /// in the order of the elements.
    ///
    /// # Panics
    /// If an element names a node that there is not.
    pub fn boundary_quads(&self) -> Vec<[u32; 4]> {
        let shared = self.shared_quads();
        let alone = shared
            .iter()
            .enumerate()
            .filter(|(_, is_shared)| !**is_shared);
        alone.map(|(quad, _)| self.quad(quad)).collect()
    }

    /// Whether each quad belongs to another hexahedron too.
    ///
    /// Every quad is compared with those before it that have the same lowest node: a few.
    fn shared_quads(&self) -> Vec<bool> {
        const NONE: u32 = u32::MAX;
        let count = HEX_FACES.len() * self.hexes.len();
        let mut is_shared = vec![false; count];
        let mut newest = vec![NONE; self.nodes.len()];
        let mut older = vec![NONE; count];
        for here in 0..count {
            let quad = sorted(self.quad(here));
            older[here] = std::mem::replace(&mut newest[quad[0] as usize], here as u32);
            let mut other = older[here];
            while other != NONE {
                let at = other as usize;
                if sorted(self.quad(at)) == quad {
                    (is_shared[at], is_shared[here]) = (true, true);
                }
                other = older[at];
            }
        }
        is_shared
    }

    /// A quad by its number: six to an element.
    fn quad(&self, number: usize) -> [u32; 4] {
        let (hex, face) = (number / HEX_FACES.len(), number % HEX_FACES.len());
        HEX_FACES[face].map(|corner| self.hexes[hex][corner])
    }
}

fn sorted(mut quad: [u32; 4]) -> [u32; 4] {
    quad.sort_unstable();
    quad
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// A block of `n` unit cubes along each axis, nodes numbered x fastest, then y, then z.
    pub(crate) fn block(n: [usize; 3]) -> HexMesh {
        let id = |i: usize, j: usize, k: usize| (i + (n[0] + 1) * (j + (n[1] + 1) * k)) as u32;
        let mut nodes = Vec::new();
        for k in 0..=n[2] {
            for j in 0..=n[1] {
                for i in 0..=n[0] {
                    nodes.push(Vec3::new(i as f64, j as f64, k as f64));
                }
            }
        }
        let mut hexes = Vec::new();
        for k in 0..n[2] {
            for j in 0..n[1] {
                for i in 0..n[0] {
                    let quad = |k| {
                        [
                            id(i, j, k),
                            id(i + 1, j, k),
                            id(i + 1, j + 1, k),
                            id(i, j + 1, k),
                        ]
                    };
                    let ([a, b, c, d], [e, f, g, h]) = (quad(k), quad(k + 1));
                    hexes.push([a, b, c, d, e, f, g, h]);
                }
            }
        }
        HexMesh {
            nodes,
            hexes: hexes.into(),
        }
    }

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
}
