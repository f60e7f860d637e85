//! The box around points.

use crate::Vec3;

/// Lowest and highest coordinate of `points` along each axis; of none, infinity and minus infinity.
pub fn bounds<'a>(points: impl IntoIterator<Item = &'a Vec3>) -> (Vec3, Vec3) {
    let none = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    let wider = |(low, high): (Vec3, Vec3), point: &Vec3| (low.inf(point), high.sup(point));
    points.into_iter().fold(none, wider)
}
