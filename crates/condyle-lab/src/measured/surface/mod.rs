//! Predicted against scanned wear.

mod depth;
mod place;
mod register;
mod sheet;

use std::path::Path;

use condyle::Vec3;
use condyle_io::measured::Scan;
use condyle_io::mesh::read_vtu_points;
use condyle_io::results::insert_file_name;
use condyle_report::SurfaceFields;
use serde::Serialize;

use super::CompareError;
use depth::{Compared, compared};
pub use place::{Place, SurfaceErrors};
pub use register::Registration;
use register::register;
use sheet::{Sheet, triangulated};

/// Name of the field of wear in the meshes of a run.
const DEPTH: &str = "wear_depth_mm";

/// What a scan of an unloaded insert shows beside wear.
const CREEP: &str = "a scan of an unloaded insert shows wear and about half of the creep; the \
    prediction is wear alone, so scanned depths are expected to be larger where pressure was high";

/// How far a scanned surface is from the predicted one. Depths are measured from the unworn
/// surface along its normal; differences are scanned minus predicted.
#[derive(Clone, Debug, Serialize)]
pub struct SurfaceComparison {
    /// How the scan was laid onto the prediction.
    pub registration: Registration,
    /// Points of the scan.
    pub scan_points: usize,
    /// Part of the articulating surface that the scan covers, by area, 0 to 1.
    pub covered_area_share: f64,
    /// Nodes compared.
    pub nodes: usize,
    /// Over all nodes compared, weighted by area.
    pub everywhere: SurfaceErrors,
    /// Where either depth is above 5 % of the deepest predicted; none without such a place.
    pub in_scars: Option<SurfaceErrors>,
    /// The node where the two differ most.
    pub worst: Place,
    /// The node of the deepest predicted wear.
    pub deepest_predicted: Place,
    /// The node of the deepest scanned wear.
    pub deepest_scanned: Place,
    /// Predicted volume over the area compared.
    pub predicted_volume_mm3: f64,
    /// Scanned volume over the same area.
    pub scanned_volume_mm3: f64,
    /// What to keep in mind.
    pub notes: Vec<String>,
    /// The unworn surface with the three fields `predicted_mm`, `scanned_mm`, `difference_mm`, NaN
    /// where the scan does not reach.
    #[serde(skip)]
    pub fields: SurfaceFields,
}

/// Registers a scan onto the worn insert of a results folder, and compares depths.
pub(super) fn compare(scan: &Scan, folder: &Path) -> Result<SurfaceComparison, CompareError> {
    let (unworn, worn) = first_and_last(folder)?;
    let (unworn_mesh, worn_mesh) = (triangulated(&unworn), triangulated(&worn));
    let (unworn_sheet, worn_sheet) = (Sheet::new(&unworn_mesh), Sheet::new(&worn_mesh));
    let depth = worn.field(DEPTH).unwrap_or_default();
    let registration = register(scan, &worn_sheet, depth)?;
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
    place::summarised(&unworn, &compared, registration, scan)
}

/// The unworn surface and that of the last update, of one numbering.
fn first_and_last(folder: &Path) -> Result<(SurfaceFields, SurfaceFields), CompareError> {
    let unworn = surface(folder, 0)?;
    let mut last = 0;
    while folder.join(insert_file_name(last + 1)).is_file() {
        last += 1;
    }
    let worn = surface(folder, last)?;
    match unworn.nodes.len() == worn.nodes.len() {
        true => Ok((unworn, worn)),
        false => Err(CompareError::OtherMesh {
            first: unworn.nodes.len(),
            last: worn.nodes.len(),
        }),
    }
}

fn surface(folder: &Path, update: usize) -> Result<SurfaceFields, CompareError> {
    let path = folder.join(insert_file_name(update));
    if !path.is_file() {
        let table = "surface";
        return Err(CompareError::MissingFile { path, table });
    }
    let file = read_vtu_points(&path)?;
    Ok(SurfaceFields::of_mesh(&file.mesh, &file.point_data, &path)?)
}
