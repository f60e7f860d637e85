//! The share of the surface that belongs to a node.

use super::connectivity::FacesAround;
use crate::{
    Vec3, Vector,
    number::{
        F64x4, LANES, Number, cross, dot, scale_add, tangential_part, vector_from_lanes,
        zero_vector,
    },
};

/// A node's share of the articulating surface: a quarter of each face around it, combined
/// as the flat parallelogram with the same area, centroid and second moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Share {
    /// Centroid, mm; along the normal, the centroid of the smooth surface through the nodes.
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

/// Returns the shares of all nodes, and their unit normals: the average of the unit normals of the faces around.
///
/// Four nodes are computed side by side.
pub(super) fn shares_and_normals(
    positions: &[Vec3],
    around: &FacesAround,
) -> (Vec<Share>, Vec<Vec3>) {
    let count = positions.len();
    let (mut shares, mut normals) = (Vec::with_capacity(count), Vec::with_capacity(count));
    let mut patches = Vec::new();
    for first in (0..count).step_by(LANES) {
        let nodes = [0, 1, 2, 3].map(|lane| (first + lane).min(count - 1) as u32);
        let faces = nodes.map(|node| around.of(node as usize));
        let most = faces.iter().map(|faces| faces.len()).max().unwrap_or(0);
        patches.clear();
        for place in 0..most {
            patches.push(patch(positions, &nodes, &faces, place));
        }
        let flat = FlatShare::new(&patches);
        let [edge_a, edge_b] = flat.parallelogram(&patches);
        let spread_mm2 = dot(&edge_a, &edge_a) + dot(&edge_b, &edge_b);
        let spread_mm2 = spread_mm2 * F64x4::splat(1.0 / 48.0);
        let own = vector_from_lanes(|lane| &positions[nodes[lane] as usize]);
        // Between nodes the true surface bulges away from the bilinear faces: the mean of a
        // parabola over a share is a third of the mean of the bilinear faces. So of the
        // centroid's offset from the node, the part along the normal counts a third.
        let third = F64x4::splat(1.0 / 3.0);
        let centre = scale_add(&flat.rise, third, &(own + flat.offset));
        let mut normal = zero_vector();
        for patch in &patches {
            normal += patch.normal;
        }
        let normal = unit(&normal);
        for lane in 0..LANES.min(count - first) {
            let of_lane =
                |v: &Vector<F64x4>| Vec3::new(v.x.lane(lane), v.y.lane(lane), v.z.lane(lane));
            normals.push(of_lane(&normal));
            shares.push(Share {
                centre: of_lane(&centre),
                edge_a: of_lane(&edge_a),
                edge_b: of_lane(&edge_b),
                area_mm2: flat.area_mm2.lane(lane),
                spread_mm2: spread_mm2.lane(lane),
            });
        }
    }
    (shares, normals)
}

/// Returns the faces number `place` around four nodes; a node with fewer faces has an empty one.
#[inline(always)]
fn patch(
    positions: &[Vec3],
    nodes: &[u32; LANES],
    faces: &[&[[u32; 3]]; LANES],
    place: usize,
) -> CornerPatch {
    let mut corners = [*nodes; 3];
    for lane in 0..LANES {
        if let Some(face) = faces[lane].get(place) {
            corners[0][lane] = face[0];
            corners[1][lane] = face[1];
            corners[2][lane] = face[2];
        }
    }
    let places = |nodes: &[u32; LANES]| vector_from_lanes(|lane| &positions[nodes[lane] as usize]);
    let own = places(nodes);
    CornerPatch::new(
        &(places(&corners[0]) - own),
        &(places(&corners[1]) - own),
        &(places(&corners[2]) - own),
    )
}

/// A face at each of four nodes, and the quarter of it next to the node, relative to the node.
struct CornerPatch {
    /// Unit normal of the whole face; zero where there is no face.
    normal: Vector<F64x4>,
    centre: Vector<F64x4>,
    /// Edges of the parallelogram through the middles of the quarter's sides.
    edges: [Vector<F64x4>; 2],
    /// Normal of the quarter, as long as its area.
    area_vector: Vector<F64x4>,
    area_mm2: F64x4,
}

impl CornerPatch {
    /// Creates the quarters of bilinear faces with the next corner, the opposite one and the one before.
    #[inline(always)]
    fn new(next: &Vector<F64x4>, across: &Vector<F64x4>, before: &Vector<F64x4>) -> Self {
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

/// Returns a vector in units of its length; zero stays zero.
#[inline(always)]
fn unit(v: &Vector<F64x4>) -> Vector<F64x4> {
    v * (F64x4::splat(1.0) / Number::max(length(v), F64x4::splat(f64::MIN_POSITIVE)))
}

/// The plane of a share, and the position of its centroid relative to the node.
struct FlatShare {
    area_mm2: F64x4,
    normal: Vector<F64x4>,
    /// Offset of the centroid from the node along the plane.
    offset: Vector<F64x4>,
    /// Offset of the centroid along its normal.
    rise: Vector<F64x4>,
}

impl FlatShare {
    #[inline(always)]
    fn new(patches: &[CornerPatch]) -> Self {
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
    fn parallelogram(&self, patches: &[CornerPatch]) -> [Vector<F64x4>; 2] {
        let u = unit(&tangential_part(&patches[0].edges[0], &self.normal));
        let v = cross(&self.normal, &u);
        // A parallelogram has the second moment (a a' + b b')/12 over its area, about its centre.
        // Each quarter gives its own edges' products, and twelve times those of the arm from the
        // share's centroid to its centre, weighted by its part of the area.
        let zero = F64x4::splat(0.0);
        let mut moment = SecondMoment {
            uu: zero,
            uv: zero,
            vv: zero,
        };
        for patch in patches {
            let part = patch.area_mm2 / self.area_mm2;
            moment.add(&patch.edges[0], part, &u, &v);
            moment.add(&patch.edges[1], part, &u, &v);
            let arm = patch.centre - self.offset;
            moment.add(&arm, part * F64x4::splat(12.0), &u, &v);
        }
        // A symmetric matrix is a a' + b b' for many pairs of edges. Of these one has a along u:
        // then b alone has a part along v, so b_v = sqrt(vv), b_u = uv/sqrt(vv), and the rest of
        // uu is a^2 = uu - uv^2/vv.
        let SecondMoment { uu, uv, vv } = moment;
        // Rounding may leave the determinant of a sliver slightly negative.
        let determinant = Number::max(uu.mul_sub(vv, uv * uv), zero);
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
    #[inline(always)]
    fn add(&mut self, arm: &Vector<F64x4>, weight: F64x4, u: &Vector<F64x4>, v: &Vector<F64x4>) {
        let (along, across) = (dot(arm, u), dot(arm, v));
        let weighted = weight * along;
        self.uu = weighted.mul_add(along, self.uu);
        self.uv = weighted.mul_add(across, self.uv);
        self.vv = (weight * across).mul_add(across, self.vv);
    }
}
