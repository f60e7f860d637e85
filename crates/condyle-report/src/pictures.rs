//! The pictures of the report as SVG files of their own, on white.

use std::path::{Path, PathBuf};

use crate::error::ReportError;
use crate::figure::{alone, sheet};
use crate::file::write_text;
use crate::page::{kinematics_panels, wear_map, wear_panels};
use crate::results::contents::Results;

/// Scale of the map, px per mm.
const PX_PER_MM: f64 = 8.0;

/// The wear map of the last update as the text of an SVG file.
///
/// # Errors
/// The folder cannot be read, or holds no mesh with `wear_depth_mm`.
pub fn wear_map_svg(results_dir: &Path) -> Result<String, ReportError> {
    let results = Results::read(results_dir)?;
    if results.surface.is_none() {
        return Err(missing(results_dir, "insert_0000.vtu", "the wear map"));
    }
    let map = wear_map(&results, PX_PER_MM).ok_or_else(|| ReportError::MissingField {
        path: results_dir.join("insert_*.vtu"),
        field: "wear_depth_mm",
    })?;
    Ok(alone(map.title, &map.desc(), map.size(), &map.body()))
}

/// Mass loss and maximum depth against cycles as the text of an SVG file.
///
/// # Errors
/// The folder cannot be read, or holds no wear.csv with these columns.
pub fn wear_curve_svg(results_dir: &Path) -> Result<String, ReportError> {
    const PICTURE: &str = "the wear curve";
    let results = Results::read(results_dir)?;
    if results.wear.is_none() {
        return Err(missing(results_dir, "wear.csv", PICTURE));
    }
    let mut panels = wear_panels(&results);
    panels.truncate(2);
    if panels.is_empty() {
        let path = results_dir.join("wear.csv");
        let columns = "cycles, mass_loss_mg, max_depth_mm";
        return Err(ReportError::MissingColumns {
            path,
            columns,
            picture: PICTURE,
        });
    }
    let desc = "Mass loss and maximum wear depth against cycles.";
    Ok(sheet(
        "Wear over the test",
        desc,
        &panels,
        2,
        &[("last", "each dot is an update of the shape")],
    ))
}

/// Motions and loads of the first and last cycle as the text of an SVG file.
///
/// # Errors
/// The folder cannot be read, or holds no kinematics.csv with `percent` and a known channel.
pub fn kinematics_svg(results_dir: &Path) -> Result<String, ReportError> {
    const PICTURE: &str = "the picture of the kinematics";
    let results = Results::read(results_dir)?;
    if results.kinematics.is_none() {
        return Err(missing(results_dir, "kinematics.csv", PICTURE));
    }
    let panels = kinematics_panels(&results);
    if panels.is_empty() {
        let path = results_dir.join("kinematics.csv");
        let columns = "percent, flexion_deg, axial_force_n, ap_mm, ie_deg";
        return Err(ReportError::MissingColumns {
            path,
            columns,
            picture: PICTURE,
        });
    }
    let desc = "Motions and loads against percent of the gait cycle.";
    let key = [
        ("first", "first cycle"),
        ("last", "last cycle, against % of the gait cycle"),
    ];
    Ok(sheet(
        "Motion and load in a gait cycle",
        desc,
        &panels,
        3,
        &key,
    ))
}

/// Writes `wear_map.svg` into a results folder and returns its path.
///
/// # Errors
/// As [`wear_map_svg`], or the file cannot be written.
pub fn write_wear_map(results_dir: &Path) -> Result<PathBuf, ReportError> {
    write_text(
        results_dir.join("wear_map.svg"),
        &wear_map_svg(results_dir)?,
    )
}

/// Writes `wear.svg` into a results folder and returns its path.
///
/// # Errors
/// As [`wear_curve_svg`], or the file cannot be written.
pub fn write_wear_curve(results_dir: &Path) -> Result<PathBuf, ReportError> {
    write_text(results_dir.join("wear.svg"), &wear_curve_svg(results_dir)?)
}

/// Writes `kinematics.svg` into a results folder and returns its path.
///
/// # Errors
/// As [`kinematics_svg`], or the file cannot be written.
pub fn write_kinematics(results_dir: &Path) -> Result<PathBuf, ReportError> {
    write_text(
        results_dir.join("kinematics.svg"),
        &kinematics_svg(results_dir)?,
    )
}

fn missing(folder: &Path, name: &str, picture: &'static str) -> ReportError {
    ReportError::MissingFile {
        path: folder.join(name),
        picture,
    }
}
