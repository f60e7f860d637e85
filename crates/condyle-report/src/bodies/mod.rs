//! Femur and insert in place, seen from three sides: a picture of a case before it runs.
//!
//! The surfaces, plain triangles, are drawn into small images with a depth buffer, so that sixty thousand triangles
//! make a file no larger than six hundred; names, axes and scale are drawn over the images as vectors.

use std::io::Write as _;

use base64::{Engine as _, engine::general_purpose::STANDARD};
use condyle_mesh::{TriangleMesh, Vec3};
use condyle_results::Directions;
use flate2::{Compression, Crc, write::ZlibEncoder};

use crate::figure::{escape, finite_range, scale_bar, svg_file};

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
    /// The joint and its side.
    pub directions: Directions,
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
        body += &image([picture.insert, picture.femur, picture.contact], frame);
        body += &picture
            .axes
            .map_or_else(String::new, |axes| axes.svg(frame));
        body += &frame.directions(picture.directions);
        x += width_mm * scale + BETWEEN;
    }
    let height = ABOVE + tallest_mm * scale + BELOW;
    let (base, caption) = (height - 8.0, escape(picture.caption));
    body += &format!(r#"<text x="{BETWEEN:.1}" y="{base:.1}">{caption}</text>"#);
    body += &scale_bar((x - BETWEEN, height - 16.0), scale);
    let [counterface, bearing] = picture.directions.joint.bodies();
    let desc = format!(
        "The {counterface} and the {bearing} from the front, from the right and from above."
    );
    svg_file(picture.title, &desc, (x, height), &body)
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

const MARGIN_MM: f64 = 4.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum View {
    Front,
    Right,
    Above,
}

const VIEWS: [View; 3] = [View::Front, View::Right, View::Above];

impl View {
    /// Returns the coordinates of a point to the right and up in the picture, and towards the viewer.
    fn seen(self, point: &Vec3) -> [f64; 3] {
        match self {
            Self::Front => [-point.z, point.y, point.x],
            Self::Right => [point.x, point.y, point.z],
            Self::Above => [point.z, point.x, point.y],
        }
    }
}

struct Frame {
    view: View,
    /// Ends to the right and up, mm.
    right_mm: (f64, f64),
    up_mm: (f64, f64),
    corner: (f64, f64),
    scale: f64,
}

impl Frame {
    /// Creates a frame around bodies; a small square where there are none.
    fn around(bodies: [&TriangleMesh; 2], view: View) -> Self {
        let ends = |axis: usize| {
            let points = bodies.iter().flat_map(|body| &body.vertices);
            let ends = finite_range(points.map(|point| view.seen(point)[axis]));
            let wider = |(low, high)| (low - MARGIN_MM, high + MARGIN_MM);
            ends.map_or((-1.0, 1.0), wider)
        };
        Self {
            view,
            right_mm: ends(0),
            up_mm: ends(1),
            corner: (0.0, 0.0),
            scale: 1.0,
        }
    }

    fn size_mm(&self) -> (f64, f64) {
        (
            self.right_mm.1 - self.right_mm.0,
            self.up_mm.1 - self.up_mm.0,
        )
    }

    /// Left, top, width and height in the picture, px.
    fn rectangle(&self) -> [f64; 4] {
        let (width, height) = self.size_mm();
        let (x, y) = self.corner;
        [x, y, width * self.scale, height * self.scale]
    }

    fn place(&self, point: &Vec3) -> (f64, f64) {
        let [right, up, _] = self.view.seen(point);
        (
            self.corner.0 + (right - self.right_mm.0) * self.scale,
            self.corner.1 + (self.up_mm.1 - up) * self.scale,
        )
    }

    /// Names of the directions around the view, and of the view above it.
    fn directions(&self, names: Directions) -> String {
        let ([front, back], [left, right]) = (names.along_x(), names.along_z());
        let (name, at_left, at_right) = match self.view {
            View::Front => ("From the front".to_owned(), right, left),
            View::Right => {
                let name = format!("From the {} side", right.to_lowercase());
                (name, back, front)
            }
            View::Above => {
                let name = format!("From above, {} up", front.to_lowercase());
                (name, left, right)
            }
        };
        let [x, y, width, height] = self.rectangle();
        let (middle, down) = (x + width / 2.0, y + height / 2.0);
        let (above, before, after) = (y - 8.0, x - 6.0, x + width + 14.0);
        format!(
            r#"<text class="title" x="{middle:.1}" y="{above:.1}" text-anchor="middle">{name}</text><text class="side" text-anchor="middle" transform="translate({before:.1} {down:.1}) rotate(-90)">{at_left}</text><text class="side" text-anchor="middle" transform="translate({after:.1} {down:.1}) rotate(-90)">{at_right}</text>"#
        )
    }
}

/// Pixels of an image for each px of the picture, both ways, so that edges are smooth.
const FINENESS: f64 = 2.0;
/// Lightness of a face seen edge on; one that faces the viewer has 1.
const MIN_LIGHT: f32 = 0.45;

type Colour = [f32; 3];

const PAPER: Colour = [255.0, 255.0, 255.0];
const POLYETHYLENE: Colour = [236.0, 229.0, 208.0];
const METAL: Colour = [128.0, 150.0, 176.0];
const CONTACT: Colour = [200.0, 40.0, 30.0];
/// Opacity of the femur where it is in front of the insert, and where it is behind and shows through.
const IN_FRONT: f32 = 0.62;
const BEHIND: f32 = 0.18;
/// Opacity of the contact patch over both bodies.
const PATCH: f32 = 0.7;

/// A surface as seen in a frame, a value for each pixel, rows from above.
struct Raster {
    width: usize,
    height: usize,
    /// Nearness of the surface to the viewer, in pixels; minus infinity where it is not visible.
    near: Vec<f32>,
    light: Vec<f32>,
}

impl Raster {
    fn new(surface: &TriangleMesh, frame: &Frame) -> Self {
        let fine = frame.scale * FINENESS;
        let (width_mm, height_mm) = frame.size_mm();
        let [width, height] = [width_mm, height_mm].map(|mm| (mm * fine).ceil() as usize);
        let mut raster = Self {
            width,
            height,
            near: vec![f32::NEG_INFINITY; width * height],
            light: vec![0.0; width * height],
        };
        let place = |vertex: &Vec3| {
            let [right, up, near] = frame.view.seen(vertex);
            Vec3::new(right - frame.right_mm.0, frame.up_mm.1 - up, near) * fine
        };
        let places: Vec<Vec3> = surface.vertices.iter().map(place).collect();
        for triangle in &surface.triangles {
            raster.draw(triangle.map(|vertex| places[vertex as usize]));
        }
        raster
    }

    /// Draws a triangle where nothing is nearer; its corners are column, row and nearness.
    fn draw(&mut self, [a, b, c]: [Vec3; 3]) {
        let twice_area =
            |p: Vec3, q: Vec3, r: Vec3| (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
        let whole = twice_area(a, b, c);
        if whole == 0.0 {
            return;
        }
        // A face is lighter the more it faces the viewer and a lamp above.
        let normal = (b - a).cross(&(c - a)).try_normalize(0.0);
        let normal = normal.unwrap_or_default();
        let towards = if normal.z < 0.0 { -normal } else { normal };
        // Rows of pixels run down, so the lamp is at negative y.
        let lit = towards.dot(&Vec3::new(-0.25, -0.35, 0.9)).max(0.0) as f32;
        let light = MIN_LIGHT + (1.0 - MIN_LIGHT) * lit.min(1.0);
        for row in pixels_between([a.y, b.y, c.y], self.height) {
            for column in pixels_between([a.x, b.x, c.x], self.width) {
                let at = Vec3::new(column as f64, row as f64, 0.0);
                // Barycentric coordinates: all are positive inside, for either orientation.
                let parts = [(b, c), (c, a), (a, b)].map(|(q, r)| twice_area(at, q, r) / whole);
                let near = (parts[0] * a.z + parts[1] * b.z + parts[2] * c.z) as f32;
                let pixel = row * self.width + column;
                if parts.iter().all(|part| *part >= 0.0) && near > self.near[pixel] {
                    (self.near[pixel], self.light[pixel]) = (near, light);
                }
            }
        }
    }

    /// Returns the lit colour of the surface at a pixel; none if it is not seen.
    fn lit(&self, pixel: usize, colour: Colour) -> Option<Colour> {
        let is_seen = self.near[pixel].is_finite();
        is_seen.then(|| colour.map(|part| part * self.light[pixel]))
    }
}

/// Pixels between the smallest and the largest of three places, within `count`.
fn pixels_between([a, b, c]: [f64; 3], count: usize) -> std::ops::Range<usize> {
    let (low, high) = (a.min(b).min(c).ceil(), a.max(b).max(c).floor());
    let first = low.max(0.0) as usize;
    let end = (high + 1.0).clamp(0.0, count as f64) as usize;
    first..end.max(first)
}

/// Renders insert, translucent femur and the contact patch over both, in this order, as an element of an SVG.
fn image(surfaces: [&TriangleMesh; 3], frame: &Frame) -> String {
    let [insert, femur, contact] = surfaces.map(|surface| Raster::new(surface, frame));
    let colour = |pixel: usize| {
        let below = insert.lit(pixel, POLYETHYLENE).unwrap_or(PAPER);
        let is_in_front = femur.near[pixel] >= insert.near[pixel];
        let opacity = if is_in_front { IN_FRONT } else { BEHIND };
        let metal = femur.lit(pixel, METAL);
        let bodies = metal.map_or(below, |metal| mixed(below, metal, opacity));
        match contact.near[pixel].is_finite() {
            true => mixed(bodies, CONTACT, PATCH),
            false => bodies,
        }
    };
    let pixels = 0..insert.width * insert.height;
    let bytes: Vec<u8> = pixels
        .flat_map(|pixel| colour(pixel).map(|part| part.round() as u8))
        .collect();
    let data = STANDARD.encode(png_bytes(insert.width, insert.height, &bytes));
    let [x, y, width, height] = frame.rectangle();
    format!(
        r#"<image x="{x:.1}" y="{y:.1}" width="{width:.1}" height="{height:.1}" href="data:image/png;base64,{data}"/>"#
    )
}

fn mixed(below: Colour, above: Colour, opacity: f32) -> Colour {
    std::array::from_fn(|i| below[i] * (1.0 - opacity) + above[i] * opacity)
}

/// Returns the bytes of a PNG file (ISO/IEC 15948) of red, green and blue bytes.
fn png_bytes(width: usize, height: usize, bytes: &[u8]) -> Vec<u8> {
    // Each row as its difference from the row above: filter 2.
    const FROM_ABOVE: u8 = 2;
    let mut above = vec![0; 3 * width];
    let mut data = ZlibEncoder::new(Vec::new(), Compression::default());
    for row in bytes.chunks((3 * width).max(1)) {
        let differences = row
            .iter()
            .zip(&above)
            .map(|(here, up)| here.wrapping_sub(*up));
        let line: Vec<u8> = [FROM_ABOVE].into_iter().chain(differences).collect();
        data.write_all(&line).expect("a Vec takes any bytes");
        above.copy_from_slice(row);
    }
    let data = data.finish().expect("a Vec takes any bytes");
    let size = [width as u32, height as u32].map(u32::to_be_bytes);
    // 8 bits a colour, red green blue, the only compression and filter set, no interlacing.
    let header = [&size.concat()[..], &[8, 2, 0, 0, 0]].concat();
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    for (name, content) in [(b"IHDR", header), (b"IDAT", data), (b"IEND", Vec::new())] {
        let mut sum = Crc::new();
        sum.update(name);
        sum.update(&content);
        file.extend((content.len() as u32).to_be_bytes());
        file.extend(name);
        file.extend(content);
        file.extend(sum.sum().to_be_bytes());
    }
    file
}

#[cfg(test)]
mod tests;
