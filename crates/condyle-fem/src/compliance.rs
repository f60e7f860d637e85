//! Displacements of some nodes of a solid under forces on them.

use std::ops::Range;

use wide::f64x4;

use crate::{
    Vec3,
    solid::ElasticSolid,
    sparse::{Factor, Rhs},
};

/// Vectors of right-hand sides that are solved side by side: twelve sums stay in registers.
const VECTORS: usize = 3;
type Columns = Rhs<VECTORS>;

/// Number of right-hand sides that are solved with a front while it is in the cache.
const AT_ONCE: usize = 8 * Columns::COLUMNS;

impl ElasticSolid {
    /// Returns the displacements of `nodes` by forces on other nodes, each acting alone: row-major, row `3 i + k` is the
    /// displacement of node `i` along axis `k`, and column `j` belongs to force `j`.
    ///
    /// By reciprocity it is also the displacement by forces on `nodes`, such as those of an eigenstrain
    /// ([`YieldingElement::forces`](crate::YieldingElement::forces)), along the other forces. A force along a held
    /// direction causes no displacement. A column has the same bytes whatever the other columns are, on every run.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn influence(&self, nodes: &[u32], forces: &[(u32, Vec3)]) -> Vec<f64> {
        let mut displacements = vec![0.0; 3 * nodes.len() * forces.len()];
        let place = |node: u32| self.factor.dissection.place(node);
        let free = |(i, node)| Some((place(node)?, i));
        let rows: Vec<(u32, usize)> = nodes.iter().copied().enumerate().filter_map(free).collect();
        // Back substitution goes only to the groups of these rows.
        let wanted = self.factor.paths(rows.iter().map(|&(place, _)| place));
        // Forces that are near in the order of elimination load the same fronts.
        let loaded = forces.iter().map(|&(node, _)| node).enumerate();
        let mut columns: Vec<(u32, usize)> = loaded.filter_map(free).collect();
        columns.sort_unstable();
        let felt: Vec<Vec3> = forces.iter().map(|&(node, f)| self.felt(node, f)).collect();
        for some in columns.chunks(AT_ONCE) {
            let solved = solved(&self.factor, some, &felt, &wanted);
            for (solved, some) in solved.iter().zip(some.chunks(Columns::COLUMNS)) {
                for &(place, node) in &rows {
                    for k in 0..3 {
                        let row = &mut displacements[(3 * node + k) * forces.len()..];
                        for (column, &(_, force)) in some.iter().enumerate() {
                            row[force] = solved.at(3 * place as usize + k, column);
                        }
                    }
                }
            }
        }
        displacements
    }
}

/// Solves for the displacements by forces at places, with as many columns side by side as possible.
fn solved(
    factor: &Factor,
    columns: &[(u32, usize)],
    felt: &[Vec3],
    wanted: &[bool],
) -> Vec<Columns> {
    let (mut solved, mut loaded) = (Vec::new(), Vec::new());
    for some in columns.chunks(Columns::COLUMNS) {
        let mut x = Columns::new(factor.freedoms());
        for (column, &(place, force)) in some.iter().enumerate() {
            for (k, component) in felt[force].iter().enumerate() {
                *x.at_mut(3 * place as usize + k, column) = *component;
            }
        }
        solved.push(x);
        loaded.push(factor.paths(some.iter().map(|&(place, _)| place)));
    }
    factor.solve_some(&mut solved, &loaded, wanted);
    solved
}

/// Products of four forces with all forces side by side: twelve sums stay in registers.
type Sums = [[f64x4; VECTORS]; 4];

/// Some forces on a solid, each acting alone, solved half way.
///
/// With the stiffness K = L L' and forces a and b, the displacement by b along a is
///
/// $$ a^T K^{-1} b = (L^{-1} a) \cdot (L^{-1} b) : $$
///
/// a product over the part of the factor that both forces affect. If few places of a large solid are of interest,
/// this is much less work than a full solution, and as exact.
#[derive(Clone, Debug)]
pub struct HalfSolved {
    forces: usize,
    /// Groups of the factor that feel a force, ascending, and the rows of each.
    groups: Vec<(usize, Range<usize>)>,
    /// The rows of all those groups, for the forces that are solved side by side.
    strips: Vec<Vec<[f64x4; VECTORS]>>,
}

impl ElasticSolid {
    /// Solves forces on nodes, each acting alone, half way.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn half_solved(&self, forces: &[(u32, Vec3)]) -> HalfSolved {
        let alone: Vec<&[(u32, Vec3)]> = forces.iter().map(std::slice::from_ref).collect();
        self.half_solved_sums(&alone)
    }

    /// Solves sums of forces half way: each of `forces` is one, of forces on some nodes.
    ///
    /// # Panics
    /// If there is no such node.
    pub(crate) fn half_solved_sums(&self, forces: &[&[(u32, Vec3)]]) -> HalfSolved {
        let factor = &self.factor;
        let places = forces.iter().copied().flatten();
        let places = places.filter_map(|&(node, _)| factor.dissection.place(node));
        let felt = factor.paths(places);
        let felt: Vec<usize> = (0..felt.len()).filter(|&group| felt[group]).collect();
        let mut memory = Columns::new(factor.freedoms());
        let strips = forces.chunks(Columns::COLUMNS).map(|forces| {
            for (column, forces) in forces.iter().enumerate() {
                for &(node, force) in *forces {
                    if let Some(place) = factor.dissection.place(node) {
                        for (k, component) in self.felt(node, force).iter().enumerate() {
                            *memory.at_mut(3 * place as usize + k, column) += *component;
                        }
                    }
                }
            }
            factor.solve_half(&felt, &mut memory)
        });
        let strips = strips.collect();
        let mut end = 0;
        let groups = felt.iter().map(|&group| {
            let start = end;
            end += factor.own_freedoms(group).len();
            (group, start..end)
        });
        HalfSolved {
            forces: forces.len(),
            groups: groups.collect(),
            strips,
        }
    }
}

impl HalfSolved {
    /// Returns the number of forces.
    pub fn forces(&self) -> usize {
        self.forces
    }

    /// Returns the displacement by each force here at each of the others and along it, row-major, a row for each
    /// force here. By reciprocity, exchanging the two gives the bytes of the transpose.
    pub fn moved_along(&self, others: &Self) -> Vec<f64> {
        let common = self.common_rows(others);
        let mut moved = vec![0.0; self.forces * others.forces];
        for (at, own) in self.strips.iter().enumerate() {
            for (four, row) in (Columns::COLUMNS * at..self.forces)
                .step_by(4)
                .enumerate()
                .take(VECTORS)
            {
                for (at, other) in others.strips.iter().enumerate() {
                    let sums = products(own, other, four, &common);
                    for (row, sums) in (row..self.forces).zip(&sums) {
                        let numbers = sums.iter().flat_map(|sum| *sum.as_array());
                        let columns = Columns::COLUMNS * at..others.forces;
                        for (column, number) in columns.zip(numbers) {
                            moved[row * others.forces + column] = number;
                        }
                    }
                }
            }
        }
        moved
    }

    /// Returns the rows, here and in `others`, of the groups that forces of both affect.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::standing;

    /// Some of the top, one that is held, and one at the side, in no order.
    fn some_nodes() -> Vec<u32> {
        (0..40)
            .map(|i| 360 + (i * 37) % 90)
            .chain([3, 95])
            .collect()
    }

    fn direction(node: u32) -> Vec3 {
        Vec3::new(0.1, f64::from(node).sin(), -1.0).normalize()
    }

    #[test]
    fn columns_are_the_displacements_by_single_forces() {
        let (solid, nodes) = (standing([9, 8, 4]), some_nodes());
        let directions: Vec<Vec3> = nodes.iter().map(|&n| direction(n)).collect();
        let forces: Vec<_> = nodes
            .iter()
            .copied()
            .zip(directions.iter().copied())
            .collect();
        let moved = solid.influence(&nodes, &forces);
        let displacement =
            |node: usize, force: usize| Vec3::from_fn(|k, _| moved[(3 * node + k) * 42 + force]);
        assert_eq!(moved.len(), 3 * 42 * 42);
        for (j, (&node, &direction)) in nodes.iter().zip(&directions).enumerate() {
            let alone = solid.displacements(&[(node, direction)]);
            for (i, &node) in nodes.iter().enumerate() {
                let found = displacement(i, j);
                assert!((found - alone[node as usize]).norm() < 1e-15);
            }
            assert_eq!(displacement(40, j), Vec3::zeros());
        }
        // Work is the same whichever force comes first (Betti).
        for (i, j) in [(0, 7), (12, 33), (41, 5)] {
            let work = |a: usize, b: usize| displacement(a, b).dot(&directions[a]);
            assert!((work(i, j) - work(j, i)).abs() < 1e-15);
        }
    }

    #[test]
    fn products_are_what_forces_move() {
        let (solid, nodes) = (standing([9, 8, 4]), some_nodes());
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
