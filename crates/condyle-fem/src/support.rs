//! Supports that move: their effect on a solid that they hold.
//!
//! With the stiffness K parted into free nodes f and held nodes h, a motion u of what is held takes the free nodes
//! along as forces -K_fh u would, and needs the forces K_hh u besides the reaction to those.

use std::collections::BTreeMap;

use nalgebra::SVector;

use crate::{Vec3, compliance::HalfSolved, solid::ElasticSolid};

type Motion = [(u32, Vec3)];

/// Motions of the supports of a solid, each alone: as forces on its free nodes, solved half way, and their stiffness.
///
/// With forces b on the solid and its supports moved by $u = \sum_j q_j u_j$ the supports push with the forces R along the
/// motions,
///
/// $$ R = S q - B^T b, \qquad S_{jk} = u_j \cdot K_{hh} u_k - z_j \cdot z_k, \qquad z_j = -L^{-1} K_{fh} u_j, $$
///
/// and b moves by B q besides what it moves alone, with $B_{ij} = (L^{-1} b_i) \cdot z_j$. The condensed stiffness S is
/// symmetric, and without force for motions of the whole as a rigid body.
#[derive(Clone, Debug)]
pub struct MovedSupports {
    /// The forces $-K_{fh} u$ that each motion is to the free nodes, solved half way, in groups that lie together.
    pub solved: Vec<HalfSolved>,
    /// S, row-major, a row and a column for each motion, in the order of the groups.
    pub stiffness: Vec<f64>,
}

impl ElasticSolid {
    /// Condenses the solid to motions of held nodes, each alone, in groups of motions that lie together.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn moved_supports(&self, groups: &[Vec<Vec<(u32, Vec3)>>]) -> MovedSupports {
        let motions: Vec<&Motion> = groups.iter().flatten().map(Vec::as_slice).collect();
        let forces = self.forces_by_supports(&motions);
        let mut left = forces.as_slice();
        let solved: Vec<HalfSolved> = groups
            .iter()
            .map(|group| {
                let (own, others) = left.split_at(group.len());
                left = others;
                let pushed = own.iter().map(|forces| -> Vec<(u32, Vec3)> {
                    let forces = forces.iter();
                    forces.map(|(&node, force)| (node, -force)).collect()
                });
                let pushed: Vec<_> = pushed.collect();
                self.half_solved_sums(&pushed.iter().map(Vec::as_slice).collect::<Vec<_>>())
            })
            .collect();
        // Work of the forces of each motion on every other, with the free nodes fixed ...
        let count = motions.len();
        let mut stiffness = Vec::with_capacity(count * count);
        for moved in &motions {
            for forces in &forces {
                let works = moved.iter();
                let works = works.filter_map(|(node, by)| Some(forces.get(node)?.dot(by)));
                stiffness.push(works.sum::<f64>());
            }
        }
        // ... less the products of the half-solved forces, since the free nodes deflect.
        let mut first_row = 0;
        for one in &solved {
            let mut first_column = 0;
            for other in &solved {
                let products = one.moved_along(other);
                for (row, products) in products.chunks_exact(other.forces()).enumerate() {
                    let own = &mut stiffness[(first_row + row) * count + first_column..];
                    for (own, product) in own.iter_mut().zip(products) {
                        *own -= product;
                    }
                }
                first_column += other.forces();
            }
            first_row += one.forces();
        }
        MovedSupports { solved, stiffness }
    }

    /// Displacements of all nodes under forces, with the supports moved.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn displacements_with_supports(
        &self,
        forces: &[(u32, Vec3)],
        moved: &[(u32, Vec3)],
    ) -> Vec<Vec3> {
        let pushed = self.forces_by_supports(&[moved]);
        let pushed = pushed.iter().flatten();
        let mut all = forces.to_vec();
        all.extend(pushed.map(|(&node, force)| (node, -force)));
        let mut displacements = self.displacements(&all);
        for &(node, by) in moved {
            displacements[node as usize] += by;
        }
        displacements
    }

    /// Forces on nodes, K u, that hold the solid with some nodes moved and all others where they were.
    fn forces_by_supports(&self, motions: &[&Motion]) -> Vec<BTreeMap<u32, Vec3>> {
        let mut motions_of: BTreeMap<u32, Vec<(usize, Vec3)>> = BTreeMap::new();
        for (motion, moved) in motions.iter().enumerate() {
            for &(node, by) in *moved {
                motions_of.entry(node).or_default().push((motion, by));
            }
        }
        let mut forces = vec![BTreeMap::new(); motions.len()];
        for (element, hex) in self.mesh().hexes.iter().enumerate() {
            let mut moved: BTreeMap<usize, SVector<f64, 24>> = BTreeMap::new();
            for (corner, node) in hex.iter().enumerate() {
                for &(motion, by) in motions_of.get(node).into_iter().flatten() {
                    let all = moved.entry(motion).or_insert_with(SVector::zeros);
                    let mut own = all.fixed_rows_mut::<3>(3 * corner);
                    own += by;
                }
            }
            if moved.is_empty() {
                continue;
            }
            let element = self.element(element);
            let stiffness = element.stiffness(&self.elastic()).condensed();
            for (motion, moved) in moved {
                let own = stiffness * moved;
                for (corner, &node) in hex.iter().enumerate() {
                    let sum = forces[motion].entry(node).or_insert_with(Vec3::zeros);
                    *sum += own.fixed_rows::<3>(3 * corner);
                }
            }
        }
        forces
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::{nodes_where, standing};

    fn held(solid: &ElasticSolid) -> Vec<u32> {
        nodes_where(solid.mesh(), |place| place.z == 0.0)
    }

    #[test]
    fn verify_supports_that_move_as_a_rigid_body_take_all_along_without_force() {
        let solid = standing([4, 3, 3]);
        let (mesh, held) = (solid.mesh(), held(&solid));
        let (turn, shift) = (Vec3::new(0.01, -0.02, 0.03), Vec3::new(0.1, 0.2, -0.3));
        let rigid = |node: u32| turn.cross(&mesh.nodes[node as usize]) + shift;
        let moved: Vec<(u32, Vec3)> = held.iter().map(|&node| (node, rigid(node))).collect();
        let displacements = solid.displacements_with_supports(&[], &moved);
        for (node, by) in displacements.iter().enumerate() {
            assert!((by - rigid(node as u32)).norm() < 1e-12);
        }
        let supports = solid.moved_supports(&[vec![moved]]);
        assert!(supports.stiffness[0].abs() < 1e-10);
    }

    #[test]
    fn verify_what_supports_need_is_what_takes_the_solid_there() {
        // The forces that move single supports, against a solid of which those nodes are free.
        let solid = standing([4, 3, 3]);
        let (mesh, held) = (solid.mesh(), held(&solid));
        let (free, still) = held.split_at(2);
        let looser = ElasticSolid::new(mesh, solid.elastic(), still.iter().copied()).unwrap();
        let axes = [Vec3::x(), Vec3::y(), Vec3::z()];
        let motions = |node: u32| axes.map(|axis| vec![(node, axis)]).to_vec();
        let supports = solid.moved_supports(&[motions(free[0]), motions(free[1])]);
        let stiffness = nalgebra::DMatrix::from_row_slice(6, 6, &supports.stiffness);
        let inverse = stiffness.try_inverse().unwrap();
        for column in 0..6 {
            let force = (free[column / 3], axes[column % 3]);
            let moved = looser.displacements(&[force]);
            for row in 0..6 {
                let exact = moved[free[row / 3] as usize][row % 3];
                assert!((inverse[(row, column)] - exact).abs() < 1e-12);
            }
        }
        // A force on top moves by Betti as much along the motion as the motion moves it.
        let top = (mesh.nodes.len() as u32 - 1, Vec3::new(0.3, -0.2, 1.0));
        let by_motion = solid.half_solved(&[top]).moved_along(&supports.solved[1]);
        for (axis, by) in axes.iter().zip(by_motion) {
            let moved = solid.displacements_with_supports(&[], &[(free[1], *axis)]);
            assert!((moved[top.0 as usize].dot(&top.1) - by).abs() < 1e-12);
        }
    }
}
