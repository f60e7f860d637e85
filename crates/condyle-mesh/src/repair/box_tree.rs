//! Triangles that are near one another, found with a tree of boxes.

use std::ops::ControlFlow;

use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Triangles in a leaf: fewer make the tree deep, more make the leaves slow.
const LEAF: usize = 4;

/// A box along the axes.
#[derive(Clone, Copy)]
struct Bounds {
    low: Vec3,
    high: Vec3,
}

impl Bounds {
    fn of(corners: &[Vec3; 3]) -> Self {
        let [a, b, c] = corners;
        Self {
            low: a.inf(b).inf(c),
            high: a.sup(b).sup(c),
        }
    }

    fn wider_by(self, margin: f64) -> Self {
        Self {
            low: self.low.add_scalar(-margin),
            high: self.high.add_scalar(margin),
        }
    }

    fn joined(&self, other: &Self) -> Self {
        Self {
            low: self.low.inf(&other.low),
            high: self.high.sup(&other.high),
        }
    }

    fn meets(&self, other: &Self) -> bool {
        (0..3).all(|i| self.low[i] <= other.high[i] && other.low[i] <= self.high[i])
    }
}

struct BoxNode {
    bounds: Bounds,
    /// Range of the leaf's or branch's triangles in the tree's order.
    start: u32,
    end: u32,
    /// The two nodes below; none for a leaf.
    below: Option<[u32; 2]>,
}

/// The boxes of a mesh's triangles, in boxes of boxes.
pub(super) struct BoxTree {
    bounds: Vec<Bounds>,
    order: Vec<u32>,
    nodes: Vec<BoxNode>,
    /// How many of the triangles a surface of so many vertices can have: about two a vertex.
    surface_of: usize,
}

impl BoxTree {
    /// The tree of a mesh's triangles.
    pub(super) fn new(mesh: &TriangleMesh) -> Self {
        Self::with_margin(mesh, 0.0)
    }

    /// The same with boxes that reach `margin` farther on every side.
    pub(super) fn with_margin(mesh: &TriangleMesh, margin: f64) -> Self {
        let count = mesh.triangles.len();
        let bounds = (0..count).map(|t| Bounds::of(&mesh.corners(t)).wider_by(margin));
        let bounds: Vec<Bounds> = bounds.collect();
        let order = (0..count as u32).collect();
        let mut tree = Self {
            bounds,
            order,
            nodes: Vec::with_capacity(count),
            surface_of: count.min(4 * mesh.vertices.len()),
        };
        if count > 0 {
            tree.build(0, count);
        }
        tree
    }

    /// Splits at the median along the longest side, down to the leaves; gives the node's number.
    fn build(&mut self, start: usize, end: usize) -> u32 {
        let within = self.order[start..end]
            .iter()
            .map(|&t| self.bounds[t as usize]);
        let bounds = within
            .reduce(|one, other| one.joined(&other))
            .unwrap_or(self.bounds[0]);
        let number = self.nodes.len();
        self.nodes.push(BoxNode {
            bounds,
            start: start as u32,
            end: end as u32,
            below: None,
        });
        if end - start > LEAF {
            let axis = (bounds.high - bounds.low).imax();
            let middle = usize::midpoint(start, end);
            let place = |t: u32| {
                let own = &self.bounds[t as usize];
                own.low[axis] + own.high[axis]
            };
            let by_place = |a: &u32, b: &u32| place(*a).total_cmp(&place(*b)).then(a.cmp(b));
            self.order[start..end].select_nth_unstable_by(middle - start, by_place);
            let below = [self.build(start, middle), self.build(middle, end)];
            self.nodes[number].below = Some(below);
        }
        number as u32
    }

    /// Pairs and boxes that are looked at, for each triangle and at least: the surface of a scanned implant has
    /// some fifty a triangle, a flat bottom drawn across by the triangles of its 1500 vertices has 15 million, and a
    /// file of 1 MB is looked through within a second.
    const MAX_LOOKS: (usize, usize) = (400, 20_000_000);

    /// Calls `visit` with each pair of different triangles whose boxes meet, once, until it breaks.
    ///
    /// Triangles that all lie on one another are given up on. Of a search that did not come to its end, two
    /// triangles are given where it ended.
    pub(super) fn for_close_pairs(
        &self,
        mut visit: impl FnMut(usize, usize) -> ControlFlow<()>,
    ) -> Option<[usize; 2]> {
        let (each, least) = Self::MAX_LOOKS;
        let mut left = least.max(each * self.surface_of);
        let mut open = vec![[0, 0]];
        while let Some([one, other]) = open.pop().filter(|_| !self.nodes.is_empty()) {
            let (a, b) = (&self.nodes[one as usize], &self.nodes[other as usize]);
            if one != other && !a.bounds.meets(&b.bounds) {
                left = left.saturating_sub(1);
                continue;
            }
            match (a.below, b.below) {
                (Some([first, second]), _) if one == other => {
                    open.extend([[first, first], [second, second], [first, second]]);
                }
                (Some([first, second]), _) if b.below.is_none() || size(a) >= size(b) => {
                    open.extend([[first, other], [second, other]]);
                }
                (_, Some([first, second])) => open.extend([[one, first], [one, second]]),
                _ => {
                    left = left.saturating_sub(LEAF * LEAF);
                    if self.visit_leaves(a, b, one == other, &mut visit).is_break() {
                        left = 0;
                    }
                }
            }
            if left == 0 {
                return Some([a, b].map(|node| self.order[node.start as usize] as usize));
            }
        }
        None
    }

    fn visit_leaves(
        &self,
        a: &BoxNode,
        b: &BoxNode,
        same: bool,
        visit: &mut impl FnMut(usize, usize) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        for i in a.start..a.end {
            let from = if same { i + 1 } else { b.start };
            for j in from..b.end {
                let [one, other] = [i, j].map(|at| self.order[at as usize] as usize);
                if self.bounds[one].meets(&self.bounds[other]) {
                    visit(one, other)?;
                }
            }
        }
        ControlFlow::Continue(())
    }
}

fn size(node: &BoxNode) -> u32 {
    node.end - node.start
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::tests::strip;

    #[test]
    fn every_close_pair_is_visited_once() {
        let mesh = strip(40, 0.1);
        let tree = BoxTree::new(&mesh);
        let mut pairs = Vec::new();
        tree.for_close_pairs(|a, b| {
            pairs.push((a.min(b), a.max(b)));
            ControlFlow::Continue(())
        });
        pairs.sort_unstable();
        let mut expected = Vec::new();
        for a in 0..mesh.triangles.len() {
            for b in a + 1..mesh.triangles.len() {
                if tree.bounds[a].meets(&tree.bounds[b]) {
                    expected.push((a, b));
                }
            }
        }
        assert_eq!(pairs, expected);
    }
}
