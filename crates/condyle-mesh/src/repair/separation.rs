//! How deep two triangles cut into one another, and where.

use crate::Vec3;

/// Corners of a triangle.
pub(super) type Corners = [Vec3; 3];

/// How far one of two triangles must be shifted for them to part, if that is more than `least`.
///
/// By the separating-axis theorem the shortest such shift is along the normal of one of the two or
/// across an edge of each (eleven directions). It is 0 for triangles that touch or lie in one
/// plane, so the test needs no exact arithmetic: rounding moves the depth by some 1e-16 of the
/// coordinates. `least` must not be negative.
pub(super) fn depth_above(least: f64, first: &Corners, second: &Corners) -> Option<f64> {
    let origin = first[0];
    let [first, second] = [first, second].map(|corners| corners.map(|corner| corner - origin));
    let [along_first, along_second] = [edges(&first), edges(&second)];
    let normals = [along_first, along_second].map(|[a, b, _]| a.cross(&b));
    let across = along_first
        .iter()
        .flat_map(|a| along_second.map(|b| (a.cross(&b), a.norm_squared() * b.norm_squared())));
    let faces = normals
        .into_iter()
        .map(|normal| (normal, normal.norm_squared()));
    let mut depth = f64::INFINITY;
    for (axis, scale) in faces.chain(across) {
        let length_squared = axis.norm_squared();
        // Parallel edges have no direction across them.
        if length_squared <= 1e-20 * scale {
            continue;
        }
        let along = overlap(&axis, &first, &second);
        if along <= 0.0 || along * along <= least * least * length_squared {
            return None;
        }
        depth = depth.min(along / length_squared.sqrt());
    }
    Some(depth)
}

/// Whether the plane of the first triangle has the second on one side; most pairs end here.
pub(super) fn are_parted_by_a_plane(first: &Corners, second: &Corners) -> bool {
    let normal = (first[1] - first[0]).cross(&(first[2] - first[0]));
    let [a, b, c] = second.map(|corner| normal.dot(&(corner - first[0])));
    (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0)
}

fn edges([a, b, c]: &Corners) -> [Vec3; 3] {
    [b - a, c - b, a - c]
}

/// Shift along `axis`, times its length, that parts the shadows of the two triangles.
fn overlap(axis: &Vec3, first: &Corners, second: &Corners) -> f64 {
    let [(low, high), (other_low, other_high)] = [shadow(axis, first), shadow(axis, second)];
    (high - other_low).min(other_high - low)
}

fn shadow(axis: &Vec3, corners: &Corners) -> (f64, f64) {
    let [a, b, c] = corners.each_ref().map(|corner| corner.dot(axis));
    (a.min(b).min(c), a.max(b).max(c))
}

/// A point that two crossing triangles share: where an edge of one pierces the other.
pub(super) fn meeting_point(first: &Corners, second: &Corners) -> Vec3 {
    let pierced = piercing(first, second).or_else(|| piercing(second, first));
    // Edges that just miss by rounding: the crossing is between the two.
    pierced.unwrap_or_else(|| (first.iter().sum::<Vec3>() + second.iter().sum::<Vec3>()) / 6.0)
}

fn piercing(edges_of: &Corners, plate: &Corners) -> Option<Vec3> {
    let normal = (plate[1] - plate[0]).cross(&(plate[2] - plate[0]));
    (0..3).find_map(|i| {
        let (from, to) = (edges_of[i], edges_of[(i + 1) % 3]);
        let [above, below] = [from, to].map(|end| normal.dot(&(end - plate[0])));
        let at = from + (to - from) * (above / (above - below));
        (above * below < 0.0 && is_within(&at, plate, &normal)).then_some(at)
    })
}

fn is_within(at: &Vec3, plate: &Corners, normal: &Vec3) -> bool {
    (0..3).all(|i| {
        let (from, to) = (plate[i], plate[(i + 1) % 3]);
        (to - from).cross(&(at - from)).dot(normal) >= 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const FLOOR: Corners = [
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(4.0, 0.0, 0.0),
        Vec3::new(0.0, 4.0, 0.0),
    ];

    fn upright(tip_z: f64, at: [f64; 2]) -> Corners {
        let [x, y] = at;
        let tip = Vec3::new(x, y, tip_z);
        [
            tip,
            tip + Vec3::new(0.5, 0.0, 3.0),
            tip + Vec3::new(-0.5, 0.2, 3.0),
        ]
    }

    #[test]
    fn verify_depth_of_a_tip_through_a_plate() {
        let depth = depth_above(0.0, &FLOOR, &upright(-0.25, [1.0, 1.0])).unwrap();
        assert!((depth - 0.25).abs() < 1e-14, "{depth}");
        assert_eq!(depth_above(0.26, &FLOOR, &upright(-0.25, [1.0, 1.0])), None);
    }

    #[test]
    fn apart_touching_and_coplanar_triangles_do_not_cross() {
        assert_eq!(depth_above(0.0, &FLOOR, &upright(0.1, [1.0, 1.0])), None);
        assert_eq!(depth_above(0.0, &FLOOR, &upright(0.0, [1.0, 1.0])), None);
        assert_eq!(depth_above(0.0, &FLOOR, &upright(-0.25, [5.0, 1.0])), None);
        let shifted = FLOOR.map(|corner| corner + Vec3::new(0.5, 0.5, 0.0));
        assert_eq!(depth_above(0.0, &FLOOR, &shifted), None);
    }

    #[test]
    fn the_meeting_point_lies_in_both() {
        let tip = upright(-0.5, [1.0, 1.0]);
        let at = meeting_point(&FLOOR, &tip);
        assert!(
            at.z.abs() < 1e-14 && (at.x - 1.0).abs() < 0.1 && (at.y - 1.0).abs() < 0.1,
            "{at}"
        );
    }
}
