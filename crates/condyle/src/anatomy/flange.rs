//! Which flange of the trochlea stands out: what a femoral component shows of its side.

use crate::{Vec3, geometry::TriangleMesh};

/// A flange that stands out by less than this share of the longest extent proves nothing: 1 mm of a knee's.
const MIN_LEAD: f64 = 0.013;
/// The flanges lie in this front part of the length.
const FRONT: f64 = 0.35;

/// By how much the right flange of a femoral component's trochlea stands out beyond the left one, mm;
/// negative where the left one does, none where they are alike.
///
/// The lateral flange holds the patella and stands out wherever a design tells left from right. What
/// counts is how far in front it reaches of the line behind both posterior condyles, and how high above the
/// line below both distal ones, as a surgeon measures it: a component that is turned or tilted by some
/// degrees shows the same. `femur` in mm, x anterior, y superior, z right.
pub fn flange_lead_mm(femur: &TriangleMesh) -> Option<f64> {
    let (low, high) = femur.bounds();
    let middle_z = (low.z + high.z) / 2.0;
    let [behind, below] = [0, 1].map(|axis| Line::across(femur, axis, middle_z));
    let in_front = |vertex: &&Vec3| vertex.x > high.x - FRONT * (high.x - low.x);
    let mut reach = [[f64::NEG_INFINITY; 2]; 2];
    for vertex in femur.vertices.iter().filter(in_front) {
        let of_side = &mut reach[usize::from(vertex.z > middle_z)];
        of_side[0] = of_side[0].max(vertex.x - behind.at(vertex.z));
        of_side[1] = of_side[1].max(vertex.y - below.at(vertex.z));
    }
    let [left, right] = reach.map(|[ahead, up]| ahead + up);
    let lead = right - left;
    (lead.is_finite() && lead.abs() > MIN_LEAD * (high - low).max()).then_some(lead)
}

/// A line that touches both condyles from below or from behind: a height over z.
struct Line {
    height: f64,
    slope: f64,
    middle_z: f64,
}

impl Line {
    /// Through the lowest place along `axis` on either side of the middle.
    fn across(femur: &TriangleMesh, axis: usize, middle_z: f64) -> Self {
        let lowest = |is_right: bool| {
            let side = femur
                .vertices
                .iter()
                .filter(|v| (v.z > middle_z) == is_right);
            let ends = side.map(|vertex| (vertex[axis], vertex.z));
            ends.min_by(|a, b| a.0.total_cmp(&b.0))
                .unwrap_or((f64::NAN, f64::NAN))
        };
        let (left, right) = (lowest(false), lowest(true));
        let slope = (right.0 - left.0) / (right.1 - left.1);
        let height = left.0 + slope * (middle_z - left.1);
        Self {
            height,
            slope,
            middle_z,
        }
    }

    fn at(&self, z: f64) -> f64 {
        self.height + self.slope * (z - self.middle_z)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Mat3,
        geometry::{GenericFemur, GenericFemurShape},
    };

    fn symmetric() -> TriangleMesh {
        GenericFemur::new(GenericFemurShape::default()).surface_mesh(1.0)
    }

    /// The front of the right half further ahead.
    fn with_a_flange(by_mm: f64) -> TriangleMesh {
        symmetric().mapped(|v| {
            let is_flange = v.x > 15.0 && v.z > 0.0;
            v + Vec3::x() * if is_flange { by_mm } else { 0.0 }
        })
    }

    #[test]
    fn a_symmetric_femur_shows_no_side() {
        assert_eq!(flange_lead_mm(&symmetric()), None);
    }

    #[test]
    fn a_flange_is_told_on_its_side_however_the_femur_is_turned_or_tilted() {
        let lead = flange_lead_mm(&with_a_flange(2.5)).unwrap();
        assert!((lead - 2.5).abs() < 1e-9);
        let mirrored = with_a_flange(2.5).mapped(|v| Vec3::new(v.x, v.y, -v.z));
        assert_eq!(flange_lead_mm(&mirrored), Some(-lead));
        for (x, y) in [(0.07, 0.0), (-0.07, 0.0), (0.0, 0.07), (0.0, -0.07)] {
            let turn = Mat3::identity() + Vec3::new(x, y, 0.0).cross_matrix();
            let turned = flange_lead_mm(&with_a_flange(2.5).mapped(|v| turn * v)).unwrap();
            assert!((turned - lead).abs() < 0.3, "{turned}");
        }
    }

    #[test]
    fn what_has_one_side_only_shows_none() {
        let sliver = TriangleMesh {
            vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::y()],
            triangles: vec![[0, 1, 2]],
        };
        assert_eq!(flange_lead_mm(&sliver), None);
    }
}
