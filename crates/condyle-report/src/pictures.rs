//! The pictures of the report as SVG files, on white.

use std::path::{Path, PathBuf};

use condyle_results::{KINEMATICS_PICTURE, MAP_PICTURES, WEAR_PICTURE};

use crate::charts;
use crate::error::ReportError;
use crate::figure::{MEASURED, Map, Panel, sheet, svg_file};
use crate::maps::{self, MAPS};
use crate::results::Results;
use crate::sheets::write_text;

const PX_PER_MM: f64 = 8.0;

/// A picture of the report as a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The file name, without an ending.
    pub name: &'static str,
    /// The text of an SVG file.
    pub svg: String,
}

/// Returns all pictures of a report for which a folder has the numbers: maps, slip paths, wear over the test, motion
/// and load.
pub fn pictures(results: &Results) -> Vec<Picture> {
    let file = |map: &Map<'_>, desc: &str, over: &str| {
        svg_file(map.style.title, desc, map.size(), &(map.body() + over))
    };
    let maps = maps::drawn(&MAPS, results, PX_PER_MM, file).into_iter();
    let maps = maps.map(|map| (map.file, map.svg));
    let wear = charts::wear(results);
    let dots = "each dot is an update of the shape";
    let key = Vec::from_iter(
        [("last", dots)]
            .into_iter()
            .chain(measured(&wear, "weighed")),
    );
    let wear = (!wear.is_empty())
        .then(|| sheet("Wear over the test", "Wear against cycles.", &wear, 2, &key));
    let motion = charts::cycle(results);
    let last = "last cycle, against % of the cycle";
    let key = [("first", "first cycle"), ("last", last)].into_iter();
    let key = Vec::from_iter(key.chain(measured(&motion, "measured")));
    let desc = "Motions and loads against percent of the cycle.";
    let title = "Motion and load in a cycle";
    let motion = (!motion.is_empty()).then(|| sheet(title, desc, &motion, 3, &key));
    let wear = wear.map(|svg| (WEAR_PICTURE, svg));
    let motion = motion.map(|svg| (KINEMATICS_PICTURE, svg));
    let all = maps.chain(wear).chain(motion);
    all.map(|(name, svg)| Picture { name, svg }).collect()
}

/// Returns the entry of measured curves in the key, where a panel has some.
fn measured(panels: &[Panel], word: &'static str) -> Option<(&'static str, &'static str)> {
    let mut curves = panels.iter().flat_map(|panel| &panel.curves);
    let is_there = curves.any(|curve| curve.class == MEASURED);
    is_there.then_some((MEASURED, word))
}

/// Returns the text of the SVG file of a picture, by its name.
///
/// # Errors
/// The folder cannot be read, or lacks the numbers of the picture.
pub fn picture_svg(results_dir: &Path, name: &'static str) -> Result<String, ReportError> {
    let results = Results::read(results_dir)?;
    let mut drawn = pictures(&results).into_iter();
    if let Some(picture) = drawn.find(|picture| picture.name == name) {
        return Ok(picture.svg);
    }
    let (file, is_there, content) = match name {
        WEAR_PICTURE => (
            "wear.csv",
            results.wear.is_some(),
            "rows of cycles, mass_loss_mg",
        ),
        KINEMATICS_PICTURE => {
            let content = "rows of percent, flexion_deg, axial_force_n, ap_mm";
            ("kinematics.csv", results.kinematics.is_some(), content)
        }
        _ => {
            let content = "point data of its field, such as `wear_depth_mm`";
            ("insert_*.vtu", results.surface.is_some(), content)
        }
    };
    let path = results_dir.join(file);
    if is_there {
        let problem = format!("has no {content}, which the picture {name} needs");
        return Err(ReportError::content(&path, problem));
    }
    Err(ReportError::Unusable(format!(
        "The file {} is missing, and the picture {name} cannot be drawn without it. Run the case again.",
        path.display()
    )))
}

/// Writes `wear_map.svg`, `wear.svg` and `kinematics.svg` into a results folder and returns the paths.
///
/// # Errors
/// As [`picture_svg`], or a file cannot be written.
pub fn write_pictures(results_dir: &Path) -> Result<Vec<PathBuf>, ReportError> {
    let write = |name| {
        let path = results_dir.join(format!("{name}.svg"));
        write_text(path, &picture_svg(results_dir, name)?)
    };
    let names = [MAP_PICTURES[0], WEAR_PICTURE, KINEMATICS_PICTURE];
    names.into_iter().map(write).collect()
}
