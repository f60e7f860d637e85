//! Femur and insert in place, seen from three sides: a picture of a case before it runs.
//!
//! The surfaces, plain triangles, are drawn into small images with a depth buffer, so that sixty thousand triangles
//! make a file no larger than six hundred; names, axes and scale are drawn over the images as vectors.

mod frame;
mod raster;

use std::path::{Path, PathBuf};

use condyle_mesh::{TriangleMesh, Vec3};

use condyle_results::Side;

use crate::error::ReportError;
use crate::figure::{escape, scale_bar, svg_file};
use crate::sheets::write_text;
use frame::{Frame, VIEWS, View};

/// The axes of the machine in the insert frame, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MachineAxes {
    /// (x, y) of the flexion axis, which is along z.
    pub flexion_mm: (f64, f64),
    /// (y, z) of the varus-valgus axis, which is along x.
    pub vv_mm: (f64, f64),
    /// (x, z) of the axis of IE rotation, which is along y.
    pub ie_mm: (f64, f64),
    /// x at which AP reads zero under the flexion axis.
    pub ap_zero_mm: f64,
}

/// Femur and insert in place.
#[derive(Clone, Copy, Debug)]
pub struct BodiesPicture<'a> {
    /// Title of the picture.
    pub title: &'a str,
    /// The side of the knee.
    pub side: Side,
    /// The femoral component in its pose on the insert, as all surfaces in the insert frame.
    pub femur: &'a TriangleMesh,
    /// The insert.
    pub insert: &'a TriangleMesh,
    /// The part of the insert's surface under pressure; empty where that is not known.
    pub contact: &'a TriangleMesh,
    /// The machine's axes; none if there is no machine yet.
    pub axes: Option<MachineAxes>,
    /// A line below the picture.
    pub caption: &'a str,
}

const MAX_WIDTH: f64 = 980.0;
const MAX_SCALE: f64 = 4.5;
/// Space between two views, for their labels, px.
const BETWEEN: f64 = 46.0;
/// Space above and below the views, px.
const ABOVE: f64 = 34.0;
const BELOW: f64 = 64.0;

/// Style of text over an image, with a white rim to be read on any colour, and of lines.
const OVER: &str = "paint-order:stroke;stroke:#fff;stroke-width:3px;stroke-linejoin:round";
const LINE: &str = "stroke:#0b4f7d;stroke-width:1.1;fill:none";
const DASHED: &str = "stroke:#0b4f7d;stroke-width:1;stroke-dasharray:4 3;fill:none";

/// Renders the picture as the text of an SVG file.
pub fn bodies_svg(picture: &BodiesPicture<'_>) -> String {
    let mut frames = VIEWS.map(|view| Frame::around([picture.femur, picture.insert], view));
    let widths_mm: f64 = frames.iter().map(|frame| frame.size_mm().0).sum();
    let room = MAX_WIDTH - BETWEEN * (VIEWS.len() + 1) as f64;
    let scale = (room / widths_mm).min(MAX_SCALE);
    let heights_mm = frames.iter().map(|frame| frame.size_mm().1);
    let tallest_mm = heights_mm.fold(0.0, f64::max);
    let (mut body, mut x) = (String::new(), BETWEEN);
    for frame in &mut frames {
        let (width_mm, height_mm) = frame.size_mm();
        frame.scale = scale;
        frame.corner = (x, ABOVE + (tallest_mm - height_mm) * scale / 2.0);
        body += &raster::image([picture.insert, picture.femur, picture.contact], frame);
        body += &picture
            .axes
            .map_or_else(String::new, |axes| axes.svg(frame));
        body += &frame.directions(picture.side);
        x += width_mm * scale + BETWEEN;
    }
    let height = ABOVE + tallest_mm * scale + BELOW;
    let (base, caption) = (height - 8.0, escape(picture.caption));
    body += &format!(r#"<text x="{BETWEEN:.1}" y="{base:.1}">{caption}</text>"#);
    body += &scale_bar((x - BETWEEN, height - 16.0), scale);
    let desc = "Femur and insert from the front, from the right and from above.";
    svg_file(picture.title, desc, (x, height), &body)
}

/// Writes the picture as an SVG file and returns its path.
///
/// # Errors
/// The file cannot be written.
pub fn write_bodies(path: &Path, picture: &BodiesPicture<'_>) -> Result<PathBuf, ReportError> {
    write_text(path.to_path_buf(), &bodies_svg(picture))
}

impl MachineAxes {
    /// Returns the axes in a view: lines, or a ring where one is seen end on.
    fn svg(&self, frame: &Frame) -> String {
        let (flexion, vv, ie) = (self.flexion_mm, self.vv_mm, self.ie_mm);
        let axes = [
            (
                "flexion axis",
                Vec3::new(flexion.0, flexion.1, 0.0),
                Vec3::z(),
            ),
            ("VV axis", Vec3::new(0.0, vv.0, vv.1), Vec3::x()),
            ("IE axis", Vec3::new(ie.0, 0.0, ie.1), Vec3::y()),
        ];
        let drawn = axes.map(|(name, on, along)| axis(name, &on, &along, frame));
        drawn.concat() + &self.ap_zero(frame)
    }

    /// Returns the place where AP reads zero, labelled at the ends of lines where axes have no labels.
    fn ap_zero(&self, frame: &Frame) -> String {
        let (x, y) = frame.place(&Vec3::new(self.ap_zero_mm, 0.0, 0.0));
        let [left, top, width, height] = frame.rectangle();
        let (path, at) = match frame.view {
            View::Front => return String::new(),
            View::Right => (
                format!("M{x:.1} {top:.1}v{height:.1}"),
                (x - 3.0, top + 10.0),
            ),
            View::Above => {
                let path = format!("M{left:.1} {y:.1}h{width:.1}");
                (path, (left + width - 3.0, y + 12.0))
            }
        };
        format!(r#"<path d="{path}" style="{DASHED}"/>"#) + &text("AP zero", at, "end")
    }
}

/// Returns a line through `on` along `along`, across the view; a ring where it is seen end on.
fn axis(name: &str, on: &Vec3, along: &Vec3, frame: &Frame) -> String {
    let (x, y) = frame.place(on);
    let [left, top, width, height] = frame.rectangle();
    let (path, at, anchor) = match frame.view.seen(along) {
        [0.0, 0.0, _] => {
            let ring = format!(r#"<circle cx="{x:.1}" cy="{y:.1}" r="4" style="{LINE}"/>"#);
            return ring + &text(name, (x + 7.0, y + 3.8), "start");
        }
        [0.0, ..] => {
            let path = format!("M{x:.1} {top:.1}v{height:.1}");
            (path, (x + 3.0, top + height + 12.0), "middle")
        }
        _ => {
            let path = format!("M{left:.1} {y:.1}h{width:.1}");
            (path, (left + 3.0, y - 4.0), "start")
        }
    };
    format!(r#"<path d="{path}" style="{LINE}"/>"#) + &text(name, at, anchor)
}

fn text(words: &str, (x, y): (f64, f64), anchor: &str) -> String {
    format!(
        r##"<text x="{x:.1}" y="{y:.1}" text-anchor="{anchor}" style="{OVER};fill:#0b4f7d">{words}</text>"##
    )
}

#[cfg(test)]
mod tests;
