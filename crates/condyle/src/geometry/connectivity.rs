//! The connectivity of a surface: the faces around its nodes, and the nodes in blocks of up to four.

use crate::number::LANES;

/// The faces around every node of a surface.
pub(crate) struct FacesAround {
    /// The faces of node i are `faces[first[i]..first[i + 1]]`.
    first: Vec<usize>,
    /// The other corners of each face, in its order from the node.
    faces: Vec<[u32; 3]>,
    /// The nodes that share a face with node i are `adjacent[first_adjacent[i]..first_adjacent[i + 1]]`, each once.
    first_adjacent: Vec<usize>,
    adjacent: Vec<u32>,
}

impl FacesAround {
    /// Sorts `faces`, in numbers of nodes, by the nodes at their corners.
    pub fn new(node_count: usize, faces: &[[u32; 4]]) -> Self {
        let mut first = vec![0; node_count + 1];
        for &node in faces.iter().flatten() {
            first[node as usize + 1] += 1;
        }
        for node in 0..node_count {
            first[node + 1] += first[node];
        }
        let mut next = first.clone();
        let mut sorted = vec![[0; 3]; first[node_count]];
        for face in faces {
            for (corner, &node) in face.iter().enumerate() {
                let others = [1, 2, 3].map(|turn| face[(corner + turn) % 4]);
                sorted[next[node as usize]] = others;
                next[node as usize] += 1;
            }
        }
        let mut first_adjacent = vec![0];
        // A node of a grid has eight others in its faces.
        let mut adjacent = Vec::with_capacity(8 * node_count);
        for node in 0..node_count {
            let start = adjacent.len();
            for &other in sorted[first[node]..first[node + 1]].as_flattened() {
                if !adjacent[start..].contains(&other) {
                    adjacent.push(other);
                }
            }
            first_adjacent.push(adjacent.len());
        }
        Self {
            first,
            faces: sorted,
            first_adjacent,
            adjacent,
        }
    }

    pub fn node_count(&self) -> usize {
        self.first.len() - 1
    }

    /// Returns the faces around a node, in their given order: for each the next corner, the opposite one
    /// and the one before.
    pub fn of(&self, node: usize) -> &[[u32; 3]] {
        &self.faces[self.first[node]..self.first[node + 1]]
    }

    fn adjacent(&self, node: u32) -> &[u32] {
        let node = node as usize;
        &self.adjacent[self.first_adjacent[node]..self.first_adjacent[node + 1]]
    }

    /// Returns a node, and then those around it: all that have a face in common with it and, if these are fewer than
    /// `least` in all, those around them too.
    pub fn patch(&self, node: u32, least: usize) -> Vec<u32> {
        let mut nodes = Vec::with_capacity(32);
        nodes.push(node);
        nodes.extend_from_slice(self.adjacent(node));
        if nodes.len() < least {
            for ring in 1..nodes.len() {
                for other in self.adjacent(nodes[ring]) {
                    if !nodes.contains(other) {
                        nodes.push(*other);
                    }
                }
            }
        }
        nodes
    }
}

/// Up to four neighbouring nodes, which the broad phase tests together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NodeBlock {
    /// Ascending; the last is repeated where there are fewer than four.
    pub nodes: [u32; LANES],
    pub count: usize,
}

impl NodeBlock {
    fn new(nodes: &mut [u32]) -> Self {
        nodes.sort_unstable();
        let last = nodes.len() - 1;
        Self {
            nodes: [0, 1, 2, 3].map(|lane: usize| nodes[lane.min(last)]),
            count: nodes.len(),
        }
    }
}

/// Divides a surface into blocks: the corners of every other face along rows and
/// columns, and the remaining nodes in chains; ascending by their first nodes.
///
/// A grid is divided into blocks of two by two, whatever its outline. Such a block is more compact than four nodes in a
/// row, and does not extend from the end of one row to the start of the next.
pub(super) fn node_blocks(faces: &[[u32; 4]], around: &FacesAround) -> Vec<NodeBlock> {
    let mut free = FreeNodes {
        around,
        is_taken: vec![false; around.node_count()],
    };
    let mut blocks = Vec::with_capacity(around.node_count().div_ceil(LANES));
    for &face in faces {
        free.take_blocks(face, &mut blocks);
    }
    for node in 0..around.node_count() as u32 {
        if let Some(chain) = free.take_chain(node) {
            blocks.push(chain);
        }
    }
    // In a fixed order, so that sums over blocks have the same bytes however the blocks were found.
    blocks.sort_unstable_by_key(|block| block.nodes[0]);
    blocks
}

struct FreeNodes<'a> {
    around: &'a FacesAround,
    is_taken: Vec<bool>,
}

impl FreeNodes<'_> {
    fn take(&mut self, nodes: &[u32]) -> bool {
        let is_free = !nodes.iter().any(|&node| self.is_taken[node as usize]);
        if is_free {
            nodes
                .iter()
                .for_each(|&node| self.is_taken[node as usize] = true);
        }
        is_free
    }

    /// Takes a face's corners, those of the next face but one on each side, and so on.
    fn take_blocks(&mut self, face: [u32; 4], blocks: &mut Vec<NodeBlock>) {
        let mut open = vec![face];
        while let Some(mut face) = open.pop() {
            if self.take(&face) {
                let sides = [0, 1, 2, 3].map(|side| [face[side], face[(side + 1) % 4]]);
                let beyond = |side| {
                    let [_, _, from, to] = self.face_beyond(side)?;
                    self.face_beyond([from, to])
                };
                open.extend(sides.into_iter().filter_map(beyond));
                blocks.push(NodeBlock::new(&mut face));
            }
        }
    }

    /// Returns the face on the other side of an edge, starting with that edge.
    fn face_beyond(&self, [from, to]: [u32; 2]) -> Option<[u32; 4]> {
        let faces = self.around.of(to as usize).iter();
        let mut faces = faces.map(|&[next, across, before]| [to, next, across, before]);
        faces.find(|face| face[1] == from)
    }

    /// Takes a free node with up to three others, each a neighbour of an earlier one.
    fn take_chain(&mut self, node: u32) -> Option<NodeBlock> {
        let mut nodes = Vec::with_capacity(LANES);
        if self.take(&[node]) {
            nodes.push(node);
        }
        let mut end = 0;
        while let Some(&node) = nodes.get(end) {
            for &other in self.around.of(node as usize).iter().flatten() {
                if nodes.len() < LANES && self.take(&[other]) {
                    nodes.push(other);
                }
            }
            end += 1;
        }
        (!nodes.is_empty()).then(|| NodeBlock::new(&mut nodes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_patch_is_of_the_faces_around_and_larger_where_these_are_few() {
        let faces = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]];
        let around = FacesAround::new(9, &faces);
        let sorted = |node, least| {
            let mut nodes = around.patch(node, least);
            assert_eq!(nodes[0], node);
            nodes.sort_unstable();
            nodes
        };
        assert_eq!(sorted(4, 7), [0, 1, 2, 3, 4, 5, 6, 7, 8]);
        assert_eq!(sorted(0, 4), [0, 1, 3, 4]);
        assert_eq!(sorted(5, 6), [1, 2, 4, 5, 7, 8]);
        assert_eq!(sorted(0, 7), [0, 1, 2, 3, 4, 5, 6, 7, 8]);
    }

    /// Returns the blocks of a grid of `columns` by `rows` nodes.
    fn of_grid(columns: u32, rows: u32) -> Vec<NodeBlock> {
        let first = (0..rows - 1).flat_map(|j| (0..columns - 1).map(move |i| i + j * columns));
        let faces: Vec<[u32; 4]> = first
            .map(|n| [n, n + 1, n + columns + 1, n + columns])
            .collect();
        node_blocks(&faces, &FacesAround::new((columns * rows) as usize, &faces))
    }

    fn numbers(blocks: &[NodeBlock]) -> Vec<&[u32]> {
        blocks
            .iter()
            .map(|block| &block.nodes[..block.count])
            .collect()
    }

    #[test]
    fn a_grid_falls_into_blocks_and_what_is_left_into_chains() {
        let even = of_grid(4, 2);
        assert_eq!(numbers(&even), [[0, 1, 4, 5], [2, 3, 6, 7]]);
        let odd = of_grid(5, 3);
        let (blocks, chains) = (
            [[0, 1, 5, 6], [2, 3, 7, 8]],
            [[4, 9, 13, 14], [10, 11, 12, 12]],
        );
        assert_eq!([odd[0].nodes, odd[1].nodes], blocks);
        assert_eq!([odd[2].nodes, odd[3].nodes], chains);
        assert_eq!([odd[2].count, odd[3].count], [4, 3]);
    }

    #[test]
    fn a_ragged_outline_leaves_few_over() {
        // A disc of 25 nodes across, its rows of all lengths.
        let is_in = |i: i32, k: i32| i * i + k * k <= 150;
        let corners = [(0, 0), (1, 0), (1, 1), (0, 1)];
        let cells = (-12..12).flat_map(|k| (-12..12).map(move |i| (i, k)));
        let cells: Vec<_> = cells
            .filter(|&(i, k)| corners.iter().all(|(di, dk)| is_in(i + di, k + dk)))
            .collect();
        let mut places: Vec<_> = cells
            .iter()
            .flat_map(|&(i, k)| corners.map(|(di, dk)| (k + dk, i + di)))
            .collect();
        places.sort_unstable();
        places.dedup();
        let number = |(i, k): (i32, i32)| places.binary_search(&(k, i)).unwrap() as u32;
        let face = |&(i, k): &(i32, i32)| corners.map(|(di, dk)| number((i + di, k + dk)));
        let faces: Vec<[u32; 4]> = cells.iter().map(face).collect();
        let blocks = node_blocks(&faces, &FacesAround::new(places.len(), &faces));
        assert!(
            blocks.len() * 4 < places.len() * 11 / 10,
            "{}",
            blocks.len()
        );
        let mut nodes = numbers(&blocks).concat();
        nodes.sort_unstable();
        assert!(nodes.into_iter().eq(0..places.len() as u32));
    }
}
