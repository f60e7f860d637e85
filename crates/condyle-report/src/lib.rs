//! From a results folder to a page and pictures; knows no solver.
//!
//! [`write_report`] makes `report.html`: one file, no network, no JavaScript.
//! The pictures on it can also be had alone, as SVG files on white, for a README or a book.
//! The same results folder gives the same bytes: the page names no path, no date and no wall time.

mod error;
mod figure;
pub mod measured;
mod number;
mod page;
mod pictures;
mod plots;
mod results;

pub use error::ReportError;
pub use page::report_html;
pub use pictures::{
    kinematics_svg, wear_curve_svg, wear_map_svg, write_kinematics, write_wear_curve,
    write_wear_map,
};
pub use plots::{Plot, plots_svg};
pub use results::{Extreme, Region, Results, Side, Summary, SurfaceFields, Table};

use std::path::{Path, PathBuf};

/// A point or a vector in the insert frame, mm.
pub type Vec3 = condyle_fem::Vec3;

/// Writes `report.html` into a results folder and returns its path.
///
/// What the folder does not hold is left out of the page, which says so.
///
/// # Errors
/// The folder is missing or holds no result at all, a file in it is damaged,
/// or the page cannot be written.
pub fn write_report(results_dir: &Path) -> Result<PathBuf, ReportError> {
    let html = report_html(&Results::read(results_dir)?);
    write(results_dir.join("report.html"), &html)
}

fn write(path: PathBuf, text: &str) -> Result<PathBuf, ReportError> {
    // Beside it and then in its place in one step: a stop leaves the old page or the new one.
    let mut beside = path.clone().into_os_string();
    beside.push(".part");
    match std::fs::write(&beside, text).and_then(|()| std::fs::rename(&beside, &path)) {
        Ok(()) => Ok(path),
        Err(source) => Err(ReportError::Write { path, source }),
    }
}
