//! The quarters around a node taken together as one flat parallelogram.

use super::corner_patch::{CornerPatch, unit};
use crate::{
    Vector,
    number::{F64x4, Number, cross, dot, scale_add, tangential_part, zero_vector},
};

/// The plane of a share, and where its centroid lies from the node.
pub struct FlatShare {
    /// Sum of the quarters' areas, mm2.
    pub area_mm2: F64x4,
    /// Unit normal of the plane.
    normal: Vector<F64x4>,
    /// Offset of the centroid from the node along the plane.
    pub offset: Vector<F64x4>,
    /// The same along its normal.
    pub rise: Vector<F64x4>,
}

impl FlatShare {
    /// The share that some quarters make.
    #[inline(always)]
    pub fn new(patches: &[CornerPatch]) -> Self {
        let (mut area_mm2, mut area_vector, mut moment) =
            (F64x4::splat(0.0), zero_vector(), zero_vector());
        for patch in patches {
            area_mm2 += patch.area_mm2;
            area_vector += patch.area_vector;
            moment = scale_add(&patch.centre, patch.area_mm2, &moment);
        }
        let normal = unit(&area_vector);
        let centroid = moment * (F64x4::splat(1.0) / area_mm2);
        let offset = tangential_part(&centroid, &normal);
        Self {
            area_mm2,
            normal,
            offset,
            rise: centroid - offset,
        }
    }

    /// Edges a and b of the flat parallelogram with the quarters' second moment over its area, the
    /// first along an edge of the first quarter.
    #[inline(always)]
    pub fn parallelogram(&self, patches: &[CornerPatch]) -> [Vector<F64x4>; 2] {
        let u = unit(&tangential_part(&patches[0].edges[0], &self.normal));
        let v = cross(&self.normal, &u);
        // A parallelogram has the second moment (a a' + b b')/12 over its area, about its centre.
        // Each quarter gives its own edges' products, and twelve times those of the arm from the
        // share's centroid to its centre, weighted by its part of the area.
        let mut moment = SecondMoment::none();
        for patch in patches {
            let part = patch.area_mm2 / self.area_mm2;
            moment.add(&patch.edges[0], part, &u, &v);
            moment.add(&patch.edges[1], part, &u, &v);
            let arm = patch.centre - self.offset;
            moment.add(&arm, part * F64x4::splat(12.0), &u, &v);
        }
        // A symmetric matrix is a a' + b b' for many pairs of edges. Of these one has a along u:
        // then b alone reaches along v, so b_v = sqrt(vv), b_u = uv/sqrt(vv), and what is left of
        // uu is a^2 = uu - uv^2/vv.
        let SecondMoment { uu, uv, vv } = moment;
        let determinant = Number::max(uu.mul_sub(vv, uv * uv), F64x4::splat(0.0));
        let edge_a = u * (determinant / vv).sqrt();
        let root = vv.sqrt();
        [edge_a, scale_add(&u, uv / root, &(v * root))]
    }
}

/// Twelve times a second moment over an area, in directions u and v of the plane.
struct SecondMoment {
    uu: F64x4,
    uv: F64x4,
    vv: F64x4,
}

impl SecondMoment {
    fn none() -> Self {
        let zero = F64x4::splat(0.0);
        Self {
            uu: zero,
            uv: zero,
            vv: zero,
        }
    }

    #[inline(always)]
    fn add(&mut self, arm: &Vector<F64x4>, weight: F64x4, u: &Vector<F64x4>, v: &Vector<F64x4>) {
        let (along, across) = (dot(arm, u), dot(arm, v));
        let weighted = weight * along;
        self.uu = weighted.mul_add(along, self.uu);
        self.uv = weighted.mul_add(across, self.uv);
        self.vv = (weight * across).mul_add(across, self.vv);
    }
}
