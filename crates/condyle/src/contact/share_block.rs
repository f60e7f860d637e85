//! The insert's side of the contact: nodes' shares of its surface, a block of four side by side.

use super::model::MAX_REGIONS;
use crate::{
    Vec3, Vector,
    geometry::{ArticulatingSurface, Insert, NodeBlock, Share, SurfaceRegions},
    number::{F64x4, LANES, Number, vector_from_lanes},
};

/// The shares of a block of four nodes; a lane too many repeats the last node without area.
pub(crate) struct ShareBlock {
    pub nodes: [u32; LANES],
    /// The region of the surface that each node belongs to.
    pub regions: [u8; LANES],
    /// 1 in the lanes that belong to a region, 0 in the others.
    pub in_region: [F64x4; MAX_REGIONS],
    pub centre: Vector<F64x4>,
    pub edge_a: Vector<F64x4>,
    pub edge_b: Vector<F64x4>,
    pub area_mm2: F64x4,
    pub spread_mm2: F64x4,
    /// One over the thickness below, 1/mm.
    pub per_thickness: F64x4,
    /// The largest distance of a corner from its centre, mm.
    pub half_mm: f64,
}

impl ShareBlock {
    /// All shares of an insert's surface, in its blocks of nodes.
    pub fn from_shares(insert: &Insert, surface: &ArticulatingSurface) -> Vec<Self> {
        let blocks = insert.node_blocks().iter();
        blocks
            .map(|block| Self::new(block, surface, insert))
            .collect()
    }

    /// The same, each share taken to be what lies at its node alone: its centre there, and without spread.
    pub fn from_nodes(insert: &Insert, surface: &ArticulatingSurface) -> Vec<Self> {
        let at_nodes = |block: Self| Self {
            centre: vector_from_lanes(|lane| &surface.positions[block.nodes[lane] as usize]),
            spread_mm2: F64x4::splat(0.0),
            ..block
        };
        Self::from_shares(insert, surface)
            .into_iter()
            .map(at_nodes)
            .collect()
    }

    fn new(block: &NodeBlock, surface: &ArticulatingSurface, insert: &Insert) -> Self {
        let NodeBlock { nodes, count } = *block;
        let thickness_mm = insert.thickness_mm();
        let share = |lane: usize| &surface.shares[nodes[lane] as usize];
        let regions = nodes.map(|node| region_of(insert.regions(), node));
        let is_in = |region: usize, lane: usize| usize::from(regions[lane]) == region;
        Self {
            nodes,
            regions,
            in_region: std::array::from_fn(|region| {
                F64x4::from_lanes(|lane| f64::from(u8::from(is_in(region, lane))))
            }),
            centre: vector_from_lanes(|lane| &share(lane).centre),
            edge_a: vector_from_lanes(|lane| &share(lane).edge_a),
            edge_b: vector_from_lanes(|lane| &share(lane).edge_b),
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

/// The region of a node; whatever is beyond the last that loads are told apart by counts to that.
fn region_of(regions: &SurfaceRegions, node: u32) -> u8 {
    regions.of_node(node as usize).min(MAX_REGIONS - 1) as u8
}

/// Half of a share's longer diagonal: how far its corners lie from its centre at most.
fn half_mm(share: &Share) -> f64 {
    let diagonal = |to: Vec3| to.norm() / 2.0;
    diagonal(share.edge_a + share.edge_b).max(diagonal(share.edge_a - share.edge_b))
}
