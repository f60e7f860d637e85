//! A torus and a cylinder about an axis along z.

use super::surface_sample::{Curvature, SurfaceSample};
use crate::{Vec3, Vector, number::Number};

/// The outer side of a torus about an axis along z; with a ring radius of 0, a ball.
///
/// ```
/// use condyle::{Vec3, geometry::Torus};
///
/// let ball = Torus::sphere(Vec3::new(0.0, 24.0, 0.0), 24.0);
/// let sample = ball.sample(&Vec3::new(0.0, -0.5, 0.0), 0.0);
/// assert!((sample.gap_mm - 0.5).abs() < 1e-12);
/// assert!((sample.normal - Vec3::new(0.0, -1.0, 0.0)).norm() < 1e-12);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus<T: Number = f64> {
    /// Centre of the torus, mm.
    pub centre: Vector<T>,
    /// Distance from the axis to the circle of tube centres, mm; negative for a spindle.
    pub ring_radius_mm: T,
    /// Radius of the tube, mm.
    pub tube_radius_mm: T,
}

impl Torus {
    /// Creates a ball.
    pub fn sphere(centre: Vec3, radius_mm: f64) -> Self {
        Self {
            centre,
            ring_radius_mm: 0.0,
            tube_radius_mm: radius_mm,
        }
    }

    /// Returns the torus in every lane.
    #[inline(always)]
    pub fn splat<T: Number>(&self) -> Torus<T> {
        Torus {
            centre: self.centre.map(T::splat),
            ring_radius_mm: T::splat(self.ring_radius_mm),
            tube_radius_mm: T::splat(self.tube_radius_mm),
        }
    }
}

impl<T: Number> Torus<T> {
    /// Returns the gap at a point, mm.
    #[inline(always)]
    pub fn gap_mm(&self, point: &Vector<T>) -> T {
        let r = point - self.centre;
        let across = (r.x * r.x + r.y * r.y).sqrt() - self.ring_radius_mm;
        (across * across + r.z * r.z).sqrt() - self.tube_radius_mm
    }

    /// Returns gap, normal and curvature at a point, the gap averaged as in
    /// [`Counterface::sample`](super::Counterface::sample).
    ///
    /// With $t$ the distance from the circle of tube centres, $\rho$ that from the axis, $\rho_0$ the
    /// ring's, $n$ the normal and $e$ along the ring, the curvature is
    /// $K = \frac{1}{t} \left(I - n n^T - \frac{\rho_0}{\rho} e e^T\right)$ and
    /// $\operatorname{div} n = \frac{1}{t} \left(2 - \frac{\rho_0}{\rho}\right)$.
    #[inline(always)]
    pub fn sample(&self, point: &Vector<T>, spread_mm2: T) -> SurfaceSample<T> {
        let r = point - self.centre;
        let from_axis = (r.x * r.x + r.y * r.y).sqrt();
        let per_axis = T::one() / from_axis;
        let (outward_x, outward_y) = (r.x * per_axis, r.y * per_axis);
        let across = from_axis - self.ring_radius_mm;
        let from_tube = (across * across + r.z * r.z).sqrt();
        let per_tube = T::one() / from_tube;
        let radial = across * per_tube;
        let normal = Vector::new(outward_x * radial, outward_y * radial, r.z * per_tube);
        let ring = self.ring_radius_mm * per_axis;
        // The mean of the gap over a flat share is g + spread div n: of the share's second moment M
        // only the trace counts, as if the share were a square, since g + K:M/2 with M = 2 spread
        // (I - n n') gives the same. Its gradient includes the derivatives of div n.
        let divergence = (T::splat(2.0) - ring) * per_tube;
        let inward = -(divergence * per_tube * spread_mm2);
        let outward = ring * per_axis * per_tube * spread_mm2;
        let lean = Vector::new(outward_x * outward, outward_y * outward, T::zero());
        SurfaceSample {
            gap_mm: from_tube - self.tube_radius_mm + spread_mm2 * divergence,
            gap_gradient: normal + normal * inward + lean,
            normal,
            curvature: Curvature {
                xx: (T::one() - normal.x * normal.x - ring * outward_y * outward_y) * per_tube,
                yy: (T::one() - normal.y * normal.y - ring * outward_x * outward_x) * per_tube,
                zz: (T::one() - normal.z * normal.z) * per_tube,
                xy: (ring * outward_x * outward_y - normal.x * normal.y) * per_tube,
                xz: -(normal.x * normal.z * per_tube),
                yz: -(normal.y * normal.z * per_tube),
            },
        }
    }
}

/// An infinite cylinder about the z axis of the counterface frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cylinder {
    /// Radius, mm.
    pub radius_mm: f64,
}

impl Cylinder {
    /// Returns the gap at a point, mm.
    #[inline(always)]
    pub fn gap_mm<T: Number>(&self, point: &Vector<T>) -> T {
        (point.x * point.x + point.y * point.y).sqrt() - T::splat(self.radius_mm)
    }

    /// Returns gap, normal and curvature at a point, the gap averaged as in
    /// [`Counterface::sample`](super::Counterface::sample).
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
    use crate::geometry::tests::check_derivatives;

    #[test]
    fn gradient_and_curvature_are_derivatives() {
        let tori = [
            Torus {
                centre: Vec3::new(1.0, 2.0, 23.0),
                ring_radius_mm: 14.0,
                tube_radius_mm: 24.0,
            },
            Torus {
                centre: Vec3::zeros(),
                ring_radius_mm: -2.0,
                tube_radius_mm: 24.0,
            },
            Torus::sphere(Vec3::new(0.0, 1.0, 0.0), 24.0),
        ];
        for torus in tori {
            for point in [Vec3::new(5.0, -35.0, 20.0), Vec3::new(-12.0, -20.0, 30.0)] {
                check_derivatives(|p| torus.sample(p, 0.05), point, 1e-8);
            }
        }
    }

    #[test]
    fn verify_mean_gap_of_a_share_of_a_ball() {
        let ball = Torus::sphere(Vec3::zeros(), 24.0);
        let (h, n) = (1.0, 400);
        let mut mean = 0.0;
        for i in 0..n {
            for j in 0..n {
                let place = |k: i32| (f64::from(k) + 0.5) / f64::from(n) * h - h / 2.0;
                mean += ball.gap_mm(&Vec3::new(place(i), -23.8, place(j)));
            }
        }
        mean /= f64::from(n * n);
        let sample = ball.sample(&Vec3::new(0.0, -23.8, 0.0), h * h / 24.0);
        assert!(
            (mean - sample.gap_mm).abs() < 1e-6,
            "{mean} {}",
            sample.gap_mm
        );
    }

    #[test]
    fn gradient_and_curvature_of_a_cylinder_are_derivatives() {
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
