//! The inside of a mesh follows its moved surface.

use std::collections::BTreeSet;

use crate::{HexMesh, Vec3};

/// Edges of a hexahedron in VTK's numbering.
const HEX_EDGES: [[usize; 2]; 12] = [
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

/// Relative residual at which the following is taken as solved: far below what the shape of an element can feel.
const RELATIVE_RESIDUAL: f64 = 1e-4;

/// Spreads the displacement of some nodes into the mesh, harmonically: every free node moves by
/// the mean of its neighbours along the edges.
///
/// In a stack of layers below a moved surface that is the linear interpolation between the
/// surface and the fixed backside, so an element thins but cannot invert before the stack is gone.
pub struct InteriorFollower {
    is_held: Vec<bool>,
    /// Neighbours of node i are `neighbours[first[i]..first[i + 1]]`.
    first: Vec<usize>,
    neighbours: Vec<u32>,
}

impl InteriorFollower {
    /// A follower of `mesh` whose `held` nodes take a given displacement, and the rest follow.
    pub fn new(mesh: &HexMesh, held: impl IntoIterator<Item = u32>) -> Self {
        let mut is_held = vec![false; mesh.nodes.len()];
        for node in held {
            is_held[node as usize] = true;
        }
        let edges: BTreeSet<(u32, u32)> = mesh
            .hexes
            .iter()
            .flat_map(|hex| HEX_EDGES.map(|[a, b]| (hex[a], hex[b])))
            .flat_map(|(a, b)| [(a, b), (b, a)])
            .collect();
        let mut first = vec![0; mesh.nodes.len() + 1];
        for &(a, _) in &edges {
            first[a as usize + 1] += 1;
        }
        for i in 0..mesh.nodes.len() {
            first[i + 1] += first[i];
        }
        let neighbours = edges.into_iter().map(|(_, b)| b).collect();
        Self {
            is_held,
            first,
            neighbours,
        }
    }

    /// Replaces the displacement of every node that is not held by the harmonic one.
    ///
    /// `displacement`: one vector a node; those of held nodes are the data, the others the
    /// starting guess. Conjugate gradients, preconditioned by the diagonal.
    pub fn follow(&self, displacement: &mut [Vec3]) {
        let mut residual: Vec<Vec3> = (0..displacement.len())
            .map(|i| self.pull(i, displacement))
            .collect();
        let scale = dot(&residual, &residual).sqrt();
        let mut precision = self.precondition(&residual);
        let mut direction = precision.clone();
        let mut rho = dot(&residual, &precision);
        for _ in 0..displacement.len() {
            if dot(&residual, &residual).sqrt() <= RELATIVE_RESIDUAL * scale {
                break;
            }
            let image: Vec<Vec3> = (0..direction.len())
                .map(|i| -self.pull(i, &direction))
                .collect();
            let step = rho / dot(&direction, &image);
            for i in 0..displacement.len() {
                displacement[i] += direction[i] * step;
                residual[i] -= image[i] * step;
            }
            precision = self.precondition(&residual);
            let next = dot(&residual, &precision);
            for (d, z) in direction.iter_mut().zip(&precision) {
                *d = z + *d * (next / rho);
            }
            rho = next;
        }
    }

    /// What the neighbours of node `i` pull it by: sum of w (u_j - u_i); none if it is held.
    fn pull(&self, i: usize, u: &[Vec3]) -> Vec3 {
        if self.is_held[i] {
            return Vec3::zeros();
        }
        let around = self.around(i);
        around.iter().map(|&j| u[j as usize]).sum::<Vec3>() - u[i] * around.len() as f64
    }

    fn precondition(&self, residual: &[Vec3]) -> Vec<Vec3> {
        let scaled = |(i, r): (usize, &Vec3)| r / self.around(i).len() as f64;
        residual.iter().enumerate().map(scaled).collect()
    }

    fn around(&self, i: usize) -> &[u32] {
        &self.neighbours[self.first[i]..self.first[i + 1]]
    }
}

fn dot(a: &[Vec3], b: &[Vec3]) -> f64 {
    a.iter().zip(b).map(|(u, v)| u.dot(v)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::tests::block;

    #[test]
    fn verify_uniform_push_is_linear_through_the_layers() {
        let mut mesh = block([4, 4, 3]);
        let level = |z: f64| {
            let nodes = mesh.nodes.iter().enumerate();
            nodes
                .filter(move |(_, p)| p.z == z)
                .map(|(i, _)| i as u32)
                .collect::<Vec<_>>()
        };
        let (bottom, top) = (level(0.0), level(3.0));
        let follower = InteriorFollower::new(&mesh, bottom.into_iter().chain(top.clone()));
        let mut displacement = vec![Vec3::zeros(); mesh.nodes.len()];
        for node in top {
            displacement[node as usize].z = -0.9;
        }
        follower.follow(&mut displacement);
        for (node, d) in mesh.nodes.iter_mut().zip(&displacement) {
            assert!((d.z + 0.3 * node.z).abs() < 5.0 * RELATIVE_RESIDUAL);
            *node += d;
        }
        assert!(mesh.worst_quality() > 0.99);
    }

    #[test]
    fn no_displacement_stays_none() {
        let mesh = block([2, 2, 2]);
        let follower = InteriorFollower::new(&mesh, [0]);
        let mut displacement = vec![Vec3::zeros(); mesh.nodes.len()];
        follower.follow(&mut displacement);
        assert!(displacement.iter().all(|d| d.norm() == 0.0));
    }
}
