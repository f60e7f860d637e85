//! The order in which nodes are eliminated: nested dissection by their places.
//!
//! A set of nodes is cut in two across its longest side; the nodes of one half that touch the other half separate
//! them, and come last. The remaining halves are cut again (George 1973). So the halves are uncoupled, and there is
//! little fill-in.

use std::ops::Range;

use crate::{Vec3, mesh::HexMesh};

/// Largest number of nodes of a set that is not cut again.
const SMALL: usize = 8;

/// Place of a node that is held, and so is not eliminated.
const HELD: u32 = u32::MAX;

/// Nodes that are eliminated at once, and those that they still touch.
pub(crate) struct Group {
    /// Places in the order.
    pub(crate) own: Range<u32>,
    /// Later places that the elimination affects, ascending.
    pub(crate) boundary: Vec<u32>,
    /// Groups whose next later group this is.
    pub(crate) children: Vec<usize>,
    /// Elements whose first node to be eliminated is here.
    pub(crate) elements: Vec<u32>,
}

/// An order of elimination: groups, each after its children.
pub(crate) struct Dissection {
    pub(crate) groups: Vec<Group>,
    /// The group that comes next above each.
    pub(crate) parents: Vec<Option<usize>>,
    /// Nodes in the order of elimination.
    pub(crate) order: Vec<u32>,
    /// Place in that order of every node of the mesh.
    places: Vec<u32>,
}

impl Dissection {
    /// Orders all nodes of a mesh that belong to an element and are not held in all directions.
    pub(crate) fn new(mesh: &HexMesh, held: &[[bool; 3]]) -> Self {
        let mut around = vec![Vec::new(); mesh.nodes.len()];
        for (element, nodes) in mesh.hexes.iter().enumerate() {
            for &node in nodes {
                around[node as usize].push(element as u32);
            }
        }
        let free = (0..mesh.nodes.len() as u32)
            .filter(|&n| held[n as usize] != [true; 3] && !around[n as usize].is_empty());
        let mut cutter = Cutter {
            mesh,
            around: &around,
            side: vec![0; mesh.nodes.len()],
            cuts: 0,
            order: Vec::new(),
            groups: Vec::new(),
        };
        cutter.cut(free.collect());
        let (order, groups) = (cutter.order, cutter.groups);
        let mut places = vec![HELD; mesh.nodes.len()];
        for (place, &node) in order.iter().enumerate() {
            places[node as usize] = place as u32;
        }
        let mut parents = vec![None; groups.len()];
        for (parent, group) in groups.iter().enumerate() {
            for &child in &group.children {
                parents[child] = Some(parent);
            }
        }
        let mut dissection = Self {
            groups,
            parents,
            order,
            places,
        };
        for (element, nodes) in mesh.hexes.iter().enumerate() {
            let places = nodes.iter().filter_map(|&node| dissection.place(node));
            if let Some(first) = places.min() {
                let group = dissection.group_of(first);
                dissection.groups[group].elements.push(element as u32);
            }
        }
        dissection.find_boundaries(mesh);
        dissection
    }

    #[inline]
    pub(crate) fn place(&self, node: u32) -> Option<u32> {
        Some(self.places[node as usize]).filter(|&place| place != HELD)
    }

    pub(crate) fn group_of(&self, place: u32) -> usize {
        self.groups.partition_point(|group| group.own.end <= place)
    }

    /// The boundary of a group: what its elements and its children touch, less its own.
    fn find_boundaries(&mut self, mesh: &HexMesh) {
        for at in 0..self.groups.len() {
            let group = &self.groups[at];
            let end = group.own.end;
            let of_elements = group.elements.iter().flat_map(|&e| mesh.hexes[e as usize]);
            let mut boundary: Vec<u32> = of_elements.filter_map(|n| self.place(n)).collect();
            for &child in &group.children {
                boundary.extend(&self.groups[child].boundary);
            }
            boundary.retain(|&place| place >= end);
            boundary.sort_unstable();
            boundary.dedup();
            self.groups[at].boundary = boundary;
        }
    }
}

struct Cutter<'a> {
    mesh: &'a HexMesh,
    around: &'a [Vec<u32>],
    /// The last cut in which a node was on the lower side.
    side: Vec<u32>,
    cuts: u32,
    order: Vec<u32>,
    groups: Vec<Group>,
}

impl Cutter<'_> {
    /// Orders some nodes; gives the groups that come last.
    fn cut(&mut self, mut nodes: Vec<u32>) -> Vec<usize> {
        if nodes.len() <= SMALL {
            return self.close(nodes, Vec::new());
        }
        let nothing = [f64::INFINITY, f64::NEG_INFINITY].map(Vec3::repeat);
        let [low, high] = self
            .mesh
            .positions(&nodes)
            .fold(nothing, |[low, high], p| [low.inf(&p), high.sup(&p)]);
        let axis = (high - low).imax();
        let along = |node: &u32| self.mesh.nodes[*node as usize][axis];
        // Ties by number, so that the order does not depend on the sort.
        nodes.sort_by(|a, b| along(a).total_cmp(&along(b)).then(a.cmp(b)));
        // Halves of equal count balance the work, also where nodes are denser on one side.
        let upper = nodes.split_off(nodes.len() / 2);
        self.cuts += 1;
        for &node in &nodes {
            self.side[node as usize] = self.cuts;
        }
        let (between, upper) = upper.into_iter().partition(|&node: &u32| {
            let elements = self.around[node as usize].iter();
            let mut near = elements.flat_map(|&element| self.mesh.hexes[element as usize]);
            near.any(|node| self.side[node as usize] == self.cuts)
        });
        let mut last = self.cut(nodes);
        last.extend(self.cut(upper));
        self.close(between, last)
    }

    /// Makes a group of some nodes, in the order of their numbers.
    fn close(&mut self, mut nodes: Vec<u32>, children: Vec<usize>) -> Vec<usize> {
        if nodes.is_empty() {
            return children;
        }
        nodes.sort_unstable();
        let start = self.order.len() as u32;
        self.order.extend(nodes);
        self.groups.push(Group {
            own: start..self.order.len() as u32,
            boundary: Vec::new(),
            children,
            elements: Vec::new(),
        });
        vec![self.groups.len() - 1]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::block;

    #[test]
    fn every_free_node_is_ordered_once_and_elements_meet_no_gap() {
        let mesh = block([7, 5, 3]);
        let held: Vec<_> = mesh.nodes.iter().map(|node| [node.z == 0.0; 3]).collect();
        let dissection = Dissection::new(&mesh, &held);
        let mut order = dissection.order.clone();
        order.sort_unstable();
        let free = (0..mesh.nodes.len() as u32).filter(|&n| !held[n as usize][0]);
        assert!(order.into_iter().eq(free));
        // The nodes of an element that its group does not eliminate are all on the boundary.
        for group in &dissection.groups {
            for &element in &group.elements {
                for node in mesh.hexes[element as usize] {
                    let Some(place) = dissection.place(node) else {
                        continue;
                    };
                    assert!(group.own.contains(&place) || group.boundary.contains(&place));
                }
            }
        }
        // The remainder of a group lies within the group above it.
        for (at, group) in dissection.groups.iter().enumerate() {
            if let Some(parent) = dissection.parents[at] {
                let parent = &dissection.groups[parent];
                let knows = |p: &u32| parent.own.contains(p) || parent.boundary.contains(p);
                assert!(group.boundary.iter().all(knows));
            } else {
                assert!(group.boundary.is_empty());
            }
        }
    }
}
