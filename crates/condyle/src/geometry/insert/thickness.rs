//! Thickness of an insert, measured along the normals of its articulating surface.

use condyle_fem::HexMesh;
use condyle_mesh::triangle;

use super::error::InsertError;
use crate::{Vec3, geometry::articulating_surface::ArticulatingSurface};

/// Edge of the bins that sort the backside over the transverse plane, mm.
const BIN_MM: f64 = 2.0;

/// The triangles of the backside, sorted into square bins over the transverse plane.
struct Backside {
    triangles: Vec<[Vec3; 3]>,
    lowest: f64,
    low: (f64, f64),
    counts: (usize, usize),
    bins: Vec<Vec<u32>>,
}

/// Distance from each node of a surface, against its normal, to the backside, mm.
///
/// Where a normal misses the backside (at the rim), the distance straight down counts, and where
/// that misses too, the nearest vertex of the backside.
pub fn thickness_at_nodes(
    surface: &ArticulatingSurface,
    mesh: &HexMesh,
    backside: &[[u32; 4]],
) -> Result<Vec<f64>, InsertError> {
    let backside = Backside::new(mesh, backside);
    let thickness = |(from, normal): (&Vec3, &Vec3)| {
        backside
            .distance_along(from, &-normal)
            .or_else(|| backside.distance_along(from, &-Vec3::y()))
            .or_else(|| backside.distance_to_vertex(from))
            .ok_or(InsertError::NoThickness {
                x: from.x,
                y: from.y,
                z: from.z,
            })
    };
    let nodes = surface.positions.iter().zip(&surface.normals);
    nodes.map(thickness).collect()
}

impl Backside {
    fn new(mesh: &HexMesh, quads: &[[u32; 4]]) -> Self {
        let corners = |quad: &[u32; 4]| {
            let [a, b, c, d] = quad.map(|node| mesh.nodes[node as usize]);
            [[a, b, c], [a, c, d]]
        };
        let triangles: Vec<[Vec3; 3]> = quads.iter().flat_map(corners).collect();
        let all = || triangles.iter().flatten();
        let low = all().fold((f64::INFINITY, f64::INFINITY), |m, p| {
            (m.0.min(p.x), m.1.min(p.z))
        });
        let high = all().fold((f64::NEG_INFINITY, f64::NEG_INFINITY), |m, p| {
            (m.0.max(p.x), m.1.max(p.z))
        });
        let count = |length: f64| (length / BIN_MM) as usize + 1;
        let counts = (count(high.0 - low.0), count(high.1 - low.1));
        let mut sorted = Self {
            bins: vec![Vec::new(); counts.0 * counts.1],
            lowest: triangles
                .iter()
                .flatten()
                .map(|p| p.y)
                .fold(f64::INFINITY, f64::min),
            triangles,
            low,
            counts,
        };
        for index in 0..sorted.triangles.len() {
            let [a, b, c] = sorted.triangles[index];
            for bin in sorted.bins_between(&a.inf(&b).inf(&c), &a.sup(&b).sup(&c)) {
                sorted.bins[bin].push(index as u32);
            }
        }
        sorted
    }

    /// Distance from a point along a unit direction to the first triangle hit.
    fn distance_along(&self, from: &Vec3, direction: &Vec3) -> Option<f64> {
        if direction.y >= 0.0 {
            return None;
        }
        let end = from + direction * ((self.lowest - from.y) / direction.y).max(0.0);
        let mut nearest: Option<f64> = None;
        for bin in self.bins_between(&from.inf(&end), &from.sup(&end)) {
            for &index in &self.bins[bin] {
                let distance = triangle::hit(&self.triangles[index as usize], from, direction);
                nearest = nearest.map_or(distance, |d| Some(distance.map_or(d, |e| d.min(e))));
            }
        }
        nearest
    }

    fn distance_to_vertex(&self, from: &Vec3) -> Option<f64> {
        let vertices = self.triangles.iter().flatten();
        vertices
            .map(|vertex| (vertex - from).norm())
            .min_by(f64::total_cmp)
            .filter(|&distance| distance > 0.0)
    }

    /// Bins that the box between two points covers.
    fn bins_between(&self, low: &Vec3, high: &Vec3) -> impl Iterator<Item = usize> + use<> {
        let place = |value: f64, origin: f64, count: usize| {
            (((value - origin) / BIN_MM).floor().max(0.0) as usize).min(count - 1)
        };
        let (nx, nz) = self.counts;
        let (x, z) = (
            place(low.x, self.low.0, nx)..=place(high.x, self.low.0, nx),
            place(low.z, self.low.1, nz)..=place(high.z, self.low.1, nz),
        );
        x.flat_map(move |i| z.clone().map(move |k| i * nz + k))
    }
}
