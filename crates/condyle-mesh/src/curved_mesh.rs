//! The curved surface that a triangle mesh samples.

use crate::{
    Vec3,
    triangle_mesh::{TriangleMesh, closest_point, weighted},
};

/// Vertex normals that lean further from their triangle's than 30 degrees mark a sharp edge.
const MIN_COSINE: f64 = 0.866;

/// Surfaces steeper than 60 degrees are walls.
const MIN_SLOPE_COSINE: f64 = 0.5;

/// A triangle mesh with vertex normals, read as samples of a smooth surface.
///
/// Over a triangle with corners v_i and vertex normals n_i, the point c with barycentric
/// coordinates b_i is lifted along the normals by (1/2) sum b_i ((v_i - c) . n_i) n_i. Half of the
/// blended tangent planes (Boubekeur & Alexa 2008, alpha = 1/2) is exact for a quadratic surface.
pub struct CurvedMesh<'a> {
    /// The mesh.
    pub mesh: &'a TriangleMesh,
    vertex_normals: Vec<Vec3>,
    planes: Vec<(Vec3, f64)>,
}

impl<'a> CurvedMesh<'a> {
    /// Returns the curved surface that `mesh` samples.
    pub fn new(mesh: &'a TriangleMesh) -> Self {
        let plane = |triangle| {
            let [a, b, c] = mesh.corners(triangle);
            let normal = (b - a)
                .cross(&(c - a))
                .try_normalize(0.0)
                .unwrap_or_default();
            (normal, normal.dot(&a))
        };
        Self {
            mesh,
            vertex_normals: mesh.vertex_normals(),
            planes: (0..mesh.triangles.len()).map(plane).collect(),
        }
    }

    /// Returns the unit normals at the corners of every triangle, of the smooth surface that the triangle is part of.
    ///
    /// If all triangles around a vertex make one smooth surface, that is the vertex normal. At a crease,
    /// such as the rim of an insert, a mean over all of them would lean across it and raise a ridge
    /// next to it. There the normals of the neighbouring smooth vertices are mirrored over the middle of the edge
    /// between, which is exact on a sphere.
    pub(crate) fn corner_normals(&self) -> Vec<[Vec3; 3]> {
        let around = self.mesh.triangles_around();
        let smooth: Vec<bool> = around.iter().map(|star| self.is_smooth(star)).collect();
        let corner = |triangle: usize, vertex: u32| {
            if smooth[vertex as usize] {
                return self.vertex_normals[vertex as usize];
            }
            let own = self.planes[triangle].0;
            let same = |other: &&u32| self.planes[**other as usize].0.dot(&own) > MIN_COSINE;
            let fan = around[vertex as usize].iter().filter(same);
            let neighbours = fan.flat_map(|&other| self.mesh.triangles[other as usize]);
            let mirrored = neighbours
                .filter(|&other| smooth[other as usize])
                .map(|other| self.mirrored(other, vertex));
            mirrored.sum::<Vec3>().try_normalize(0.0).unwrap_or(own)
        };
        let triangles = self.mesh.triangles.iter().enumerate();
        triangles
            .map(|(triangle, vertices)| vertices.map(|vertex| corner(triangle, vertex)))
            .collect()
    }

    fn is_smooth(&self, triangles: &[u32]) -> bool {
        let normal = |triangle: &u32| self.planes[*triangle as usize].0;
        // Every pair: around the tip of a cone neighbours differ little, and opposite facets much.
        triangles.iter().enumerate().all(|(n, one)| {
            let mut others = triangles[n + 1..].iter();
            others.all(|other| normal(one).dot(&normal(other)) > MIN_COSINE)
        })
    }

    /// Returns the normal at vertex `to` if the surface continues from `from` as a circle.
    fn mirrored(&self, from: u32, to: u32) -> Vec3 {
        let [from, to] = [from, to].map(|vertex| vertex as usize);
        let along = self.mesh.vertices[to] - self.mesh.vertices[from];
        let along = along.try_normalize(0.0).unwrap_or_default();
        let normal = self.vertex_normals[from];
        normal - along * (2.0 * normal.dot(&along))
    }

    /// Returns the squared distance from a point to a flat triangle, mm2.
    pub fn distance2_to_triangle(corners: &[Vec3; 3], point: &Vec3) -> f64 {
        (weighted(corners, closest_point(corners, point)) - point).norm_squared()
    }

    /// Returns the intersection of the vertical line at a place (x, z) with the curved surface over the triangle, if
    /// the triangle covers it.
    ///
    /// `normals`: at its corners, from [`CurvedMesh::corner_normals`].
    pub(crate) fn over(
        &self,
        triangle: usize,
        normals: &[Vec3; 3],
        [x, z]: [f64; 2],
    ) -> Option<Over> {
        // Places on an edge belong to both of its triangles in spite of rounding.
        const COVERED: f64 = -1e-9;
        let corners = self.mesh.corners(triangle);
        let [a, b, c] = corners;
        let twice_area = |p: [f64; 2], q: &Vec3, r: &Vec3| {
            (q.x - p[0]) * (r.z - p[1]) - (q.z - p[1]) * (r.x - p[0])
        };
        let all = twice_area([a.x, a.z], &b, &c);
        let parts = [(&b, &c), (&c, &a), (&a, &b)].map(|(q, r)| twice_area([x, z], q, r));
        let weights = parts.map(|part| part / all);
        if all == 0.0 || weights.iter().any(|&weight| weight < COVERED) {
            return None;
        }
        let flat = weighted(&corners, weights);
        let facet = self.planes[triangle].0;
        let is_smooth_at = |normal: &Vec3| normal.dot(&facet) > MIN_COSINE;
        let own = normals.map(|normal| if is_smooth_at(&normal) { normal } else { facet });
        let normal = weighted(&own, weights);
        let upward = normal.y / normal.norm();
        // At a sharp edge the vertex normals contain no information about the facet, and on a steep wall a sideways
        // lift has no height: there the surface stays flat.
        let is_smooth = normals.iter().all(is_smooth_at);
        let is_lifted = is_smooth && upward.abs() >= MIN_SLOPE_COSINE;
        let height = if is_lifted {
            flat.y + lift(&corners, normals, weights, &flat).dot(&normal) / normal.y
        } else {
            flat.y
        };
        Some(Over {
            weights,
            height,
            upward,
            lift_mm: (height - flat.y) * upward,
        })
    }

    /// Returns the place of the curved surface over the triangle that belongs to a point.
    pub fn foot(&self, triangle: usize, point: &Vec3) -> Foot {
        let corners = self.mesh.corners(triangle);
        let normals = self.mesh.triangles[triangle].map(|v| self.vertex_normals[v as usize]);
        let weights = closest_point(&corners, point);
        let flat = weighted(&corners, weights);
        let normal = weighted(&normals, weights);
        Foot {
            weights,
            point: flat + lift(&corners, &normals, weights, &flat),
            normal: normal.try_normalize(0.0).unwrap_or_default(),
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Over {
    /// Barycentric coordinates on the flat triangle.
    pub(crate) weights: [f64; 3],
    pub(crate) height: f64,
    /// Cosine of the slope: the component along y of the unit normal, less than 0 where it points down.
    pub(crate) upward: f64,
    /// Distance of the curved surface from the triangle along the normal, mm; positive outside.
    pub(crate) lift_mm: f64,
}

/// A place on the curved surface over a triangle.
#[derive(Clone, Copy, Debug)]
pub struct Foot {
    /// Barycentric coordinates on the flat triangle.
    pub weights: [f64; 3],
    /// Position on the curved surface, mm.
    pub point: Vec3,
    /// Outward unit normal there.
    pub normal: Vec3,
}

/// Returns the rise of the curved surface over the place `flat` of a triangle.
pub(crate) fn lift(
    corners: &[Vec3; 3],
    normals: &[Vec3; 3],
    weights: [f64; 3],
    flat: &Vec3,
) -> Vec3 {
    let half = |i: usize| normals[i] * (weights[i] / 2.0 * (corners[i] - flat).dot(&normals[i]));
    half(0) + half(1) + half(2)
}
