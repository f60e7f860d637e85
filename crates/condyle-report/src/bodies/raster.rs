//! A surface as pixels: how near it is, and how light.

use condyle_fem::Vec3;

use super::body_surface::BodySurface;
use super::frame::Frame;
use super::view::View;

/// Lightness of a face seen edge on; one that faces the viewer has 1.
const MIN_LIGHT: f32 = 0.45;

/// What is seen of one surface, a value a pixel, rows from above.
pub(super) struct Raster {
    pub width: usize,
    pub height: usize,
    /// How near it is, mm; minus infinity where it is not.
    pub near: Vec<f32>,
    /// Lightness, 0 to 1.
    pub light: Vec<f32>,
}

impl Raster {
    /// `surface` from the side of `view`.
    pub fn new(surface: &BodySurface, view: &View, frame: &Frame) -> Self {
        let (width, height) = frame.pixels();
        let mut raster = Self {
            width,
            height,
            near: vec![f32::NEG_INFINITY; width * height],
            light: vec![0.0; width * height],
        };
        let place = |vertex: &Vec3| frame.pixel(view.seen(vertex));
        let places: Vec<[f64; 3]> = surface.vertices.iter().map(place).collect();
        for triangle in &surface.triangles {
            raster.draw(triangle.map(|vertex| places[vertex as usize]));
        }
        raster
    }

    /// Draws a triangle where nothing is nearer.
    fn draw(&mut self, [a, b, c]: [[f64; 3]; 3]) {
        let twice_area = |p: [f64; 2], q: [f64; 3], r: [f64; 3]| {
            (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0])
        };
        let whole = twice_area([a[0], a[1]], b, c);
        if whole == 0.0 {
            return;
        }
        let light = light_of([a, b, c]);
        for row in pixels_between([a[1], b[1], c[1]], self.height) {
            for column in pixels_between([a[0], b[0], c[0]], self.width) {
                let at = [column as f64, row as f64];
                let parts = [
                    twice_area(at, b, c),
                    twice_area(at, c, a),
                    twice_area(at, a, b),
                ];
                let parts = parts.map(|part| part / whole);
                if parts.iter().all(|part| *part >= 0.0) {
                    let near = parts[0] * a[2] + parts[1] * b[2] + parts[2] * c[2];
                    self.put(row * self.width + column, near as f32, light);
                }
            }
        }
    }

    fn put(&mut self, pixel: usize, near: f32, light: f32) {
        if near > self.near[pixel] {
            (self.near[pixel], self.light[pixel]) = (near, light);
        }
    }

    /// Whether the surface is seen at a pixel.
    pub fn is_at(&self, pixel: usize) -> bool {
        self.near[pixel].is_finite()
    }
}

/// Pixels between the smallest and the largest of three places, of `count` that there are.
fn pixels_between(places: [f64; 3], count: usize) -> std::ops::Range<usize> {
    let [a, b, c] = places;
    let (low, high) = (a.min(b).min(c).ceil(), a.max(b).max(c).floor());
    let first = low.max(0.0) as usize;
    let end = (high + 1.0).clamp(0.0, count as f64) as usize;
    first..end.max(first)
}

/// Lighter the more a face looks at the viewer, and at a lamp above them.
fn light_of([a, b, c]: [[f64; 3]; 3]) -> f32 {
    let [a, b, c] = [a, b, c].map(Vec3::from);
    let normal = (b - a).cross(&(c - a)).try_normalize(0.0);
    let normal = normal.unwrap_or_default();
    let towards = if normal.z < 0.0 { -normal } else { normal };
    // Rows of pixels run down, so the lamp is at negative y.
    let lit = towards.dot(&Vec3::new(-0.25, -0.35, 0.9)).max(0.0) as f32;
    MIN_LIGHT + (1.0 - MIN_LIGHT) * lit.min(1.0)
}
