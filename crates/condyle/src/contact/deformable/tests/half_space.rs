//! The compliance of an elastic half-space in closed form.

use std::f64::consts::PI;

use crate::{
    Vec3,
    contact::deformable::compliance::SurfaceCompliance,
    geometry::{ArticulatingSurface, Share},
};

/// An elastic half-space whose surface is cut into rectangles.
#[derive(Debug)]
pub(crate) struct HalfSpace {
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

/// The compliance along the surface of the same half-space: load 2 i + k is on share i along its direction k.
#[derive(Debug)]
pub(crate) struct AlongHalfSpace {
    shares: Vec<Share>,
    directions: Vec<[Vec3; 2]>,
    tiles: Vec<Vec<u32>>,
    shear_modulus_mpa: f64,
    poissons_ratio: f64,
}

impl AlongHalfSpace {
    /// That under a flat surface.
    pub fn under(
        surface: &ArticulatingSurface,
        shear_modulus_mpa: f64,
        poissons_ratio: f64,
    ) -> Self {
        let loads: Vec<u32> = (0..2 * surface.shares.len() as u32).collect();
        Self {
            shares: surface.shares.clone(),
            directions: (0..surface.shares.len())
                .map(|node| surface.directions(node))
                .collect(),
            tiles: loads.chunks(40).map(<[u32]>::to_vec).collect(),
            shear_modulus_mpa,
            poissons_ratio,
        }
    }

    /// How far unit forces spread evenly over a share, along each of its directions, move another's middle along each of
    /// its own, mm/N: Cerruti's solution, integrated.
    fn moved(&self, loaded: usize, at: usize) -> [[f64; 2]; 2] {
        let (share, seen) = (&self.shares[loaded], &self.shares[at]);
        let way = seen.centre - share.centre;
        let (a, b) = (share.edge_a.norm(), share.edge_b.norm());
        let edges = [share.edge_a / a, share.edge_b / b];
        let (x, y) = (way.dot(&edges[0]), way.dot(&edges[1]));
        let corners = [(1.0, 1.0), (-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)];
        let mut integrals = [0.0; 3];
        for (k, (p, q)) in corners.into_iter().enumerate() {
            let (u, v) = (x + p * a / 2.0, y + q * b / 2.0);
            let (r, sign) = (u.hypot(v), if k < 2 { 1.0 } else { -1.0 });
            // Of x^2/r^3, y^2/r^3 and x y/r^3.
            let of_corner = [v * (u + r).ln(), u * (v + r).ln(), -r];
            for (integral, of_corner) in integrals.iter_mut().zip(of_corner) {
                *integral += sign * of_corner;
            }
        }
        let [xx, yy, xy] = integrals;
        let even = (1.0 - self.poissons_ratio) * (xx + yy);
        let v = self.poissons_ratio;
        let per_force = 1.0 / (2.0 * PI * self.shear_modulus_mpa * a * b);
        let in_edges = [[even + v * xx, v * xy], [v * xy, even + v * yy]];
        let along = |direction: Vec3| edges.map(|edge| edge.dot(&direction));
        let (from, to) = (
            self.directions[loaded].map(along),
            self.directions[at].map(along),
        );
        from.map(|f| {
            to.map(|t| {
                let sums = [0, 1].map(|i| t[0] * in_edges[0][i] + t[1] * in_edges[1][i]);
                per_force * (sums[0] * f[0] + sums[1] * f[1])
            })
        })
    }
}

impl SurfaceCompliance for AlongHalfSpace {
    fn tiles(&self) -> &[Vec<u32>] {
        &self.tiles
    }

    fn between(&self, one: usize, other: usize) -> Vec<f64> {
        let numbers = self.tiles[one].iter().flat_map(|&one| {
            let loads = self.tiles[other].iter();
            loads.map(move |&other| {
                let (first, second) = (one.min(other), one.max(other));
                let moved = self.moved(first as usize / 2, second as usize / 2);
                moved[first as usize % 2][second as usize % 2]
            })
        });
        numbers.collect()
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
