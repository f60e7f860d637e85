//! The pictures of the report as SVG files of their own, on white.

use std::path::{Path, PathBuf};

use condyle_results::{KINEMATICS_PICTURE, MAP_PICTURES, SLIP_PATHS_PICTURE, WEAR_PICTURE};

use crate::error::ReportError;
use crate::figure::{Map, Panel, alone, sheet};
use crate::file::write_text;
use crate::page::{MAPS, kinematics_panels, slip_map, wear_map, wear_panels};
use crate::results::contents::Results;

/// Scale of the map, px per mm.
const PX_PER_MM: f64 = 8.0;

/// A picture of the report as a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// Its name, without an ending.
    pub name: &'static str,
    /// The text of an SVG file.
    pub svg: String,
}

/// All pictures of a report that a folder has the numbers for: maps, slip paths, wear over cycles, motion
/// and load.
pub fn pictures(results: &Results) -> Vec<Picture> {
    let picture = |(name, svg): (&'static str, Option<String>)| Some(Picture { name, svg: svg? });
    let others = [
        (SLIP_PATHS_PICTURE, slip_map(results, PX_PER_MM, map_with)),
        (WEAR_PICTURE, sheet_of_wear(&wear_panels(results))),
        (
            KINEMATICS_PICTURE,
            sheet_of_motion(&kinematics_panels(results)),
        ),
    ];
    // Both are in one order.
    let maps = MAPS.iter().zip(MAP_PICTURES).map(|(map, name)| {
        let surface = results.surface.as_ref();
        let map = surface.and_then(|surface| map.drawn(surface, results.side, PX_PER_MM));
        (name, map.map(|map| map_with(&map, &map.desc(), "")))
    });
    maps.chain(others).filter_map(picture).collect()
}

fn map_with(map: &Map<'_>, desc: &str, over: &str) -> String {
    alone(map.title, desc, map.size(), &(map.body() + over))
}

/// Curves over cycles as a file; `None` without any.
fn sheet_of_wear(panels: &[Panel]) -> Option<String> {
    let desc = "What wears against cycles.";
    let run = ("last", "each dot is an update of the shape");
    let key = [&[run][..], &measured(panels, "weighed")].concat();
    (!panels.is_empty()).then(|| sheet("Wear over the test", desc, panels, 2, &key))
}

/// Motions and loads as a file; `None` without any.
fn sheet_of_motion(panels: &[Panel]) -> Option<String> {
    let desc = "Motions and loads against percent of the gait cycle.";
    let first = ("first", "first cycle");
    let last = ("last", "last cycle, against % of the gait cycle");
    let key = [&[first, last][..], &measured(panels, "measured")].concat();
    let title = "Motion and load in a gait cycle";
    (!panels.is_empty()).then(|| sheet(title, desc, panels, 3, &key))
}

/// The key of what was measured, where a panel has it.
fn measured(panels: &[Panel], word: &'static str) -> Vec<(&'static str, &'static str)> {
    const MEASURED: &str = "specimen";
    let mut curves = panels.iter().flat_map(|panel| &panel.curves);
    let is_there = curves.any(|curve| curve.class == MEASURED);
    Vec::from_iter(is_there.then_some((MEASURED, word)))
}

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
    Ok(sheet_of_wear(&panels).unwrap_or_default())
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
    sheet_of_motion(&kinematics_panels(&results)).ok_or_else(|| ReportError::MissingColumns {
        path: results_dir.join("kinematics.csv"),
        columns: "percent, flexion_deg, axial_force_n, ap_mm, ie_deg",
        picture: PICTURE,
    })
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
