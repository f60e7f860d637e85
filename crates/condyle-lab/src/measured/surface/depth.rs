//! Depths below the unworn surface, predicted and scanned, at its nodes.

use condyle::{Mat3, Vec3};
use condyle_report::SurfaceFields;
use rstar::RTree;
use rstar::primitives::GeomWithData;

use super::register::MIN_COSINE;
use super::sheet::Sheet;

/// Scanned depth at a node is that of points up to this many of their spacings away.
const SPACINGS: f64 = 1.5;
/// Places of which the spacing is taken.
const MAX_FOR_SPACING: usize = 2000;
/// Smaller determinants of a fit, relative to its weight, leave the slope open.
const MIN_DETERMINANT: f64 = 1e-3;

/// Depths at the nodes of the unworn surface, mm, NaN where the scan does not reach.
pub(super) struct Compared {
    pub predicted_mm: Vec<f64>,
    pub scanned_mm: Vec<f64>,
    /// Area that a node stands for, mm2.
    pub areas_mm2: Vec<f64>,
}

/// A place of the unworn surface, and the scanned depth there.
type Sounding = GeomWithData<[f64; 3], f64>;

/// Both depths at every node.
///
/// Predicted is the depth of the worn node below the unworn surface; scanned is what the depths of
/// the points around say, so that both are measured alike.
pub(super) fn compared(
    unworn: &SurfaceFields,
    sheet: &Sheet<'_>,
    worn_nodes: &[Vec3],
    scan: (&[Vec3], Option<&[Vec3]>),
    farthest_mm: f64,
) -> Compared {
    let soundings = soundings(sheet, scan, farthest_mm);
    let radius = edge_mm(unworn).max(SPACINGS * spacing_mm(&soundings));
    let tree = RTree::bulk_load(soundings);
    let depth_of = |point: &Vec3| sheet.foot(point).map_or(f64::NAN, |foot| -foot.height_mm);
    let scanned = |node: usize| {
        if sheet.is_border(node) {
            return f64::NAN;
        }
        sounded(&tree, &unworn.nodes[node], radius).unwrap_or(f64::NAN)
    };
    Compared {
        predicted_mm: worn_nodes.iter().map(depth_of).collect(),
        scanned_mm: (0..unworn.nodes.len()).map(scanned).collect(),
        areas_mm2: areas(unworn),
    }
}

/// The depth of every point of the scan that lies over the surface.
fn soundings(
    sheet: &Sheet<'_>,
    (points, normals): (&[Vec3], Option<&[Vec3]>),
    farthest_mm: f64,
) -> Vec<Sounding> {
    let sounding = |(index, point): (usize, &Vec3)| {
        let foot = sheet.foot(point)?;
        let faces = normals.is_none_or(|all| all[index].dot(&foot.normal) > MIN_COSINE);
        let counts = faces && !foot.on_border && foot.height_mm.abs() <= farthest_mm;
        counts.then(|| Sounding::new(foot.point.into(), -foot.height_mm))
    };
    points.iter().enumerate().filter_map(sounding).collect()
}

/// Mean length of the edges of the quads.
fn edge_mm(surface: &SurfaceFields) -> f64 {
    let around = |quad: &[u32; 4]| {
        let corners = surface.corners(*quad);
        (0..4)
            .map(|i| (corners[(i + 1) % 4] - corners[i]).norm())
            .sum::<f64>()
            / 4.0
    };
    surface.quads.iter().map(around).sum::<f64>() / surface.quads.len().max(1) as f64
}

/// Median distance from a sounding to the next.
fn spacing_mm(soundings: &[Sounding]) -> f64 {
    let tree = RTree::bulk_load(soundings.to_vec());
    let every = soundings.len().div_ceil(MAX_FOR_SPACING).max(1);
    let next = |sounding: &Sounding| {
        let [_, next] = two_nearest(&tree, *sounding.geom())?;
        Some((Vec3::from(next) - Vec3::from(*sounding.geom())).norm())
    };
    let mut distances: Vec<f64> = soundings.iter().step_by(every).filter_map(next).collect();
    distances.sort_by(f64::total_cmp);
    distances.get(distances.len() / 2).copied().unwrap_or(0.0)
}

fn two_nearest(tree: &RTree<Sounding>, place: [f64; 3]) -> Option<[[f64; 3]; 2]> {
    let mut nearest = tree.nearest_neighbor_iter(place).map(|found| *found.geom());
    Some([nearest.next()?, nearest.next()?])
}

/// The depth at a node: the plane of weighted least squares through the soundings around, or
/// their weighted mean where they leave its slope open; none where there are none.
fn sounded(tree: &RTree<Sounding>, node: &Vec3, radius: f64) -> Option<f64> {
    let place = [node.x, node.y, node.z];
    let mut matrix = Mat3::zeros();
    let mut right_side = Vec3::zeros();
    for sounding in tree.locate_within_distance(place, radius * radius) {
        let away = (Vec3::from(*sounding.geom()) - node) / radius;
        let weight = fading(away.norm());
        // Steep surfaces are rare on an insert, so x and z stand for directions along it.
        let row = Vec3::new(1.0, away.x, away.z);
        matrix += row * row.transpose() * weight;
        right_side += row * (weight * sounding.data);
    }
    let weight = matrix[(0, 0)];
    if weight <= 0.0 {
        return None;
    }
    let is_fixed = matrix.determinant() > MIN_DETERMINANT * weight.powi(3);
    let plane = matrix.cholesky().filter(|_| is_fixed);
    Some(plane.map_or(right_side.x / weight, |plane| plane.solve(&right_side).x))
}

/// Wendland's function: 1 at the node, smoothly 0 at the radius.
fn fading(part: f64) -> f64 {
    (1.0 - part).max(0.0).powi(4) * (4.0 * part + 1.0)
}

/// A quarter of each face for each of its nodes.
fn areas(surface: &SurfaceFields) -> Vec<f64> {
    let mut areas = vec![0.0; surface.nodes.len()];
    for quad in &surface.quads {
        let [a, b, c, d] = surface.corners(*quad);
        let area = (c - a).cross(&(d - b)).norm() / 2.0;
        for &node in quad {
            areas[node as usize] += area / 4.0;
        }
    }
    areas
}
