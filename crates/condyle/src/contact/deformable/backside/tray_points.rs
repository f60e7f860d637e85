//! Points of the backside at which its motion against the tray is told.

use condyle_fem::HexMesh;

use super::grid::Grid;
use crate::{Vec3, contact::deformable::tiles::tiles};

/// So many points at most are solved for together.
const TOGETHER: usize = 16;

/// A point of the backside, for the mesh nodes around it.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct TrayPoint {
    /// Its place on the grid, at the middle height of the backside.
    pub position: Vec3,
    /// Its own directions: anterior and lateral along the tray, then off the tray, into the insert.
    pub frame: [Vec3; 3],
    /// How far each mesh node of the backside around it goes along with it.
    pub weights: Vec<(u32, f64)>,
    /// Its share of the backside, mm2.
    pub area_mm2: f64,
}

/// Points on a grid of some `spacing_mm` over the transverse plane, in groups that lie together.
///
/// The backside moves by bilinear interpolation between them, and beyond its outermost points by extrapolation, so that a
/// motion as a rigid body is among its motions. A point has the mean normal of the backside around it.
pub(in super::super) fn tray_points(
    mesh: &HexMesh,
    backside: &[u32],
    spacing_mm: f64,
) -> Vec<Vec<TrayPoint>> {
    let inward = inward_mm2(mesh, backside);
    let grid = Grid::over(mesh, backside, spacing_mm);
    let around = grid.from_within(grid.around(mesh, backside), &inward);
    let mut points: Vec<TrayPoint> = Vec::new();
    for (at, weights) in around.into_iter().enumerate() {
        if weights.is_empty() {
            continue;
        }
        let part = |&(at, weight): &(usize, f64)| inward[at] * weight;
        let area: Vec3 = weights.iter().map(part).sum();
        let nodes = weights.into_iter();
        points.push(TrayPoint {
            position: grid.place(at),
            frame: frame_of(&area),
            weights: nodes.map(|(at, weight)| (backside[at], weight)).collect(),
            area_mm2: area.norm(),
        });
    }
    let places: Vec<Vec3> = points.iter().map(|point| point.position).collect();
    let groups = tiles(&places, TOGETHER).into_iter();
    let group = |group: Vec<u32>| {
        group
            .iter()
            .map(|&at| points[at as usize].clone())
            .collect()
    };
    groups.map(group).collect()
}

/// The share of the backside at each of its nodes, mm2, along the normal into the insert.
fn inward_mm2(mesh: &HexMesh, backside: &[u32]) -> Vec<Vec3> {
    let number = |node: &u32| backside.binary_search(node).ok();
    let mut quads = mesh.boundary_quads();
    quads.retain(|quad| quad.iter().all(|node| number(node).is_some()));
    let mut inward = vec![Vec3::zeros(); backside.len()];
    for (node, share) in mesh.traction_forces(&quads, |_, normal| -normal) {
        if let Some(at) = number(&node) {
            inward[at] += share;
        }
    }
    inward
}

/// The directions of a point with that normal: anterior and lateral along the tray, then the normal.
fn frame_of(inward: &Vec3) -> [Vec3; 3] {
    let up = inward.try_normalize(0.0).unwrap_or_else(Vec3::y);
    let anterior = Vec3::x() - up * up.x;
    // Where the backside stands upright across x, anterior is down.
    let anterior = anterior.try_normalize(1e-6).unwrap_or_else(|| -Vec3::y());
    [anterior, anterior.cross(&up), up]
}
