//! The nodes of a surface in blocks of up to four.

use super::faces_around::FacesAround;
use crate::number::LANES;

/// Up to four nodes that lie together: what is near one is near all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NodeBlock {
    /// The nodes, ascending; the last of them again where there are fewer than four.
    pub nodes: [u32; LANES],
    /// How many there are.
    pub count: usize,
}

impl NodeBlock {
    /// The block of up to four nodes, which are put into order.
    fn of(nodes: &mut [u32]) -> Self {
        nodes.sort_unstable();
        let last = nodes.len() - 1;
        Self {
            nodes: [0, 1, 2, 3].map(|lane: usize| nodes[lane.min(last)]),
            count: nodes.len(),
        }
    }
}

/// The blocks of a surface, every node in one: the corners of every other face along rows and
/// columns, and then what is left in chains; ascending by their first nodes.
///
/// A grid falls into blocks of two by two, whatever its outline. They touch, or not, sooner all
/// together than four nodes in a row would, and do not reach from one end of a row to the start of
/// the next.
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
    blocks.sort_unstable_by_key(|block| block.nodes[0]);
    blocks
}

/// The nodes that are in no block yet.
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

    /// Takes a face's corners, those of the faces next but one on all its sides, and so on.
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
                blocks.push(NodeBlock::of(&mut face));
            }
        }
    }

    /// The face on the other side of an edge of one, from there on.
    fn face_beyond(&self, [from, to]: [u32; 2]) -> Option<[u32; 4]> {
        let faces = self.around.of(to as usize).iter();
        let mut faces = faces.map(|&[next, across, before]| [to, next, across, before]);
        faces.find(|face| face[1] == from)
    }

    /// Takes a free node with up to three others, each beside one before it.
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
        (!nodes.is_empty()).then(|| NodeBlock::of(&mut nodes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The blocks of a grid of `columns` by `rows` nodes.
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
