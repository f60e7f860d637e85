//! The curved surface that a triangle mesh samples, over triangles that are small enough for its curvature.

mod facets;
mod normals;
mod patch;
mod samples;
#[cfg(test)]
mod tests;

use std::ops::Range;

use self::{
    normals::Normals,
    samples::{facet_normals, samples_of},
};
use crate::{
    Vec3,
    curved_mesh::{CurvedMesh, Foot, lift},
    triangle_mesh::{TriangleMesh, bounds, closest_point, weighted},
};

pub(crate) use self::facets::Facets;
pub(crate) use self::normals::flatten_planes;
pub use self::normals::split_at_creases;

/// Share of a corner below which a place lies on the opposite side, in spite of rounding.
const ON_SIDE: f64 = 1e-9;

/// A triangle mesh read as samples of smooth surfaces that meet at creases, in small triangles with normals at their
/// corners, lifted as those of a [`CurvedMesh`].
pub struct DividedMesh {
    /// The triangles.
    pub mesh: TriangleMesh,
    normals: Vec<[Vec3; 3]>,
    planes: Vec<(Vec3, f64)>,
    /// The facet that each triangle is part of, and the barycentric coordinates of its corners there.
    facet_of: Vec<(u32, [[f64; 3]; 3])>,
    facets: Vec<Facet>,
}

/// The creases at the ends of a facet: normals between those of the surfaces that meet there, by corner and by the side
/// opposite to it.
struct Facet {
    at_corners: [Option<Vec3>; 3],
    at_sides: [Option<Vec3>; 3],
}

/// Consecutive triangles that are parts of one facet, and the ball around them.
pub struct Cluster {
    /// Their numbers.
    pub triangles: Range<usize>,
    /// Centre of the ball.
    pub centre: Vec3,
    /// Radius of the ball, mm.
    pub radius_mm: f64,
}

impl DividedMesh {
    /// Returns the curved surface that `mesh` samples, over triangles that are small enough for their curvature.
    ///
    /// Long facets, slivers and subdivided facets, as programs for design export them, are first replaced by triangles of
    /// the same vertices, and then by cubic patches, which are divided.
    pub fn new(mesh: &TriangleMesh) -> Self {
        let mesh = samples_of(mesh);
        let facets = facet_normals(&mesh);
        let normals = Normals::new(&mesh, &facets);
        let mut parts = Vec::new();
        let mut facet_of = Vec::new();
        for (triangle, facet) in (0..).zip(&facets) {
            normals.patch(&mesh, triangle, facet).divide(&mut parts);
            facet_of.resize(parts.len(), triangle as u32);
        }
        let corners = parts.iter().flat_map(|part| part.corners).collect();
        let divided = TriangleMesh {
            vertices: corners,
            triangles: (0..parts.len() as u32)
                .map(|n| [3 * n, 3 * n + 1, 3 * n + 2])
                .collect(),
        };
        let places = parts.iter().map(|part| part.places);
        Self {
            normals: parts.iter().map(|part| part.normals).collect(),
            planes: planes(&divided),
            facet_of: facet_of.into_iter().zip(places).collect(),
            facets: creases(&mesh, &normals, &facets),
            mesh: divided,
        }
    }

    /// Returns the triangles in clusters of neighbours, in their order.
    pub fn clusters(&self) -> Vec<Cluster> {
        /// More make the balls large, fewer make them many.
        const MAX_IN_CLUSTER: usize = 8;
        let mut first = 0;
        let of_facets = self.facet_of.chunk_by(|one, next| one.0 == next.0);
        let sizes = of_facets.flat_map(|parts| parts.chunks(MAX_IN_CLUSTER).map(<[_]>::len));
        let clusters = sizes.map(|size| {
            let triangles = first..first + size;
            first += size;
            // Every triangle has its own vertices, in the order of the triangles.
            let corners = &self.mesh.vertices[3 * triangles.start..3 * triangles.end];
            let (low, high) = bounds(corners);
            let centre = (low + high) / 2.0;
            let radii = corners.iter().map(|corner| (corner - centre).norm());
            let radius_mm = radii.fold(0.0, f64::max);
            Cluster {
                triangles,
                centre,
                radius_mm,
            }
        });
        clusters.collect()
    }

    /// Returns the outward normal of a triangle.
    pub fn normal(&self, triangle: usize) -> Vec3 {
        self.planes[triangle].0
    }

    /// Returns the squared distance from a point to the triangle's plane, mm2: a cheap lower bound.
    pub fn plane_distance2(&self, triangle: usize, point: &Vec3) -> f64 {
        let (normal, offset) = self.planes[triangle];
        (normal.dot(point) - offset).powi(2)
    }

    /// Returns the squared distance from a point to the flat triangle, mm2.
    pub fn distance2(&self, triangle: usize, point: &Vec3) -> f64 {
        CurvedMesh::distance2_to_triangle(&self.mesh.corners(triangle), point)
    }

    /// Returns the place of the curved surface over the triangle that belongs to a point.
    pub fn foot(&self, triangle: usize, point: &Vec3) -> Foot {
        let corners = self.mesh.corners(triangle);
        let normals = &self.normals[triangle];
        let weights = closest_point(&corners, point);
        let flat = weighted(&corners, weights);
        let at = flat + lift(&corners, normals, weights, &flat);
        let normal = match self.crease_at(triangle, weights) {
            // Every direction between the normals of the two surfaces is normal to a crease.
            Some(between) => {
                let towards = (point - at).try_normalize(0.0).unwrap_or(between);
                if towards.dot(&between) < 0.0 {
                    -towards
                } else {
                    towards
                }
            }
            None => weighted(normals, weights)
                .try_normalize(0.0)
                .unwrap_or_default(),
        };
        Foot {
            weights,
            point: at,
            normal,
        }
    }

    /// Returns a normal between those of the surfaces that meet at a place of a triangle, if it lies on a crease.
    fn crease_at(&self, triangle: usize, weights: [f64; 3]) -> Option<Vec3> {
        let (facet, places) = &self.facet_of[triangle];
        let is_zero = |corner: usize| {
            let shares = (0..3).map(|i| weights[i] * places[i][corner]);
            shares.sum::<f64>() < ON_SIDE
        };
        let facet = &self.facets[*facet as usize];
        match [0, 1, 2].map(is_zero) {
            [false, true, true] => facet.at_corners[0],
            [true, false, true] => facet.at_corners[1],
            [true, true, false] => facet.at_corners[2],
            zero => (0..3)
                .find(|&side| zero[side])
                .and_then(|side| facet.at_sides[side]),
        }
    }
}

fn planes(mesh: &TriangleMesh) -> Vec<(Vec3, f64)> {
    let normals = facet_normals(mesh).into_iter().enumerate();
    let plane =
        |(triangle, normal): (usize, Vec3)| (normal, normal.dot(&mesh.corners(triangle)[0]));
    normals.map(plane).collect()
}

/// Returns the creases of each triangle.
fn creases(mesh: &TriangleMesh, normals: &Normals, facets: &[Vec3]) -> Vec<Facet> {
    // At a corner the sum of the triangles' normals by their angles lies between all of them (Baerentzen & Aanaes 2005).
    let mut sums = vec![Vec3::zeros(); mesh.vertices.len()];
    let mut is_creased = vec![false; mesh.vertices.len()];
    for (triangle, vertices) in mesh.triangles.iter().enumerate() {
        let corners = mesh.corners(triangle);
        for i in 0..3 {
            let [a, b] = [1, 2].map(|step| corners[(i + step) % 3] - corners[i]);
            sums[vertices[i] as usize] += facets[triangle] * a.angle(&b);
            if normals.is_crease[triangle][i] {
                is_creased[vertices[i] as usize] = true;
                is_creased[vertices[(i + 1) % 3] as usize] = true;
            }
        }
    }
    let facet = |(triangle, vertices): (usize, &[u32; 3])| Facet {
        at_corners: vertices.map(|v| is_creased[v as usize].then_some(sums[v as usize])),
        at_sides: [1, 2, 0].map(|side| {
            let across =
                normals.across[triangle][side].filter(|_| normals.is_crease[triangle][side]);
            across.map(|(other, _)| facets[triangle] + facets[other])
        }),
    };
    mesh.triangles.iter().enumerate().map(facet).collect()
}
