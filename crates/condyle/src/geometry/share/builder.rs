//! Each node's share of a surface, four nodes side by side.

use super::FacesAround;
use crate::{
    Vec3, Vector,
    number::vector::{cross, dot, scale_add, tangential_part, zero_vector},
    number::{F64x4, LANES, Number},
};

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

/// A face around each of four nodes, and the quarter of it at the node; as seen from the node.
struct Quarter {
    /// Unit normal of the face; zero where there is no face.
    normal: Vector<F64x4>,
    centre: Vector<F64x4>,
    edges: [Vector<F64x4>; 2],
    area_vector: Vector<F64x4>,
    area_mm2: F64x4,
}

impl Quarter {
    /// The quarters of bilinear faces with the next corner, the one across and the one before.
    #[inline(always)]
    fn new(next: &Vector<F64x4>, across: &Vector<F64x4>, before: &Vector<F64x4>) -> Self {
        let (three, eighth) = (F64x4::splat(3.0), F64x4::splat(0.125));
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

/// Looks at the faces around four nodes at a time.
pub(super) struct ShareSeeker<'a> {
    positions: &'a [Vec3],
    around: &'a FacesAround,
    /// Those of the last four nodes.
    quarters: Vec<Quarter>,
}

/// What four nodes find around them.
pub(super) struct Found {
    /// Average of the unit normals of the faces around.
    normal: Vector<F64x4>,
    centre: Vector<F64x4>,
    edge_a: Vector<F64x4>,
    edge_b: Vector<F64x4>,
    area_mm2: F64x4,
    spread_mm2: F64x4,
}

impl<'a> ShareSeeker<'a> {
    pub fn new(positions: &'a [Vec3], around: &'a FacesAround) -> Self {
        Self {
            positions,
            around,
            quarters: Vec::new(),
        }
    }

    /// Shares and normals of four nodes.
    pub fn find(&mut self, nodes: &[u32; LANES]) -> Found {
        let faces = nodes.map(|node| self.around.of(node as usize));
        let most = faces.iter().map(|faces| faces.len()).max().unwrap_or(0);
        self.quarters.clear();
        for place in 0..most {
            let quarter = self.quarter(nodes, &faces, place);
            self.quarters.push(quarter);
        }
        let flat = Flat::new(&self.quarters);
        let [edge_a, edge_b] = flat.parallelogram(&self.quarters);
        let spread_mm2 = dot(&edge_a, &edge_a) + dot(&edge_b, &edge_b);
        let own = self.places(nodes);
        let third = F64x4::splat(1.0 / 3.0);
        let mut normal = zero_vector();
        for quarter in &self.quarters {
            normal += quarter.normal;
        }
        Found {
            normal: unit(&normal),
            // Between nodes the true surface bulges away from the bilinear faces: the mean of a
            // parabola over a share is a third of what the bilinear faces say. So of the
            // centroid's offset from the node, the part along the normal counts a third.
            centre: scale_add(&flat.rise, third, &(own + flat.offset)),
            edge_a,
            edge_b,
            area_mm2: flat.area_mm2,
            spread_mm2: spread_mm2 * F64x4::splat(1.0 / 48.0),
        }
    }

    /// The faces number `place` around four nodes; a node with fewer has an empty one.
    #[inline(always)]
    fn quarter(&self, nodes: &[u32; LANES], faces: &[&[[u32; 3]]; LANES], place: usize) -> Quarter {
        let mut corners = [*nodes; 3];
        for lane in 0..LANES {
            if let Some(face) = faces[lane].get(place) {
                corners[0][lane] = face[0];
                corners[1][lane] = face[1];
                corners[2][lane] = face[2];
            }
        }
        let own = self.places(nodes);
        Quarter::new(
            &(self.places(&corners[0]) - own),
            &(self.places(&corners[1]) - own),
            &(self.places(&corners[2]) - own),
        )
    }

    #[inline(always)]
    fn places(&self, nodes: &[u32; LANES]) -> Vector<F64x4> {
        let at = |lane: usize| &self.positions[nodes[lane] as usize];
        let [a, b, c, d] = [at(0), at(1), at(2), at(3)];
        let lanes = |axis: usize| F64x4::new([a[axis], b[axis], c[axis], d[axis]]);
        Vector::new(lanes(0), lanes(1), lanes(2))
    }
}

impl Found {
    /// The share of one of the four nodes.
    pub fn share(&self, lane: usize) -> Share {
        Share {
            centre: one(&self.centre, lane),
            edge_a: one(&self.edge_a, lane),
            edge_b: one(&self.edge_b, lane),
            area_mm2: self.area_mm2.lane(lane),
            spread_mm2: self.spread_mm2.lane(lane),
        }
    }

    /// The unit normal at one of the four nodes.
    pub fn normal(&self, lane: usize) -> Vec3 {
        one(&self.normal, lane)
    }
}

/// The plane of a share, and where its centroid lies from the node.
struct Flat {
    area_mm2: F64x4,
    normal: Vector<F64x4>,
    /// Offset of the centroid from the node along the plane.
    offset: Vector<F64x4>,
    /// And along its normal.
    rise: Vector<F64x4>,
}

impl Flat {
    #[inline(always)]
    fn new(quarters: &[Quarter]) -> Self {
        let (mut area_mm2, mut area_vector, mut moment) =
            (F64x4::splat(0.0), zero_vector(), zero_vector());
        for quarter in quarters {
            area_mm2 += quarter.area_mm2;
            area_vector += quarter.area_vector;
            moment = scale_add(&quarter.centre, quarter.area_mm2, &moment);
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

    /// Edges of the flat parallelogram with the quarters' second moment over its area, the first
    /// along an edge of the first quarter: moment = (a a' + b b')/12.
    #[inline(always)]
    fn parallelogram(&self, quarters: &[Quarter]) -> [Vector<F64x4>; 2] {
        let u = unit(&tangential_part(&quarters[0].edges[0], &self.normal));
        let v = cross(&self.normal, &u);
        let mut sums = Moments::none();
        for quarter in quarters {
            let part = quarter.area_mm2 / self.area_mm2;
            sums.add(&quarter.edges[0], part, &u, &v);
            sums.add(&quarter.edges[1], part, &u, &v);
            let lever = quarter.centre - self.offset;
            sums.add(&lever, part * F64x4::splat(12.0), &u, &v);
        }
        let Moments { uu, uv, vv } = sums;
        let determinant = Number::max(uu.mul_sub(vv, uv * uv), F64x4::splat(0.0));
        let edge_a = u * (determinant / vv).sqrt();
        let root = vv.sqrt();
        [edge_a, scale_add(&u, uv / root, &(v * root))]
    }
}

/// Second moments in the plane of a share.
struct Moments {
    uu: F64x4,
    uv: F64x4,
    vv: F64x4,
}

impl Moments {
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

#[inline(always)]
fn length(v: &Vector<F64x4>) -> F64x4 {
    dot(v, v).sqrt()
}

/// A vector in units of its length; zero stays zero.
#[inline(always)]
fn unit(v: &Vector<F64x4>) -> Vector<F64x4> {
    v * (F64x4::splat(1.0) / Number::max(length(v), F64x4::splat(f64::MIN_POSITIVE)))
}

fn one(v: &Vector<F64x4>, lane: usize) -> Vec3 {
    Vec3::new(v.x.lane(lane), v.y.lane(lane), v.z.lane(lane))
}
