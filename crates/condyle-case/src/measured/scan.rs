//! A scan of a worn insert: a surface, or points as CSV.

use condyle::{Vec3, geometry::TriangleMesh};

use super::columns::too_few;
use crate::case::{Axes, LengthUnit, Side, check_axes};
use crate::config::*;
use condyle_mesh::formats::read_surface;

choice! {
    /// Part of a scan that is registered to the prediction.
    FitWord {
        /// The places that are unworn in the prediction.
        Unworn = "unworn",
        /// All of it.
        All = "all",
        /// Within `fit_x_mm` and `fit_z_mm`.
        Region = "region",
        /// Nothing: after `axes` and `start_mm`, the scan lies in the frame of the results.
        Nothing = "nothing",
    }
}

settings! {
    /// A scan of a worn insert and its registration to the prediction.
    ScanKeys {
        /// STL, PLY, OBJ or VTP surface, or points as CSV with the columns x_mm,y_mm,z_mm.
        file: DataFile;
        /// Unit of length of a surface file; a CSV has it in its header.
        length_unit: LengthUnit = LengthUnit::Millimetre;
        /// Anatomical directions of x, y and z of the file.
        axes: Axes = Axes::ISB;
        /// Added to every point, in the frame of the results, before the registration starts.
        start_mm: [f64; 3] = [0.0; 3], in within(-1000.0, 1000.0);
        /// Part that is registered to the prediction.
        fit: FitWord = FitWord::Unworn;
        /// Predicted depth up to which a place counts as unworn.
        unworn_depth_mm: f64 = 0.005, in within(0.0, 10.0);
        /// Range of x, in the frame of the results, with `fit = "region"`.
        fit_x_mm: Option<[f64; 2]> = None, in within(-1000.0, 1000.0);
        /// Range of z, in the frame of the results, with `fit = "region"`.
        fit_z_mm: Option<[f64; 2]> = None, in within(-1000.0, 1000.0);
        /// Points of the scan farther than this from the registered surface are omitted.
        farthest_mm: f64 = 2.0, in within(0.01, 50.0);
    }
}

const COORDINATES: [&str; 3] = ["x_mm", "y_mm", "z_mm"];
/// Six numbers of a rigid motion need at least as many points.
const MIN_POINTS: usize = 12;

/// A scan in the frame of the results, mm, before it is registered.
#[derive(Clone, Debug)]
pub struct Scan {
    /// The keys of the table.
    pub keys: ScanKeys,
    /// The points, turned by the axes and moved by `start_mm`.
    pub points: Vec<Vec3>,
    /// Outward unit normal at each point, where the file is a surface.
    pub normals: Option<Vec<Vec3>>,
}

impl Scan {
    pub(super) fn read(root: &Section<'_>, side: Side, log: &mut Log<'_>) -> Option<Self> {
        let section = root.table("surface", log);
        let keys = ScanKeys::read_checked(&section, log)?;
        check_axes(&keys.axes, side, section.value_span("axes"), log);
        check_region(&keys, &section, log);
        // Left-handed axes are reported by the check above.
        let rotation = keys.axes.rotation(side).ok()?;
        let ending = keys.file.path().extension();
        let is_csv = ending.is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
        let (points, normals) = if is_csv {
            let source = keys.file.source(&section, "file", log)?;
            let points = log.noted(&source, rows(source.inner(), &keys.file.name()))?;
            (points, None)
        } else {
            surface(&keys, &section, log)?
        };
        let start_mm = Vec3::from(keys.start_mm);
        // Normals turn with the points and do not shift.
        let turned = |all: Vec<Vec3>| all.iter().map(|normal| rotation * normal).collect();
        Some(Self {
            keys,
            points: points
                .iter()
                .map(|point| rotation * point + start_mm)
                .collect(),
            normals: normals.map(turned),
        })
    }
}

/// Reads the vertices of a surface, mm, and their normals.
fn surface(
    keys: &ScanKeys,
    section: &Section<'_>,
    log: &mut Log<'_>,
) -> Option<(Vec<Vec3>, Option<Vec<Vec3>>)> {
    let in_mm = keys.length_unit.in_mm();
    let mesh = read_surface(keys.file.files(), keys.file.path());
    let mesh = mesh.map_err(|error| {
        let advice = "export the scan again as STL, PLY, or CSV with the columns x_mm,y_mm,z_mm";
        log.problem(
            section.value_span("file"),
            Fault::new(error.to_string(), advice),
        );
    });
    let mesh = mesh.ok()?;
    let vertices = mesh.vertices.iter().map(|vertex| vertex * in_mm);
    let outward = if is_inside_out(&mesh) { -1.0 } else { 1.0 };
    let normals = mesh.vertex_normals().into_iter();
    let normals = normals.map(|normal| outward * normal).collect();
    Some((vertices.collect(), Some(normals)))
}

/// Returns whether the triangles of a closed body face inwards.
fn is_inside_out(mesh: &TriangleMesh) -> bool {
    /// Largest sum of the directed areas, relative to that of the areas, of a body that is closed but for holes.
    const NEARLY_CLOSED: f64 = 0.1;
    let directed = |triangle: usize| {
        let [a, b, c] = mesh.corners(triangle);
        (b - a).cross(&(c - a))
    };
    let all = || (0..mesh.triangles.len()).map(directed);
    let area: f64 = all().map(|one| one.norm()).sum();
    all().sum::<Vec3>().norm() < NEARLY_CLOSED * area && mesh.signed_volume() < 0.0
}

fn rows(text: &str, file: &str) -> Result<Vec<Vec3>, Vec<Placed>> {
    let columns = Columns::split(text, file, &COORDINATES.join(","))?;
    let names = columns.names();
    let mut found: Vec<Vec<Cell>> = Vec::new();
    for name in COORDINATES {
        let Some(index) = names.iter().position(|column| *column == name) else {
            let fault = no_column(name, file, &names);
            return Err(vec![(columns.name_span(0), fault)]);
        };
        found.push(columns.numbers(index)?);
    }
    let count = found[0].len();
    if count < MIN_POINTS {
        let span = columns.name_span(0);
        let fault = too_few(COORDINATES[0], count, MIN_POINTS);
        return Err(vec![(span, fault)]);
    }
    let point = |row: usize| Vec3::from_fn(|axis, _| found[axis][row].value);
    Ok((0..count).map(point).collect())
}

fn check_region(keys: &ScanKeys, section: &Section<'_>, log: &mut Log<'_>) {
    let ranges = [("fit_x_mm", keys.fit_x_mm), ("fit_z_mm", keys.fit_z_mm)];
    for (key, range) in ranges {
        let Some([low, high]) = range else { continue };
        if low >= high {
            let message = format!("`{key}` is [{low}, {high}]: the second must be the larger");
            let fault = Fault::new(message, "write the smaller one first");
            log.problem(section.value_span(key), fault);
        }
        if keys.fit != FitWord::Region {
            log.problem(section.key_span(key), idle(key, "`fit = \"region\"`"));
        }
    }
    let none = ranges.iter().all(|(_, range)| range.is_none());
    if keys.fit == FitWord::Region && none {
        let fault = Fault::new(
            "`fit = \"region\"` needs `fit_x_mm`, `fit_z_mm` or both",
            "add one, such as `fit_x_mm = [-20, 20]`",
        );
        log.problem(section.value_span("fit"), fault);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_whose_triangles_face_inwards_is_inside_out_and_a_sheet_is_not() {
        let (o, x, y, z) = (Vec3::zeros(), Vec3::x(), Vec3::y(), Vec3::z());
        let mut body = TriangleMesh {
            vertices: vec![o, x, y, z],
            triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]],
        };
        assert!(is_inside_out(&body));
        body.triangles
            .iter_mut()
            .for_each(|corners| corners.swap(0, 1));
        assert!(!is_inside_out(&body));
        // A sheet away from the origin, towards which it faces.
        body.triangles = vec![[1, 3, 2]];
        assert!(!is_inside_out(&body));
    }
}
