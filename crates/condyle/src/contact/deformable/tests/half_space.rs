//! The compliance of an elastic half-space in closed form.

use std::f64::consts::PI;

use crate::{
    Vec3,
    contact::deformable::compliance::SurfaceCompliance,
    geometry::{ArticulatingSurface, Share},
};

/// An elastic half-space whose surface is cut into rectangles.
#[derive(Debug)]
pub(super) struct HalfSpace {
    shares: Vec<Share>,
    tiles: Vec<Vec<u32>>,
    contact_modulus_mpa: f64,
}

impl HalfSpace {
    /// That under a flat surface.
    pub fn under(surface: &ArticulatingSurface, contact_modulus_mpa: f64) -> Self {
        let nodes: Vec<u32> = (0..surface.shares.len() as u32).collect();
        Self {
            shares: surface.shares.clone(),
            tiles: nodes.chunks(20).map(<[u32]>::to_vec).collect(),
            contact_modulus_mpa,
        }
    }

    /// Deflection at a point by a unit force spread evenly over a share, mm/N.
    pub fn deflection(&self, share: &Share, at: &Vec3) -> f64 {
        let way = at - share.centre;
        let (a, b) = (share.edge_a.norm(), share.edge_b.norm());
        let along = |edge: &Vec3| way.dot(&edge.normalize());
        let (x, y) = (along(&share.edge_a), along(&share.edge_b));
        love(x, y, a / 2.0, b / 2.0) / (PI * self.contact_modulus_mpa * a * b)
    }
}

/// The integral of 1/r over a rectangle of half edges a and b, as seen from (x, y) off its middle (Love 1929).
fn love(x: f64, y: f64, a: f64, b: f64) -> f64 {
    let part = |u: f64, v: f64, w: f64| {
        // u ln((v + r)/(w + r)), the far sides of the rectangle at v and w.
        u * ((v + v.hypot(u)) / (w + w.hypot(u))).ln()
    };
    part(x + a, y + b, y - b) - part(x - a, y + b, y - b) + part(y + b, x + a, x - a)
        - part(y - b, x + a, x - a)
}

impl SurfaceCompliance for HalfSpace {
    fn tiles(&self) -> &[Vec<u32>] {
        &self.tiles
    }

    fn between(&self, one: usize, other: usize) -> Vec<f64> {
        let numbers = self.tiles[one].iter().flat_map(|&one| {
            let nodes = self.tiles[other].iter();
            nodes.map(move |&other| {
                // Of a pair the one with the lower number, so that it is the same both ways.
                let (loaded, at) = (one.min(other) as usize, one.max(other) as usize);
                self.deflection(&self.shares[loaded], &self.shares[at].centre)
            })
        });
        numbers.collect()
    }
}
