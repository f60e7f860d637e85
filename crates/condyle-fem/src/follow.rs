//! Moves the inside of a mesh with its surface.

use crate::{
    Vec3,
    mesh::{HEX_EDGES, HexMesh},
};

/// Relative residual at which the displacement counts as solved: a hundredth of the motion of one wear step, some
/// tenths of a micrometre, is far too small to affect the shape of an element.
const RELATIVE_RESIDUAL: f64 = 1e-2;

/// Spreads the displacement of some nodes into the mesh, harmonically: every free node moves by
/// the mean of its neighbours along the edges.
///
/// In a stack of layers below a moved surface all layers thin by the same amount, so that an element cannot invert before
/// the depth is the number of layers times the thickness of the thinnest.
pub struct InteriorFollower {
    /// Nodes that are not held, ascending; "row k" is that of node `free[k]`.
    free: Vec<u32>,
    neighbours: Neighbours,
    /// The inverse of their number: the inverse of the diagonal, the preconditioner.
    scale: Vec<f64>,
}

impl InteriorFollower {
    /// Creates a follower of `mesh`: the `held` nodes take a given displacement, and all other nodes follow.
    ///
    /// # Panics
    /// If `held` or an element names a node that the mesh does not have.
    pub fn new(mesh: &HexMesh, held: impl IntoIterator<Item = u32>) -> Self {
        let mut is_held = vec![false; mesh.nodes.len()];
        for node in held {
            is_held[node as usize] = true;
        }
        let free: Vec<u32> = (0..mesh.nodes.len() as u32)
            .filter(|&node| !is_held[node as usize])
            .collect();
        let neighbours = Neighbours::along_edges(&free, mesh);
        Self {
            scale: neighbours
                .counts()
                .map(|count| 1.0 / count as f64)
                .collect(),
            free,
            neighbours,
        }
    }

    /// Replaces the displacement of every node that is not held by the harmonic one.
    ///
    /// `displacement`: one vector per node; the vectors of held nodes are the data, the others the initial guess.
    /// Conjugate gradients, preconditioned by the diagonal.
    ///
    /// # Panics
    /// If there are fewer displacements than the mesh has nodes.
    pub fn follow(&self, displacement: &mut [Vec3]) {
        // Relative to the pull of the held nodes alone, not to the first residual: with a good initial guess the
        // iteration then ends at once.
        let mut held = displacement.to_vec();
        for &node in &self.free {
            held[node as usize] = Vec3::zeros();
        }
        let pull2: f64 = self.pulls(&held).map(|pull| pull.norm_squared()).sum();
        let enough2 = (RELATIVE_RESIDUAL * pull2.sqrt()).powi(2);
        let mut residual: Vec<Vec3> = self.pulls(displacement).collect();
        let (mut length2, mut scaled2) = self.size(&residual);
        let mut direction = vec![Vec3::zeros(); displacement.len()];
        self.turn(&mut direction, &residual, 0.0);
        let mut image = vec![Vec3::zeros(); residual.len()];
        // In exact arithmetic the method ends after at most as many steps as there are unknowns.
        for _ in 0..self.free.len() {
            if length2 <= enough2 {
                break;
            }
            let step = scaled2 / self.resistance(&direction, &mut image);
            for ((residual, image), &node) in residual.iter_mut().zip(&image).zip(&self.free) {
                *residual += image * step;
                displacement[node as usize] += direction[node as usize] * step;
            }
            let before = scaled2;
            (length2, scaled2) = self.size(&residual);
            self.turn(&mut direction, &residual, scaled2 / before);
        }
    }

    /// Replaces the direction of search by the preconditioned residual plus a part of the last direction.
    fn turn(&self, direction: &mut [Vec3], residual: &[Vec3], keep: f64) {
        for ((r, scale), &node) in residual.iter().zip(&self.scale).zip(&self.free) {
            let d = &mut direction[node as usize];
            *d = r * *scale + *d * keep;
        }
    }

    /// Returns the stiffness along a direction: minus its product with its image under [`Self::pulls`], which is found
    /// on the way.
    fn resistance(&self, direction: &[Vec3], image: &mut [Vec3]) -> f64 {
        let mut resistance = 0.0;
        for ((image, pull), &node) in image.iter_mut().zip(self.pulls(direction)).zip(&self.free) {
            *image = pull;
            resistance -= pull.dot(&direction[node as usize]);
        }
        resistance
    }

    /// Returns the square of a residual's length, and its product with itself preconditioned.
    fn size(&self, residual: &[Vec3]) -> (f64, f64) {
        let parts = residual.iter().zip(&self.scale);
        parts.fold((0.0, 0.0), |(length2, scaled2), (r, scale)| {
            let own = r.norm_squared();
            (length2 + own, scaled2 + own * scale)
        })
    }

    /// Returns the pull of the neighbours on every free node: the sum of (u_j - u_i).
    fn pulls(&self, u: &[Vec3]) -> impl Iterator<Item = Vec3> {
        self.free.iter().enumerate().map(|(k, &node)| {
            let around = self.neighbours.of(k);
            let sum: Vec3 = around.iter().map(|&j| u[j as usize]).sum();
            sum - u[node as usize] * around.len() as f64
        })
    }
}

pub(crate) struct Neighbours {
    /// The neighbours of row k are `nodes[first[k]..first[k + 1]]`, ascending.
    first: Vec<usize>,
    nodes: Vec<u32>,
}

impl Neighbours {
    /// Finds the neighbours of nodes in a mesh; row k belongs to node `rows[k]`.
    pub(crate) fn along_edges(rows: &[u32], mesh: &HexMesh) -> Self {
        // An edge is met once in every hexahedron around it: all are put into their node's place
        // first, and there are few enough of them to sort.
        let mut place = vec![0; mesh.nodes.len() + 1];
        both_ways(mesh, |from, _| place[from as usize + 1] += 1);
        for node in 0..mesh.nodes.len() {
            place[node + 1] += place[node];
        }
        let start = place.clone();
        let mut met = vec![0; start[mesh.nodes.len()]];
        both_ways(mesh, |from, to| {
            met[place[from as usize]] = to;
            place[from as usize] += 1;
        });
        let (mut first, mut nodes) = (vec![0], Vec::new());
        for &row in rows {
            let around = &mut met[start[row as usize]..start[row as usize + 1]];
            around.sort_unstable();
            nodes.extend(around.chunk_by(u32::eq).map(|same| same[0]));
            first.push(nodes.len());
        }
        Self { first, nodes }
    }

    #[inline]
    pub(crate) fn of(&self, k: usize) -> &[u32] {
        &self.nodes[self.first[k]..self.first[k + 1]]
    }

    pub(crate) fn counts(&self) -> impl Iterator<Item = usize> {
        self.first.windows(2).map(|ends| ends[1] - ends[0])
    }
}

/// Calls `visit` with every edge of every hexahedron both ways.
fn both_ways(mesh: &HexMesh, mut visit: impl FnMut(u32, u32)) {
    for hex in mesh.hexes.iter() {
        for &[a, b] in &HEX_EDGES {
            visit(hex[a], hex[b]);
            visit(hex[b], hex[a]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::block;

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
            assert!((d.z + 0.3 * node.z).abs() < 5e-3);
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

    #[test]
    fn a_corner_has_three_neighbours_and_a_middle_node_six() {
        let mesh = block([2, 2, 2]);
        let neighbours = Neighbours::along_edges(&[0, 13], &mesh);
        assert_eq!(neighbours.of(0), [1, 3, 9]);
        assert_eq!(neighbours.of(1), [4, 10, 12, 14, 16, 22]);
        assert!(neighbours.counts().eq([3, 6]));
    }
}
