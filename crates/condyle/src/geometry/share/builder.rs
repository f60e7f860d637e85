//! From the faces around nodes to the nodes' shares and normals, four nodes side by side.

use super::{
    Share,
    corner_patch::{CornerPatch, unit},
    flat_share::FlatShare,
};
use crate::{
    Vec3, Vector,
    geometry::faces_around::FacesAround,
    number::{F64x4, LANES, Number, dot, scale_add, zero_vector},
};

/// Makes shares of the faces around nodes, four nodes at a time.
pub struct ShareBuilder<'a> {
    positions: &'a [Vec3],
    around: &'a FacesAround,
    /// Room for the quarters around the four nodes at hand.
    patches: Vec<CornerPatch>,
}

/// Shares and normals of four nodes.
pub struct FourShares {
    /// Average of the unit normals of the faces around.
    normal: Vector<F64x4>,
    centre: Vector<F64x4>,
    edge_a: Vector<F64x4>,
    edge_b: Vector<F64x4>,
    area_mm2: F64x4,
    spread_mm2: F64x4,
}

impl<'a> ShareBuilder<'a> {
    /// A builder for the nodes of a surface at `positions` with faces around them.
    pub fn new(positions: &'a [Vec3], around: &'a FacesAround) -> Self {
        Self {
            positions,
            around,
            patches: Vec::new(),
        }
    }

    /// Shares and normals of four nodes.
    pub fn build(&mut self, nodes: &[u32; LANES]) -> FourShares {
        self.collect_patches(nodes);
        let flat = FlatShare::new(&self.patches);
        let [edge_a, edge_b] = flat.parallelogram(&self.patches);
        let spread_mm2 = dot(&edge_a, &edge_a) + dot(&edge_b, &edge_b);
        let own = self.places(nodes);
        let third = F64x4::splat(1.0 / 3.0);
        let mut normal = zero_vector();
        for patch in &self.patches {
            normal += patch.normal;
        }
        FourShares {
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

    /// Puts the quarters around four nodes into their room.
    fn collect_patches(&mut self, nodes: &[u32; LANES]) {
        let faces = nodes.map(|node| self.around.of(node as usize));
        let most = faces.iter().map(|faces| faces.len()).max().unwrap_or(0);
        self.patches.clear();
        for place in 0..most {
            let patch = self.patch(nodes, &faces, place);
            self.patches.push(patch);
        }
    }

    /// The faces number `place` around four nodes; a node with fewer has an empty one.
    #[inline(always)]
    fn patch(
        &self,
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
        let own = self.places(nodes);
        CornerPatch::new(
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

impl FourShares {
    /// The share of one of the four nodes.
    pub fn share(&self, lane: usize) -> Share {
        Share {
            centre: of_lane(&self.centre, lane),
            edge_a: of_lane(&self.edge_a, lane),
            edge_b: of_lane(&self.edge_b, lane),
            area_mm2: self.area_mm2.lane(lane),
            spread_mm2: self.spread_mm2.lane(lane),
        }
    }

    /// The unit normal at one of the four nodes.
    pub fn normal(&self, lane: usize) -> Vec3 {
        of_lane(&self.normal, lane)
    }
}

fn of_lane(v: &Vector<F64x4>, lane: usize) -> Vec3 {
    Vec3::new(v.x.lane(lane), v.y.lane(lane), v.z.lane(lane))
}
