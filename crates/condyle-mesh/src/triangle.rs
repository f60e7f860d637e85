//! One flat triangle: its closest point, its height over a place, and its intersection with a ray.

use super::Vec3;

/// Interpolates vectors at the corners with barycentric coordinates `weights`.
#[inline]
pub(crate) fn weighted(vectors: &[Vec3; 3], weights: [f64; 3]) -> Vec3 {
    vectors[0] * weights[0] + vectors[1] * weights[1] + vectors[2] * weights[2]
}

/// Returns the barycentric coordinates of the point of a triangle closest to `point`.
///
/// By the regions of the triangle, as in Ericson, Real-Time Collision Detection, 5.1.5.
pub(crate) fn closest_point(corners: &[Vec3; 3], point: &Vec3) -> [f64; 3] {
    let [a, b, c] = corners;
    let (ab, ac) = (b - a, c - a);
    let from_a = point - a;
    let (d1, d2) = (ab.dot(&from_a), ac.dot(&from_a));
    // Beyond corner a: both edges lead away from the point.
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let from_b = point - b;
    let (d3, d4) = (ab.dot(&from_b), ac.dot(&from_b));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    // The signs of va, vb and vc are the sides of the edges on which the point lies: no root is needed.
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let along = d1 / (d1 - d3);
        return [1.0 - along, along, 0.0];
    }
    let from_c = point - c;
    let (d5, d6) = (ab.dot(&from_c), ac.dot(&from_c));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let along = d2 / (d2 - d6);
        return [1.0 - along, 0.0, along];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - along, along];
    }
    // Inside, the areas are the barycentric coordinates.
    let all = va + vb + vc;
    [va / all, vb / all, vc / all]
}

/// Returns the height of a triangle over a place (x, z), if it covers it.
pub(crate) fn height_over([a, b, c]: &[Vec3; 3], (x, z): (f64, f64)) -> Option<f64> {
    let twice_area = |p: &Vec3, q: &Vec3| (p.x - x) * (q.z - z) - (p.z - z) * (q.x - x);
    let weights = [twice_area(b, c), twice_area(c, a), twice_area(a, b)];
    let whole: f64 = weights.iter().sum();
    let covers = whole != 0.0 && weights.iter().all(|weight| weight * whole >= 0.0);
    covers.then(|| (weights[0] * a.y + weights[1] * b.y + weights[2] * c.y) / whole)
}

/// Returns the distance along a ray to a triangle, if it hits (Moller & Trumbore 1997).
pub fn hit([a, b, c]: &[Vec3; 3], from: &Vec3, direction: &Vec3) -> Option<f64> {
    // With a small tolerance at the edges, so that no ray passes between two triangles.
    const EDGE: f64 = 1e-9;
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(&ac);
    let determinant = ab.dot(&across);
    if determinant == 0.0 {
        return None;
    }
    let offset = from - a;
    let u = offset.dot(&across) / determinant;
    // Most rays miss, and most of these are rejected here.
    if !(-EDGE..=1.0 + EDGE).contains(&u) {
        return None;
    }
    let turned = offset.cross(&ab);
    let v = direction.dot(&turned) / determinant;
    let distance = ac.dot(&turned) / determinant;
    (v >= -EDGE && u + v <= 1.0 + EDGE && distance > 0.0).then_some(distance)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closest_point_is_no_further_than_any_sample_of_the_triangle() {
        let corners = [[0., 0., 0.], [2., 0.1, 0.], [0.4, 1.5, 0.3]].map(Vec3::from);
        for i in 0..200 {
            let angle = f64::from(i);
            let point = Vec3::new(
                3.0 * angle.sin(),
                3.0 * (1.7 * angle).cos(),
                (0.3 * angle).sin(),
            );
            let best = (weighted(&corners, closest_point(&corners, &point)) - point).norm();
            for a in 0..=20 {
                for b in 0..=(20 - a) {
                    let (u, v) = (f64::from(a) / 20.0, f64::from(b) / 20.0);
                    let there = weighted(&corners, [1.0 - u - v, u, v]);
                    assert!(best <= (there - point).norm() + 1e-12);
                }
            }
        }
    }
}
