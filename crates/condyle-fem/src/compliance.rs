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

/// Number of vectors of right-hand sides that are solved with a front while it is in the cache.
const STRIPS_AT_ONCE: usize = 8;

impl ElasticSolid {
    /// Returns the displacements of some nodes by each of some forces that are solved half way, three numbers a node, in
    /// single precision since there are many.
    ///
    /// The displacements by a force have the same bytes whatever the other forces are, on every run.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn displacements_by_each(
        &self,
        half_solved: &[&HalfSolved],
        nodes: &[u32],
    ) -> Vec<Vec<f32>> {
        let strips = half_solved.iter().flat_map(|half| {
            let columns = |strip| Columns::COLUMNS.min(half.forces - Columns::COLUMNS * strip);
            (0..half.strips.len()).map(move |strip| (half, strip, columns(strip)))
        });
        let strips: Vec<(&&HalfSolved, usize, usize)> = strips.collect();
        let mut all = Vec::new();
        for some in strips.chunks(STRIPS_AT_ONCE) {
            let xs = some.iter();
            let xs = xs.map(|&(half, strip, _)| half.rows_of(strip, &self.factor));
            let mut xs: Vec<Columns> = xs.collect();
            self.factor.backward_all(&mut xs);
            let places = nodes.iter().map(|&node| self.factor.dissection.place(node));
            let places: Vec<Option<u32>> = places.collect();
            for (x, &(.., columns)) in xs.iter().zip(some) {
                all.extend((0..columns).map(|column| {
                    let number = |place: Option<u32>, k| {
                        place.map_or(0.0, |place| x.at(3 * place as usize + k, column) as f32)
                    };
                    let numbers = |&place| [0, 1, 2].map(|k| number(place, k));
                    places.iter().flat_map(numbers).collect()
                }));
            }
        }
        all
    }
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

    /// Returns some of the forces as right-hand sides of the second half of the solution.
    fn rows_of(&self, strip: usize, factor: &Factor) -> Columns {
        let mut x = Columns::new(factor.freedoms());
        for (group, rows) in &self.groups {
            let own = &self.strips[strip][rows.clone()];
            x.rows[factor.own_freedoms(*group)].copy_from_slice(own);
        }
        x
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
        let halves = [&forces[..17], &forces[17..]].map(|some| solid.half_solved(some));
        let all: Vec<u32> = (0..solid.mesh().nodes.len() as u32).collect();
        let moved = solid.displacements_by_each(&[&halves[0], &halves[1]], &all);
        assert_eq!(moved.len(), 42);
        for (&force, moved) in forces.iter().zip(&moved) {
            let alone = solid.displacements(&[force]);
            let largest = alone.iter().map(Vec3::amax).fold(0.0, f64::max);
            for (found, exact) in moved.as_chunks::<3>().0.iter().zip(&alone) {
                let found = Vec3::from_fn(|k, _| f64::from(found[k]));
                assert!((found - exact).amax() <= 1e-7 * largest);
            }
        }
        // A force along a held direction causes no displacement.
        assert!(moved[40].iter().all(|by| *by == 0.0));
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
