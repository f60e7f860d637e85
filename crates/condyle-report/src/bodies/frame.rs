//! The part of a view that is shown, and its place in the picture.

use condyle_mesh::{TriangleMesh, Vec3};
use condyle_results::Side;

use crate::figure::finite_range;

const MARGIN_MM: f64 = 4.0;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum View {
    Front,
    Right,
    Above,
}

pub(super) const VIEWS: [View; 3] = [View::Front, View::Right, View::Above];

impl View {
    /// Returns the directions to the right and up in the picture, and towards the viewer.
    fn axes(self) -> [Vec3; 3] {
        let [x, y, z] = [Vec3::x(), Vec3::y(), Vec3::z()];
        match self {
            Self::Front => [-z, y, x],
            Self::Right => [x, y, z],
            Self::Above => [z, x, y],
        }
    }

    pub(super) fn seen(self, point: &Vec3) -> [f64; 3] {
        self.axes().map(|direction| direction.dot(point))
    }
}

pub(super) struct Frame {
    pub(super) view: View,
    /// Ends to the right and up, mm.
    pub(super) right_mm: (f64, f64),
    pub(super) up_mm: (f64, f64),
    pub(super) corner: (f64, f64),
    pub(super) scale: f64,
}

impl Frame {
    /// Creates a frame around bodies; a small square where there are none.
    pub(super) fn around(bodies: [&TriangleMesh; 2], view: View) -> Self {
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

    pub(super) fn size_mm(&self) -> (f64, f64) {
        (
            self.right_mm.1 - self.right_mm.0,
            self.up_mm.1 - self.up_mm.0,
        )
    }

    /// Left, top, width and height in the picture, px.
    pub(super) fn rectangle(&self) -> [f64; 4] {
        let (width, height) = self.size_mm();
        let (x, y) = self.corner;
        [x, y, width * self.scale, height * self.scale]
    }

    pub(super) fn place(&self, point: &Vec3) -> (f64, f64) {
        let [right, up, _] = self.view.seen(point);
        (
            self.corner.0 + (right - self.right_mm.0) * self.scale,
            self.corner.1 + (self.up_mm.1 - up) * self.scale,
        )
    }

    /// Names of the directions around the view, and of the view above it.
    pub(super) fn directions(&self, side: Side) -> String {
        let [left, right] = side.regions();
        let (name, at_left, at_right) = match self.view {
            View::Front => ("From the front".to_owned(), right, left),
            View::Right => {
                let name = format!("From the right, {}", right.to_lowercase());
                (name, "Posterior", "Anterior")
            }
            View::Above => ("From above, anterior up".to_owned(), left, right),
        };
        let [x, y, width, height] = self.rectangle();
        let (middle, down) = (x + width / 2.0, y + height / 2.0);
        let (above, before, after) = (y - 8.0, x - 6.0, x + width + 14.0);
        format!(
            r#"<text class="title" x="{middle:.1}" y="{above:.1}" text-anchor="middle">{name}</text><text class="side" text-anchor="middle" transform="translate({before:.1} {down:.1}) rotate(-90)">{at_left}</text><text class="side" text-anchor="middle" transform="translate({after:.1} {down:.1}) rotate(-90)">{at_right}</text>"#
        )
    }
}
