//! Which nodes may touch: a short list, kept while the femur moves little.

use super::{Pose, motion::Pose4};
use crate::{
    Vec3, Vector,
    geometry::{ArticulatingSurface, FemoralSurface, Share},
    number::{LANES, Lanes, Number},
};

/// Nodes are listed while their share could come into contact within this much motion, mm.
/// Wider lists last longer and hold more nodes that do not touch.
const MARGIN_MM: f64 = 0.25;

/// Curvature that no articulating surface exceeds, 1/mm: how fast a share's reach may grow.
const SHARPEST_PER_MM: f64 = 0.2;

/// What the mean gap of a share may differ from the gap at its centre, and the widening of its
/// reach that keeps the mean overclosure's closed form away from 0/0, mm.
const SPREAD_MM: f64 = 0.02;

/// Four nodes that may touch, side by side; a lane too many repeats the last node without area.
pub(super) struct Candidates4 {
    pub nodes: [u32; LANES],
    pub centre: Vector<Lanes>,
    pub edge_a: Vector<Lanes>,
    pub edge_b: Vector<Lanes>,
    pub area_mm2: Lanes,
    pub spread_mm2: Lanes,
    pub thickness_mm: Lanes,
    /// A share touches only where its gap is below this, mm: half its rise over both edges.
    reach_mm: Lanes,
}

/// The nodes that may touch, exactly those a search over all nodes would find.
///
/// A gap changes no faster than the point moves in the femoral frame. So a node that is further
/// from contact than the femur has moved since the list was made cannot touch.
pub(super) struct Candidates {
    list: Vec<Candidates4>,
    made_at: Option<Pose>,
    /// Corners of the box around all shares.
    box_corners: [Vec3; 8],
    longest_half_mm: f64,
    /// How much further shares may reach now than when the list was made, mm.
    reach_growth_mm: f64,
}

/// How far the femur has moved and turned between two poses.
struct Motion {
    farthest_mm: f64,
    turn_rad: f64,
}

impl Candidates {
    pub fn new(surface: &ArticulatingSurface) -> Self {
        Self {
            list: Vec::new(),
            made_at: None,
            box_corners: box_corners(&surface.shares),
            longest_half_mm: surface.shares.iter().map(half_mm).fold(0.0, f64::max),
            reach_growth_mm: 0.0,
        }
    }

    /// Makes the list good for a pose.
    pub fn update(
        &mut self,
        pose: &Pose,
        femur: &FemoralSurface,
        shares: &[Share],
        thickness_mm: &[f64],
    ) {
        if let Some(made_at) = &self.made_at {
            let Motion {
                farthest_mm,
                turn_rad,
            } = self.motion(made_at, pose);
            self.reach_growth_mm =
                self.longest_half_mm * (turn_rad + farthest_mm * SHARPEST_PER_MM);
            if farthest_mm + self.reach_growth_mm <= MARGIN_MM {
                return;
            }
        }
        let candidate = |(node, share): (u32, &Share)| {
            let (to_contact_mm, reach_mm) =
                distance_to_contact(share, pose, femur, self.longest_half_mm);
            (to_contact_mm <= MARGIN_MM).then_some((node, reach_mm))
        };
        let found: Vec<(u32, f64)> = (0..).zip(shares).filter_map(candidate).collect();
        let four = |some: &[(u32, f64)]| Candidates4::new(some, shares, thickness_mm);
        self.list = found.chunks(LANES).map(four).collect();
        self.made_at = Some(*pose);
        self.reach_growth_mm = 0.0;
    }

    /// The candidates that a look at their gap does not rule out, ascending.
    #[inline]
    pub fn near(&self, pose: &Pose4, femur: &FemoralSurface) -> impl Iterator<Item = &Candidates4> {
        let slack = Lanes::splat(self.reach_growth_mm + SPREAD_MM);
        self.list.iter().filter(move |four| {
            let gap = femur.gap_mm(&pose.to_femur(&four.centre));
            (gap - four.reach_mm - slack).any_below_zero()
        })
    }

    /// The motion of a point is affine in its place, so its length is largest at a corner of the box.
    fn motion(&self, from: &Pose, to: &Pose) -> Motion {
        let moved = |corner: &Vec3| (to.to_femur(corner) - from.to_femur(corner)).norm_squared();
        Motion {
            farthest_mm: self
                .box_corners
                .iter()
                .map(moved)
                .fold(0.0, f64::max)
                .sqrt(),
            turn_rad: (to.rotation - from.rotation).norm(),
        }
    }
}

impl Candidates4 {
    fn new(some: &[(u32, f64)], shares: &[Share], thickness_mm: &[f64]) -> Self {
        let nodes = std::array::from_fn(|lane| some[lane.min(some.len() - 1)].0);
        let share = |lane: usize| &shares[nodes[lane] as usize];
        let vector = |of: fn(&Share) -> &Vec3| {
            Vector::from([0, 1, 2].map(|axis| Lanes::from_lanes(|lane| of(share(lane))[axis])))
        };
        Self {
            nodes,
            centre: vector(|share| &share.centre),
            edge_a: vector(|share| &share.edge_a),
            edge_b: vector(|share| &share.edge_b),
            area_mm2: Lanes::from_lanes(|lane| {
                if lane < some.len() {
                    share(lane).area_mm2
                } else {
                    0.0
                }
            }),
            spread_mm2: Lanes::from_lanes(|lane| share(lane).spread_mm2),
            thickness_mm: Lanes::from_lanes(|lane| thickness_mm[nodes[lane] as usize]),
            reach_mm: Lanes::from_lanes(|lane| some[lane.min(some.len() - 1)].1),
        }
    }
}

/// A lower bound of how far a share is from touching, and how far it reaches below its middle, mm.
fn distance_to_contact(
    share: &Share,
    pose: &Pose,
    femur: &FemoralSurface,
    longest_half_mm: f64,
) -> (f64, f64) {
    let place = pose.to_femur(&share.centre);
    let gap_mm = femur.gap_mm(&place) - SPREAD_MM;
    if gap_mm - longest_half_mm > MARGIN_MM {
        return (gap_mm - longest_half_mm, longest_half_mm);
    }
    let normal = pose.rotation * femur.sample(&place, share.spread_mm2).normal;
    let reach_mm = (normal.dot(&share.edge_a).abs() + normal.dot(&share.edge_b).abs()) / 2.0;
    (gap_mm - reach_mm, reach_mm)
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
