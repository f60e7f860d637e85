//! The articulating surface in its present shape: normals, areas, and each node's share of the surface.

use super::connectivity::FacesAround;
use crate::{
    Vec3, Vector,
    number::{
        F64x4, LANES, Number, cross, dot, scale_add, tangential_part, vector_from_lanes,
        zero_vector,
    },
};

/// The articulating surface of an insert; every array has one entry per surface node.
#[derive(Clone, Debug, PartialEq)]
pub struct ArticulatingSurface {
    /// Node positions, mm.
    pub positions: Vec<Vec3>,
    /// Unit normals outwards: the average of the unit normals of the faces around.
    pub normals: Vec<Vec3>,
    /// Shares of the surface.
    pub shares: Vec<Share>,
}

impl ArticulatingSurface {
    pub(crate) fn new(positions: Vec<Vec3>, around: &FacesAround) -> Self {
        let (shares, normals) = shares_and_normals(&positions, around);
        Self {
            normals,
            shares,
            positions,
        }
    }

    /// Returns the area of the whole surface, mm2.
    pub fn area_mm2(&self) -> f64 {
        self.shares.iter().map(|share| share.area_mm2).sum()
    }

    /// Returns the same with tributary areas, for pressures that are unknowns at the nodes.
    pub(crate) fn with_tributary_areas(mut self) -> Self {
        for share in &mut self.shares {
            share.area_mm2 = share.tributary_mm2;
        }
        self
    }

    /// Returns the heights of the lowest and the highest node, mm.
    pub fn height_range_mm(&self) -> (f64, f64) {
        let heights = || self.positions.iter().map(|position| position.y);
        (
            heights().fold(f64::INFINITY, f64::min),
            heights().fold(f64::NEG_INFINITY, f64::max),
        )
    }

    /// Returns the mean spread of the shares, weighted by their areas, mm2.
    pub fn mean_spread_mm2(&self) -> f64 {
        let weighted = |share: &Share| share.spread_mm2 * share.area_mm2;
        self.shares.iter().map(weighted).sum::<f64>() / self.area_mm2()
    }

    /// Returns the tangential directions at a node, anterior and lateral.
    pub fn directions(&self, node: usize) -> [Vec3; 2] {
        let normal = self.normals[node];
        let forward = Vec3::x() - normal * normal.x;
        // A wall that faces forwards or backwards has no anterior tangent; the direction up or down it takes its place.
        let anterior = forward
            .try_normalize(1e-9)
            .unwrap_or_else(|| normal.cross(&Vec3::z()).normalize());
        [anterior, anterior.cross(&normal)]
    }
}

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
    /// Area, mm2; the tributary one where pressures are unknowns at the nodes.
    pub area_mm2: f64,
    /// Integral of the node's shape function over the faces, mm2: the load on the node by a pressure of 1 MPa.
    ///
    /// It differs from the area where the faces around the node are no parallelograms.
    pub tributary_mm2: f64,
    /// A quarter of the trace of the second moment over the area, mm2: a 24th of a square's area.
    pub spread_mm2: f64,
}

/// Returns the shares of all nodes, and their unit normals: the average of the unit normals of the faces around.
///
/// Four nodes are computed side by side.
fn shares_and_normals(positions: &[Vec3], around: &FacesAround) -> (Vec<Share>, Vec<Vec3>) {
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
        // The second moment has the trace (a.a + b.b)/12 over the area, and the spread is a quarter of that.
        let spread_mm2 = spread_mm2 * F64x4::splat(1.0 / 48.0);
        let own = vector_from_lanes(|lane| &positions[nodes[lane] as usize]);
        // Between nodes the true surface bulges away from the bilinear faces: the mean of a
        // parabola over a share is a third of the mean of the bilinear faces. So of the
        // centroid's offset from the node, the part along the normal counts a third.
        let third = F64x4::splat(1.0 / 3.0);
        let centre = scale_add(&flat.rise, third, &(own + flat.offset));
        let (mut tributary_mm2, mut normal) = (F64x4::splat(0.0), zero_vector());
        for patch in &patches {
            tributary_mm2 += patch.tributary_mm2;
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
                tributary_mm2: tributary_mm2.lane(lane),
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
    /// Integral of the node's shape function over the face, mm2.
    tributary_mm2: F64x4,
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
        // A uniform pressure loads the node by the integral of its shape function. The map's
        // Jacobian is linear, so that its value at the function's centroid (1/3, 1/3) counts.
        let sixth = F64x4::splat(1.0 / 6.0);
        let at_third = [
            (next * F64x4::splat(2.0) + across - before) * sixth,
            (before * F64x4::splat(2.0) + across - next) * sixth,
        ];
        Self {
            tributary_mm2: length(&cross(&at_third[0], &at_third[1])),
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{GenericInsertShape, Meshing, flat_insert};

    #[test]
    fn verify_shares_of_a_flat_grid_are_its_cells() {
        let insert = flat_insert(
            (6.0, 4.0),
            5.0,
            Meshing {
                edge_mm: 1.0,
                layers: 1,
            },
        )
        .unwrap();
        let surface = insert.surface();
        assert!((surface.area_mm2() - 24.0).abs() < 1e-12);
        let tributary_mm2 = surface.shares.iter().map(|share| share.tributary_mm2);
        assert!((tributary_mm2.sum::<f64>() - 24.0).abs() < 1e-12);
        for (position, share) in surface.positions.iter().zip(&surface.shares) {
            let at_rim = position.x.abs() == 3.0 || position.z.abs() == 2.0;
            if !at_rim {
                assert!((share.centre - position).norm() < 1e-12);
                assert!((share.area_mm2 - 1.0).abs() < 1e-12);
                assert!((share.edge_a.norm() - 1.0).abs() < 1e-12);
                assert!((share.edge_b.norm() - 1.0).abs() < 1e-12);
                assert!(share.edge_a.dot(&share.edge_b).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn verify_shares_of_a_skewed_grid_are_its_parallelograms() {
        let place =
            |i: u32, k: u32| Vec3::new(f64::from(i) + 0.4 * f64::from(k), 0.0, 0.8 * f64::from(k));
        let positions: Vec<Vec3> = (0..9).map(|n| place(n / 3, n % 3)).collect();
        let faces = [[0, 1, 4, 3], [1, 2, 5, 4], [3, 4, 7, 6], [4, 5, 8, 7]];
        let middle = ArticulatingSurface::new(positions, &FacesAround::new(9, &faces)).shares[4];
        assert!((middle.area_mm2 - 0.8).abs() < 1e-12);
        assert!((middle.edge_a.cross(&middle.edge_b).norm() - 0.8).abs() < 1e-12);
    }

    #[test]
    fn verify_the_tributary_area_of_a_trapezium() {
        let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 0.0]];
        let positions = corners.map(|[x, z]| Vec3::new(x, 0.0, z)).to_vec();
        let around = FacesAround::new(4, &[[0, 1, 2, 3]]);
        let shares = ArticulatingSurface::new(positions, &around).shares;
        // With x = 2 u - u v and z = v, the Jacobian is 2 - v: its integrals with the shape functions are 5/12 and 4/12.
        let exact = [5.0, 4.0, 4.0, 5.0].map(|twelfths| twelfths / 12.0);
        for (share, exact) in shares.iter().zip(exact) {
            assert!((share.tributary_mm2 - exact).abs() < 1e-12, "{share:?}");
        }
    }

    #[test]
    fn verify_centroid_of_a_share_of_a_dish() {
        let insert = GenericInsertShape::default()
            .insert(Meshing {
                edge_mm: 1.0,
                layers: 1,
            })
            .unwrap();
        let surface = insert.surface();
        let shape = GenericInsertShape::default();
        let node = surface
            .positions
            .iter()
            .position(|p| (p - Vec3::new(3.0, p.y, 25.0)).norm() < 1e-9);
        let share = surface.shares[node.unwrap()];
        let n = 200;
        let mut mean = 0.0;
        for i in 0..n {
            for k in 0..n {
                let place = |j: i32| (f64::from(j) + 0.5) / f64::from(n) - 0.5;
                mean += shape.height_mm(3.0 + place(i), 25.0 + place(k)) / f64::from(n * n);
            }
        }
        let bulge = share.centre.y - shape.height_mm(share.centre.x, share.centre.z);
        let exact = mean - shape.height_mm(3.0, 25.0);
        assert!((bulge - exact).abs() < 1e-5, "{bulge} {exact}");
    }

    #[test]
    fn directions_are_anterior_and_lateral() {
        let insert = flat_insert(
            (2.0, 2.0),
            5.0,
            Meshing {
                edge_mm: 1.0,
                layers: 1,
            },
        )
        .unwrap();
        assert_eq!(insert.surface().directions(0), [Vec3::x(), Vec3::z()]);
    }
}
