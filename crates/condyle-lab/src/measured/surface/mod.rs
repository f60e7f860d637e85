//! Predicted against scanned wear.

mod comparison;
mod depth;
mod register;
mod sheet;

use std::path::Path;

use condyle::Vec3;
use condyle_io::measured::Scan;
use condyle_io::mesh::read_vtu_points;
use condyle_io::results::{check_file, insert_file_name};
use condyle_report::SurfaceFields;

use super::CompareError;
pub use comparison::{NodeDepths, SurfaceComparison, SurfaceErrors};
use depth::compared;
pub use register::Registration;
use register::register;
use sheet::{Sheet, triangulated};

/// Name of the field of wear in the meshes of a run.
const DEPTH: &str = "wear_depth_mm";

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
    comparison::summarised(&unworn, &compared, registration, scan)
}

/// The unworn surface and that of the last update, of one numbering.
fn first_and_last(folder: &Path) -> Result<(SurfaceFields, SurfaceFields), CompareError> {
    let unworn = surface(folder, 0)?;
    let mut last = 0;
    while folder.join(insert_file_name(last + 1)).is_file() {
        last += 1;
    }
    let worn = surface(folder, last)?;
    if unworn.nodes.len() == worn.nodes.len() {
        Ok((unworn, worn))
    } else {
        Err(CompareError::OtherMesh {
            first: unworn.nodes.len(),
            last: worn.nodes.len(),
        })
    }
}

fn surface(folder: &Path, update: usize) -> Result<SurfaceFields, CompareError> {
    let path = folder.join(insert_file_name(update));
    if !path.is_file() {
        let table = "surface";
        return Err(CompareError::MissingFile { path, table });
    }
    check_file(&path)?;
    let file = read_vtu_points(&path)?;
    Ok(SurfaceFields::of_mesh(&file.mesh, &file.point_data, &path)?)
}
