//! What forces on some nodes of a solid move those nodes by.

use crate::{
    solid::ElasticSolid,
    sparse::{Factor, Rhs},
    vector::Vec3,
};

/// Vectors of right-hand sides that are solved side by side: twelve sums stay in registers.
const VECTORS: usize = 3;
type Columns = Rhs<VECTORS>;

/// Right-hand sides that go through a front while it is in the cache.
const AT_ONCE: usize = 8 * Columns::COLUMNS;

/// Displacements of some nodes by some forces, each alone.
#[derive(Clone, Debug, PartialEq)]
pub struct Compliance {
    forces: usize,
    /// Row-major, three rows a node, one column a force.
    values: Vec<f64>,
}

impl Compliance {
    /// How many nodes move.
    pub fn nodes(&self) -> usize {
        self.values.len() / (3 * self.forces.max(1))
    }

    /// How many forces there are.
    pub fn forces(&self) -> usize {
        self.forces
    }

    /// Row-major, `3 * nodes` rows and `forces` columns: row `3 i + k` is the displacement of node `i` along axis
    /// `k`, column `j` is by force `j`; both counted as they were given.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Displacement of a node by a force, both counted as they were given.
    ///
    /// # Panics
    /// If there are not as many.
    pub fn displacement(&self, node: usize, force: usize) -> Vec3 {
        Vec3::from_fn(|k, _| self.values[(3 * node + k) * self.forces + force])
    }
}

impl ElasticSolid {
    /// Displacements of `nodes` by a unit force on each of them along its direction.
    ///
    /// Column j is the force on `nodes[j]` along `directions[j]`, a unit vector; so values are in length a force.
    ///
    /// # Panics
    /// If there is no such node, or not one direction a node.
    pub fn compliance(&self, nodes: &[u32], directions: &[Vec3]) -> Compliance {
        assert_eq!(nodes.len(), directions.len(), "a direction for every node");
        let forces = nodes.iter().copied().zip(directions.iter().copied());
        self.influence(nodes, &forces.collect::<Vec<_>>())
    }

    /// Displacements of `nodes` by forces on other nodes, each alone.
    ///
    /// By reciprocity it is also what forces on `nodes`, such as those of an eigenstrain
    /// ([`Self::eigenstrain_forces`]), move along the other forces by. A force along a direction that is held moves
    /// nothing. A column has the same bytes whatever stands beside it, on every run.
    ///
    /// # Panics
    /// If there is no such node.
    pub fn influence(&self, nodes: &[u32], forces: &[(u32, Vec3)]) -> Compliance {
        let mut compliance = Compliance {
            forces: forces.len(),
            values: vec![0.0; 3 * nodes.len() * forces.len()],
        };
        let place = |node: u32| self.factor.dissection.place(node);
        let free = |(i, node)| Some((place(node)?, i));
        let rows: Vec<(u32, usize)> = nodes.iter().copied().enumerate().filter_map(free).collect();
        let wanted = self.factor.paths(rows.iter().map(|&(place, _)| place));
        // Forces that are near in the order of elimination load the same fronts.
        let loaded = forces.iter().map(|&(node, _)| node).enumerate();
        let mut columns: Vec<(u32, usize)> = loaded.filter_map(free).collect();
        columns.sort_unstable();
        let felt: Vec<Vec3> = forces.iter().map(|&(node, f)| self.felt(node, f)).collect();
        for some in columns.chunks(AT_ONCE) {
            let solved = solved(&self.factor, some, &felt, &wanted);
            for (solved, some) in solved.iter().zip(some.chunks(Columns::COLUMNS)) {
                compliance.take(solved, &rows, some);
            }
        }
        compliance
    }
}

/// Displacements by forces at places, as many columns side by side as go.
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

impl Compliance {
    /// Copies solved columns to their places.
    fn take(&mut self, solved: &Columns, rows: &[(u32, usize)], columns: &[(u32, usize)]) {
        for &(place, node) in rows {
            for k in 0..3 {
                let row = &mut self.values[(3 * node + k) * self.forces..][..self.forces];
                for (column, &(_, force)) in columns.iter().enumerate() {
                    row[force] = solved.at(3 * place as usize + k, column);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Elastic, solid::tests::distorted};

    #[test]
    fn columns_are_the_displacements_by_single_forces() {
        let mesh = distorted([9, 8, 4]);
        let held = (0..90).filter(|&n| mesh.nodes[n as usize].z == 0.0);
        let elastic = Elastic::new(463.0, 0.46).unwrap();
        let solid = ElasticSolid::new(&mesh, elastic, held).unwrap();
        // Some of the top, one that is held, and one at the side, in no order.
        let mut nodes: Vec<u32> = (0..40).map(|i| 360 + (i * 37) % 90).collect();
        nodes.extend([3, 95]);
        let direction = |&n: &u32| Vec3::new(0.1, f64::from(n).sin(), -1.0).normalize();
        let directions: Vec<Vec3> = nodes.iter().map(direction).collect();
        let compliance = solid.compliance(&nodes, &directions);
        assert_eq!(compliance.values().len(), 3 * 42 * 42);
        for (j, (&node, &direction)) in nodes.iter().zip(&directions).enumerate() {
            let alone = solid.displacements(&[(node, direction)]);
            for (i, &node) in nodes.iter().enumerate() {
                let found = compliance.displacement(i, j);
                assert!((found - alone[node as usize]).norm() < 1e-15);
            }
            assert_eq!(compliance.displacement(40, j), Vec3::zeros());
        }
        // Work is the same whichever force comes first (Betti).
        for (i, j) in [(0, 7), (12, 33), (41, 5)] {
            let work = |a: usize, b: usize| compliance.displacement(a, b).dot(&directions[a]);
            assert!((work(i, j) - work(j, i)).abs() < 1e-15);
        }
    }
}
