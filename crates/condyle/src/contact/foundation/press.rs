//! What presses a block that touches.

use super::{
    mean_overclosure::{EdgeSlopes, mean_overclosure},
    settings::Foundation,
};
use crate::{
    contact::{
        pressed::{CachedSample, Sliding, Tractions4},
        share_block::ShareBlock,
    },
    number::{
        F64x4,
        vector::{cross, scale_add, tangential_part, zero_vector},
    },
    spatial::{Pose4, Twist4},
};

impl Foundation {
    /// Pressure and rubbing on the shares.
    ///
    /// With n the femur's normal, K its curvature, G the gradient of the gap, e_k the share's edges and W
    /// the mean overclosure of the share, a motion a and a turn w of the femur change the middle's
    /// overclosure by G . a, the normal by w x n - K a, and each edge slope n . e_k with the normal.
    #[inline(always)]
    pub(super) fn press(
        &self,
        cached: &CachedSample,
        slopes: &EdgeSlopes<F64x4>,
        shares: &ShareBlock,
        pose: &Pose4,
        twist: &Twist4,
    ) -> Tractions4 {
        let CachedSample { place, sample } = cached;
        let mean = mean_overclosure(-sample.gap_mm, slopes);
        let (pressure_mpa, slope) = self.pressure.pressures(mean.mm, shares.per_thickness);
        let stiffness = slope * shares.area_mm2;
        let mut load_by_motion = sample.gap_gradient * (mean.by_middle * stiffness);
        let mut load_by_turn = zero_vector();
        if let Some(by_slope) = mean.by_slope {
            let (by_a, by_b) = (by_slope[0] * stiffness, by_slope[1] * stiffness);
            let by_normal = scale_add(&shares.edge_a, by_a, &(shares.edge_b * by_b));
            let by_normal = pose.turn_to_femur(&by_normal);
            let along_surface = tangential_part(&by_normal, &sample.normal);
            load_by_motion -= sample.curvature.times(&along_surface);
            load_by_turn = cross(&sample.normal, &by_normal);
        }
        Tractions4 {
            pressure_mpa,
            area_mm2: shares.area_mm2,
            covered_mm2: mean.by_middle * shares.area_mm2,
            load_by_motion,
            load_by_turn,
            sliding: Sliding::new(
                &twist.velocity(place),
                &sample.normal,
                self.slip_tolerance_mm_per_s,
            ),
        }
    }
}
