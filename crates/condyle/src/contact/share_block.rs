//! The insert's side of the contact: nodes' shares of its surface, four side by side.

use crate::{
    Vec3, Vector,
    geometry::{ArticulatingSurface, Insert, NodeBlock, Share},
    number::{F64x4, LANES, Number},
};

/// NodeBlock nodes' shares, side by side; a lane too many repeats the last node without area.
pub(super) struct ShareBlock {
    pub nodes: [u32; LANES],
    /// Which region each node belongs to.
    pub regions: [u8; LANES],
    pub centre: Vector<F64x4>,
    pub edge_a: Vector<F64x4>,
    pub edge_b: Vector<F64x4>,
    pub area_mm2: F64x4,
    pub spread_mm2: F64x4,
    /// One over the thickness below, 1/mm.
    pub per_thickness: F64x4,
    /// How far corners lie from their centre at most, mm.
    pub half_mm: f64,
}

impl ShareBlock {
    /// All shares of an insert's surface, in its node_blocks.
    pub fn of(insert: &Insert, surface: &ArticulatingSurface) -> Vec<Self> {
        let thickness_mm = insert.thickness_mm();
        let node_blocks = insert.node_blocks().iter();
        node_blocks
            .map(|four| Self::new(four, surface, thickness_mm))
            .collect()
    }

    fn new(four: &NodeBlock, surface: &ArticulatingSurface, thickness_mm: &[f64]) -> Self {
        let NodeBlock { nodes, count } = *four;
        let share = |lane: usize| &surface.shares[nodes[lane] as usize];
        let vector = |of: fn(&Share) -> &Vec3| {
            Vector::from([0, 1, 2].map(|axis| F64x4::from_lanes(|lane| of(share(lane))[axis])))
        };
        Self {
            nodes,
            regions: nodes.map(|node| u8::from(surface.positions[node as usize].z >= 0.0)),
            centre: vector(|share| &share.centre),
            edge_a: vector(|share| &share.edge_a),
            edge_b: vector(|share| &share.edge_b),
            area_mm2: F64x4::from_lanes(|lane| {
                if lane < count {
                    share(lane).area_mm2
                } else {
                    0.0
                }
            }),
            spread_mm2: F64x4::from_lanes(|lane| share(lane).spread_mm2),
            per_thickness: F64x4::from_lanes(|lane| 1.0 / thickness_mm[nodes[lane] as usize]),
            half_mm: F64x4::from_lanes(|lane| half_mm(share(lane))).greatest(),
        }
    }
}

/// Half of a share's longer diagonal: how far its corners lie from its centre at most.
fn half_mm(share: &Share) -> f64 {
    let diagonal = |to: Vec3| to.norm() / 2.0;
    diagonal(share.edge_a + share.edge_b).max(diagonal(share.edge_a - share.edge_b))
}
