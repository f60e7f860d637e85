//! Sums over all blocks that touch.

use super::traction::Tractions4;
use crate::{
    Vec3, Vector,
    contact::model::MAX_REGIONS,
    number::{
        F64x4, Number,
        vector::{cross, scale_add, zero_vector},
    },
    spatial::{Wrench, body},
};

/// The wrench of many forces.
pub(super) struct WrenchSum([F64x4; 6]);

impl WrenchSum {
    pub fn new() -> Self {
        Self([F64x4::splat(0.0); 6])
    }

    /// Adds forces at places, about the origin.
    #[inline(always)]
    pub fn add(&mut self, place: &Vector<F64x4>, force: &Vector<F64x4>) {
        let moment = cross(place, force);
        let wrench = [moment.x, moment.y, moment.z, force.x, force.y, force.z];
        for (sum, part) in self.0.iter_mut().zip(&wrench) {
            *sum += *part;
        }
    }

    /// The sum.
    pub fn total(&self) -> Wrench<body::Insert, body::Femur> {
        let [mx, my, mz, fx, fy, fz] = self.0.map(F64x4::sum);
        Wrench::new(Vec3::new(mx, my, mz), Vec3::new(fx, fy, fz))
    }
}

/// Slip of many shares weighted by their loads, in every region.
pub(super) struct RegionSlips([(F64x4, Vector<F64x4>); MAX_REGIONS]);

impl RegionSlips {
    pub fn new() -> Self {
        Self([(F64x4::splat(0.0), zero_vector()); MAX_REGIONS])
    }

    /// Adds shares, of which `in_region` says which belong to each region.
    #[inline(always)]
    pub fn add(&mut self, in_region: &[F64x4; MAX_REGIONS], pressed: &Tractions4) {
        let load = pressed.pressure_mpa * pressed.area_mm2;
        let velocity = &pressed.sliding.velocity_mm_per_s;
        for ((loads, slips), is_in) in self.0.iter_mut().zip(in_region) {
            let own = load * *is_in;
            *loads += own;
            *slips = scale_add(velocity, own, slips);
        }
    }

    /// The mean of each region, mm/s; none where nothing is loaded.
    pub fn means(&self) -> [Vec3; MAX_REGIONS] {
        self.0
            .map(|(loads, slips)| slips.map(F64x4::sum) / loads.sum().max(f64::MIN_POSITIVE))
    }
}
