//! What a node stands for: its share of the surface.

pub(super) mod builder;
mod corner_patch;
mod flat_share;

use crate::Vec3;

/// A node's share of the articulating surface: a quarter of each face around it, taken together
/// as the flat parallelogram with the same area, centroid and second moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Centroid, mm. Along the normal it is that of the smooth surface through the nodes.
    pub centre: Vec3,
    /// First edge of the parallelogram, mm.
    pub edge_a: Vec3,
    /// Second edge of the parallelogram, mm.
    pub edge_b: Vec3,
    /// Area, mm2.
    pub area_mm2: f64,
    /// A quarter of the trace of the second moment over the area, mm2: a 24th of a square's area.
    pub spread_mm2: f64,
}
