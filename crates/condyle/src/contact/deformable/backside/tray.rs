//! The tray under an insert: points that carry the motion of the backside, their stiffness, the lock, and the equilibrium.

use std::sync::OnceLock;

use condyle_fem::{ElasticSolid, HalfSolved, HexMesh};
use nalgebra::{DMatrix, DVector};

use super::floor::{Floor, Grid};
use crate::{
    Vec3,
    contact::{
        deformable::compliance::{UnitLoads, tiles},
        model::NotBorne,
    },
    number::{Mixing, Symmetric},
};

/// Stiffness of the rim that locks the insert into its tray, against its mean slip, N/mm. A hundred newtons displace it
/// by a micrometre, far less than an insert slips under load. The rim carries the net force only.
const LOCK_N_PER_MM: f64 = 1e5;

/// Ratio of the stiffness of the search to the stiffness of a single point. This value took the fewest steps for the
/// inserts of the cases. It changes the path to the equilibrium, not the equilibrium.
const SEARCH_STIFFNESS: f64 = 0.5;

/// Smallest spacing of the points, in edges of the floor: points that are closer move the same nodes, and the search for the
/// equilibrium takes 50 times as many steps.
const MIN_EDGES_APART: f64 = 1.5;

/// The equilibrium is found once the motion under the forces and the admissible motion agree within this, mm: a hundredth
/// of the agreement that is required of loads and backside.
pub const AT_REST_MM: f64 = 1e-7;
/// Number of steps after which no equilibrium exists: ten times the number observed where one exists.
const MAX_STEPS: usize = 5000;
/// Displacement beyond which the insert has tipped off its tray, mm.
const TIPPED_MM: f64 = 10.0;

/// The tray under an insert, condensed to the points of its backside.
///
/// The motion q has three numbers per point, along the point's own directions. With the forces b that loads on the
/// surface exert along them, the tray pushes with R = S q - b; and the surface deflects by B q in addition to its
/// deflection with the backside held ([`condyle_fem::MovedSupports`]). S includes the rim that locks the insert
/// sideways: a spring against the mean slip and the mean turn of the backside.
pub(crate) struct Tray {
    pub points: Vec<TrayPoint>,
    /// The stiffness of the search for every number of q, N/mm, and the inverse of S with those.
    pub stiffness_of_search: Vec<f64>,
    inverse: Symmetric,
    /// Mean slips, anterior and lateral, and mean turn times radius of gyration, by q.
    lock: [DVector<f64>; 3],
    gyration_mm: f64,
    solved: Vec<HalfSolved>,
    /// The transpose of B for each tile of the surface: a row for every number of q.
    by_tile: Vec<OnceLock<Vec<f64>>>,
}

impl Tray {
    /// Creates the tray of a solid that is held by the floor of its backside and whose surface has `tiles` tiles; its points are
    /// about `spacing_mm` apart, or farther on a coarse mesh.
    pub fn new(solid: &ElasticSolid, floor: &Floor, spacing_mm: f64, tiles: usize) -> Self {
        let edge_mm = (floor.share_mm2.iter().sum::<f64>() / floor.nodes.len() as f64).sqrt();
        let spacing_mm = spacing_mm.max(MIN_EDGES_APART * edge_mm);
        let groups = tray_points(solid.mesh(), floor, spacing_mm);
        let motions_of = |point: &TrayPoint| {
            point.frame.map(|along| {
                let nodes = point.weights.iter();
                nodes
                    .map(|&(node, weight)| (node, along * weight))
                    .collect()
            })
        };
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
        // The same for the three numbers of a point, so that the search prefers no direction.
        let own = |i: usize| supports.stiffness[i * size + i];
        let of_point = |i| [SEARCH_STIFFNESS * (own(i) + own(i + 1) + own(i + 2)) / 3.0; 3];
        let searched: Vec<f64> = (0..size).step_by(3).flat_map(of_point).collect();
        for (i, own) in searched.iter().enumerate() {
            stiffness[(i, i)] += own;
        }
        // A stiffness is positive definite, so there is an inverse; without one, by rounding, nothing moves.
        let inverse = stiffness.cholesky().map(|factor| factor.inverse());
        Self {
            points,
            stiffness_of_search: searched,
            inverse: Symmetric::from_lower(&inverse.unwrap_or_else(|| DMatrix::zeros(size, size))),
            lock,
            gyration_mm,
            solved: supports.solved,
            by_tile: (0..tiles).map(|_| OnceLock::new()).collect(),
        }
    }

    pub fn freedoms(&self) -> usize {
        self.stiffness_of_search.len()
    }

    /// Returns the motion under forces, N, with a spring of the search's stiffness from each component to `to_mm`.
    fn pulled(&self, forces_n: &DVector<f64>, to_mm: &DVector<f64>) -> DVector<f64> {
        let stiffness = self.stiffness_of_search.iter();
        let pull = stiffness.zip(to_mm.iter()).map(|(own, to)| own * to);
        let pulled = forces_n + DVector::from_iterator(to_mm.len(), pull);
        self.inverse.times(pulled.as_slice()).into()
    }

    /// Returns the displacements of the nodes of a tile of the surface along their inward normals, a row for every number of
    /// q: those of each node by that number.
    pub fn of_tile(&self, loads: &UnitLoads, tile: usize) -> &[f64] {
        self.by_tile[tile].get_or_init(|| {
            let own = loads.solved(tile);
            let groups = self.solved.iter();
            groups.flat_map(|group| group.moved_along(&own)).collect()
        })
    }

    /// Returns the displacements of mesh nodes of the backside by a motion.
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

    /// Returns the load on the lock for a motion of the backside: the force along the tray, N, and the moment about the
    /// vertical axis through the middle of the backside, N mm.
    pub fn lock_load(&self, moved_mm: &DVector<f64>) -> [f64; 2] {
        let [x, z, turn] = self
            .lock
            .each_ref()
            .map(|mean| LOCK_N_PER_MM * mean.dot(moved_mm));
        [x.hypot(z), (turn * self.gyration_mm).abs()]
    }

    /// Estimates the memory of a tray with `freedoms` numbers of motion, with its influence on `nodes` nodes of the
    /// surface, bytes.
    pub fn bytes(freedoms: f64, nodes: f64, felt: f64) -> f64 {
        size_of::<f64>() as f64 * freedoms * (2.0 * freedoms + nodes + felt)
    }

    /// Finds the equilibrium of the backside under forces b of the surface on its points, N; `stuck_mm` is the motion at which
    /// each stuck last, and `searched_mm` the start of the search.
    ///
    /// Every point lifts without force or is in contact, and sticks or slips against its friction:
    ///
    /// $$ q_n \ge 0, \quad R_n \ge 0, \quad q_n R_n = 0, \qquad |R_t| \le \mu R_n, \quad
    /// R_t = -\mu R_n \frac{q_t - q_t^0}{|q_t - q_t^0|} \quad \text{where it slips}, \qquad R = S q - b. $$
    ///
    /// Douglas-Rachford splitting [eckstein-bertsekas1992]: the projection of each point alone, pulled by a spring, onto
    /// its conditions, and the motion of the whole with the springs of all points, alternately, accelerated by Anderson
    /// mixing.
    ///
    /// # Errors
    /// A load under which the insert tips off its tray.
    pub fn rest(
        &self,
        friction: f64,
        stuck_mm: &[f64],
        forces_n: &DVector<f64>,
        searched_mm: &DVector<f64>,
    ) -> Result<Rest, NotBorne> {
        self.rest_within(AT_REST_MM, friction, stuck_mm, forces_n, searched_mm)
    }

    /// Finds the same within `within_mm`.
    ///
    /// # Errors
    /// As [`Tray::rest`].
    pub fn rest_within(
        &self,
        within_mm: f64,
        friction: f64,
        stuck_mm: &[f64],
        forces_n: &DVector<f64>,
        searched_mm: &DVector<f64>,
    ) -> Result<Rest, NotBorne> {
        let mut searched = searched_mm.clone();
        let mut mixing = Mixing::default();
        for _ in 0..MAX_STEPS {
            let admissible = admissible(friction, stuck_mm, &searched);
            // The reflection of the splitting: at its fixed point the force of the springs is that of the contact.
            let mirrored = &admissible * 2.0 - &searched;
            let apart = self.pulled(forces_n, &mirrored) - &admissible;
            if apart.amax() <= within_mm {
                let ends = admissible.iter().zip(searched.iter());
                let pulls = self.stiffness_of_search.iter().zip(ends);
                return Ok(Rest {
                    pushes_n: pulls.map(|(own, (at, from))| own * (at - from)).collect(),
                    moved_mm: admissible.as_slice().to_vec(),
                    searched_mm: searched,
                });
            }
            if !admissible.amax().is_finite() || admissible.amax() > TIPPED_MM {
                break;
            }
            let image = &searched + apart;
            searched = mixing
                .next(searched.as_slice(), image.as_slice(), 1.0)
                .into();
        }
        let moved_mm = admissible(friction, stuck_mm, &searched).amax();
        Err(NotBorne::Tipped { moved_mm })
    }
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Rest {
    /// Motion of every point along its own directions, anterior, lateral, off the tray, mm.
    pub moved_mm: Vec<f64>,
    /// The force of the tray on each, N.
    pub pushes_n: Vec<f64>,
    /// The start of the search for the next equilibrium.
    pub searched_mm: DVector<f64>,
}

/// Projects every point, pulled to a place by the stiffness of the search, onto its contact conditions.
fn admissible(friction: f64, stuck_mm: &[f64], pulled_to: &DVector<f64>) -> DVector<f64> {
    let points = pulled_to.as_slice().as_chunks::<3>().0;
    let points = points.iter().zip(stuck_mm.as_chunks::<3>().0);
    let project = |(to, stuck): (&[f64; 3], &[f64; 3])| {
        let [x, z, off] = *to;
        if off > 0.0 {
            return *to;
        }
        // In contact: the spring presses by -off, and friction can hold a slip of up to -mu off.
        let slip = [x - stuck[0], z - stuck[1]];
        let pulled = slip[0].hypot(slip[1]);
        let held = -friction * off;
        let part = if pulled <= held {
            0.0
        } else {
            1.0 - held / pulled
        };
        [stuck[0] + part * slip[0], stuck[1] + part * slip[1], 0.0]
    };
    DVector::from_iterator(pulled_to.len(), points.flat_map(project))
}

/// Returns the mean slips along x and z and the mean turn about y times the radius of gyration of the backside, as products
/// with the motion; and that radius.
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
    // The turn is scaled by the radius of gyration, so that one stiffness serves slips and turn.
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

/// Largest number of points that are solved for together.
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

/// Returns points on a grid of about `spacing_mm` over the transverse plane, in groups that lie together.
///
/// The floor moves by bilinear interpolation between them, and beyond its outermost points by extrapolation, so that
/// rigid-body motions are among its motions. All points have the directions of the floor.
fn tray_points(mesh: &HexMesh, floor: &Floor, spacing_mm: f64) -> Vec<Vec<TrayPoint>> {
    let grid = Grid::over(mesh, &floor.nodes, spacing_mm);
    let around = grid.led_from_within(grid.around(mesh, &floor.nodes), &floor.share_mm2);
    let up = floor.normal.try_normalize(0.0).unwrap_or_else(Vec3::y);
    let anterior = Vec3::x() - up * up.x;
    // If the backside is upright and faces along x, anterior is down.
    let anterior = anterior.try_normalize(1e-6).unwrap_or_else(|| -Vec3::y());
    let frame = [anterior, anterior.cross(&up), up];
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
    // Neighbouring points use the same part of the factor and are solved together.
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
