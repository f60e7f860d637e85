//! The quarter of a face that belongs to the node at its corner, four nodes side by side.

use crate::{
    Vector,
    number::{F64x4, Number, cross, dot, scale_add},
};

/// A face at each of four nodes, and the quarter of it next to the node; as seen from the node.
pub struct CornerPatch {
    /// Unit normal of the whole face; zero where there is no face.
    pub normal: Vector<F64x4>,
    /// Centre of the quarter.
    pub centre: Vector<F64x4>,
    /// Edges of the parallelogram through the middles of the quarter's sides.
    pub edges: [Vector<F64x4>; 2],
    /// Normal of the quarter, as long as its area.
    pub area_vector: Vector<F64x4>,
    /// Area of the quarter, mm2.
    pub area_mm2: F64x4,
}

impl CornerPatch {
    /// The quarters of bilinear faces with the next corner, the one across and the one before.
    #[inline(always)]
    pub fn new(next: &Vector<F64x4>, across: &Vector<F64x4>, before: &Vector<F64x4>) -> Self {
        let (three, eighth) = (F64x4::splat(3.0), F64x4::splat(0.125));
        // The quarter is the bilinear map of [0, 1/2] squared: its derivatives at (1/4, 1/4) times
        // 1/2 are its edges, and the map there is its centre.
        let edges = [
            scale_add(next, three, &(across - before)) * eighth,
            scale_add(before, three, &(across - next)) * eighth,
        ];
        let area_vector = cross(&edges[0], &edges[1]);
        Self {
            normal: unit(&cross(across, &(before - next))),
            centre: scale_add(&(next + before), three, across) * F64x4::splat(1.0 / 16.0),
            edges,
            area_vector,
            area_mm2: length(&area_vector),
        }
    }
}

#[inline(always)]
fn length(v: &Vector<F64x4>) -> F64x4 {
    dot(v, v).sqrt()
}

/// A vector in units of its length; zero stays zero.
#[inline(always)]
pub fn unit(v: &Vector<F64x4>) -> Vector<F64x4> {
    v * (F64x4::splat(1.0) / Number::max(length(v), F64x4::splat(f64::MIN_POSITIVE)))
}
