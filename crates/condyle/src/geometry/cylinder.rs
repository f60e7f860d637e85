//! A cylinder about the z axis.

use super::surface_sample::{Curvature, SurfaceSample};
use crate::{Vector, number::Number};

/// An endless cylinder about the z axis of the femoral frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Radius, mm.
    pub radius_mm: f64,
}

impl Cylinder {
    /// Gap at a point, mm.
    #[inline(always)]
    pub fn gap_mm<T: Number>(&self, point: &Vector<T>) -> T {
        (point.x * point.x + point.y * point.y).sqrt() - T::splat(self.radius_mm)
    }

    /// Gap, normal and curvature at a point, the gap averaged as
    /// [`FemoralSurface::sample`](super::FemoralSurface::sample) says.
    ///
    /// With rho the distance from the axis and t = (-n_y, n_x, 0): K = t t'/rho, div n = 1/rho.
    #[inline(always)]
    pub fn sample<T: Number>(&self, point: &Vector<T>, spread_mm2: T) -> SurfaceSample<T> {
        let from_axis = (point.x * point.x + point.y * point.y).sqrt();
        let per_axis = T::one() / from_axis;
        let (x, y) = (point.x * per_axis, point.y * per_axis);
        let normal = Vector::new(x, y, T::zero());
        let rise_mm = spread_mm2 * per_axis;
        SurfaceSample {
            gap_mm: from_axis - T::splat(self.radius_mm) + rise_mm,
            gap_gradient: normal * (T::one() - rise_mm * per_axis),
            normal,
            curvature: Curvature {
                xx: y * y * per_axis,
                yy: x * x * per_axis,
                zz: T::zero(),
                xy: -(x * y * per_axis),
                xz: T::zero(),
                yz: T::zero(),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Vec3, geometry::surface_sample::tests::check_derivatives};

    #[test]
    fn gradient_and_curvature_are_derivatives() {
        let cylinder = Cylinder { radius_mm: 20.0 };
        for point in [Vec3::new(3.0, -19.5, 7.0), Vec3::new(-12.0, -15.0, -40.0)] {
            check_derivatives(|p| cylinder.sample(p, 0.05), point, 1e-8);
        }
    }

    #[test]
    fn verify_gap_is_the_distance_from_the_axis_less_the_radius() {
        let cylinder = Cylinder { radius_mm: 20.0 };
        assert_eq!(cylinder.gap_mm(&Vec3::new(-15.0, -20.0, 33.0)), 5.0);
    }
}
