//! The insert's side of the contact: nodes' shares of its surface, four side by side.

use crate::{
    Vec3, Vector,
    geometry::{ArticulatingSurface, Share},
    number::{LANES, Lanes, Number},
};

/// Four nodes' shares, side by side; a lane too many repeats the last node without area.
pub(super) struct Shares4 {
    pub nodes: [u32; LANES],
    pub is_medial: [bool; LANES],
    pub centre: Vector<Lanes>,
    pub edge_a: Vector<Lanes>,
    pub edge_b: Vector<Lanes>,
    pub area_mm2: Lanes,
    pub spread_mm2: Lanes,
    /// One over the thickness below, 1/mm.
    pub per_thickness: Lanes,
    /// Half of both edges of the largest: how far its corners can lie from its centre, mm.
    pub half_mm: f64,
}

impl Shares4 {
    /// All shares of a surface, four at a time in the order of the nodes.
    pub fn of(surface: &ArticulatingSurface, thickness_mm: &[f64]) -> Vec<Self> {
        let count = surface.shares.len() as u32;
        let first = (0..count).step_by(LANES);
        first
            .map(|first| Self::new(first, surface, thickness_mm))
            .collect()
    }

    fn new(first: u32, surface: &ArticulatingSurface, thickness_mm: &[f64]) -> Self {
        let shares = &surface.shares;
        let last = shares.len() as u32 - 1;
        let nodes: [u32; LANES] = std::array::from_fn(|lane| (first + lane as u32).min(last));
        let share = |lane: usize| &shares[nodes[lane] as usize];
        let is_surplus = |lane: usize| first + lane as u32 > last;
        let vector = |of: fn(&Share) -> &Vec3| {
            Vector::from([0, 1, 2].map(|axis| Lanes::from_lanes(|lane| of(share(lane))[axis])))
        };
        Self {
            nodes,
            is_medial: nodes.map(|node| surface.positions[node as usize].z < 0.0),
            centre: vector(|share| &share.centre),
            edge_a: vector(|share| &share.edge_a),
            edge_b: vector(|share| &share.edge_b),
            area_mm2: Lanes::from_lanes(|lane| {
                if is_surplus(lane) {
                    0.0
                } else {
                    share(lane).area_mm2
                }
            }),
            spread_mm2: Lanes::from_lanes(|lane| share(lane).spread_mm2),
            per_thickness: Lanes::from_lanes(|lane| 1.0 / thickness_mm[nodes[lane] as usize]),
            half_mm: Lanes::from_lanes(|lane| half_mm(share(lane))).greatest(),
        }
    }
}

/// Half of both edges of a share: how far its corners can lie from its centre.
fn half_mm(share: &Share) -> f64 {
    (share.edge_a.norm() + share.edge_b.norm()) / 2.0
}
