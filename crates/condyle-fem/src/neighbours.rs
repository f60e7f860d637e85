//! Which nodes an edge joins to which.

use crate::{hex::HEX_EDGES, mesh::HexMesh};

/// The neighbours along the edges of some nodes.
pub(crate) struct Neighbours {
    /// Those of row k are `nodes[first[k]..first[k + 1]]`, ascending.
    first: Vec<usize>,
    nodes: Vec<u32>,
}

impl Neighbours {
    /// Those of `rows` in a mesh; row k is of node `rows[k]`.
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

    /// The neighbours of row `k`.
    #[inline]
    pub(crate) fn of(&self, k: usize) -> &[u32] {
        &self.nodes[self.first[k]..self.first[k + 1]]
    }

    /// How many neighbours each row has.
    pub(crate) fn counts(&self) -> impl Iterator<Item = usize> {
        self.first.windows(2).map(|ends| ends[1] - ends[0])
    }
}

/// Tells every edge of every hexahedron both ways.
fn both_ways(mesh: &HexMesh, mut tell: impl FnMut(u32, u32)) {
    for hex in mesh.hexes.iter() {
        for &[a, b] in &HEX_EDGES {
            tell(hex[a], hex[b]);
            tell(hex[b], hex[a]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::tests::block;

    #[test]
    fn a_corner_has_three_neighbours_and_a_middle_node_six() {
        let mesh = block([2, 2, 2]);
        let neighbours = Neighbours::along_edges(&[0, 13], &mesh);
        assert_eq!(neighbours.of(0), [1, 3, 9]);
        assert_eq!(neighbours.of(1), [4, 10, 12, 14, 16, 22]);
        assert!(neighbours.counts().eq([3, 6]));
    }
}
