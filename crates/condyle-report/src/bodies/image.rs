//! Pixels of three surfaces over one another, as a PNG inside an SVG.

use std::io::Write as _;

use base64::{Engine as _, engine::general_purpose::STANDARD};
use flate2::{Compression, Crc, write::ZlibEncoder};

use super::frame::Frame;
use super::raster::Raster;

type Colour = [f32; 3];

const PAPER: Colour = [255.0, 255.0, 255.0];
const POLYETHYLENE: Colour = [236.0, 229.0, 208.0];
const METAL: Colour = [128.0, 150.0, 176.0];
const PRESSED: Colour = [200.0, 40.0, 30.0];
/// How much the femur covers where it is in front ...
const COVERS: f32 = 0.62;
/// ... and where it is behind the insert, mixed in so that it can be seen through it.
const SHINES_THROUGH: f32 = 0.18;

/// An image in red, green and blue, rows from above.
pub(super) struct Pixels {
    width: usize,
    height: usize,
    bytes: Vec<u8>,
}

/// The insert, the femur seen through, and over both of them what is pressed.
pub(super) fn composed(insert: &Raster, femur: &Raster, contact: &Raster) -> Pixels {
    let count = insert.width * insert.height;
    let colour = |pixel: usize| {
        let below = lit(insert, pixel, POLYETHYLENE).unwrap_or(PAPER);
        let is_in_front = femur.near[pixel] >= insert.near[pixel];
        let part = if is_in_front { COVERS } else { SHINES_THROUGH };
        let with_femur = lit(femur, pixel, METAL).map_or(below, |metal| mixed(below, metal, part));
        if contact.is_at(pixel) {
            mixed(with_femur, PRESSED, 0.7)
        } else {
            with_femur
        }
    };
    Pixels {
        width: insert.width,
        height: insert.height,
        bytes: (0..count)
            .flat_map(|pixel| colour(pixel).map(|part| part.round() as u8))
            .collect(),
    }
}

fn lit(raster: &Raster, pixel: usize, colour: Colour) -> Option<Colour> {
    let light = raster.light[pixel];
    raster.is_at(pixel).then(|| colour.map(|part| part * light))
}

fn mixed(below: Colour, above: Colour, part: f32) -> Colour {
    std::array::from_fn(|i| below[i] * (1.0 - part) + above[i] * part)
}

/// The image as an element of an SVG.
pub(super) fn element(pixels: &Pixels, frame: &Frame) -> String {
    let ((x, y), (width, height)) = (frame.corner, frame.size());
    let data = STANDARD.encode(png(pixels));
    format!(
        r#"<image x="{x:.1}" y="{y:.1}" width="{width:.1}" height="{height:.1}" href="data:image/png;base64,{data}"/>"#
    )
}

/// The bytes of a PNG file (ISO/IEC 15948): each row as its difference from the row above.
fn png(pixels: &Pixels) -> Vec<u8> {
    let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
    let size = [pixels.width as u32, pixels.height as u32].map(u32::to_be_bytes);
    // 8 bits a colour, red green blue, and the only compression, filter set and order that are simple.
    let header = [&size.concat()[..], &[8, 2, 0, 0, 0]].concat();
    chunk(&mut file, b"IHDR", &header);
    chunk(&mut file, b"IDAT", &compressed(pixels));
    chunk(&mut file, b"IEND", &[]);
    file
}

fn chunk(file: &mut Vec<u8>, name: &[u8; 4], content: &[u8]) {
    let mut sum = Crc::new();
    sum.update(name);
    sum.update(content);
    file.extend((content.len() as u32).to_be_bytes());
    file.extend(name);
    file.extend(content);
    file.extend(sum.sum().to_be_bytes());
}

fn compressed(pixels: &Pixels) -> Vec<u8> {
    const FROM_ABOVE: u8 = 2;
    let per_row = 3 * pixels.width;
    let mut above = vec![0; per_row];
    let mut out = ZlibEncoder::new(Vec::new(), Compression::default());
    for row in pixels.bytes.chunks(per_row.max(1)) {
        let mut line = vec![FROM_ABOVE];
        line.extend(
            row.iter()
                .zip(&above)
                .map(|(here, up)| here.wrapping_sub(*up)),
        );
        out.write_all(&line).expect("a Vec takes any bytes");
        above.copy_from_slice(row);
    }
    out.finish().expect("a Vec takes any bytes")
}
