//! Which nodes may touch: a short list, kept while the femur moves little.

use super::Pose;
use crate::{
    Mat3, Vec3,
    geometry::{ArticulatingSurface, FemoralSurface, Share},
};

/// Nodes are listed while their share could come into contact within this much motion, mm.
/// Wider lists last longer and hold more nodes that do not touch.
const MARGIN_MM: f64 = 0.25;

/// How much faster than the motion itself the gap may shrink, on top of the share's own turning:
/// the gap's slope is 1, and a share half as wide as the femur's radius adds at most a fifth.
const GAP_PER_MOTION: f64 = 1.2;

/// The nodes that may touch, exactly those a search over all nodes would find.
///
/// A gap changes no faster than the point moves in the femoral frame. So a node that is further
/// from contact than the femur has moved since the list was made cannot touch.
pub(super) struct Candidates {
    nodes: Vec<u32>,
    made_at: Option<Pose>,
    /// Corners of the box around all shares.
    box_corners: [Vec3; 8],
    longest_half_mm: f64,
}

impl Candidates {
    pub fn new(surface: &ArticulatingSurface) -> Self {
        Self {
            nodes: Vec::new(),
            made_at: None,
            box_corners: box_corners(&surface.shares),
            longest_half_mm: surface.shares.iter().map(half_mm).fold(0.0, f64::max),
        }
    }

    /// The candidates at a pose, ascending.
    pub fn at(&mut self, pose: &Pose, femur: &FemoralSurface, shares: &[Share]) -> &[u32] {
        let stale = self
            .made_at
            .is_none_or(|made_at| self.motion_mm(&made_at, pose) > MARGIN_MM);
        if stale {
            let near = |share: &Share| {
                distance_to_contact_at_least(share, pose, femur, self.longest_half_mm) <= MARGIN_MM
            };
            self.nodes.clear();
            self.nodes
                .extend((0..shares.len() as u32).filter(|&node| near(&shares[node as usize])));
            self.made_at = Some(*pose);
        }
        &self.nodes
    }

    /// The most by which any share can have come nearer to contact between two poses, mm.
    ///
    /// The motion of a point is affine in its place, so its length is largest at a corner of the box.
    fn motion_mm(&self, from: &Pose, to: &Pose) -> f64 {
        let moved = |corner: &Vec3| (to.to_femur(corner) - from.to_femur(corner)).norm_squared();
        let farthest = self
            .box_corners
            .iter()
            .map(moved)
            .fold(0.0, f64::max)
            .sqrt();
        let turned: Mat3 = to.rotation - from.rotation;
        GAP_PER_MOTION * farthest + turned.norm() * self.longest_half_mm
    }
}

/// A lower bound of how far a share is from touching, mm.
fn distance_to_contact_at_least(
    share: &Share,
    pose: &Pose,
    femur: &FemoralSurface,
    longest_half_mm: f64,
) -> f64 {
    let place = pose.to_femur(&share.centre);
    let coarse = femur.gap_mm(&place) - longest_half_mm;
    if coarse > MARGIN_MM {
        return coarse;
    }
    let sample = femur.sample(&place, share.spread_mm2);
    let normal = pose.rotation * sample.normal;
    sample.gap_mm - (normal.dot(&share.edge_a).abs() + normal.dot(&share.edge_b).abs()) / 2.0
}

/// Half of both edges of a share: how far its corners can lie from its centre.
fn half_mm(share: &Share) -> f64 {
    (share.edge_a.norm() + share.edge_b.norm()) / 2.0
}

fn box_corners(shares: &[Share]) -> [Vec3; 8] {
    let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    let wider = |(low, high): (Vec3, Vec3), share: &Share| {
        (low.inf(&share.centre), high.sup(&share.centre))
    };
    let (low, high) = shares.iter().fold(none, wider);
    [0, 1, 2, 3, 4, 5, 6, 7].map(|corner: usize| {
        let pick = |axis: usize| {
            if corner >> axis & 1 == 0 {
                low[axis]
            } else {
                high[axis]
            }
        };
        Vec3::new(pick(0), pick(1), pick(2))
    })
}
