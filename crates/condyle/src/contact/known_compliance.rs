//! What was computed of the compliance of a surface, for another run of the same insert.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// What is known of the normal compliance of an insert's surface, mm/N: how far unit loads on the nodes of one tile move
/// those of another, for the pairs of tiles that were asked for.
///
/// It follows from the mesh, its backside, its articulating surface and the elastic constants, and from nothing else; and
/// it is known to the bit, so that a run that begins with it has the bytes of one that does not.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct KnownCompliance {
    /// By the numbers of two tiles, the lower first; row-major, a row for each node of the first.
    between: BTreeMap<(u32, u32), Vec<f64>>,
}

impl KnownCompliance {
    /// Of how many pairs of tiles something is known.
    pub fn pairs(&self) -> usize {
        self.between.len()
    }

    /// About how many bytes it takes.
    pub fn bytes(&self) -> usize {
        let numbers: usize = self.between.values().map(Vec::len).sum();
        size_of::<f64>() * (numbers + 2 * self.pairs())
    }

    /// Hands over what is known of two tiles of so many nodes: row-major, a row for each node of `one`.
    pub(in crate::contact) fn take(
        &mut self,
        one: usize,
        other: usize,
        nodes: [usize; 2],
    ) -> Option<Vec<f64>> {
        let [rows, columns] = nodes;
        let key = [one.min(other), one.max(other)].map(|tile| tile as u32);
        let known = self.between.remove(&(key[0], key[1]))?;
        if known.len() != rows * columns {
            return None;
        }
        if one <= other {
            return Some(known);
        }
        let of_row = |row: usize| (0..columns).map(move |column| (row, column));
        let places = (0..rows).flat_map(of_row);
        Some(
            places
                .map(|(row, column)| known[column * rows + row])
                .collect(),
        )
    }

    /// Adds what loads on one tile move another by, of which the number is not lower.
    pub(in crate::contact) fn add(&mut self, one: usize, other: usize, moved: Vec<f64>) {
        self.between.insert((one as u32, other as u32), moved);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_known_is_handed_over_either_way_round() {
        let mut known = KnownCompliance::default();
        known.add(1, 4, vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let there = known.clone().take(1, 4, [2, 3]).unwrap();
        assert_eq!(there, [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
        let back = known.clone().take(4, 1, [3, 2]).unwrap();
        assert_eq!(back, [1.0, 4.0, 2.0, 5.0, 3.0, 6.0]);
        assert_eq!(known.take(1, 1, [2, 2]), None);
        // A file of another surface tells nothing.
        assert_eq!(known.take(1, 4, [3, 3]), None);
    }
}
