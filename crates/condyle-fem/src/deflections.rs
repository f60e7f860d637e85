//! How far some nodes give way to unit forces on a few of them.

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

/// A node whose displacement is asked for: its place in the order of elimination, and its number among those given.
type Asked = (u32, usize);

impl ElasticSolid {
    /// Deflections of `nodes`, each along its own direction, a unit vector, by a unit force along its direction on
    /// each node of those numbered `loaded` among them; a column a force.
    ///
    /// A force on a held node moves nothing. A column has the same bytes whatever forces stand beside it.
    ///
    /// # Panics
    /// If there is no such node, or not one direction a node.
    pub fn deflections(&self, nodes: &[u32], directions: &[Vec3], loaded: &[u32]) -> Vec<Vec<f64>> {
        assert_eq!(nodes.len(), directions.len(), "a direction for every node");
        let factor = &self.factor;
        let place = |number: usize| Some((factor.dissection.place(nodes[number])?, number));
        let asked: Vec<Asked> = (0..nodes.len()).filter_map(place).collect();
        let wanted = factor.paths(asked.iter().map(|&(place, _)| place));
        let mut deflections = vec![vec![0.0; nodes.len()]; loaded.len()];
        // Forces that are near in the order of elimination load the same fronts.
        let force = |(column, &number): (usize, &u32)| {
            Some((place(number as usize)?.0, number as usize, column))
        };
        let mut forces: Vec<_> = loaded.iter().enumerate().filter_map(force).collect();
        forces.sort_unstable();
        for some in forces.chunks(AT_ONCE) {
            let right = |&(place, number, _): &(u32, usize, usize)| {
                (place, self.felt(nodes[number], directions[number]))
            };
            let solved = solved(factor, &some.iter().map(right).collect::<Vec<_>>(), &wanted);
            for (columns, some) in solved.iter().zip(some.chunks(Columns::COLUMNS)) {
                for (side, &(_, _, column)) in some.iter().enumerate() {
                    for &(place, number) in &asked {
                        let moved = Vec3::from_fn(|k, _| columns.at(3 * place as usize + k, side));
                        deflections[column][number] = directions[number].dot(&moved);
                    }
                }
            }
        }
        deflections
    }
}

/// Displacements under forces at places, as many side by side as go.
fn solved(factor: &Factor, forces: &[(u32, Vec3)], wanted: &[bool]) -> Vec<Columns> {
    let (mut columns, mut loaded) = (Vec::new(), Vec::new());
    for some in forces.chunks(Columns::COLUMNS) {
        let mut x = Columns::new(factor.freedoms());
        for (side, (place, force)) in some.iter().enumerate() {
            for k in 0..3 {
                *x.at_mut(3 * *place as usize + k, side) = force[k];
            }
        }
        columns.push(x);
        loaded.push(factor.paths(some.iter().map(|(place, _)| *place)));
    }
    factor.solve_some(&mut columns, &loaded, wanted);
    columns
}
