//! The regular grid at whose nodes the gap to a mesh is known, and the numbers at its nodes.

use condyle_mesh::{Cluster, DividedMesh};
use serde::{Deserialize, Serialize};

use super::visibility::Visibility;
use crate::Vec3;

/// Largest and smallest distance between grid nodes, mm: with the largest, the spline's error on a ball of radius 20 mm is below
/// 0.1 micrometre. The number of nodes grows with its inverse cube.
const MAX_SPACING_MM: f64 = 1.25;
const MIN_SPACING_MM: f64 = 0.4;
/// Spacings along the smallest extent of a small surface: on a ball, the error is below 0.2 micrometres.
const SPACINGS_ACROSS: f64 = 20.0;

/// Distance from the surface within which grid nodes have a true gap, mm: the deepest overclosure
/// of a run, and the spline's support around it.
pub const BAND_MM: f64 = 3.5;

/// A regular grid of nodes around a surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NodeGrid {
    /// Position of node (0, 0, 0), mm.
    pub origin: Vec3,
    /// Nodes along x, y, z; x runs fastest.
    pub counts: [usize; 3],
    /// Distance between neighbours along each axis, mm.
    pub spacing_mm: f64,
}

impl NodeGrid {
    /// Creates the grid around a surface from `low` to `high`: two nodes beyond the band.
    pub fn around((low, high): (Vec3, Vec3)) -> Self {
        let spacing_mm =
            ((high - low).min() / SPACINGS_ACROSS).clamp(MIN_SPACING_MM, MAX_SPACING_MM);
        // The spline reads a node on either side, and a point at the band has one more beyond it.
        let margin = Vec3::repeat(BAND_MM + 2.0 * spacing_mm);
        let origin = low - margin;
        let size = high + margin - origin;
        let count = |axis: usize| ((size[axis] / spacing_mm).ceil() as usize).saturating_add(1);
        Self {
            origin,
            counts: [0, 1, 2].map(count),
            spacing_mm,
        }
    }

    /// Differences of the numbers of neighbours along x, y and z.
    #[inline]
    pub fn strides(&self) -> [usize; 3] {
        [1, self.counts[0], self.counts[0] * self.counts[1]]
    }

    /// Returns the number of nodes; saturates.
    pub fn node_count(&self) -> usize {
        let counts = self.counts.iter();
        counts.fold(1, |product: usize, &count| product.saturating_mul(count))
    }

    /// Returns the position of node (i, j, k), mm.
    #[inline]
    pub fn position(&self, i: usize, j: usize, k: usize) -> Vec3 {
        self.origin + Vec3::new(i as f64, j as f64, k as f64) * self.spacing_mm
    }

    /// Returns the numbers and positions of the nodes with neighbours on all sides.
    pub fn inner_nodes(&self) -> impl Iterator<Item = (usize, Vec3)> {
        let [nx, ny, nz] = self.counts;
        let [sx, sy, sz] = self.strides();
        let rows = (1..nz - 1).flat_map(move |k| (1..ny - 1).map(move |j| (j, k)));
        rows.flat_map(move |(j, k)| {
            (1..nx - 1).map(move |i| (i * sx + j * sy + k * sz, self.position(i, j, k)))
        })
    }

    /// Returns the first node and one past the last node along each axis within `reach_mm` of a place along that axis.
    pub fn nodes_around(&self, place: &Vec3, reach_mm: f64) -> [[usize; 2]; 3] {
        let (middle, reach) = (
            (place - self.origin) / self.spacing_mm,
            reach_mm / self.spacing_mm,
        );
        [0, 1, 2].map(|axis| {
            let first = (middle[axis] - reach).ceil().max(0.0) as usize;
            let end = (middle[axis] + reach).floor().max(-1.0) + 1.0;
            [first, (end as usize).min(self.counts[axis])]
        })
    }

    /// Returns the largest distance of the grid from the frame's origin, mm.
    pub fn reach_mm(&self) -> f64 {
        let size = Vec3::from(self.counts.map(|count| count as f64)) * self.spacing_mm;
        self.origin.abs().sup(&(self.origin + size).abs()).norm()
    }
}

/// Marker of nodes beyond the band until their bound is computed, mm: no gap is as large.
pub const BEYOND_BAND_MM: f64 = 1e3;

/// Returns the gap at every node of a grid within the band, [`BEYOND_BAND_MM`] elsewhere, and the gap to the other side of a wall at the
/// nodes inside and behind it, 0 elsewhere.
///
/// Inside a thin wall and behind it, the gap to the articulating surface counts, though the other side of the wall is nearer: the spline
/// near the surface reads nodes up to 3 mm below it, and a bend of the gaps in the middle of the wall would make the surface wavy.
///
/// Each of `threads` fills its own layers, and no number depends on the thread that computed it. With one thread, the
/// thread of the caller does the work.
pub fn gaps_at_nodes(
    grid: &NodeGrid,
    curved: &DividedMesh,
    seen: &Visibility,
    threads: usize,
) -> [Vec<f64>; 2] {
    let triangles = 0..curved.mesh.triangles.len();
    let sees = |triangle| seen.sees(&curved.mesh.corners(triangle));
    let is_seen: Vec<bool> = triangles.map(sees).collect();
    let count = grid.node_count();
    let [mut gaps, mut across] = [vec![BEYOND_BAND_MM; count], vec![0.0; count]];
    if threads <= 1 {
        fill_layers(grid, curved, &is_seen, 0, [&mut gaps, &mut across]);
        return [gaps, across];
    }
    let [_, _, layer] = grid.strides();
    let layers = grid.counts[2].div_ceil(threads);
    std::thread::scope(|scope| {
        let [gaps, across] = [&mut gaps, &mut across].map(|all| all.chunks_mut(layer * layers));
        for (index, (gaps, across)) in gaps.zip(across).enumerate() {
            let (is_seen, first) = (&is_seen, index * layers);
            scope.spawn(move || fill_layers(grid, curved, is_seen, first, [gaps, across]));
        }
    });
    [gaps, across]
}

/// Fills the layers of nodes from `first_layer` with their gaps to the nearest triangle, and to the seen side of a wall.
fn fill_layers(
    grid: &NodeGrid,
    curved: &DividedMesh,
    is_seen: &[bool],
    first_layer: usize,
    [gaps, across_mm]: [&mut [f64]; 2],
) {
    let [_, row, layer] = grid.strides();
    // Only for the nearest facet: the gap to the curved surface is far more expensive than the distance to a facet.
    let foot = |here: usize, triangle: u32| {
        let (i, j, k) = (here % row, here % layer / row, here / layer);
        let node = grid.position(i, j, k + first_layer);
        (node, curved.foot(triangle as usize, &node))
    };
    let mut clusters = curved.clusters();
    let band_mm = vec![BAND_MM; gaps.len()];
    let nearest = nearest_triangles(grid, curved, &clusters, first_layer, &band_mm, &|_, _| true);
    let is_hidden = |triangle: u32| triangle != NONE && !is_seen[triangle as usize];
    let reach_mm = |&triangle: &u32| if is_hidden(triangle) { WALL_MM } else { 0.0 };
    let reach_mm: Vec<f64> = nearest.iter().map(reach_mm).collect();
    let is_across = |here: usize, triangle: usize| {
        let cosine = |near: u32| curved.normal(near as usize).dot(&curved.normal(triangle));
        is_seen[triangle] && cosine(nearest[here]) < MAX_COSINE_ACROSS
    };
    clusters.retain(|cluster| is_seen[cluster.triangles.clone()].contains(&true));
    let across = nearest_triangles(grid, curved, &clusters, first_layer, &reach_mm, &is_across);
    for (here, gap) in gaps.iter_mut().enumerate() {
        if nearest[here] == NONE {
            continue;
        }
        let (node, near) = foot(here, nearest[here]);
        *gap = (node - near.point).dot(&near.normal);
        if across[here] != NONE {
            let far = foot(here, across[here]).1;
            let (normal, wall) = (curved.normal(across[here] as usize), far.point - near.point);
            let is_straight = |way: Vec3| way.dot(&normal) > MIN_COSINE_OF_WALL * way.norm();
            // Beside the edge of a wall and behind a thick one, the nearest side counts.
            let is_reached = *gap < 0.0 || wall.norm() < MAX_WALL * grid.spacing_mm;
            if is_reached && is_straight(far.point - node) && is_straight(wall) {
                across_mm[here] = (node - far.point).dot(&far.normal);
            }
        }
    }
}

/// Distance behind the articulating surface up to which the gap is that to it, though the other side of a wall is nearer, mm: the
/// spline at the surface reads nodes 2.5 spacings away along each axis.
const WALL_MM: f64 = 5.5;
/// Largest thickness of a wall through which the spline at the surface reads nodes behind it, in spacings.
const MAX_WALL: f64 = 2.5;
/// Smallest cosine between the normal of the articulating surface and the way to it through the wall.
const MIN_COSINE_OF_WALL: f64 = 0.9;
/// Largest cosine between the normals of the sides of a wall, which may be a wedge.
const MAX_COSINE_ACROSS: f64 = -0.3;

/// No triangle.
const NONE: u32 = u32::MAX;

/// Returns the nearest of the triangles that count to each node from `first_layer` on, within its reach, mm; [`NONE`] beyond.
fn nearest_triangles(
    grid: &NodeGrid,
    curved: &DividedMesh,
    clusters: &[Cluster],
    first_layer: usize,
    reach_mm: &[f64],
    counts: &dyn Fn(usize, usize) -> bool,
) -> Vec<u32> {
    /// Parts by which rounding may place a point nearer than it is: every bound is wider, so that it changes no result.
    const ROUNDING: f64 = 1e-9;
    let [_, row, layer] = grid.strides();
    let layers = first_layer..first_layer + reach_mm.len() / layer;
    let farthest_mm = reach_mm.iter().copied().fold(0.0, f64::max);
    let rows_around = |cluster: &Cluster| {
        let [xs, ys, zs] = grid.nodes_around(&cluster.centre, cluster.radius_mm + farthest_mm);
        (zs[0].max(layers.start)..zs[1].min(layers.end))
            .flat_map(move |k| (ys[0]..ys[1]).map(move |j| (xs[0]..xs[1], j, k)))
    };
    let number = move |i: usize, j: usize, k: usize| i + row * j + layer * (k - first_layer);
    let mut nearest2: Vec<f64> = reach_mm.iter().map(|mm| mm * mm).collect();
    // One corner of each cluster bounds the squared distance, with which most clusters are out of question for most nodes.
    for cluster in clusters {
        let first = cluster.triangles.start;
        let corner = curved.mesh.corners(first)[0];
        for (across, j, k) in rows_around(cluster) {
            for i in across {
                let (here, node) = (number(i, j, k), grid.position(i, j, k));
                let distance2 = (node - corner).norm_squared() * (1.0 + ROUNDING);
                if distance2 < nearest2[here] && counts(here, first) {
                    nearest2[here] = distance2;
                }
            }
        }
    }
    let mut nearest = vec![NONE; nearest2.len()];
    for cluster in clusters {
        for (across, j, k) in rows_around(cluster) {
            for i in across {
                let (here, node) = (number(i, j, k), grid.position(i, j, k));
                let reach = (nearest2[here].sqrt() + cluster.radius_mm) * (1.0 + ROUNDING);
                if (node - cluster.centre).norm_squared() > reach * reach {
                    continue;
                }
                for triangle in cluster.triangles.clone() {
                    // The plane is never farther than the triangle, and cheaper to evaluate.
                    if curved.plane_distance2(triangle, &node) >= nearest2[here]
                        || !counts(here, triangle)
                    {
                        continue;
                    }
                    let distance2 = curved.distance2(triangle, &node);
                    if distance2 < nearest2[here] {
                        (nearest2[here], nearest[here]) = (distance2, triangle as u32);
                    }
                }
            }
        }
    }
    nearest
}

/// Lower bound of the straight distance over the distance along grid lines, 1/sqrt(3).
const STRAIGHT_PER_PATH: f64 = 0.577;

/// Sets a lower bound of the distance at the nodes beyond the band, and returns which nodes they are.
///
/// Far inside a closed surface the bound is negative. An open surface has no inside: a sign
/// propagated past its rim from its back would make the insert overlap it.
pub fn bound_far_gaps(grid: &NodeGrid, gaps: &mut [f64], is_closed: bool) -> Vec<bool> {
    let is_far: Vec<bool> = gaps.iter().map(|&gap| gap == BEYOND_BAND_MM).collect();
    let strides = grid.strides();
    let count = gaps.len();
    let mut pass_on = |there: usize, here: usize| {
        let from_there = gaps[there].abs() + grid.spacing_mm * STRAIGHT_PER_PATH;
        if is_far[here] && from_there < gaps[here].abs() {
            let sign = if is_closed { gaps[there].signum() } else { 1.0 };
            gaps[here] = sign * from_there;
        }
    };
    // One pass carries bounds to higher numbers along all axes at once, the other back to lower ones.
    for here in 0..count {
        let lower = strides.iter().filter(|&&stride| here >= stride);
        lower.for_each(|stride| pass_on(here - stride, here));
    }
    for here in (0..count).rev() {
        let higher = strides.iter().filter(|&&stride| here + stride < count);
        higher.for_each(|stride| pass_on(here + stride, here));
    }
    is_far
}

/// Returns the coefficients of the quadratic B-spline through the gaps at the nodes, without fourth differences.
///
/// Along one axis the spline's value at a node is (c_before + 6 c + c_after)/8, which is c and an
/// eighth of its second difference. So c = g minus an eighth of the second difference of g, one axis
/// after the other.
pub fn spline_coefficients(grid: &NodeGrid, is_far: &[bool], mut gaps: Vec<f64>) -> Vec<f64> {
    for stride in grid.strides() {
        let before = gaps.clone();
        add_second_differences(&mut gaps, &before, is_far, stride, -1.0 / 8.0);
    }
    gaps
}

/// Adds `spread_mm2` times the Laplacian of a spline: the sum of its second differences over the
/// spacing squared.
pub fn add_laplacian(
    grid: &NodeGrid,
    is_far: &[bool],
    to: &mut [f64],
    from: &[f64],
    spread_mm2: f64,
) {
    let factor = spread_mm2 / (grid.spacing_mm * grid.spacing_mm);
    for stride in grid.strides() {
        add_second_differences(to, from, is_far, stride, factor);
    }
}

/// Adds `factor` times the second difference along one axis of `from`, where all its nodes are
/// within the band.
fn add_second_differences(
    to: &mut [f64],
    from: &[f64],
    is_far: &[bool],
    stride: usize,
    factor: f64,
) {
    for i in stride..is_far.len() - stride {
        let (before, after) = (i - stride, i + stride);
        if !(is_far[before] || is_far[i] || is_far[after]) {
            to[i] += factor * (from[before] - 2.0 * from[i] + from[after]);
        }
    }
}
