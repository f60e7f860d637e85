//! The part of the femur that may touch, as facets that approximate its smooth surface.

use std::collections::HashSet;

use condyle::Vec3;
use condyle::geometry::{Counterface, TriangleMesh};
use condyle::spatial::Pose;

/// Gap below which a node of the insert may come into contact, mm.
const NEAR_MM: f64 = 0.1;
/// Edge of the cells by which triangles near such nodes are found, mm.
const CELL_MM: f64 = 1.0;
/// Longest edge of a facet, mm; longer edges are halved. On a radius of 20 mm, facets lie 0.1 micrometres below the
/// surface on average.
const LONGEST_EDGE_MM: f64 = 0.25;
const MAX_HALVINGS: usize = 3;

/// Returns the triangles near `nodes` (insert frame) with the femur at any of `poses`, refined and moved onto `femur`; in
/// the femoral frame, anticlockwise seen from outside.
pub(super) fn facets(
    femur: &Counterface,
    triangles: &TriangleMesh,
    nodes: &[Vec3],
    poses: &[Pose],
) -> TriangleMesh {
    let mut facets = near(triangles, &cells(femur, nodes, poses));
    for _ in 0..MAX_HALVINGS {
        let edges = |triangle| {
            let [a, b, c] = facets.corners(triangle);
            (b - a).norm().max((c - b).norm()).max((a - c).norm())
        };
        let longest_mm = (0..facets.triangles.len()).map(edges).fold(0.0, f64::max);
        if longest_mm <= LONGEST_EDGE_MM {
            break;
        }
        facets = facets.in_four(|a, b| (a + b) / 2.0);
    }
    facets.mapped(|corner| on_surface(femur, corner))
}

/// Returns the same corners moved inward by `thickness_mm`.
pub(super) fn inside(femur: &Counterface, corners: &[Vec3], thickness_mm: f64) -> Vec<Vec3> {
    let inward = |corner: &Vec3| corner - thickness_mm * femur.sample(corner, 0.0).gap_gradient;
    corners.iter().map(inward).collect()
}

fn on_surface(femur: &Counterface, point: &Vec3) -> Vec3 {
    // The gap is a distance only near the surface, so one projection along its gradient is not enough.
    const ROUNDS: usize = 3;
    let nearer = |point: Vec3, _| {
        let sample = femur.sample(&point, 0.0);
        point - sample.gap_mm * sample.gap_gradient
    };
    (0..ROUNDS).fold(*point, nearer)
}

type Cell = [i64; 3];

fn cell(point: &Vec3) -> Cell {
    [point.x, point.y, point.z].map(|mm| (mm / CELL_MM).floor() as i64)
}

/// Returns the cells of the femoral frame in which the femur is near a node, and their neighbours.
fn cells(femur: &Counterface, nodes: &[Vec3], poses: &[Pose]) -> HashSet<Cell> {
    let seen = poses
        .iter()
        .flat_map(|pose| nodes.iter().map(|node| pose.to_counterface(node)));
    let touching = seen.filter(|node| femur.gap_mm(node) < NEAR_MM);
    let mut cells = HashSet::new();
    for node in touching {
        let [x, y, z] = cell(&on_surface(femur, &node));
        // A triangle may reach over the side of a cell: the neighbours count too.
        for place in 0..27 {
            cells.insert([x + place % 3 - 1, y + place / 3 % 3 - 1, z + place / 9 - 1]);
        }
    }
    cells
}

/// Returns the triangles with a corner in `cells`, without unused vertices.
fn near(mesh: &TriangleMesh, cells: &HashSet<Cell>) -> TriangleMesh {
    let is_near: Vec<bool> = mesh
        .vertices
        .iter()
        .map(|vertex| cells.contains(&cell(vertex)))
        .collect();
    let mut kept = TriangleMesh::default();
    let mut number = vec![None; mesh.vertices.len()];
    let triangles = mesh.triangles.iter();
    for corners in triangles.filter(|corners| corners.iter().any(|&at| is_near[at as usize])) {
        kept.triangles.push(corners.map(|at| {
            *number[at as usize].get_or_insert_with(|| {
                kept.vertices.push(mesh.vertices[at as usize]);
                kept.vertices.len() as u32 - 1
            })
        }));
    }
    kept
}
