//! The shares of a block of nodes, as the contact evaluates them.

use crate::{
    Vec3, Vector,
    contact::model::MAX_REGIONS,
    geometry::{ArticulatingSurface, Insert, NodeBlock, Share},
    number::{F64x4, LANES, Number, vector_from_lanes},
};

/// The shares of a block of four nodes, side by side; unused lanes repeat the last node with no area.
pub(crate) struct ShareBlock {
    pub nodes: [u32; LANES],
    pub regions: [u8; LANES],
    /// For each region, 1 in the lanes of its nodes and 0 in the others.
    pub in_region: [F64x4; MAX_REGIONS],
    pub centre: Vector<F64x4>,
    pub edge_a: Vector<F64x4>,
    pub edge_b: Vector<F64x4>,
    pub area_mm2: F64x4,
    pub spread_mm2: F64x4,
    /// One over the thickness below, 1/mm.
    pub per_thickness: F64x4,
    /// The largest distance of a corner from the centre of its share, mm.
    pub half_mm: f64,
}

impl ShareBlock {
    /// Returns all shares of an insert's surface, in its blocks of nodes.
    pub fn from_shares(insert: &Insert, surface: &ArticulatingSurface) -> Vec<Self> {
        let blocks = insert.node_blocks().iter();
        blocks
            .map(|block| Self::new(block, surface, insert))
            .collect()
    }

    /// Returns the same with each share shrunk to its node: the centre lies there, and the spread is 0.
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
        let share = |lane: usize| &surface.shares[nodes[lane] as usize];
        // Loads are summed for MAX_REGIONS regions; further regions count as the last of these.
        let region = |node: u32| insert.regions().of_node(node as usize).min(MAX_REGIONS - 1);
        let regions = nodes.map(|node| region(node) as u8);
        let is_in = |region: usize, lane: usize| usize::from(regions[lane]) == region;
        let half_mm = |share: &Share| {
            let half_of = |diagonal: Vec3| diagonal.norm() / 2.0;
            half_of(share.edge_a + share.edge_b).max(half_of(share.edge_a - share.edge_b))
        };
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
            per_thickness: F64x4::from_lanes(|lane| {
                1.0 / insert.thickness_mm()[nodes[lane] as usize]
            }),
            half_mm: F64x4::from_lanes(|lane| half_mm(share(lane))).greatest(),
        }
    }
}
