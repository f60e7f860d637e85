//! The tray under an insert: condensed stiffness of the backside, the lock, and the points that carry the motion.

use std::sync::{Arc, OnceLock};

use condyle_fem::{ElasticSolid, HalfSolved, HexMesh};
use nalgebra::{DMatrix, DVector};

use super::floor::{Floor, Grid};
use crate::{
    Vec3,
    contact::deformable::compliance::{UnitLoads, tiles},
};

/// Stiffness of the rim that locks the insert into its tray, against its mean slip, N/mm: a micrometre under a hundred
/// newtons, far less than a load makes the insert slip within the rim.
const LOCK_N_PER_MM: f64 = 1e5;

/// The stiffness of the search over that of a point alone: the search is quickest so for the inserts of the cases.
const STIFFER: f64 = 0.5;

/// The load on the lock.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct LockLoad {
    /// Force along the tray, N.
    pub force_n: f64,
    /// Moment about the vertical axis through the middle of the backside, N mm.
    pub moment_nmm: f64,
}

/// The tray under an insert, as its points feel it.
///
/// Three numbers a point, its motion along its own directions: q. Under the forces b along them, which loads on the surface
/// are there, the tray pushes with R = S q - b, and the surface deflects by B q besides what it does with its backside
/// held ([`condyle_fem::MovedSupports`]). S holds the rim that locks the insert sideways: a spring against the mean slip and
/// the mean turn of the backside.
pub(crate) struct Tray {
    pub points: Vec<TrayPoint>,
    /// The stiffness of the search for every number of q, N/mm, and the inverse of S with those.
    pub stiffness_of_search: Vec<f64>,
    inverse: DMatrix<f64>,
    /// Mean slips, anterior and lateral, and mean turn times radius of gyration, by q.
    lock: [DVector<f64>; 3],
    gyration_mm: f64,
    solved: Vec<HalfSolved>,
    /// B, a row for each node of a tile of the surface.
    by_tile: Vec<OnceLock<Vec<f64>>>,
}

impl Tray {
    /// The tray of a solid that is held by the floor of its backside and whose surface has `tiles` tiles.
    pub fn new(solid: &ElasticSolid, floor: &Floor, spacing_mm: f64, tiles: usize) -> Self {
        let groups = tray_points(solid.mesh(), floor, spacing_mm);
        let motions = |group: &Vec<TrayPoint>| group.iter().flat_map(motions_of).collect();
        let motions: Vec<Vec<Vec<(u32, Vec3)>>> = groups.iter().map(motions).collect();
        let supports = solid.moved_supports(&motions);
        let points: Vec<TrayPoint> = groups.into_iter().flatten().collect();
        let size = 3 * points.len();
        let mut stiffness = DMatrix::from_row_slice(size, size, &supports.stiffness);
        let (lock, gyration_mm) = lock_of(&points);
        for mean in &lock {
            stiffness.ger(LOCK_N_PER_MM, mean, mean, 1.0);
        }
        let searched = stiffness_of_search(size, &supports.stiffness);
        for (i, own) in searched.iter().enumerate() {
            stiffness[(i, i)] += own;
        }
        // A stiffness is positive, so there is an inverse; without one nothing moves.
        let inverse = stiffness.cholesky().map(|factor| factor.inverse());
        Self {
            points,
            stiffness_of_search: searched,
            inverse: inverse.unwrap_or_else(|| DMatrix::zeros(size, size)),
            lock,
            gyration_mm,
            solved: supports.solved,
            by_tile: (0..tiles).map(|_| OnceLock::new()).collect(),
        }
    }

    /// Returns the count of numbers in the motion of the backside: three per point.
    pub fn freedoms(&self) -> usize {
        self.stiffness_of_search.len()
    }

    /// Motion under forces, N, with each number pulled to `to_mm` by the stiffness of the search.
    pub fn pulled(&self, forces_n: &DVector<f64>, to_mm: &DVector<f64>) -> DVector<f64> {
        let stiffness = self.stiffness_of_search.iter();
        let pull = stiffness.zip(to_mm.iter()).map(|(own, to)| own * to);
        let pulled = forces_n + DVector::from_iterator(to_mm.len(), pull);
        &self.inverse * pulled
    }

    /// Returns how far each number of q moves the nodes of a tile of the surface along their inward normals: row-major, a row a
    /// node.
    pub fn of_tile(&self, loads: &UnitLoads, tile: usize) -> &[f64] {
        self.by_tile[tile].get_or_init(|| {
            let own: Arc<HalfSolved> = loads.solved(tile);
            let size = self.freedoms();
            let mut rows = vec![0.0; own.forces() * size];
            let mut first = 0;
            for group in &self.solved {
                let moved = own.moved_along(group);
                let moved = moved.chunks_exact(group.forces());
                for (row, moved) in rows.chunks_exact_mut(size).zip(moved) {
                    row[first..first + moved.len()].copy_from_slice(moved);
                }
                first += group.forces();
            }
            rows
        })
    }

    /// Displacements of mesh nodes of the backside by a motion.
    pub fn moved_nodes(&self, moved_mm: &[f64]) -> Vec<(u32, Vec3)> {
        let points = self.points.iter().zip(moved_mm.as_chunks::<3>().0);
        let moved = points.flat_map(|(point, own)| {
            let by: Vec3 = std::iter::zip(point.frame, own)
                .map(|(e, own)| e * *own)
                .sum();
            let nodes = point.weights.iter();
            nodes.map(move |&(node, weight)| (node, by * weight))
        });
        moved.collect()
    }

    /// Returns the load on the lock for a motion of the backside.
    pub fn lock_load(&self, moved_mm: &DVector<f64>) -> LockLoad {
        let [x, z, turn] = self
            .lock
            .each_ref()
            .map(|mean| LOCK_N_PER_MM * mean.dot(moved_mm));
        LockLoad {
            force_n: x.hypot(z),
            moment_nmm: (turn * self.gyration_mm).abs(),
        }
    }

    /// Bytes that a tray of so many numbers takes, with its influence on some nodes of the surface.
    pub fn bytes(freedoms: f64, nodes: f64, felt: f64) -> f64 {
        size_of::<f64>() as f64 * freedoms * (2.0 * freedoms + nodes + felt)
    }
}

/// The motions of the nodes around a point by each of its three numbers.
fn motions_of(point: &TrayPoint) -> impl Iterator<Item = Vec<(u32, Vec3)>> {
    point.frame.into_iter().map(|along| {
        let nodes = point.weights.iter();
        nodes
            .map(|&(node, weight)| (node, along * weight))
            .collect()
    })
}

/// The same for the three numbers of a point, so that the search knows no direction.
fn stiffness_of_search(size: usize, stiffness: &[f64]) -> Vec<f64> {
    let own = |i: usize| stiffness[i * size + i];
    let points = (0..size).step_by(3);
    points
        .flat_map(|i| [STIFFER * (own(i) + own(i + 1) + own(i + 2)) / 3.0; 3])
        .collect()
}

/// Mean slips along x and z, and the mean turn about y times the radius of gyration of the backside; and that radius.
fn lock_of(points: &[TrayPoint]) -> ([DVector<f64>; 3], f64) {
    let area_mm2: f64 = points.iter().map(|point| point.area_mm2).sum();
    let part = |point: &TrayPoint| point.area_mm2 / area_mm2;
    let middle: Vec3 = points
        .iter()
        .map(|point| point.position * part(point))
        .sum();
    let arm = |point: &TrayPoint| {
        let from = point.position - middle;
        Vec3::new(from.z, 0.0, -from.x)
    };
    let arms = points
        .iter()
        .map(|point| part(point) * arm(point).norm_squared());
    let gyration_mm = arms.sum::<f64>().sqrt();
    let mean = |slip: &dyn Fn(&TrayPoint) -> Vec3| {
        let parts = points.iter().flat_map(|point| {
            let [anterior, lateral, _] = point.frame;
            let slip = slip(point) * part(point);
            [anterior.dot(&slip), lateral.dot(&slip), 0.0]
        });
        DVector::from_iterator(3 * points.len(), parts)
    };
    let lock = [
        mean(&|_| Vec3::x()),
        mean(&|_| Vec3::z()),
        mean(&|point| arm(point) / gyration_mm),
    ];
    (lock, gyration_mm)
}

/// So many points at most are solved for together.
const TOGETHER: usize = 16;

/// A point of the backside, for the mesh nodes around it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct TrayPoint {
    /// Its place on the grid, at the middle height of the floor.
    pub position: Vec3,
    /// Its own directions: anterior and lateral along the tray, then off the tray, into the insert.
    pub frame: [Vec3; 3],
    /// The weights with which the mesh nodes of the floor around it follow its motion.
    pub weights: Vec<(u32, f64)>,
    /// Its share of the floor, mm2.
    pub area_mm2: f64,
}

/// Points on a grid of some `spacing_mm` over the transverse plane, in groups that lie together.
///
/// The floor moves by bilinear interpolation between them, and beyond its outermost points by extrapolation, so that a
/// motion as a rigid body is among its motions. All points have its directions.
pub(crate) fn tray_points(mesh: &HexMesh, floor: &Floor, spacing_mm: f64) -> Vec<Vec<TrayPoint>> {
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
