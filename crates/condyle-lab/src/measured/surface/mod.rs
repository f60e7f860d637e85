//! Comparison of predicted wear with a scanned surface.

pub(crate) mod register;

use std::{collections::HashSet, path::Path};

use condyle::{Mat3, Vec3, geometry::bounds};
use condyle_case::measured::{FitWord, Scan};
use condyle_report::{SurfaceFields, unworn_surface};
use condyle_results::insert_file_name;
use rstar::{RTree, primitives::GeomWithData};
use serde::Serialize;

use crate::measured::{
    CompareError,
    surface::register::{
        MIN_COSINE, SCALE_OF_MEDIAN, Sheet, TUKEY, median, register, triangulated,
    },
};

pub use crate::measured::surface::register::Registration;

const DEPTH: &str = "wear_depth_mm";
const CREEP: &str = "creep_depth_mm";
const CREEP_LEFT: &str = "creep_left_unloaded_mm";
const PERMANENT_SET: &str = "permanent_set_mm";

/// Registers a scan onto the worn insert of a results folder, whose surface after the last update is `last`, and compares
/// depths.
pub(crate) fn compare(
    scan: &Scan,
    folder: &Path,
    last: Option<SurfaceFields>,
) -> Result<SurfaceComparison, CompareError> {
    let (unworn, mut worn) = first_and_last(folder, last)?;
    let depth = unload(&unworn, &mut worn);
    let (unworn_mesh, worn_mesh) = (triangulated(&unworn), triangulated(&worn));
    let (unworn_sheet, worn_sheet) = (Sheet::new(&unworn_mesh), Sheet::new(&worn_mesh));
    let registration = register(scan, &worn_sheet, &depth, edge_mm(&unworn))
        .map_err(|error| with_sizes(error, &scan.points, &unworn.nodes))?;
    let registered: Vec<Vec3> = scan.points.iter().map(|p| registration.moved(p)).collect();
    let normals = scan.normals.as_ref();
    let normals: Option<Vec<Vec3>> = normals.map(|all| {
        all.iter()
            .map(|normal| registration.turned(normal))
            .collect()
    });
    let compared = compared(
        &unworn,
        &unworn_sheet,
        &worn.nodes,
        (&registered, normals.as_deref()),
        scan.keys.farthest_mm,
    );
    let mut compared = summarised(&unworn, &compared, registration, scan)?;
    compared.notes.insert(0, contents(&worn));
    if scan.keys.fit == FitWord::All {
        let remark = "the whole scan was fitted, worn places too: a wear that is deeper or less deep everywhere shifts the scan instead";
        compared.notes.push(remark.to_owned());
    }
    Ok(compared)
}

/// Moves a worn surface to where a scan of the unloaded insert shows it, with the parts of creep and yield that remain; returns
/// the depth of every node, mm.
fn unload(unworn: &SurfaceFields, worn: &mut SurfaceFields) -> Vec<f64> {
    let field = |name| worn.field(name).map(<[f64]>::to_vec);
    let [wear, creep, left, set] = [DEPTH, CREEP, CREEP_LEFT, PERMANENT_SET].map(field);
    let at = |field: &Option<Vec<f64>>, node: usize| field.as_ref().map_or(0.0, |all| all[node]);
    let unload = |(node, place): (usize, &mut Vec3)| {
        let wear_mm = at(&wear, node);
        let moved_mm = wear_mm + at(&creep, node);
        let depth_mm = wear_mm + at(&left, node) + at(&set, node);
        // The mesh holds the creep under load, and no permanent set.
        if moved_mm > 0.0 {
            let unworn = unworn.nodes[node];
            *place = unworn + (*place - unworn) * (depth_mm / moved_mm);
        }
        depth_mm
    };
    worn.nodes.iter_mut().enumerate().map(unload).collect()
}

/// Returns a remark on the parts of the predicted depth.
fn contents(worn: &SurfaceFields) -> String {
    let has = |name| worn.field(name).is_some();
    let set = if has(PERMANENT_SET) {
        ", the permanent set"
    } else {
        ""
    };
    if has(CREEP_LEFT) {
        return format!(
            "predicted depths are those of an unloaded insert: wear{set} and the creep that is left"
        );
    }
    format!(
        "predicted depths are wear{set} alone: a scan of an unloaded insert also shows about half of the creep, so scanned depths are \
         expected to be larger where pressure was high"
    )
}

/// Returns the unworn surface and that of the last update, of one numbering.
fn first_and_last(
    folder: &Path,
    last: Option<SurfaceFields>,
) -> Result<(SurfaceFields, SurfaceFields), CompareError> {
    let (Some(unworn), Some(worn)) = (unworn_surface(folder)?, last) else {
        let first = folder.join(insert_file_name(0));
        return Err(CompareError::missing_file(&first, "surface"));
    };
    if unworn.nodes.len() == worn.nodes.len() {
        Ok((unworn, worn))
    } else {
        let [first, last] = [&unworn, &worn].map(|surface| surface.nodes.len());
        Err(CompareError::NotComparable(format!(
            "the first and the last mesh of the results have {first} and {last} nodes on the surface; run the case again"
        )))
    }
}

/// A place deeper than this share of the largest predicted depth is part of a scar.
const SCAR_SHARE: f64 = 0.05;
/// A registration with a larger standard error is noted, mm.
const MAX_STANDARD_ERROR_MM: f64 = 0.02;
/// A scan that covers a smaller share of the surface is noted.
const MIN_COVERED: f64 = 0.9;
/// A scan that lies farther off unworn places than this share of the deepest predicted wear is noted. Our choice: scars are on average
/// about a third as deep as at their deepest, so that a misfit of this size changes their volume by a third.
const MAX_MISFIT: f64 = 0.1;
/// A scan that is deeper than the prediction by this factor may contain points of walls.
const MUCH_DEEPER: f64 = 2.0;
/// Sizes of a scan, relative to the insert, that are likely with the right unit; inches and centimetres differ by 2.54.
const LIKELY_SIZES: std::ops::Range<f64> = 0.4..2.0;

/// Scanned and predicted depths, both measured from the unworn surface along its normal. Differences are scanned minus
/// predicted.
#[derive(Clone, Debug, Serialize)]
pub struct SurfaceComparison {
    /// The motion that aligned the scan with the prediction.
    pub registration: Registration,
    /// Points of the scan.
    pub scan_points: usize,
    /// Points left out of the depths, since they lie off those around them.
    pub outliers: usize,
    /// Part of the articulating surface that the scan covers, by area, 0 to 1.
    pub covered_area_share: f64,
    /// Nodes compared.
    pub nodes: usize,
    /// Over all nodes compared, weighted by area.
    pub everywhere: SurfaceErrors,
    /// Over the nodes where either depth is above 5 % of the deepest predicted; none without such nodes.
    pub in_scars: Option<SurfaceErrors>,
    /// The node where the two differ most.
    pub worst: NodeDepths,
    /// The node of the deepest predicted wear.
    pub deepest_predicted: NodeDepths,
    /// The node of the deepest scanned wear.
    pub deepest_scanned: NodeDepths,
    /// Predicted volume over the area compared.
    pub predicted_volume_mm3: f64,
    /// Scanned volume over the same area.
    pub scanned_volume_mm3: f64,
    /// Standard error of the position of the scan, that of its least determined motion, times this area; none for a scan that was
    /// not fitted.
    pub scanned_volume_standard_error_mm3: Option<f64>,
    /// Remarks on the interpretation.
    pub notes: Vec<String>,
    /// The unworn surface with the three fields `predicted_mm`, `scanned_mm`, `difference_mm`, NaN
    /// where the scan does not reach.
    #[serde(skip)]
    pub fields: SurfaceFields,
}

/// Differences of two surfaces, weighted by area; scanned minus predicted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SurfaceErrors {
    /// Mean difference.
    pub mean_mm: f64,
    /// Mean of the absolute differences.
    pub mean_absolute_mm: f64,
    /// Root of the mean square.
    pub rms_mm: f64,
    /// The area of the places compared.
    pub area_mm2: f64,
}

/// A node and its depths.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NodeDepths {
    /// Position on the unworn surface, x.
    pub x_mm: f64,
    /// Position on the unworn surface, y.
    pub y_mm: f64,
    /// Position on the unworn surface, z.
    pub z_mm: f64,
    /// Predicted depth.
    pub predicted_mm: f64,
    /// Scanned depth.
    pub scanned_mm: f64,
    /// Scanned minus predicted.
    pub difference_mm: f64,
}

pub(crate) fn summarised(
    unworn: &SurfaceFields,
    compared: &Compared,
    registration: Registration,
    scan: &Scan,
) -> Result<SurfaceComparison, CompareError> {
    let both = |node: &usize| {
        compared.scanned_mm[*node].is_finite() && compared.predicted_mm[*node].is_finite()
    };
    let nodes: Vec<usize> = (0..compared.scanned_mm.len()).filter(both).collect();
    let place = |node: &usize| place(unworn, compared, *node);
    let all: Vec<NodeDepths> = nodes.iter().map(place).collect();
    let largest = |of: fn(&NodeDepths) -> f64| {
        let found = all.iter().max_by(|a, b| of(a).total_cmp(&of(b)));
        found.copied().ok_or_else(|| {
            let farthest_mm = scan.keys.farthest_mm;
            CompareError::NotComparable(format!(
                "the registered scan covers no node of the insert within {farthest_mm} mm; raise farthest_mm in [surface], \
                 or scan more of the insert"
            ))
        })
    };
    let deepest_predicted = largest(|place| place.predicted_mm)?;
    let scar = SCAR_SHARE * deepest_predicted.predicted_mm;
    let worn = |&&node: &&usize| {
        scar > 0.0 && compared.predicted_mm[node].max(compared.scanned_mm[node]) > scar
    };
    let scars: Vec<usize> = nodes.iter().filter(worn).copied().collect();
    let area: f64 = compared.areas_mm2.iter().sum();
    let volume = |depth: &[f64]| {
        nodes
            .iter()
            .map(|&i| depth[i] * compared.areas_mm2[i])
            .sum()
    };
    let everywhere = errors(compared, &nodes);
    let covered_area_share = everywhere.area_mm2 / area;
    let mut found = SurfaceComparison {
        scanned_volume_standard_error_mm3: (registration.steps > 0)
            .then_some(registration.weakest_standard_error_mm * everywhere.area_mm2),
        notes: Vec::new(),
        registration,
        scan_points: scan.points.len(),
        outliers: compared.outliers,
        covered_area_share,
        nodes: nodes.len(),
        everywhere,
        in_scars: (!scars.is_empty()).then(|| errors(compared, &scars)),
        worst: largest(|place| place.difference_mm.abs())?,
        deepest_predicted,
        deepest_scanned: largest(|place| place.scanned_mm)?,
        predicted_volume_mm3: volume(&compared.predicted_mm),
        scanned_volume_mm3: volume(&compared.scanned_mm),
        fields: fields(unworn, compared),
    };
    found.notes = notes(&found, compared, scan, &nodes);
    Ok(found)
}

/// Returns remarks on the numbers of a comparison.
fn notes(
    found: &SurfaceComparison,
    compared: &Compared,
    scan: &Scan,
    nodes: &[usize],
) -> Vec<String> {
    let mut notes = Vec::new();
    let standard_error_mm = found.registration.weakest_standard_error_mm;
    if standard_error_mm > MAX_STANDARD_ERROR_MM {
        notes.push(format!(
            "the fitted surface leaves one motion of the scan uncertain by {standard_error_mm:.3} mm (standard error)"
        ));
    }
    if found.covered_area_share < MIN_COVERED {
        let percent = 100.0 * found.covered_area_share;
        notes.push(format!(
            "the scan covers {percent:.0} % of the articulating surface"
        ));
    }
    let deepest_mm = found.deepest_predicted.predicted_mm;
    let is_unworn = |node: &&usize| compared.predicted_mm[**node] <= scan.keys.unworn_depth_mm;
    let unworn: Vec<usize> = nodes.iter().filter(is_unworn).copied().collect();
    let off_mm = errors(compared, &unworn).rms_mm;
    if off_mm > MAX_MISFIT * deepest_mm {
        notes.push(format!(
            "doubtful: where no wear is predicted, the scan lies {off_mm:.3} mm (rms) off the unworn insert, and the deepest predicted \
             wear is {deepest_mm:.3} mm; check that the scan is of this insert, of this side and scale, and that it wore only where \
             predicted"
        ));
    }
    if found.scanned_volume_mm3 < -found.scanned_volume_standard_error_mm3.unwrap_or(0.0) {
        notes.push(
            "the scanned volume is negative: on average, the scan lies above the unworn insert; check that it is of this insert and scale"
                .to_owned(),
        );
    }
    let scanned_mm = found.deepest_scanned.scanned_mm;
    if scan.normals.is_none() && scanned_mm > MUCH_DEEPER * deepest_mm {
        notes.push(format!(
            "the deepest scanned place, {scanned_mm:.3} mm, is more than {MUCH_DEEPER} times as deep as the deepest predicted: points without normals on \
             walls, recesses and the backside count as wear if they are within farthest_mm; lower it, or give a surface file"
        ));
    }
    // The largest ignores depths that are not numbers.
    let anywhere_mm = compared.predicted_mm.iter().copied().fold(0.0, f64::max);
    if anywhere_mm > deepest_mm {
        notes.push(format!(
            "the deepest predicted wear, {anywhere_mm:.3} mm, lies on the rim or outside the scan, where nothing is compared"
        ));
    }
    notes
}

/// Adds to an error of the registration that the scan has another size than the insert, as one in another unit has.
fn with_sizes(error: CompareError, scan: &[Vec3], insert: &[Vec3]) -> CompareError {
    let size_mm = |points: &[Vec3]| {
        let (low, high) = bounds(points);
        (high - low).norm()
    };
    let [scan_mm, insert_mm] = [scan, insert].map(size_mm);
    match error {
        CompareError::NotComparable(text) if !LIKELY_SIZES.contains(&(scan_mm / insert_mm)) => {
            CompareError::NotComparable(format!(
                "the scan is {scan_mm:.3} mm large, and the insert {insert_mm:.0} mm: check length_unit in [surface], or the unit of the \
                 columns of a CSV file; {text}"
            ))
        }
        other => other,
    }
}

fn place(unworn: &SurfaceFields, compared: &Compared, node: usize) -> NodeDepths {
    let position = unworn.nodes[node];
    let (predicted_mm, scanned_mm) = (compared.predicted_mm[node], compared.scanned_mm[node]);
    NodeDepths {
        x_mm: position.x,
        y_mm: position.y,
        z_mm: position.z,
        predicted_mm,
        scanned_mm,
        difference_mm: scanned_mm - predicted_mm,
    }
}

fn errors(compared: &Compared, nodes: &[usize]) -> SurfaceErrors {
    let area_mm2: f64 = nodes.iter().map(|&node| compared.areas_mm2[node]).sum();
    let mean = |of: fn(f64) -> f64| {
        let part = |&node: &usize| {
            let difference = compared.scanned_mm[node] - compared.predicted_mm[node];
            compared.areas_mm2[node] * of(difference)
        };
        nodes.iter().map(part).sum::<f64>() / area_mm2
    };
    SurfaceErrors {
        mean_mm: mean(|difference| difference),
        mean_absolute_mm: mean(f64::abs),
        rms_mm: mean(|difference| difference * difference).sqrt(),
        area_mm2,
    }
}

fn fields(unworn: &SurfaceFields, compared: &Compared) -> SurfaceFields {
    let pairs = || compared.scanned_mm.iter().zip(&compared.predicted_mm);
    // Zero times NaN is NaN: no prediction is shown where there is no scan.
    let predicted = pairs().map(|(scanned, predicted)| predicted + 0.0 * scanned);
    let difference = pairs().map(|(scanned, predicted)| scanned - predicted);
    SurfaceFields {
        nodes: unworn.nodes.clone(),
        quads: unworn.quads.clone(),
        fields: vec![
            ("predicted_mm".to_owned(), predicted.collect()),
            ("scanned_mm".to_owned(), compared.scanned_mm.clone()),
            ("difference_mm".to_owned(), difference.collect()),
        ],
        is_cup: unworn.is_cup,
    }
}

/// Radius of the points that determine the scanned depth at a node, in spacings of the points.
const SPACINGS: f64 = 1.5;
/// Points from which the spacing is found; more cost time and gain nothing.
const MAX_FOR_SPACING: usize = 2000;
/// Smallest determinant of a plane's normal equations, relative to their weight, that determines its slope.
const MIN_DETERMINANT: f64 = 1e-3;
/// Largest variance of a plane's depth at the node over that of the mean of its points: a larger one extrapolates.
const MAX_LEVERAGE: f64 = 5.0;
/// Factors of the radius, tried in this order until the points determine a plane: points of scan lines are near each other in one
/// direction only.
const WIDER: [f64; 6] = [1.0, 1.25, 1.6, 2.0, 2.6, 3.4];
/// Smallest scale of the residuals of a plane, in radii: points within 9 % of the radius count even where the others fit the plane
/// exactly, as at the rim of a scar.
const MIN_PLANE_SCALE: f64 = 0.02;
/// Largest scale of these residuals, mm: points that are farther apart are those of a wall.
const MAX_PLANE_SCALE_MM: f64 = 0.3;
/// Number of times that the outliers are determined, each time from the plane through the others.
const ROUNDS: usize = 6;

/// Depths at the nodes of the unworn surface; NaN where the scan does not reach.
pub(crate) struct Compared {
    pub predicted_mm: Vec<f64>,
    pub scanned_mm: Vec<f64>,
    pub areas_mm2: Vec<f64>,
    /// Points that lie off the others around them.
    pub outliers: usize,
}

/// A place of the unworn surface with the number and the depth of a scanned point.
type Sounding = GeomWithData<[f64; 3], (usize, f64)>;

/// Both depths at every node: that of the worn node below the unworn surface, and that of the scanned points around it,
/// so that both are measured alike.
pub(crate) fn compared(
    unworn: &SurfaceFields,
    sheet: &Sheet<'_>,
    worn_nodes: &[Vec3],
    scan: (&[Vec3], Option<&[Vec3]>),
    farthest_mm: f64,
) -> Compared {
    let soundings = soundings(sheet, scan, farthest_mm);
    // A coarse scan needs a wide radius; a fine one is averaged over an edge of the mesh, which reduces its noise.
    let radius = edge_mm(unworn).max(SPACINGS * spacing_mm(&soundings));
    let tree = RTree::bulk_load(soundings);
    let depth_of = |point: &Vec3| sheet.foot(point).map_or(f64::NAN, |foot| -foot.height_mm);
    let mut outliers = HashSet::new();
    let scanned = |node: usize| {
        // At the border half of the points around a node are missing, which would tilt its plane.
        if sheet.is_border(node) {
            return f64::NAN;
        }
        let Some(plane) = Plane::near(&tree, &unworn.nodes[node], radius) else {
            return f64::NAN;
        };
        outliers.extend(plane.outliers);
        plane.depth_mm
    };
    Compared {
        predicted_mm: worn_nodes.iter().map(depth_of).collect(),
        scanned_mm: (0..unworn.nodes.len()).map(scanned).collect(),
        areas_mm2: areas(unworn),
        outliers: outliers.len(),
    }
}

/// Returns the depth of every point of the scan that lies over the surface.
fn soundings(
    sheet: &Sheet<'_>,
    (points, normals): (&[Vec3], Option<&[Vec3]>),
    farthest_mm: f64,
) -> Vec<Sounding> {
    let sounding = |(index, point): (usize, &Vec3)| {
        let foot = sheet.foot(point)?;
        let faces = normals.is_none_or(|all| all[index].dot(&foot.normal) > MIN_COSINE);
        let counts = faces && !foot.on_border && foot.height_mm.abs() <= farthest_mm;
        counts.then(|| Sounding::new(foot.point.into(), (index, -foot.height_mm)))
    };
    points.iter().enumerate().filter_map(sounding).collect()
}

/// Returns the mean length of the edges of the quads.
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
        let place = *sounding.geom();
        // The nearest one is the sounding itself.
        let next = tree.nearest_neighbor_iter(place).nth(1)?;
        Some((Vec3::from(*next.geom()) - Vec3::from(place)).norm())
    };
    let mut distances: Vec<f64> = soundings.iter().step_by(every).filter_map(next).collect();
    distances.sort_by(f64::total_cmp);
    distances.get(distances.len() / 2).copied().unwrap_or(0.0)
}

/// A plane of weighted least squares through the soundings around a node, without those that lie off it.
struct Plane {
    /// NaN on a wall, which has no depth.
    depth_mm: f64,
    /// Numbers of the points left out.
    outliers: Vec<usize>,
}

/// A sounding in the neighbourhood of a node.
struct Near {
    number: usize,
    /// 1, and the distance from the node along x and z, in radii.
    row: Vec3,
    weight: f64,
    depth_mm: f64,
}

impl Near {
    fn new(sounding: &Sounding, node: &Vec3, radius: f64) -> Self {
        let away = (Vec3::from(*sounding.geom()) - node) / radius;
        // Wendland's function: 1 at the node, smoothly 0 at the radius.
        let part = away.norm();
        let (number, depth_mm) = sounding.data;
        Self {
            number,
            // Steep surfaces are rare on an insert, so x and z approximate directions along it.
            row: Vec3::new(1.0, away.x, away.z),
            weight: (1.0 - part).max(0.0).powi(4) * (4.0 * part + 1.0),
            depth_mm,
        }
    }
}

impl Plane {
    /// Fits the plane within the smallest radius that determines it, from `radius` on.
    fn near(tree: &RTree<Sounding>, node: &Vec3, radius: f64) -> Option<Self> {
        let around = |factor: &f64| Self::around(tree, node, factor * radius);
        WIDER.iter().find_map(around)
    }

    /// Fits the plane; none where the soundings do not determine it at the node.
    fn around(tree: &RTree<Sounding>, node: &Vec3, radius: f64) -> Option<Self> {
        let near = tree.locate_within_distance([node.x, node.y, node.z], radius * radius);
        let near: Vec<Near> = near.map(|one| Near::new(one, node, radius)).collect();
        // The median withstands outliers that would tilt a first plane of least squares.
        let level = median(near.iter().map(|one| (one.depth_mm, one.weight)));
        let mut plane = Vec3::new(level, 0.0, 0.0);
        let (mut kept, mut scale) = (Vec::new(), 0.0);
        for _ in 0..ROUNDS {
            let off = |one: &Near| (one.depth_mm - plane.dot(&one.row)).abs();
            scale = SCALE_OF_MEDIAN * median(near.iter().map(|one| (off(one), one.weight)));
            let limit = TUKEY * scale.max(MIN_PLANE_SCALE * radius);
            kept = near.iter().map(|one| off(one) < limit).collect();
            let counting = near.iter().zip(&kept).filter(|(_, is_kept)| **is_kept);
            plane = fitted(counting.map(|(one, _)| one))?;
        }
        // Points of a wall are steep, or scatter about the last plane.
        let is_steep = radius < MIN_COSINE * Vec3::new(radius, plane.y, plane.z).norm();
        let is_wall = is_steep || scale > MAX_PLANE_SCALE_MM;
        let left_out = near.iter().zip(&kept).filter(|(_, is_kept)| !**is_kept);
        Some(Self {
            depth_mm: if is_wall { f64::NAN } else { plane.x },
            outliers: left_out.map(|(one, _)| one.number).collect(),
        })
    }
}

/// Returns the plane of weighted least squares; none if the soundings do not determine it at the node.
fn fitted<'a>(near: impl Iterator<Item = &'a Near>) -> Option<Vec3> {
    let (mut matrix, mut right_side) = (Mat3::zeros(), Vec3::zeros());
    for one in near {
        matrix += one.row * one.row.transpose() * one.weight;
        right_side += one.row * (one.weight * one.depth_mm);
    }
    let weight = matrix[(0, 0)];
    let is_fixed = matrix.determinant() > MIN_DETERMINANT * weight.powi(3);
    let matrix = matrix.cholesky().filter(|_| is_fixed)?;
    let leverage = weight * matrix.solve(&Vec3::x()).x;
    (leverage < MAX_LEVERAGE).then(|| matrix.solve(&right_side))
}

/// Returns a quarter of each face for each of its nodes.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a tree of points (x, z, depth) over the plane y = 0.
    fn over_a_plane(points: impl Iterator<Item = [f64; 3]>) -> RTree<Sounding> {
        let sounding = |(number, [x, z, depth]): (usize, [f64; 3])| {
            Sounding::new([x, 0.0, z], (number, depth))
        };
        RTree::bulk_load(points.enumerate().map(sounding).collect())
    }

    /// Returns places of a grid of 0.3 mm.
    fn grid() -> impl Iterator<Item = [f64; 2]> {
        (0..81).map(|i| [0.3 * f64::from(i % 9) - 1.2, 0.3 * f64::from(i / 9) - 1.2])
    }

    #[test]
    fn verify_dust_and_spikes_are_left_out_of_the_depth() {
        for spike in [-1.5, -0.5, 0.5, 1.5] {
            let depth = |(number, [x, z]): (usize, [f64; 2])| {
                let off = if number % 20 == 0 { spike } else { 0.0 };
                [x, z, 0.2 + 0.05 * x + off]
            };
            let tree = over_a_plane(grid().enumerate().map(depth));
            let plane = Plane::near(&tree, &Vec3::zeros(), 1.0).unwrap();
            assert!((plane.depth_mm - 0.2).abs() < 1e-9, "{}", plane.depth_mm);
            assert!(!plane.outliers.is_empty() && plane.outliers.iter().all(|n| n % 20 == 0));
        }
    }

    #[test]
    fn a_wall_has_no_depth() {
        let at_all_depths = |(number, [x, z]): (usize, [f64; 2])| [x, z, 0.5 * (number % 4) as f64];
        let tree = over_a_plane(grid().enumerate().map(at_all_depths));
        let depth_mm = |tree, radius| Plane::near(tree, &Vec3::zeros(), radius).unwrap().depth_mm;
        assert!(depth_mm(&tree, 1.0).is_nan());
        let steep = over_a_plane(grid().map(|[x, z]| [x, z, 0.2 + 2.0 * x]));
        assert!(depth_mm(&steep, 0.7).is_nan());
        // The flank of a deep scar is no wall.
        let flank = over_a_plane(grid().map(|[x, z]| [3.0 * x, 3.0 * z, 0.2 + 2.1 * x]));
        assert!((depth_mm(&flank, 2.5) - 0.2).abs() < 1e-9);
    }

    #[test]
    fn verify_scan_lines_farther_apart_than_the_mesh_give_the_depth_of_the_node() {
        let lines = (0..400).map(|i| {
            [
                0.1 * f64::from(i % 100) - 5.0,
                2.0 * f64::from(i / 100) - 3.0,
            ]
        });
        let tree = over_a_plane(lines.map(|[x, z]| [x, z, 0.2 + 0.1 * z]));
        for z in [0.0, 0.4, 0.8, -0.9] {
            let plane = Plane::near(&tree, &Vec3::new(0.05, 0.0, z), 1.0).unwrap();
            assert!((plane.depth_mm - 0.2 - 0.1 * z).abs() < 1e-9, "{z}");
        }
        // Beyond the last line nothing is known.
        assert!(Plane::near(&tree, &Vec3::new(0.0, 0.0, 6.0), 1.0).is_none());
    }

    #[test]
    fn verify_an_unloaded_insert_has_its_wear_the_creep_left_and_the_permanent_set() {
        let up = Vec3::y();
        let unworn = SurfaceFields {
            nodes: vec![Vec3::zeros(), up],
            ..SurfaceFields::default()
        };
        let fields = [
            (DEPTH, 0.2),
            (CREEP, 0.3),
            (CREEP_LEFT, 0.1),
            (PERMANENT_SET, 0.05),
        ];
        let field = |(name, mm): (&str, f64)| (name.to_owned(), vec![mm, 0.0]);
        let mut worn = SurfaceFields {
            nodes: vec![-0.5 * up, up],
            fields: fields.map(field).to_vec(),
            ..SurfaceFields::default()
        };
        let depth_mm = unload(&unworn, &mut worn);
        assert!((depth_mm[0] - 0.35).abs() < 1e-12 && depth_mm[1] == 0.0);
        assert!((worn.nodes[0] + 0.35 * up).norm() < 1e-12 && worn.nodes[1] == up);
        worn.fields.truncate(1);
        assert!(contents(&worn).contains("wear alone"));
    }
}
