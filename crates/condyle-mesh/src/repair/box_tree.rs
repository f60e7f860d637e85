//! Triangles that are near one another, found with a tree of boxes.

use std::ops::ControlFlow;

use crate::{
    Vec3,
    triangle_mesh::{TriangleMesh, bounds},
};

/// Triangles in a leaf: fewer make the tree deep, more make the leaves slow.
const LEAF: usize = 4;

/// A box along the axes: its lowest and its highest corner.
type Bounds = (Vec3, Vec3);

fn meet(one: &Bounds, other: &Bounds) -> bool {
    (0..3).all(|i| one.0[i] <= other.1[i] && other.0[i] <= one.1[i])
}

struct BoxNode {
    bounds: Bounds,
    start: u32,
    end: u32,
    /// The two nodes below; none for a leaf.
    below: Option<[u32; 2]>,
}

impl BoxNode {
    fn size(&self) -> u32 {
        self.end - self.start
    }
}

pub(super) struct BoxTree {
    bounds: Vec<Bounds>,
    order: Vec<u32>,
    nodes: Vec<BoxNode>,
    /// Number of triangles that a surface of as many vertices may have; there are about two per vertex.
    surface_of: usize,
}

impl BoxTree {
    /// Returns a tree whose boxes reach `margin` farther on every side.
    pub(super) fn new(mesh: &TriangleMesh, margin: f64) -> Self {
        let count = mesh.triangles.len();
        let wider = |t: usize| {
            let (low, high) = bounds(&mesh.corners(t));
            (low.add_scalar(-margin), high.add_scalar(margin))
        };
        let mut tree = Self {
            bounds: (0..count).map(wider).collect(),
            order: (0..count as u32).collect(),
            nodes: Vec::with_capacity(count),
            surface_of: count.min(4 * mesh.vertices.len()),
        };
        if count > 0 {
            tree.build(0, count);
        }
        tree
    }

    /// Splits at the median along the longest side, down to the leaves; returns the node's number.
    fn build(&mut self, start: usize, end: usize) -> u32 {
        let within = self.order[start..end].iter();
        let within = within.map(|&t| self.bounds[t as usize]);
        let joined = |one: Bounds, other: Bounds| (one.0.inf(&other.0), one.1.sup(&other.1));
        let bounds = within.reduce(joined).unwrap_or(self.bounds[0]);
        let number = self.nodes.len();
        self.nodes.push(BoxNode {
            bounds,
            start: start as u32,
            end: end as u32,
            below: None,
        });
        if end - start > LEAF {
            let axis = (bounds.1 - bounds.0).imax();
            let middle = usize::midpoint(start, end);
            let place = |t: u32| {
                let (low, high) = &self.bounds[t as usize];
                low[axis] + high[axis]
            };
            let by_place = |a: &u32, b: &u32| place(*a).total_cmp(&place(*b)).then(a.cmp(b));
            self.order[start..end].select_nth_unstable_by(middle - start, by_place);
            let below = [self.build(start, middle), self.build(middle, end)];
            self.nodes[number].below = Some(below);
        }
        number as u32
    }

    /// Limit on the compared pairs and boxes: so many per triangle, but at least the second number. The surface of a
    /// scanned implant needs about fifty per triangle, a flat bottom of long triangles between its 1500 vertices needs
    /// 15 million, and a file of 1 MB takes less than a second.
    const MAX_LOOKS: (usize, usize) = (400, 20_000_000);

    /// Calls `visit` with each pair of different triangles whose boxes meet, once, until it breaks.
    ///
    /// The search is abandoned if all triangles lie on one another. Returns two triangles at the place where a search
    /// ended before all pairs were visited.
    pub(super) fn for_close_pairs(
        &self,
        mut visit: impl FnMut(usize, usize) -> ControlFlow<()>,
    ) -> Option<[usize; 2]> {
        let (each, least) = Self::MAX_LOOKS;
        let mut left = least.max(each * self.surface_of);
        let mut open = vec![[0, 0]];
        while let Some([one, other]) = open.pop().filter(|_| !self.nodes.is_empty()) {
            let (a, b) = (&self.nodes[one as usize], &self.nodes[other as usize]);
            if one != other && !meet(&a.bounds, &b.bounds) {
                left = left.saturating_sub(1);
                continue;
            }
            // The larger of the two boxes is opened.
            match (a.below, b.below) {
                (Some([first, second]), _) if one == other => {
                    open.extend([[first, first], [second, second], [first, second]]);
                }
                (Some([first, second]), _) if b.below.is_none() || a.size() >= b.size() => {
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
                if meet(&self.bounds[one], &self.bounds[other]) {
                    visit(one, other)?;
                }
            }
        }
        ControlFlow::Continue(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::tests::strip;

    #[test]
    fn every_close_pair_is_visited_once() {
        let mesh = strip(40, 0.1);
        let tree = BoxTree::new(&mesh, 0.0);
        let mut pairs = Vec::new();
        tree.for_close_pairs(|a, b| {
            pairs.push((a.min(b), a.max(b)));
            ControlFlow::Continue(())
        });
        pairs.sort_unstable();
        let mut expected = Vec::new();
        for a in 0..mesh.triangles.len() {
            for b in a + 1..mesh.triangles.len() {
                if meet(&tree.bounds[a], &tree.bounds[b]) {
                    expected.push((a, b));
                }
            }
        }
        assert_eq!(pairs, expected);
    }
}
