//! Femur and insert in place, seen from three sides: a picture of a case before it runs.
//!
//! Surfaces come as plain triangles. They are drawn into small images by depth, so that sixty thousand triangles
//! make a file no larger than six hundred; names, axes and scale stand over them as vectors.

mod body_surface;
mod frame;
mod image;
mod labels;
mod machine_axes;
mod raster;
mod view;

use std::path::{Path, PathBuf};

use condyle_results::Side;

use crate::error::ReportError;
use crate::figure::alone;
use crate::file::write_text;
use frame::Frame;
use raster::Raster;
use view::{VIEWS, View};

pub use body_surface::BodySurface;
pub use machine_axes::MachineAxes;

/// Femur and insert in place.
#[derive(Clone, Copy, Debug)]
pub struct BodiesPicture<'a> {
    /// What the picture is of.
    pub title: &'a str,
    /// Which knee it is.
    pub side: Side,
    /// The femoral component where it stands on the insert.
    pub femur: &'a BodySurface,
    /// The insert.
    pub insert: &'a BodySurface,
    /// The part of the insert's surface that is pressed, empty where that is not known.
    pub contact: &'a BodySurface,
    /// The machine's axes; none where there is no machine yet.
    pub axes: Option<MachineAxes>,
    /// A line below the picture.
    pub caption: &'a str,
}

/// Widest that the three views are together, px.
const MAX_WIDTH: f64 = 980.0;
/// Largest scale, px per mm.
const MAX_SCALE: f64 = 4.5;
/// Space between two views, for their labels, px.
const BETWEEN: f64 = 46.0;
/// Space above the views, px.
const ABOVE: f64 = 34.0;
/// Space below the views, px.
const BELOW: f64 = 64.0;

/// The picture as the text of an SVG file.
pub fn bodies_svg(picture: &BodiesPicture<'_>) -> String {
    let bounds = VIEWS.map(|view| view.bounds([picture.femur, picture.insert]));
    let widths_mm: f64 = bounds.iter().map(view::Bounds::width_mm).sum();
    let room = MAX_WIDTH - BETWEEN * (VIEWS.len() + 1) as f64;
    let scale = (room / widths_mm).min(MAX_SCALE);
    let tallest_mm = bounds
        .iter()
        .map(view::Bounds::height_mm)
        .fold(0.0, f64::max);
    let (mut body, mut x) = (String::new(), BETWEEN);
    for (view, bounds) in VIEWS.iter().zip(&bounds) {
        let y = ABOVE + (tallest_mm - bounds.height_mm()) * scale / 2.0;
        let frame = Frame::new((x, y), scale, *bounds);
        body += &drawn(picture, view, &frame);
        x += bounds.width_mm() * scale + BETWEEN;
    }
    let height = ABOVE + tallest_mm * scale + BELOW;
    body += &labels::caption(picture.caption, (BETWEEN, height - 8.0));
    body += &labels::scale_bar((x - BETWEEN, height - 16.0), scale);
    let desc = "Femur and insert from the front, from the right and from above.";
    alone(picture.title, desc, (x, height), &body)
}

/// One view: its image, and what stands over it.
fn drawn(picture: &BodiesPicture<'_>, view: &View, frame: &Frame) -> String {
    let raster = |surface| Raster::new(surface, view, frame);
    let pixels = image::composed(
        &raster(picture.insert),
        &raster(picture.femur),
        &raster(picture.contact),
    );
    let axes = picture.axes.as_ref();
    let axes = axes.map_or(String::new(), |axes| labels::axes(axes, view, frame));
    let directions = labels::directions(view, picture.side, frame);
    image::element(&pixels, frame) + &axes + &directions
}

/// Writes the picture as an SVG file and returns its path.
///
/// # Errors
/// A file that cannot be written.
pub fn write_bodies(path: &Path, picture: &BodiesPicture<'_>) -> Result<PathBuf, ReportError> {
    write_text(path.to_path_buf(), &bodies_svg(picture))
}

#[cfg(test)]
mod tests;
