//! Sums and means over a worn surface.

/// The deepest node counts most for the maximum depth: each node by this power of its depth, high enough
/// to see the bottom of the scar alone, low enough to average over the nodes there.
const DEEP_POWER: i32 = 8;

/// Sum of depth times area, mm3.
pub(super) fn volume_mm3(area_mm2: &[f64], depth_mm: &[f64]) -> f64 {
    area_mm2.iter().zip(depth_mm).map(|(a, d)| a * d).sum()
}

/// Mean of `values` over the volume that `depth_mm` makes; 0 where there is none.
pub fn mean_over_volume(area_mm2: &[f64], depth_mm: &[f64], values: &[f64]) -> f64 {
    let volumes = area_mm2.iter().zip(depth_mm).map(|(a, d)| a * d);
    let sum: f64 = volumes.zip(values).map(|(v, value)| v * value).sum();
    sum / volume_mm3(area_mm2, depth_mm).max(f64::MIN_POSITIVE)
}

/// How much a node of this depth counts for the maximum depth.
pub fn weight_of_depth(depth: f64) -> f64 {
    depth.powi(DEEP_POWER)
}
