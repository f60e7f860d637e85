//! Points of the backside at which its motion against the tray is told.

use condyle_fem::HexMesh;

use crate::{Vec3, contact::deformable::tiles::tiles, geometry::bounds};

/// So many points at most are solved for together.
const TOGETHER: usize = 16;

/// A point of the backside, for the mesh nodes around it.
#[derive(Clone, Debug, PartialEq)]
pub(in super::super) struct TrayPoint {
    /// Its place on the grid; its height is the mean of the nodes around it.
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
/// The backside moves by bilinear interpolation between them, so that a motion as a rigid body is among its motions. A
/// point has the mean normal of the backside around it.
pub(in super::super) fn tray_points(
    mesh: &HexMesh,
    backside: &[u32],
    spacing_mm: f64,
) -> Vec<Vec<TrayPoint>> {
    let inward = inward_mm2(mesh, backside);
    let mut points: Vec<TrayPoint> = Vec::new();
    for ([x, z], weights) in on_grid(mesh, backside, spacing_mm) {
        let sum: f64 = weights.iter().map(|(_, weight)| weight).sum();
        let part = |&(at, weight): &(usize, f64)| inward[at] * weight;
        let area: Vec3 = weights.iter().map(part).sum();
        let height = |&(at, weight): &(usize, f64)| mesh.nodes[backside[at] as usize].y * weight;
        let y = weights.iter().map(height).sum::<f64>() / sum;
        points.push(TrayPoint {
            position: Vec3::new(x, y, z),
            frame: frame_of(&area),
            weights: weights
                .iter()
                .map(|&(at, weight)| (backside[at], weight))
                .collect(),
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

/// Nodes around a point, by their places in `backside`, with their weights.
type Around = Vec<(usize, f64)>;

/// Every point of the grid, x and z, with the nodes around it; points without any are left out.
fn on_grid(mesh: &HexMesh, backside: &[u32], spacing_mm: f64) -> Vec<([f64; 2], Around)> {
    let place = |at: usize| mesh.nodes[backside[at] as usize];
    let places: Vec<Vec3> = (0..backside.len()).map(place).collect();
    let (low, high) = bounds(&places);
    let cells = [0, 2].map(|axis| ((high[axis] - low[axis]) / spacing_mm).ceil().max(1.0));
    let columns = cells[0] as usize + 1;
    let mut nodes = vec![Vec::new(); columns * (cells[1] as usize + 1)];
    for (at, place) in places.iter().enumerate() {
        let [x, z] = [(0, cells[0]), (2, cells[1])].map(|(axis, cells)| {
            let along = cells * (place[axis] - low[axis]) / (high[axis] - low[axis]);
            let cell = along.floor().min(cells - 1.0);
            (cell as usize, along - cell)
        });
        for (k, across) in [1.0 - z.1, z.1].into_iter().enumerate() {
            for (i, along) in [1.0 - x.1, x.1].into_iter().enumerate() {
                if along * across > 0.0 {
                    nodes[x.0 + i + columns * (z.0 + k)].push((at, along * across));
                }
            }
        }
    }
    let step = [(0, cells[0]), (2, cells[1])].map(|(axis, cells)| (high[axis] - low[axis]) / cells);
    let place = |at: usize| {
        let [i, k] = [at % columns, at / columns].map(|i| i as f64);
        [low.x + i * step[0], low.z + k * step[1]]
    };
    let points = nodes.into_iter().enumerate();
    let points = points.filter(|(_, nodes)| !nodes.is_empty());
    points.map(|(at, nodes)| (place(at), nodes)).collect()
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
