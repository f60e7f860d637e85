//! The normals of the smooth surfaces that the triangles of a mesh belong to.

use std::collections::BTreeMap;

use super::{
    patch::Patch,
    samples::{MIN_HEIGHT_MM, facet_normals, height},
};
use crate::{
    Vec3,
    curved_mesh::lift,
    repair::{by_edge, edge_uses},
    triangle_mesh::{TriangleMesh, weighted},
};

/// Triangles that meet at more than 30 degrees belong to two surfaces.
const MIN_COSINE: f64 = 0.866;

/// Weight of a normal by its triangles relative to that by one edge: triangles decide only what edges leave open, as
/// normals that alternate from ring to ring of a cylinder. Ten times more or less changes the surface by less than a tenth of
/// its chord error.
const WEIGHT_OF_TRIANGLES: f64 = 0.03;

/// The unit normals at the corners of all triangles, and the edges where two smooth surfaces meet.
pub(super) struct Normals {
    /// Of every corner of every triangle; none where the triangle is no part of a smooth surface.
    pub(super) at_corners: Vec<[Option<Vec3>; 3]>,
    /// The side of the only other triangle at each side.
    pub(super) across: Vec<[Option<TriangleSide>; 3]>,
    /// Of every side, true where two smooth surfaces meet.
    pub(super) is_crease: Vec<[bool; 3]>,
}

/// A triangle and the number of one of its sides, which begins at the corner of the same number.
type TriangleSide = (usize, usize);

impl Normals {
    /// Computes the normals, given the unit normal of each triangle.
    ///
    /// Corners at one vertex share a normal unless a crease divides them. The first estimate is that of
    /// [`TriangleMesh::vertex_normals`], with the small weight that slivers deserve. On a quadratic surface, the sum of the
    /// normals at both ends of an edge is perpendicular to it, in any triangulation: the normals are those that satisfy
    /// this best, and differ least from the estimate.
    pub(super) fn new(mesh: &TriangleMesh, facets: &[Vec3]) -> Self {
        let across = sides_across(mesh);
        let is_crease = creases(mesh, facets, &across);
        let fan_of = fans(&across, &is_crease);
        let count = fan_of
            .iter()
            .flatten()
            .max()
            .map_or(0, |&last| last as usize + 1);
        let estimate = mesh.normals_of(&fan_of, count);
        let mut is_smooth = vec![true; count];
        for (fans, facet) in fan_of.iter().zip(facets) {
            for &fan in fans {
                // As at the tip of a cone, around which neighbours differ little and opposite triangles much.
                is_smooth[fan as usize] &= estimate[fan as usize].dot(facet) > MIN_COSINE;
            }
        }
        let normals = adjusted(&estimate, &edges(mesh, &fan_of, &is_smooth));
        let corner = |fan: u32, facet: &Vec3| {
            let normal = normals[fan as usize];
            (is_smooth[fan as usize] && normal.dot(facet) > MIN_COSINE).then_some(normal)
        };
        let chords_mm = chords_of_faces_mm(mesh, facets, &across, &is_crease);
        let at_corners = fan_of.iter().zip(facets).enumerate();
        let at_corners = at_corners.map(|(triangle, (fans, facet))| {
            let own = fans.map(|fan| corner(fan, facet));
            let given = own.map(|normal| normal.unwrap_or(*facet));
            let is_plane = is_bent_plane(&mesh.corners(triangle), &given, chords_mm[triangle]);
            if is_plane { [None; 3] } else { own }
        });
        Self {
            at_corners: at_corners.collect(),
            across,
            is_crease,
        }
    }
}

impl Normals {
    /// Returns the cubic patch over a triangle.
    pub(super) fn patch(&self, mesh: &TriangleMesh, triangle: usize, facet: &Vec3) -> Patch {
        let corners = mesh.corners(triangle);
        let normals = self.at_corners[triangle];
        let side = |i: usize| {
            let j = (i + 1) % 3;
            let along = corners[j] - corners[i];
            // The side of another triangle runs in the opposite direction.
            let across = self.across[triangle][i].map(|(other, side)| {
                let normals = &self.at_corners[other];
                [normals[(side + 1) % 3], normals[side]]
            });
            let across = across.unwrap_or([normals[i], normals[j]]);
            [
                tangent(&along, normals[i], across[0]),
                tangent(&along, normals[j], across[1]),
            ]
        };
        let tangents = [0, 1, 2].map(side);
        Patch::new(
            corners,
            normals.map(|normal| normal.unwrap_or(*facet)),
            tangents,
        )
    }
}

/// Returns the distance of each triangle from the curved surface by the angles to its neighbours, mm; 0 at creases.
///
/// A triangle of a `height_mm`, which may be that over a side, that meets its neighbours at an angle a is a h / 8 from a cylinder
/// and a h / 4 from a sphere: the mean counts. Of two triangles the lower height counts, so that a flat surface next to a fillet is
/// flat.
pub(super) fn chords_mm(
    facets: &[Vec3],
    across: &[[Option<TriangleSide>; 3]],
    is_crease: &[[bool; 3]],
    height_mm: impl Fn(TriangleSide) -> f64,
) -> Vec<f64> {
    let chord = |one: usize| {
        let chord = |(side, other): (usize, TriangleSide)| {
            let angle = facets[one].cross(&facets[other.0]).norm();
            angle * height_mm((one, side)).min(height_mm(other)) / 6.0
        };
        let smooth = smooth_sides(&across[one], &is_crease[one]);
        smooth.map(chord).fold(0.0, f64::max)
    };
    (0..facets.len()).map(chord).collect()
}

/// Returns the sides of a triangle at which its smooth surface continues, each with the side across: creases and slivers are no part
/// of it.
fn smooth_sides(
    across: &[Option<TriangleSide>; 3],
    is_crease: &[bool; 3],
) -> impl Iterator<Item = (usize, TriangleSide)> {
    let sides = across.iter().zip(is_crease).enumerate();
    sides.filter_map(|(side, (other, is_crease))| Some((side, other.filter(|_| !is_crease)?)))
}

/// Returns for each triangle the largest distance from the curved surface by the heights over sides, mm: that of all triangles of its
/// flat face and of its smooth neighbours, since a triangle at a border has few sides that show how curved the surface is.
fn chords_of_faces_mm(
    mesh: &TriangleMesh,
    facets: &[Vec3],
    across: &[[Option<TriangleSide>; 3]],
    is_crease: &[[bool; 3]],
) -> Vec<f64> {
    /// Sine of the angle below which triangles are parts of a flat face: that of facets of 1 mm on a sphere of radius 1 m.
    const COPLANAR: f64 = 1e-3;
    let own = chords_mm(facets, across, is_crease, |side| {
        height_over_side(mesh, side)
    });
    let mut linked: Vec<usize> = (0..own.len()).collect();
    for (one, sides) in across.iter().enumerate() {
        for (other, _) in sides.iter().flatten() {
            if facets[one].cross(&facets[*other]).norm() < COPLANAR {
                join(&mut linked, one, *other);
            }
        }
    }
    let mut of_faces = vec![0.0; own.len()];
    for (triangle, chord_mm) in own.iter().enumerate() {
        let face = first_of(&mut linked, triangle);
        of_faces[face] = chord_mm.max(of_faces[face]);
    }
    let faces = (0..own.len()).map(|triangle| of_faces[first_of(&mut linked, triangle)]);
    let faces: Vec<f64> = faces.collect();
    let with_neighbours = |triangle: usize| {
        let smooth = smooth_sides(&across[triangle], &is_crease[triangle]);
        let chords_mm = smooth.map(|(_, (other, _))| faces[other]);
        chords_mm.fold(faces[triangle], f64::max)
    };
    (0..own.len()).map(with_neighbours).collect()
}

/// Returns the height of a triangle over a side, mm.
fn height_over_side(mesh: &TriangleMesh, (triangle, side): TriangleSide) -> f64 {
    let corners = mesh.corners(triangle);
    let [a, b, c] = [0, 1, 2].map(|step| corners[(side + step) % 3]);
    (b - a).cross(&(c - a)).norm() / (b - a).norm().max(f64::MIN_POSITIVE)
}

/// Replaces the normals at the corners of triangles that they bend though they are parts of planes.
pub(crate) fn flatten_planes(mesh: &TriangleMesh, at_corners: &mut [[Vec3; 3]]) {
    let (facets, across) = (facet_normals(mesh), sides_across(mesh));
    let is_crease = creases(mesh, &facets, &across);
    let chords_mm = chords_of_faces_mm(mesh, &facets, &across, &is_crease);
    for (triangle, normals) in at_corners.iter_mut().enumerate() {
        if is_bent_plane(&mesh.corners(triangle), normals, chords_mm[triangle]) {
            *normals = [facets[triangle]; 3];
        }
    }
}

/// Returns whether normals bend a triangle that is part of a plane, given its distance from the curved surface by the angles to its
/// neighbours.
///
/// Where a fillet leaves a plane, the triangles of both meet at a small angle, as those of one curved surface do. Means of their
/// normals lean across the plane, and would bend it over its whole width.
fn is_bent_plane(corners: &[Vec3; 3], normals: &[Vec3; 3], chord_mm: f64) -> bool {
    /// Ratio of both distances from which they are not those of one surface: where the heights of facets differ by this factor.
    const MIN_RATIO: f64 = 8.0;
    /// Bend below which a contact does not notice it, mm.
    const MIN_BEND_MM: f64 = 0.01;
    let bend_mm = |weights: [f64; 3]| {
        let flat = weighted(corners, weights);
        lift(corners, normals, weights, &flat).norm()
    };
    let third = 1.0 / 3.0;
    let places = [
        [third; 3],
        [0.5, 0.5, 0.0],
        [0.0, 0.5, 0.5],
        [0.5, 0.0, 0.5],
    ];
    let most_mm = places.map(bend_mm).into_iter().fold(0.0, f64::max);
    most_mm > MIN_BEND_MM.max(MIN_RATIO * chord_mm)
}

/// Returns the part of an edge that is tangential to the surfaces on both of its sides, by their normals at one end; the
/// edge itself, where they have none or their crease leads elsewhere.
fn tangent(along: &Vec3, normal: Option<Vec3>, across: Option<Vec3>) -> Vec3 {
    /// Cosine of the angle between an edge and its crease, as between triangles and their surface.
    const ALONG: f64 = MIN_COSINE;
    let (Some(one), Some(other)) = (normal, across) else {
        return *along;
    };
    let tangent = if one.dot(&other) > MIN_COSINE {
        let mean = (one + other).normalize();
        along - mean * mean.dot(along)
    } else {
        let crease = one.cross(&other).normalize();
        crease * crease.dot(along)
    };
    if tangent.norm() > ALONG * along.norm() {
        tangent
    } else {
        *along
    }
}

pub(super) fn sides_across(mesh: &TriangleMesh) -> Vec<[Option<TriangleSide>; 3]> {
    let mut across = vec![[None; 3]; mesh.triangles.len()];
    for pair in by_edge(&edge_uses(mesh)) {
        if let [one, other] = pair {
            let [one, other] =
                [one, other].map(|edge| (edge.triangle as usize, usize::from(edge.side)));
            across[one.0][one.1] = Some(other);
            across[other.0][other.1] = Some(one);
        }
    }
    across
}

pub(super) fn creases(
    mesh: &TriangleMesh,
    facets: &[Vec3],
    across: &[[Option<TriangleSide>; 3]],
) -> Vec<[bool; 3]> {
    let has_plane: Vec<bool> = (0..mesh.triangles.len())
        .map(|triangle| height(mesh.corners(triangle)) > MIN_HEIGHT_MM)
        .collect();
    let is_crease = |one: usize, other: usize| {
        !(facets[one].dot(&facets[other]) > MIN_COSINE && has_plane[one] && has_plane[other])
    };
    let triangles = across.iter().enumerate();
    triangles
        .map(|(one, sides)| sides.map(|side| side.is_some_and(|(other, _)| is_crease(one, other))))
        .collect()
}

/// Returns the mesh with separate vertices for the surfaces on both sides of an edge, where triangles meet at a cosine below
/// `min_cosine`: a normal that is averaged over the triangles at a vertex then leaves the edge sharp.
pub fn split_at_creases(mesh: &TriangleMesh, min_cosine: f64) -> TriangleMesh {
    let (facets, across) = (facet_normals(mesh), sides_across(mesh));
    let triangles = across.iter().zip(&facets);
    let is_crease: Vec<[bool; 3]> = triangles
        .map(|(sides, facet)| {
            sides.map(|side| side.is_some_and(|(other, _)| facet.dot(&facets[other]) < min_cosine))
        })
        .collect();
    let fan_of = fans(&across, &is_crease);
    let mut vertices = Vec::with_capacity(mesh.vertices.len());
    for (corners, fans) in mesh.triangles.iter().zip(&fan_of) {
        for (&corner, &fan) in corners.iter().zip(fans) {
            // Fans are numbered in the order of their first corners.
            if fan as usize == vertices.len() {
                vertices.push(mesh.vertices[corner as usize]);
            }
        }
    }
    TriangleMesh {
        vertices,
        triangles: fan_of,
    }
}

/// Returns for every corner the number of its fan: the corners around a vertex between two creases.
fn fans(across: &[[Option<TriangleSide>; 3]], is_crease: &[[bool; 3]]) -> Vec<[u32; 3]> {
    // Each corner points to another one of its fan, the first to itself.
    let mut linked: Vec<usize> = (0..3 * across.len()).collect();
    let corner = |triangle: usize, at: usize| 3 * triangle + at % 3;
    for (one, sides) in across.iter().enumerate() {
        for side in 0..3 {
            // The side of the other triangle runs in the opposite direction.
            if let (Some((other, opposite)), false) = (sides[side], is_crease[one][side]) {
                join(&mut linked, corner(one, side), corner(other, opposite + 1));
                join(&mut linked, corner(one, side + 1), corner(other, opposite));
            }
        }
    }
    let mut numbers = vec![u32::MAX; linked.len()];
    let mut next = 0;
    let mut fan = |corner: usize| {
        let first = first_of(&mut linked, corner);
        if numbers[first] == u32::MAX {
            numbers[first] = next;
            next += 1;
        }
        numbers[first]
    };
    let all = (0..across.len()).map(|t| [3 * t, 3 * t + 1, 3 * t + 2].map(&mut fan));
    all.collect()
}

fn first_of(linked: &mut [usize], mut corner: usize) -> usize {
    while linked[corner] != corner {
        linked[corner] = linked[linked[corner]];
        corner = linked[corner];
    }
    corner
}

fn join(linked: &mut [usize], one: usize, other: usize) {
    let (one, other) = (first_of(linked, one), first_of(linked, other));
    linked[one.max(other)] = one.min(other);
}

/// An edge of a smooth surface: its fans and its direction.
type Edge = ([usize; 2], Vec3);

/// Returns the edges between smooth fans, each once for each surface that it belongs to.
fn edges(mesh: &TriangleMesh, fan_of: &[[u32; 3]], is_smooth: &[bool]) -> Vec<Edge> {
    let mut edges = BTreeMap::new();
    for (triangle, fans) in fan_of.iter().enumerate() {
        let corners = mesh.corners(triangle);
        for i in 0..3 {
            let j = (i + 1) % 3;
            let along = (corners[j] - corners[i])
                .try_normalize(0.0)
                .unwrap_or_default();
            if is_smooth[fans[i] as usize] && is_smooth[fans[j] as usize] {
                edges.insert([fans[i].min(fans[j]), fans[i].max(fans[j])], along);
            }
        }
    }
    let edges = edges.into_iter();
    edges
        .map(|(fans, along)| (fans.map(|fan| fan as usize), along))
        .collect()
}

/// Returns the normals n whose sums over the ends of edges are perpendicular to them, in the sense of least squares:
/// the minimum of the sum of (d . (n_i + n_j))^2 over the edges and of w |n - n_0|^2 over the normals, by conjugate gradients.
fn adjusted(estimate: &[Vec3], edges: &[Edge]) -> Vec<Vec3> {
    /// Largest number of iterations, many more than it takes: the condition number is about a hundred.
    const MAX_ITERATIONS: usize = 200;
    /// Decrease of the residual at which the normals are exact to a microradian.
    const RESIDUAL: f64 = 1e-6;
    let across = |of: &[Vec3], to: &mut [Vec3], factor: f64| {
        for ([i, j], along) in edges {
            let push = along * (factor * along.dot(&(of[*i] + of[*j])));
            to[*i] += push;
            to[*j] += push;
        }
        // A normal changes only across itself.
        for (to, normal) in to.iter_mut().zip(estimate) {
            *to -= normal * normal.dot(to);
        }
    };
    let dot =
        |one: &[Vec3], other: &[Vec3]| one.iter().zip(other).map(|(a, b)| a.dot(b)).sum::<f64>();
    let mut residual = vec![Vec3::zeros(); estimate.len()];
    across(estimate, &mut residual, -1.0);
    let mut change = vec![Vec3::zeros(); estimate.len()];
    let mut direction = residual.clone();
    let mut square = dot(&residual, &residual);
    let enough = RESIDUAL * RESIDUAL * square;
    for _ in 0..MAX_ITERATIONS {
        if square <= enough {
            break;
        }
        let mut image: Vec<Vec3> = direction.iter().map(|d| d * WEIGHT_OF_TRIANGLES).collect();
        across(&direction, &mut image, 1.0);
        let step = square / dot(&direction, &image);
        for i in 0..change.len() {
            change[i] += direction[i] * step;
            residual[i] -= image[i] * step;
        }
        let before = std::mem::replace(&mut square, dot(&residual, &residual));
        for i in 0..change.len() {
            direction[i] = residual[i] + direction[i] * (square / before);
        }
    }
    let all = estimate.iter().zip(&change);
    all.map(|(normal, change)| (normal + change).try_normalize(0.0).unwrap_or_default())
        .collect()
}
