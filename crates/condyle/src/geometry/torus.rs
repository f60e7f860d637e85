//! A torus about an axis along z.

use super::SurfaceSample;
use crate::{Mat3, Vec3};

/// The outer side of a torus about an axis along z; with a tube circle about the axis, a ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Torus {
    /// Centre of the torus, mm.
    pub centre: Vec3,
    /// Distance from the axis to the circle of tube centres, mm; negative for a spindle.
    pub ring_radius_mm: f64,
    /// Radius of the tube, mm.
    pub tube_radius_mm: f64,
}

/// Where a point lies beside the torus.
struct Place {
    /// Unit vector from the axis to the point.
    outward: Vec3,
    /// Distance from the axis.
    from_axis: f64,
    /// Distance from the circle of tube centres.
    from_tube: f64,
    normal: Vec3,
}

impl Torus {
    /// A ball.
    pub fn sphere(centre: Vec3, radius_mm: f64) -> Self {
        Self {
            centre,
            ring_radius_mm: 0.0,
            tube_radius_mm: radius_mm,
        }
    }

    /// Gap at a point, mm.
    #[inline]
    pub fn gap_mm(&self, point: &Vec3) -> f64 {
        let r = point - self.centre;
        let across = (r.x * r.x + r.y * r.y).sqrt() - self.ring_radius_mm;
        (across * across + r.z * r.z).sqrt() - self.tube_radius_mm
    }

    /// Gap, normal and curvature at a point, the gap averaged as
    /// [`FemoralSurface::sample`](super::FemoralSurface::sample) says.
    ///
    /// With t the distance from the circle of tube centres, rho that from the axis and rho0 the
    /// ring's: K = (I - n n' - e e')/t + (1 - rho0/rho)/t e e', e along the ring, and
    /// div n = (2 - rho0/rho)/t.
    #[inline]
    pub fn sample(&self, point: &Vec3, spread_mm2: f64) -> SurfaceSample {
        let Place {
            outward,
            from_axis,
            from_tube,
            normal,
        } = self.place(point);
        let along = Vec3::new(-outward.y, outward.x, 0.0);
        let ring = self.ring_radius_mm / from_axis;
        let per_tube = 1.0 / from_tube;
        let curvature =
            (Mat3::identity() - normal * normal.transpose() - along * along.transpose() * ring)
                * per_tube;
        let divergence = (2.0 - ring) * per_tube;
        let divergence_gradient =
            normal * (-divergence * per_tube) + outward * (ring / from_axis * per_tube);
        SurfaceSample {
            gap_mm: from_tube - self.tube_radius_mm + spread_mm2 * divergence,
            gap_gradient: normal + divergence_gradient * spread_mm2,
            normal,
            curvature,
        }
    }

    #[inline]
    fn place(&self, point: &Vec3) -> Place {
        let r = point - self.centre;
        let from_axis = (r.x * r.x + r.y * r.y).sqrt();
        let outward = Vec3::new(r.x, r.y, 0.0) / from_axis;
        let across = from_axis - self.ring_radius_mm;
        let from_tube = (across * across + r.z * r.z).sqrt();
        let normal = (outward * across + Vec3::new(0.0, 0.0, r.z)) / from_tube;
        Place {
            outward,
            from_axis,
            from_tube,
            normal,
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Holds gap gradient and curvature of a surface against central differences at `point`.
    pub(crate) fn check_derivatives(
        sample: impl Fn(&Vec3) -> SurfaceSample,
        point: Vec3,
        tolerance: f64,
    ) {
        let step = 1e-5;
        let here = sample(&point);
        for axis in 0..3 {
            let shift = Vec3::ith(axis, step);
            let (fore, back) = (sample(&(point + shift)), sample(&(point - shift)));
            let slope = (fore.gap_mm - back.gap_mm) / (2.0 * step);
            assert!(
                (slope - here.gap_gradient[axis]).abs() < tolerance,
                "{slope} {here:?}"
            );
            let turn = (fore.normal - back.normal) / (2.0 * step);
            let bend: Vec3 = here.curvature.column(axis).into();
            let along_surface = bend - here.normal * here.normal.dot(&bend);
            assert!((turn - along_surface).norm() < tolerance, "{turn} {here:?}");
        }
        assert!((here.normal.norm() - 1.0).abs() < 1e-12);
    }

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
}
