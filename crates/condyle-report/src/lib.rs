//! Reports of results folders as pages and pictures; this crate does not depend on a solver.
//!
//! [`write_report`] writes `report.html`: one file that requests nothing from a network, with bodies in 3-D and interactive
//! charts, and with the same content in print and without scripts. [`report_html`] renders the page without scripts.
//! The pictures of the page are available as SVG files on white, for a README or a book.
//! The same results folder gives the same bytes: the page contains no path, date or wall time.

pub mod bodies;
mod charts;
mod error;
mod figure;
mod maps;
pub mod measured;
mod number;
mod page;
mod pictures;
mod plots;
#[cfg(feature = "png")]
mod png;
mod program;
mod results;
pub mod runs;
pub mod scene;
mod sheets;
pub mod study;

pub use condyle_fem::Vec3;
pub use condyle_results::{Side, Summary};
pub use error::ReportError;
pub use page::{moving_report_html, report_html};
pub use pictures::{Picture, picture_svg, pictures, write_pictures};
pub use plots::{Plot, plots_svg};
#[cfg(feature = "png")]
pub use png::png;
pub use results::{Extreme, Region, Results, SurfaceFields, Table, unworn_surface};

use std::path::{Path, PathBuf};

use scene::Scene;
use sheets::write_text;

/// Writes `report.html` into a results folder and returns its path.
///
/// Parts that the folder lacks are excluded from the page, which names them.
///
/// # Errors
/// The folder is missing or holds no result at all, a file in it is damaged,
/// or the page cannot be written.
pub fn write_report(results_dir: &Path) -> Result<PathBuf, ReportError> {
    write_page(results_dir, &Results::read(results_dir)?)
}

/// Writes `report.html` of the readable part of a results folder; returns its path, and the files that are omitted with
/// reasons.
///
/// # Errors
/// The folder is missing, nothing in it can be read, or the page cannot be written.
pub fn write_readable_report(results_dir: &Path) -> Result<(PathBuf, Vec<String>), ReportError> {
    let results = Results::read_readable(results_dir)?;
    let page = write_page(results_dir, &results)?;
    Ok((page, results.left_out))
}

fn write_page(results_dir: &Path, results: &Results) -> Result<PathBuf, ReportError> {
    let scene = Scene::read(results_dir, results);
    let html = moving_report_html(results, &scene);
    write_text(results_dir.join("report.html"), &html)
}
