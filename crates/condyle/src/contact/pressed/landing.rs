//! What nodes feel where an increment ends.

use super::{
    cached_sample::CachedSample,
    near_blocks::NearBlock,
    traction::{Coulomb, Sliding, Tractions4},
};
use crate::{
    Vec3, Vector,
    contact::{model::TouchedNode, share_block::ShareBlock},
    geometry::ArticulatingSurface,
    number::{
        F64x4, Number,
        vector::{dot, vector_from_lanes},
    },
    spatial::{FrameChange, Pose, Pose4, RelativeMotion, Twist, Twist4},
};

/// The surface's own directions at the four nodes of a block.
pub(super) struct Directions4([Vector<F64x4>; 2]);

impl Directions4 {
    /// Anterior along the surface, then lateral along it.
    pub fn new(surface: &ArticulatingSurface, shares: &ShareBlock) -> Self {
        let at = shares.nodes.map(|node| surface.directions(node as usize));
        Self([0, 1].map(|which| vector_from_lanes(|lane| &at[lane][which])))
    }
}

/// A short way from the last response to where the increment ends, to first order.
pub(super) struct ShortWay {
    moved: Twist4,
    twist: Twist4,
    pose: Pose4,
}

/// A block of shares at the end of an increment.
struct Landed4 {
    pressure_mpa: F64x4,
    covered_mm2: F64x4,
    /// In the insert frame.
    force_n: Vector<F64x4>,
    /// In the surface's own directions.
    sliding_mm_per_s: [F64x4; 2],
}

impl ShortWay {
    /// From a response at a pose to a motion near it.
    pub fn between(from: &Pose, to: &RelativeMotion) -> Self {
        let change = FrameChange::to_femur(from);
        Self {
            moved: Twist4::new(&change.twist(&Twist::between(from, &to.pose))),
            twist: Twist4::new(&change.twist(&to.twist)),
            pose: Pose4::new(from),
        }
    }

    /// Adds the nodes of a block that press at its end.
    #[inline(always)]
    pub fn land(
        &self,
        friction: Coulomb,
        (near, tractions): (&NearBlock, &Tractions4),
        (shares, directions): (&ShareBlock, &Directions4),
        touched: &mut Vec<TouchedNode>,
    ) {
        let landed = self.landed(friction, near, tractions, directions);
        landed.add(shares, touched);
    }

    /// A block at the end: pressures follow the motion to first order, the covered area stays.
    #[inline(always)]
    fn landed(
        &self,
        friction: Coulomb,
        near: &NearBlock,
        tractions: &Tractions4,
        directions: &Directions4,
    ) -> Landed4 {
        let CachedSample { place, sample } = &near.cached;
        let change_n = tractions.load_change_n(place, &self.moved);
        let area_mm2 = Number::max(tractions.area_mm2, F64x4::splat(f64::MIN_POSITIVE));
        let pressure_mpa = tractions.pressure_mpa + change_n / area_mm2;
        let landed = Tractions4 {
            pressure_mpa: Number::max(pressure_mpa, F64x4::splat(0.0)),
            sliding: Sliding::new(
                &self.twist.velocity(place),
                &sample.normal,
                friction.slip_tolerance_mm_per_s,
            ),
            ..*tractions
        };
        let force_n = landed.force_n(&sample.normal, friction.coefficient);
        let sliding = self.pose.turn_to_insert(&landed.sliding.velocity_mm_per_s);
        let [anterior, lateral] = &directions.0;
        Landed4 {
            pressure_mpa: landed.pressure_mpa,
            covered_mm2: landed.covered_mm2,
            force_n: self.pose.turn_to_insert(&force_n),
            sliding_mm_per_s: [dot(&sliding, anterior), dot(&sliding, lateral)],
        }
    }
}

impl Landed4 {
    /// Adds those of a block that press.
    #[inline(always)]
    fn add(&self, shares: &ShareBlock, touched: &mut Vec<TouchedNode>) {
        for (lane, &node) in shares.nodes.iter().enumerate() {
            let pressure_mpa = self.pressure_mpa.lane(lane);
            if pressure_mpa * shares.area_mm2.lane(lane) > 0.0 {
                let force = &self.force_n;
                let [anterior, lateral] = &self.sliding_mm_per_s;
                touched.push(TouchedNode {
                    node,
                    region: shares.regions[lane],
                    pressure_mpa,
                    covered_mm2: self.covered_mm2.lane(lane),
                    force_n: Vec3::new(force.x.lane(lane), force.y.lane(lane), force.z.lane(lane)),
                    sliding_mm_per_s: [anterior.lane(lane), lateral.lane(lane)],
                    along_mm: [0.0; 2],
                });
            }
        }
    }
}
