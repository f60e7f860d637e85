//! A side from which bodies are looked at.

use condyle_fem::Vec3;

use super::body_surface::BodySurface;

/// Margin around the bodies, mm.
const MARGIN_MM: f64 = 4.0;

/// Which side it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum From {
    Front,
    Right,
    Above,
}

/// A parallel projection.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    pub from: From,
    /// What lies to the right in the picture, up, and towards whoever looks.
    right: Vec3,
    up: Vec3,
    near: Vec3,
}

/// The three sides.
pub(super) const VIEWS: [View; 3] = [
    View {
        from: From::Front,
        right: Vec3::new(0.0, 0.0, -1.0),
        up: Vec3::new(0.0, 1.0, 0.0),
        near: Vec3::new(1.0, 0.0, 0.0),
    },
    View {
        from: From::Right,
        right: Vec3::new(1.0, 0.0, 0.0),
        up: Vec3::new(0.0, 1.0, 0.0),
        near: Vec3::new(0.0, 0.0, 1.0),
    },
    View {
        from: From::Above,
        right: Vec3::new(0.0, 0.0, 1.0),
        up: Vec3::new(1.0, 0.0, 0.0),
        near: Vec3::new(0.0, 1.0, 0.0),
    },
];

/// What of the picture's plane is shown, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Bounds {
    pub low: (f64, f64),
    pub high: (f64, f64),
}

impl Bounds {
    pub fn width_mm(&self) -> f64 {
        self.high.0 - self.low.0
    }

    pub fn height_mm(&self) -> f64 {
        self.high.1 - self.low.1
    }
}

impl View {
    /// A point to the right, up, and towards whoever looks, mm.
    pub fn seen(&self, point: &Vec3) -> [f64; 3] {
        [self.right, self.up, self.near].map(|direction| direction.dot(point))
    }

    /// What is shown of bodies; a small square where there are none.
    pub fn bounds(&self, bodies: [&BodySurface; 2]) -> Bounds {
        let points = bodies.iter().flat_map(|body| &body.vertices);
        let seen = points.map(|point| self.seen(point));
        let none = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let (low, high) = seen.fold(none, |(low, high), [x, y, _]| {
            (
                [low[0].min(x), low[1].min(y)],
                [high[0].max(x), high[1].max(y)],
            )
        });
        if low[0] > high[0] {
            let (low, high) = ((-1.0, -1.0), (1.0, 1.0));
            return Bounds { low, high };
        }
        Bounds {
            low: (low[0] - MARGIN_MM, low[1] - MARGIN_MM),
            high: (high[0] + MARGIN_MM, high[1] + MARGIN_MM),
        }
    }
}
