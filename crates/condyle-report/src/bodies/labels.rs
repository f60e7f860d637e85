//! What stands over the image of a view: directions, the machine's axes, the scale.

use condyle_results::Side;

use condyle_fem::Vec3;

use super::frame::Frame;
use super::machine_axes::MachineAxes;
use super::view::{From, View};
use crate::figure::escape;

/// Text over an image, with a white rim to be read on any colour.
const OVER: &str = "paint-order:stroke;stroke:#fff;stroke-width:3px;stroke-linejoin:round";
const LINE: &str = "stroke:#0b4f7d;stroke-width:1.1;fill:none";
const DASHED: &str = "stroke:#0b4f7d;stroke-width:1;stroke-dasharray:4 3;fill:none";

/// Names of the directions around a view, and the side it is seen from above it.
pub(super) fn directions(view: &View, side: Side, frame: &Frame) -> String {
    let [left, right] = side.regions();
    let (name, at_left, at_right) = match view.from {
        From::Front => ("From the front".to_owned(), right, left),
        From::Right => (
            format!("From the right, {}", right.to_lowercase()),
            "Posterior",
            "Anterior",
        ),
        From::Above => ("From above, anterior up".to_owned(), left, right),
    };
    let ((x, y), (width, height)) = (frame.corner, frame.size());
    let (middle, down) = (x + width / 2.0, y + height / 2.0);
    let turned = |across: f64, word: &str| {
        format!(
            r#"<text class="side" text-anchor="middle" transform="translate({across:.1} {down:.1}) rotate(-90)">{word}</text>"#
        )
    };
    format!(
        r#"<text class="title" x="{middle:.1}" y="{:.1}" text-anchor="middle">{name}</text>{}{}"#,
        y - 8.0,
        turned(x - 6.0, at_left),
        turned(x + width + 14.0, at_right)
    )
}

/// The machine's axes: lines, or a ring where one is seen end on.
pub(super) fn axes(axes: &MachineAxes, view: &View, frame: &Frame) -> String {
    let (flexion, vv, ie) = (axes.flexion_mm, axes.vv_mm, axes.ie_mm);
    let on_flexion = Vec3::new(flexion.0, flexion.1, 0.0);
    let on_vv = Vec3::new(0.0, vv.0, vv.1);
    let on_ie = Vec3::new(ie.0, 0.0, ie.1);
    let zero = Vec3::new(axes.ap_zero_mm, 0.0, 0.0);
    let lines = [
        ("flexion axis", on_flexion, Vec3::z()),
        ("VV axis", on_vv, Vec3::x()),
        ("IE axis", on_ie, Vec3::y()),
    ];
    let drawn = lines.map(|(name, on, along)| axis(name, &on, &along, view, frame));
    drawn.concat() + &ap_zero(frame.place(view.seen(&zero)), view, frame)
}

/// Where AP reads zero under the flexion axis: named at the other ends of lines than axes are.
fn ap_zero((x, y): (f64, f64), view: &View, frame: &Frame) -> String {
    let ((left, top), (width, height)) = (frame.corner, frame.size());
    let (path, at) = match view.from {
        From::Front => return String::new(),
        From::Right => (
            format!("M{x:.1} {top:.1}v{height:.1}"),
            (x - 3.0, top + 10.0),
        ),
        From::Above => (
            format!("M{left:.1} {y:.1}h{width:.1}"),
            (left + width - 3.0, y + 12.0),
        ),
    };
    format!(r#"<path d="{path}" style="{DASHED}"/>"#) + &text("AP zero", at, "end")
}

/// A line through `on` along `along`, across the view; a ring where it is seen end on.
fn axis(name: &str, on: &Vec3, along: &Vec3, view: &View, frame: &Frame) -> String {
    let [right, up, _] = view.seen(along);
    let (x, y) = frame.place(view.seen(on));
    let ((left, top), (width, height)) = (frame.corner, frame.size());
    if right == 0.0 && up == 0.0 {
        let ring = format!(r#"<circle cx="{x:.1}" cy="{y:.1}" r="4" style="{LINE}"/>"#);
        return ring + &text(name, (x + 7.0, y + 3.8), "start");
    }
    let (path, at, anchor) = if right == 0.0 {
        (
            format!("M{x:.1} {top:.1}v{height:.1}"),
            (x + 3.0, top + height + 12.0),
            "middle",
        )
    } else {
        (
            format!("M{left:.1} {y:.1}h{width:.1}"),
            (left + 3.0, y - 4.0),
            "start",
        )
    };
    format!(r#"<path d="{path}" style="{LINE}"/>"#) + &text(name, at, anchor)
}

fn text(words: &str, (x, y): (f64, f64), anchor: &str) -> String {
    format!(
        r##"<text x="{x:.1}" y="{y:.1}" text-anchor="{anchor}" style="{OVER};fill:#0b4f7d">{words}</text>"##
    )
}

/// A line of words below the views.
pub(super) fn caption(words: &str, (x, y): (f64, f64)) -> String {
    format!(r#"<text x="{x:.1}" y="{y:.1}">{}</text>"#, escape(words))
}

/// A bar of 10 mm that ends at a place.
pub(super) fn scale_bar((end, y): (f64, f64), scale: f64) -> String {
    let (start, middle) = (end - 10.0 * scale, end - 5.0 * scale);
    format!(
        r#"<path class="leader" d="M{start:.1} {:.1}v7M{start:.1} {y:.1}H{end:.1}M{end:.1} {:.1}v7"/><text x="{middle:.1}" y="{:.1}" text-anchor="middle">10 mm</text>"#,
        y - 3.5,
        y - 3.5,
        y + 14.0
    )
}
