//! The inside of a mesh follows its moved surface.

use crate::{HexMesh, Vec3, hex::HEX_EDGES};

/// Relative residual at which the following is taken as solved: far below what the shape of an element can feel.
const RELATIVE_RESIDUAL: f64 = 1e-3;

/// Spreads the displacement of some nodes into the mesh, harmonically: every free node moves by
/// the mean of its neighbours along the edges.
///
/// In a stack of layers below a moved surface that is the linear interpolation between the
/// surface and the fixed backside, so an element thins but cannot invert before the stack is gone.
pub struct InteriorFollower {
    /// Nodes that are not held, ascending; "row k" is that of node `free[k]`.
    free: Vec<u32>,
    /// Neighbours of row k are `neighbours[first[k]..first[k + 1]]`.
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
        let free: Vec<u32> = (0..mesh.nodes.len() as u32)
            .filter(|&node| !is_held[node as usize])
            .collect();
        let (first, neighbours) = neighbours_of(&free, mesh);
        Self {
            free,
            first,
            neighbours,
        }
    }

    /// Replaces the displacement of every node that is not held by the harmonic one.
    ///
    /// `displacement`: one vector a node; those of held nodes are the data, the others the
    /// starting guess. Conjugate gradients, preconditioned by the diagonal.
    pub fn follow(&self, displacement: &mut [Vec3]) {
        let enough2 = (RELATIVE_RESIDUAL * self.pull_of_held(displacement)).powi(2);
        let mut residual: Vec<Vec3> = self.pulls(displacement).collect();
        let mut direction = vec![Vec3::zeros(); displacement.len()];
        let mut image = vec![Vec3::zeros(); residual.len()];
        let mut rho = f64::INFINITY;
        for _ in 0..self.free.len() {
            if dot(&residual, &residual) <= enough2 {
                break;
            }
            let next = self.turn(&mut direction, &residual, rho);
            rho = next;
            let mut resistance = 0.0;
            for ((image, pull), &node) in
                image.iter_mut().zip(self.pulls(&direction)).zip(&self.free)
            {
                *image = pull;
                resistance -= pull.dot(&direction[node as usize]);
            }
            let step = rho / resistance;
            for ((residual, image), &node) in residual.iter_mut().zip(&image).zip(&self.free) {
                *residual += image * step;
                displacement[node as usize] += direction[node as usize] * step;
            }
        }
    }

    /// The next direction of search, from the last one and the scaled residual; returns their
    /// product.
    fn turn(&self, direction: &mut [Vec3], residual: &[Vec3], rho: f64) -> f64 {
        let scale = |k: usize| 1.0 / (self.first[k + 1] - self.first[k]) as f64;
        let rows = || residual.iter().enumerate();
        let next: f64 = rows().map(|(k, r)| r.norm_squared() * scale(k)).sum();
        let keep = next / rho;
        for (k, r) in rows() {
            let d = &mut direction[self.free[k] as usize];
            *d = r * scale(k) + *d * keep;
        }
        next
    }

    /// What the neighbours of every free node pull it by: sum of (u_j - u_i).
    fn pulls(&self, u: &[Vec3]) -> impl Iterator<Item = Vec3> {
        self.free.iter().enumerate().map(|(k, &node)| {
            let around = self.around(k);
            let sum: Vec3 = around.iter().map(|&j| u[j as usize]).sum();
            sum - u[node as usize] * around.len() as f64
        })
    }

    /// Length of what the held nodes alone pull by.
    fn pull_of_held(&self, displacement: &[Vec3]) -> f64 {
        let mut held = displacement.to_vec();
        for &node in &self.free {
            held[node as usize] = Vec3::zeros();
        }
        self.pulls(&held)
            .map(|pull| pull.norm_squared())
            .sum::<f64>()
            .sqrt()
    }

    fn around(&self, k: usize) -> &[u32] {
        &self.neighbours[self.first[k]..self.first[k + 1]]
    }
}

/// The neighbours along the edges of every free node, ascending, and where each node's begin.
///
/// An edge is met once in every hexahedron around it: all are put into their node's place first,
/// and there are few enough of them to sort.
fn neighbours_of(free: &[u32], mesh: &HexMesh) -> (Vec<usize>, Vec<u32>) {
    let edges = || {
        let both_ways =
            |hex: &[u32; 8]| HEX_EDGES.map(|[a, b]| [(hex[a], hex[b]), (hex[b], hex[a])]);
        mesh.hexes
            .iter()
            .flat_map(move |hex| both_ways(hex).into_iter().flatten())
    };
    let mut place = vec![0; mesh.nodes.len() + 1];
    for (from, _) in edges() {
        place[from as usize + 1] += 1;
    }
    for node in 0..mesh.nodes.len() {
        place[node + 1] += place[node];
    }
    let start = place.clone();
    let mut met = vec![0; start[mesh.nodes.len()]];
    for (from, to) in edges() {
        met[place[from as usize]] = to;
        place[from as usize] += 1;
    }
    let (mut first, mut neighbours) = (vec![0], Vec::new());
    for &node in free {
        let around = &mut met[start[node as usize]..start[node as usize + 1]];
        around.sort_unstable();
        neighbours.extend(around.chunk_by(u32::eq).map(|same| same[0]));
        first.push(neighbours.len());
    }
    (first, neighbours)
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
