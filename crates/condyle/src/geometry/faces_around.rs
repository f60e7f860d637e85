//! Which faces and nodes of a surface lie around a node.

/// The faces around every node of a surface.
pub struct FacesAround {
    /// Those of node i are `faces[first[i]..first[i + 1]]`.
    first: Vec<usize>,
    /// The other corners of each, going on from the node.
    faces: Vec<[u32; 3]>,
    /// The nodes that have a face in common with node i are `beside[first_beside[i]..first_beside[i + 1]]`, each once.
    first_beside: Vec<usize>,
    beside: Vec<u32>,
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
        let mut around = Self {
            first,
            faces: sorted,
            first_beside: vec![0],
            beside: Vec::with_capacity(8 * node_count),
        };
        for node in 0..node_count {
            around.list_beside(node);
        }
        around
    }

    fn list_beside(&mut self, node: usize) {
        let start = self.beside.len();
        for &other in self.faces[self.first[node]..self.first[node + 1]].as_flattened() {
            if !self.beside[start..].contains(&other) {
                self.beside.push(other);
            }
        }
        self.first_beside.push(self.beside.len());
    }

    /// How many nodes the surface has.
    pub fn node_count(&self) -> usize {
        self.first.len() - 1
    }

    /// The faces around a node, in the order they were given: of each the next corner, the one
    /// across, and the one before.
    pub fn of(&self, node: usize) -> &[[u32; 3]] {
        &self.faces[self.first[node]..self.first[node + 1]]
    }

    /// The nodes that have a face in common with a node.
    fn beside(&self, node: u32) -> &[u32] {
        let node = node as usize;
        &self.beside[self.first_beside[node]..self.first_beside[node + 1]]
    }

    /// A node, and then those around it: all that have a face in common with it and, if these are
    /// fewer than `least` in all, those around them too.
    pub fn patch(&self, node: u32, least: usize) -> Vec<u32> {
        let mut nodes = Vec::with_capacity(32);
        nodes.push(node);
        nodes.extend_from_slice(self.beside(node));
        if nodes.len() < least {
            for ring in 1..nodes.len() {
                for other in self.beside(nodes[ring]) {
                    if !nodes.contains(other) {
                        nodes.push(*other);
                    }
                }
            }
        }
        nodes
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
}
