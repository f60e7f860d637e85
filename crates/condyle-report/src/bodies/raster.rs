//! Surfaces as pixels: drawn with a depth buffer, composed, and written as a PNG inside an SVG.

use std::io::Write as _;

use base64::{Engine as _, engine::general_purpose::STANDARD};
use condyle_mesh::{TriangleMesh, Vec3};
use flate2::{Compression, Crc, write::ZlibEncoder};

use super::frame::Frame;

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
pub(super) struct Raster {
    width: usize,
    height: usize,
    /// Nearness of the surface to the viewer, in pixels; minus infinity where it is not visible.
    pub(super) near: Vec<f32>,
    light: Vec<f32>,
}

impl Raster {
    pub(super) fn new(surface: &TriangleMesh, frame: &Frame) -> Self {
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
        let light = lightness([a, b, c]);
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

/// Returns the lightness of a face: larger the more it faces the viewer and a lamp above.
fn lightness([a, b, c]: [Vec3; 3]) -> f32 {
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0);
    let normal = normal.unwrap_or_default();
    let towards = if normal.z < 0.0 { -normal } else { normal };
    // Rows of pixels run down, so the lamp is at negative y.
    let lit = towards.dot(&Vec3::new(-0.25, -0.35, 0.9)).max(0.0) as f32;
    MIN_LIGHT + (1.0 - MIN_LIGHT) * lit.min(1.0)
}

/// Renders insert, translucent femur and the contact patch over both, in this order, as an element of an SVG.
pub(super) fn image(surfaces: [&TriangleMesh; 3], frame: &Frame) -> String {
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
    let data = STANDARD.encode(png(insert.width, insert.height, &bytes));
    let [x, y, width, height] = frame.rectangle();
    format!(
        r#"<image x="{x:.1}" y="{y:.1}" width="{width:.1}" height="{height:.1}" href="data:image/png;base64,{data}"/>"#
    )
}

fn mixed(below: Colour, above: Colour, opacity: f32) -> Colour {
    std::array::from_fn(|i| below[i] * (1.0 - opacity) + above[i] * opacity)
}

/// Returns the bytes of a PNG file (ISO/IEC 15948) of red, green and blue bytes.
fn png(width: usize, height: usize, bytes: &[u8]) -> Vec<u8> {
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
