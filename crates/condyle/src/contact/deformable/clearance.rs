//! How far the nodes that do not press are from the femur, or are so at least.

use super::{candidate::Candidate, near_matrix::NearMatrix};

/// A gap may be below zero by this much, mm: a millionth of what a surface is rough by.
const GAP_TOLERANCE_MM: f64 = 1e-10;

/// A node whose gap would be less than this if it had given way as it was last known to is likely to overlap, mm.
const NARROW_MM: f64 = 0.01;

/// What is known of the gaps of nodes that do not press.
///
/// A gap is the sum of many loads, each times its compliance; but it cannot have closed since it was last computed
/// where it was wider than all changes of load since then can move a node, and the femur can have come nearer. Tile by
/// tile is known how far loads there can move the nodes of another. So most need not be computed again. What is told
/// of a node does not depend on when it was computed last.
pub(super) struct Clearances {
    /// Of every surface node: how far it had given way and what its tile had closed by, when that was computed last, mm.
    wider_mm: Vec<f64>,
    /// How far each node had given way when that was computed last, mm.
    moved_mm: Vec<f64>,
    tiles: Vec<TileClearance>,
    /// Of every surface node its load, and the nodes that have one.
    load_n: Vec<f64>,
    loaded: Vec<u32>,
}

/// What is known of the gaps over a tile of nodes, and of the loads on it.
#[derive(Clone, Copy, Default)]
struct TileClearance {
    /// How far all changes of load so far can have moved any of its nodes outwards, mm.
    closed_mm: f64,
    /// How far the loads move any of its nodes outwards at most, mm.
    most_bulge_mm: f64,
    /// By how much loads on it have become less and more with the last change, and their sum, N.
    less_n: f64,
    more_n: f64,
    pressing_n: f64,
}

impl Clearances {
    /// Nothing is known of a surface with so many nodes, and nothing presses on it.
    pub fn unknown(node_count: usize) -> Self {
        Self {
            wider_mm: vec![f64::NEG_INFINITY; node_count],
            moved_mm: vec![f64::NEG_INFINITY; node_count],
            tiles: Vec::new(),
            load_n: vec![0.0; node_count],
            loaded: Vec::new(),
        }
    }

    /// Takes other loads.
    pub fn take(&mut self, nodes: &[u32], loads_n: &[f64], compliance: &NearMatrix) {
        let reaches = compliance.reaches();
        self.tiles.resize(reaches.len(), TileClearance::default());
        for tile in &mut self.tiles {
            (tile.less_n, tile.more_n, tile.pressing_n) = (0.0, 0.0, 0.0);
        }
        for (&node, &load_n) in nodes.iter().zip(loads_n) {
            let tile = &mut self.tiles[compliance.slot(node)];
            tile.change(load_n - self.load_n[node as usize]);
            tile.pressing_n += load_n.max(0.0);
            self.load_n[node as usize] = 0.0;
        }
        for node in self.loaded.drain(..) {
            self.tiles[compliance.slot(node)].change(-self.load_n[node as usize]);
            self.load_n[node as usize] = 0.0;
        }
        for (&node, &load_n) in nodes.iter().zip(loads_n) {
            self.load_n[node as usize] = load_n;
        }
        self.loaded.extend_from_slice(nodes);
        for (own, reaches) in reaches.iter().enumerate() {
            let (mut closed_mm, mut bulge_mm) = (0.0, 0.0);
            for (tile, reach) in self.tiles.iter().zip(reaches) {
                closed_mm += tile.less_n * reach.inwards + tile.more_n * reach.outwards;
                bulge_mm += tile.pressing_n * reach.outwards;
            }
            self.tiles[own].closed_mm += closed_mm;
            self.tiles[own].most_bulge_mm = bulge_mm;
        }
    }

    /// Whether a node is likely to overlap the femur, as far as is known.
    pub fn may_overlap(&self, candidate: &Candidate) -> bool {
        self.moved_mm[candidate.node as usize] - candidate.overclosed_mm() < NARROW_MM
    }

    /// Whether a node that does not press overlaps the femur; `moved_mm` computes how far it has given way.
    ///
    /// That is right where no load pulls.
    pub fn overlaps(
        &mut self,
        candidate: &Candidate,
        compliance: &NearMatrix,
        moved_mm: impl FnOnce() -> f64,
    ) -> bool {
        let (node, overclosed_mm) = (candidate.node as usize, candidate.overclosed_mm());
        let tile = &self.tiles[compliance.slot(candidate.node)];
        let is_apart = overclosed_mm + tile.most_bulge_mm < 0.0
            || self.wider_mm[node] - overclosed_mm - tile.closed_mm > 0.0;
        if is_apart {
            return false;
        }
        let moved_mm = moved_mm();
        self.moved_mm[node] = moved_mm;
        self.wider_mm[node] = moved_mm + tile.closed_mm;
        overclosed_mm - moved_mm > GAP_TOLERANCE_MM
    }
}

impl TileClearance {
    /// A load on it has become more by so much.
    fn change(&mut self, by_n: f64) {
        self.less_n += (-by_n).max(0.0);
        self.more_n += by_n.max(0.0);
    }
}
