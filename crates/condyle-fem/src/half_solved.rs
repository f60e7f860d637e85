//! What forces do to a solid, solved half way: enough for what one force moves along another.

use std::ops::Range;

use wide::f64x4;

use crate::{
    solid::ElasticSolid,
    sparse::{Factor, Rhs},
    vector::Vec3,
};

/// Vectors of forces that go side by side.
const VECTORS: usize = 3;
type Strip = Rhs<VECTORS>;
/// Four forces by all that go side by side: twelve sums stay in registers.
type Sums = [[f64x4; VECTORS]; 4];

/// Some forces on a solid, each alone, solved half way.
///
/// With the stiffness K = L L' and forces a and b, what b moves along a is
///
/// $$ a^T K^{-1} b = (L^{-1} a) \cdot (L^{-1} b) : $$
///
/// a product over the part of the factor that feels both. Where few places of a large solid are of interest that is
/// far less than to solve for all that moves, and it is as exact.
#[derive(Clone, Debug)]
pub struct HalfSolved {
    forces: usize,
    /// Groups of the factor that feel a force, ascending, and the rows of each.
    groups: Vec<(usize, Range<usize>)>,
    /// The rows of all those groups, for as many forces as go side by side.
    strips: Vec<Vec<[f64x4; VECTORS]>>,
}

impl ElasticSolid {
    /// Forces on nodes, each alone, solved half way.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn half_solved(&self, forces: &[(u32, Vec3)]) -> HalfSolved {
        let alone: Vec<&[(u32, Vec3)]> = forces.iter().map(std::slice::from_ref).collect();
        self.half_solved_sums(&alone)
    }

    /// The same of sums of forces: each of `forces` is one, of forces on some nodes. What a node is held against it does
    /// not feel.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn half_solved_sums(&self, forces: &[&[(u32, Vec3)]]) -> HalfSolved {
        let factor = &self.factor;
        let places = forces.iter().copied().flatten();
        let places = places.filter_map(|&(node, _)| factor.dissection.place(node));
        let felt = factor.paths(places);
        let felt: Vec<usize> = (0..felt.len()).filter(|&group| felt[group]).collect();
        let mut memory = Strip::new(factor.freedoms());
        let strips = forces.chunks(Strip::COLUMNS).map(|forces| {
            self.load(forces, &mut memory);
            factor.solve_half(&felt, &mut memory)
        });
        HalfSolved {
            forces: forces.len(),
            strips: strips.collect(),
            groups: rows_of(factor, &felt),
        }
    }

    /// Puts sums of forces in zeros.
    fn load(&self, forces: &[&[(u32, Vec3)]], zeros: &mut Strip) {
        for (column, forces) in forces.iter().enumerate() {
            for &(node, force) in *forces {
                if let Some(place) = self.factor.dissection.place(node) {
                    for (k, component) in self.felt(node, force).iter().enumerate() {
                        *zeros.at_mut(3 * place as usize + k, column) += *component;
                    }
                }
            }
        }
    }
}

/// The rows of groups, one after the other.
fn rows_of(factor: &Factor, groups: &[usize]) -> Vec<(usize, Range<usize>)> {
    let mut end = 0;
    let rows = groups.iter().map(|&group| {
        let start = end;
        end += factor.own_freedoms(group).len();
        (group, start..end)
    });
    rows.collect()
}

impl HalfSolved {
    /// How many forces there are.
    pub fn forces(&self) -> usize {
        self.forces
    }

    /// How far each force here moves the place of each of the others along it, row-major, a row for each force
    /// here; as far as those move the places of these, so the same bytes come the other way round.
    pub fn moved_along(&self, others: &Self) -> Vec<f64> {
        let common = self.common_rows(others);
        let mut moved = vec![0.0; self.forces * others.forces];
        for (at, own) in self.strips.iter().enumerate() {
            for (four, row) in (Strip::COLUMNS * at..self.forces)
                .step_by(4)
                .enumerate()
                .take(VECTORS)
            {
                for (at, other) in others.strips.iter().enumerate() {
                    let sums = products(own, other, four, &common);
                    let place = [row, Strip::COLUMNS * at];
                    put(&mut moved, [self.forces, others.forces], place, &sums);
                }
            }
        }
        moved
    }

    /// Rows here and there of the groups that feel forces of both.
    fn common_rows(&self, others: &Self) -> Vec<[Range<usize>; 2]> {
        let mut theirs = others.groups.iter().peekable();
        let mut common = Vec::new();
        for (group, own) in &self.groups {
            while theirs.next_if(|(other, _)| other < group).is_some() {}
            if let Some((_, other)) = theirs.next_if(|(other, _)| other == group) {
                common.push([own.clone(), other.clone()]);
            }
        }
        common
    }
}

/// Products of four forces with those of another strip.
fn products(
    own: &[[f64x4; VECTORS]],
    other: &[[f64x4; VECTORS]],
    four: usize,
    common: &[[Range<usize>; 2]],
) -> Sums {
    let mut sums = [[f64x4::ZERO; VECTORS]; 4];
    for [rows, other_rows] in common {
        for (own, other) in own[rows.clone()].iter().zip(&other[other_rows.clone()]) {
            for (sums, &number) in sums.iter_mut().zip(own[four].as_array()) {
                let number = f64x4::splat(number);
                for (sum, other) in sums.iter_mut().zip(other) {
                    *sum = other.mul_add(number, *sum);
                }
            }
        }
    }
    sums
}

/// Puts sums to their place in a row-major matrix of that size, as far as it goes.
fn put(matrix: &mut [f64], [rows, columns]: [usize; 2], [row, column]: [usize; 2], sums: &Sums) {
    for (row, sums) in (row..rows).zip(sums) {
        let numbers = sums.iter().flat_map(|sum| *sum.as_array());
        for (column, number) in (column..columns).zip(numbers) {
            matrix[row * columns + column] = number;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Elastic, solid::tests::distorted};

    #[test]
    fn products_are_what_forces_move() {
        let mesh = distorted([9, 8, 4]);
        let held = (0..90).filter(|&n| mesh.nodes[n as usize].z == 0.0);
        let elastic = Elastic::new(463.0, 0.46).unwrap();
        let solid = ElasticSolid::new(&mesh, elastic, held).unwrap();
        // Some of the top, one that is held, and one at the side, in no order.
        let mut nodes: Vec<u32> = (0..40).map(|i| 360 + (i * 37) % 90).collect();
        nodes.extend([3, 95]);
        let direction = |n: u32| Vec3::new(0.1, f64::from(n).sin(), -1.0).normalize();
        let forces: Vec<(u32, Vec3)> = nodes.iter().map(|&n| (n, direction(n))).collect();
        for (one, other) in [(&forces[..17], &forces[17..]), (&forces[3..], &forces[..])] {
            let (half, other_half) = (solid.half_solved(one), solid.half_solved(other));
            let moved = half.moved_along(&other_half);
            let back = other_half.moved_along(&half);
            for (i, &(node, force)) in one.iter().enumerate() {
                let by_one = solid.displacements(&[(node, force)]);
                for (j, (other_node, along)) in other.iter().enumerate() {
                    let exact = by_one[*other_node as usize].dot(along);
                    assert!((moved[i * other.len() + j] - exact).abs() < 1e-15);
                    assert_eq!(moved[i * other.len() + j], back[j * one.len() + i]);
                }
            }
        }
    }
}
