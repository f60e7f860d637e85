//! A scan of a worn insert: a surface, or points as CSV.

use condyle::geometry::TriangleMesh;
use condyle::{Mat3, Vec3};

use super::reason::{MeasuredReason, too_few};
use crate::case::{Axes, LengthUnit, Side, check_axes};
use crate::config::{
    Cell, ColumnReason, Columns, DataFile, KeyReason, Log, Placed, Section, Settings, choice,
    names, settings, within,
};
use condyle_mesh::formats::read_surface;

choice! {
    /// Which part of a scan is laid onto the prediction.
    FitWord {
        /// Where the prediction is not worn.
        Unworn = "unworn",
        /// Everywhere.
        All = "all",
        /// Within `fit_x_mm` and `fit_z_mm`.
        Region = "region",
    }
}

settings! {
    /// A scan of a worn insert, and how it is laid onto the prediction.
    ScanKeys {
        /// STL, PLY, OBJ or VTP surface, or points as CSV with the columns x_mm,y_mm,z_mm.
        file: DataFile;
        /// Unit of length of a surface file; a CSV says its own.
        length_unit: LengthUnit = LengthUnit::Millimetre;
        /// Where x, y and z of the file point.
        axes: Axes = Axes::ISB;
        /// Added to every point, in the frame of the results, before the registration starts.
        start_mm: [f64; 3] = [0.0; 3], in within(-1000.0, 1000.0);
        /// Which part is laid onto the prediction.
        fit: FitWord = FitWord::Unworn;
        /// Predicted depth up to which a place counts as unworn.
        unworn_depth_mm: f64 = 0.005, in within(0.0, 10.0);
        /// Range of x, in the frame of the results, with `fit = "region"`.
        fit_x_mm: Option<[f64; 2]> = None, in within(-1000.0, 1000.0);
        /// Range of z, in the frame of the results, with `fit = "region"`.
        fit_z_mm: Option<[f64; 2]> = None, in within(-1000.0, 1000.0);
        /// Points of the scan farther than this from the registered surface are left out.
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

/// Reads `[surface]` and its file for a `side` knee.
pub(super) fn read(root: &Section<'_>, side: Side, log: &mut Log<'_>) -> Option<Scan> {
    let section = root.table("surface", log);
    let known: Vec<&str> = names(&ScanKeys::keys()).collect();
    section.check_keys(&known, log);
    let keys = ScanKeys::read(&section, log)?;
    check_axes(&keys.axes, side, section.value_span("axes"), log);
    check_region(&keys, &section, log);
    // Reported by the check already.
    let rotation = keys.axes.rotation(side).ok()?;
    let is_csv = keys
        .file
        .path()
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("csv"));
    let scan = if is_csv {
        points(&keys, &section, log)?
    } else {
        surface(&keys, &section, log)?
    };
    let scan = placed(scan, &rotation, Vec3::from(keys.start_mm));
    Some(Scan {
        keys,
        points: scan.0,
        normals: scan.1,
    })
}

/// Points and their normals.
type Raw = (Vec<Vec3>, Option<Vec<Vec3>>);

fn placed((points, normals): Raw, rotation: &Mat3, start: Vec3) -> Raw {
    let points = points.iter().map(|point| rotation * point + start);
    let normals = normals.map(|all| all.iter().map(|normal| rotation * normal).collect());
    (points.collect(), normals)
}

fn surface(keys: &ScanKeys, section: &Section<'_>, log: &mut Log<'_>) -> Option<Raw> {
    match read_surface(keys.file.files(), keys.file.path()) {
        Ok(mesh) => Some(vertices(&mesh, keys.length_unit.in_mm())),
        Err(error) => {
            let reason = MeasuredReason::Scan(error.to_string());
            log.problem(section.value_span("file"), reason);
            None
        }
    }
}

fn vertices(mesh: &TriangleMesh, in_mm: f64) -> Raw {
    let normals = mesh.vertex_normals();
    (
        mesh.vertices.iter().map(|vertex| vertex * in_mm).collect(),
        Some(normals),
    )
}

fn points(keys: &ScanKeys, section: &Section<'_>, log: &mut Log<'_>) -> Option<Raw> {
    let source = keys.file.source(section, "file", log)?;
    let points = log.noted(&source, rows(source.inner(), &keys.file.name()))?;
    Some((points, None))
}

fn rows(text: &str, file: &str) -> Result<Vec<Vec3>, Vec<Placed>> {
    let columns =
        Columns::split(text, file, &COORDINATES.join(",")).map_err(|placed| vec![placed])?;
    let names = columns.names();
    let mut found = Vec::new();
    for name in COORDINATES {
        let Some(index) = names.iter().position(|column| *column == name) else {
            let reason = ColumnReason::NoColumn {
                column: name.to_owned(),
                file: file.to_owned(),
                columns: names.iter().map(|&name| name.to_owned()).collect(),
            };
            return Err(vec![Placed::new(columns.name_span(0), reason)]);
        };
        found.push(columns.numbers(index)?);
    }
    let value = |column: &Vec<Cell>, row: usize| column[row].value;
    let point = |row| {
        Vec3::new(
            value(&found[0], row),
            value(&found[1], row),
            value(&found[2], row),
        )
    };
    match found[0].len() {
        few if few < MIN_POINTS => Err(vec![too_few(
            COORDINATES[0],
            few,
            MIN_POINTS,
            columns.name_span(0),
        )]),
        all => Ok((0..all).map(point).collect()),
    }
}

fn check_region(keys: &ScanKeys, section: &Section<'_>, log: &mut Log<'_>) {
    let ranges = [("fit_x_mm", keys.fit_x_mm), ("fit_z_mm", keys.fit_z_mm)];
    for (key, range) in ranges {
        let Some([low, high]) = range else { continue };
        if low >= high {
            let reason = MeasuredReason::EmptyRange { key, low, high };
            log.problem(section.value_span(key), reason);
        }
        if keys.fit != FitWord::Region {
            let (key, needs) = (key.to_owned(), "`fit = \"region\"`".to_owned());
            log.problem(
                section.key_span(&key),
                KeyReason::Idle {
                    key: key.clone(),
                    needs,
                },
            );
        }
    }
    let none = ranges.iter().all(|(_, range)| range.is_none());
    if keys.fit == FitWord::Region && none {
        log.problem(section.value_span("fit"), MeasuredReason::NoRegion);
    }
}
