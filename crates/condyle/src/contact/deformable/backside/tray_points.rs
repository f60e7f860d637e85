//! Points of the backside at which its motion against the tray is told.

use condyle_fem::HexMesh;

use super::{floor::Floor, grid::Grid};
use crate::{Vec3, contact::deformable::tiles::tiles};

/// So many points at most are solved for together.
const TOGETHER: usize = 16;

/// A point of the backside, for the mesh nodes around it.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct TrayPoint {
    /// Its place on the grid, at the middle height of the floor.
    pub position: Vec3,
    /// Its own directions: anterior and lateral along the tray, then off the tray, into the insert.
    pub frame: [Vec3; 3],
    /// How far each mesh node of the floor around it goes along with it.
    pub weights: Vec<(u32, f64)>,
    /// Its share of the floor, mm2.
    pub area_mm2: f64,
}

/// Points on a grid of some `spacing_mm` over the transverse plane, in groups that lie together.
///
/// The floor moves by bilinear interpolation between them, and beyond its outermost points by extrapolation, so that a
/// motion as a rigid body is among its motions. All points have its directions.
pub(in super::super) fn tray_points(
    mesh: &HexMesh,
    floor: &Floor,
    spacing_mm: f64,
) -> Vec<Vec<TrayPoint>> {
    let grid = Grid::over(mesh, &floor.nodes, spacing_mm);
    let around = grid.led_from_within(grid.around(mesh, &floor.nodes), &floor.share_mm2);
    let frame = frame_of(&floor.normal);
    let mut points: Vec<TrayPoint> = Vec::new();
    for (at, weights) in around.into_iter().enumerate() {
        if weights.is_empty() {
            continue;
        }
        let part = |&(at, weight): &(usize, f64)| floor.share_mm2[at] * weight;
        let area_mm2 = weights.iter().map(part).sum();
        let nodes = weights.into_iter();
        points.push(TrayPoint {
            position: grid.place(at),
            frame,
            weights: nodes
                .map(|(at, weight)| (floor.nodes[at], weight))
                .collect(),
            area_mm2,
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

/// The directions of a point with that normal: anterior and lateral along the tray, then the normal.
fn frame_of(inward: &Vec3) -> [Vec3; 3] {
    let up = inward.try_normalize(0.0).unwrap_or_else(Vec3::y);
    let anterior = Vec3::x() - up * up.x;
    // Where the backside stands upright across x, anterior is down.
    let anterior = anterior.try_normalize(1e-6).unwrap_or_else(|| -Vec3::y());
    [anterior, anterior.cross(&up), up]
}
