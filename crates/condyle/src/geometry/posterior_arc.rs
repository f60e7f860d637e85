//! The posterior arc of a femur's condyles.

use condyle_mesh::TriangleMesh;

use crate::{Mat3, Vec3};

/// Centre (x, y) of the circle that fits the posterior condyles in the sagittal plane, mm.
///
/// The support h(d), how far the surface reaches in direction d, is c . d + r for a circle of
/// centre c and radius r, so a straight least-squares fit over the directions from 30 to
/// 90 degrees behind straight down gives the centre.
pub fn posterior_arc_centre_mm(femur: &TriangleMesh) -> (f64, f64) {
    let mut normal_matrix = Mat3::zeros();
    let mut right_side = Vec3::zeros();
    for behind_deg in (30..=90).step_by(2) {
        let (sine, cosine) = f64::from(behind_deg).to_radians().sin_cos();
        let (x, y) = (-sine, -cosine);
        let reach = femur
            .vertices
            .iter()
            .map(|v| v.x * x + v.y * y)
            .fold(f64::NEG_INFINITY, f64::max);
        let row = Vec3::new(x, y, 1.0);
        normal_matrix += row * row.transpose();
        right_side += row * reach;
    }
    let solved = normal_matrix.lu().solve(&right_side).unwrap_or_default();
    (solved.x, solved.y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{GenericFemur, GenericFemurShape};

    #[test]
    fn verify_posterior_arc_of_the_generic_femur_is_its_origin() {
        let mesh = GenericFemur::new(GenericFemurShape::default()).surface_mesh(0.5);
        let (x, y) = posterior_arc_centre_mm(&mesh);
        assert!(x.abs() < 0.05 && y.abs() < 0.05, "{x} {y}");
    }
}
