//! From a results folder to a page and pictures; knows no solver.
//!
//! [`write_report`] makes `report.html`: one file, no network; it moves where there are scripts, and says the same
//! without them. [`report_html`] is the still page alone.
//! The pictures on it can also be had alone, as SVG files on white, for a README or a book.
//! The same results folder gives the same bytes: the page names no path, no date and no wall time.

pub mod bodies;
mod error;
mod figure;
mod file;
pub mod measured;
mod number;
mod page;
mod pictures;
mod plots;
#[cfg(feature = "png")]
mod png;
mod results;
pub mod runs;
pub mod scene;
mod sheets;
pub mod study;

pub use condyle_fem::Vec3;
pub use condyle_results::{Side, Summary};
pub use error::ReportError;
pub use page::{moving_report_html, report_html};
pub use pictures::{
    Picture, kinematics_svg, pictures, wear_curve_svg, wear_map_svg, write_kinematics,
    write_wear_curve, write_wear_map,
};
pub use plots::{Plot, plots_svg};
#[cfg(feature = "png")]
pub use png::png;
pub use results::{
    contents::Results,
    measure::{Extreme, Region},
    surface::SurfaceFields,
    table::Table,
};

use std::path::{Path, PathBuf};

use file::write_text;
use scene::Scene;

/// Writes `report.html` into a results folder and returns its path.
///
/// What the folder does not hold is left out of the page, which says so.
///
/// # Errors
/// The folder is missing or holds no result at all, a file in it is damaged,
/// or the page cannot be written.
pub fn write_report(results_dir: &Path) -> Result<PathBuf, ReportError> {
    write_page(results_dir, &Results::read(results_dir)?)
}

/// Writes `report.html` of what can be read of a results folder; returns its path, and what is left out of it because it
/// cannot be read.
///
/// # Errors
/// The folder is missing, nothing in it can be read, or the page cannot be written.
pub fn write_report_of_what_can_be_read(
    results_dir: &Path,
) -> Result<(PathBuf, Vec<String>), ReportError> {
    let results = Results::read_what_can_be(results_dir)?;
    let page = write_page(results_dir, &results)?;
    Ok((page, results.left_out))
}

fn write_page(results_dir: &Path, results: &Results) -> Result<PathBuf, ReportError> {
    let scene = Scene::read(results_dir, results);
    let html = moving_report_html(results, &scene);
    write_text(results_dir.join("report.html"), &html)
}
