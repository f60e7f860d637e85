//! Where a view lies, in px of the picture and in pixels of its image.

use super::view::Bounds;

/// Pixels of an image for each px of the picture, both ways, so that edges are smooth.
const FINENESS: f64 = 2.0;

/// Where a view lies in the picture.
pub(super) struct Frame {
    /// Its upper left corner, px.
    pub corner: (f64, f64),
    /// px per mm.
    pub scale: f64,
    bounds: Bounds,
}

impl Frame {
    pub fn new(corner: (f64, f64), scale: f64, bounds: Bounds) -> Self {
        Self {
            corner,
            scale,
            bounds,
        }
    }

    /// Width and height, px.
    pub fn size(&self) -> (f64, f64) {
        let bounds = &self.bounds;
        (
            bounds.width_mm() * self.scale,
            bounds.height_mm() * self.scale,
        )
    }

    /// Width and height of its image, pixels.
    pub fn pixels(&self) -> (usize, usize) {
        let (width, height) = self.size();
        let pixels = |length: f64| (length * FINENESS).ceil() as usize;
        (pixels(width), pixels(height))
    }

    /// A point as a view sees it: column and row of the image, and how near it is in the same unit.
    pub fn pixel(&self, [right, up, near]: [f64; 3]) -> [f64; 3] {
        let fine = self.scale * FINENESS;
        let Bounds { low, high } = self.bounds;
        [(right - low.0) * fine, (high.1 - up) * fine, near * fine]
    }

    /// The same in px of the picture.
    pub fn place(&self, seen: [f64; 3]) -> (f64, f64) {
        let [column, row, _] = self.pixel(seen);
        (
            self.corner.0 + column / FINENESS,
            self.corner.1 + row / FINENESS,
        )
    }
}
