//! The generic femoral component: two condyles, each of two pieces of torus.

mod triangles;

use super::{curvature_bounds::CurvatureBounds, surface_sample::SurfaceSample, torus::Torus};
use crate::{Vec3, Vector, number::Number};

/// Measures of the generic femoral component, mm and degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GenericFemurShape {
    /// Sagittal radius of the distal arc.
    pub distal_radius_mm: f64,
    /// Sagittal radius of the posterior arc.
    pub posterior_radius_mm: f64,
    /// How far behind straight down the distal arc passes into the posterior one.
    pub transition_deg: f64,
    /// Radius of the condyles across, in the frontal plane.
    pub coronal_radius_mm: f64,
    /// Distance between the two condyles' lowest points.
    pub spacing_mm: f64,
}

impl Default for GenericFemurShape {
    fn default() -> Self {
        Self {
            distal_radius_mm: 38.0,
            posterior_radius_mm: 22.0,
            transition_deg: 20.0,
            coronal_radius_mm: 24.0,
            spacing_mm: 46.0,
        }
    }
}

/// The generic femoral component in its own frame: origin on the axis of the posterior arc,
/// half-way between the condyles, about which it flexes.
///
/// In the sagittal plane the distal arc and the posterior arc share a tangent where they meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GenericFemur {
    shape: GenericFemurShape,
    /// The lateral condyle's pieces, with the condyle's middle plane at z = 0.
    distal: Torus,
    posterior: Torus,
    /// Direction from either arc's centre to where they meet.
    transition: Vec3,
    half_spacing_mm: f64,
}

impl GenericFemur {
    /// The component of the given measures, all > 0.
    pub fn new(shape: GenericFemurShape) -> Self {
        let (sine, cosine) = shape.transition_deg.to_radians().sin_cos();
        let transition = Vec3::new(-sine, -cosine, 0.0);
        let torus = |centre, sagittal_radius_mm: f64| Torus {
            centre,
            ring_radius_mm: sagittal_radius_mm - shape.coronal_radius_mm,
            tube_radius_mm: shape.coronal_radius_mm,
        };
        let distal_centre = -transition * (shape.distal_radius_mm - shape.posterior_radius_mm);
        Self {
            shape,
            distal: torus(distal_centre, shape.distal_radius_mm),
            posterior: torus(Vec3::zeros(), shape.posterior_radius_mm),
            transition,
            half_spacing_mm: shape.spacing_mm / 2.0,
        }
    }

    /// Its measures.
    pub fn shape(&self) -> &GenericFemurShape {
        &self.shape
    }

    /// Largest curvature of the surface, 1/mm.
    pub fn max_curvature_per_mm(&self) -> f64 {
        let shape = &self.shape;
        1.0 / shape
            .coronal_radius_mm
            .min(shape.posterior_radius_mm)
            .min(shape.distal_radius_mm)
    }

    /// Bounds around points: each condyle is convex, so they hold as far as the plane half-way to
    /// the other one.
    #[inline(always)]
    pub fn curvature_bounds<T: Number>(&self, points: &Vector<T>) -> CurvatureBounds {
        let radius_mm = points.z.abs().least().min(CurvatureBounds::FARTHEST_MM);
        CurvatureBounds::convex(self.max_curvature_per_mm(), radius_mm)
    }

    /// How far from the origin the component reaches at most, mm.
    pub fn reach_mm(&self) -> f64 {
        self.distal.centre.norm() + self.shape.distal_radius_mm + self.half_spacing_mm
    }

    /// Gap at a point, mm.
    #[inline(always)]
    pub fn gap_mm<T: Number>(&self, point: &Vector<T>) -> T {
        let (folded, _) = self.folded(point);
        self.piece(&folded).gap_mm(&folded)
    }

    /// Gap, normal and curvature at a point, the gap averaged as
    /// [`FemoralSurface::sample`](super::FemoralSurface::sample) says.
    #[inline(always)]
    pub fn sample<T: Number>(&self, point: &Vector<T>, spread_mm2: T) -> SurfaceSample<T> {
        let (folded, side) = self.folded(point);
        let mut sample = self.piece(&folded).sample(&folded, spread_mm2);
        sample.gap_gradient.z *= side;
        sample.normal.z *= side;
        sample.curvature.xz *= side;
        sample.curvature.yz *= side;
        sample
    }

    /// The point moved to the lateral condyle's middle plane, and the side it came from.
    #[inline(always)]
    fn folded<T: Number>(&self, point: &Vector<T>) -> (Vector<T>, T) {
        let side = point.z.below_zero(-T::one(), T::one());
        let across = point.z.abs() - T::splat(self.half_spacing_mm);
        (Vector::new(point.x, point.y, across), side)
    }

    /// The piece on whose side of the line through both centres a point lies.
    #[inline(always)]
    fn piece<T: Number>(&self, point: &Vector<T>) -> Torus<T> {
        let in_front =
            T::splat(self.transition.x) * point.y - T::splat(self.transition.y) * point.x;
        let pick = |posterior: f64, distal: f64| {
            in_front.below_zero(T::splat(posterior), T::splat(distal))
        };
        let (posterior, distal) = (&self.posterior, &self.distal);
        Torus {
            centre: Vector::new(
                pick(posterior.centre.x, distal.centre.x),
                pick(posterior.centre.y, distal.centre.y),
                T::zero(),
            ),
            ring_radius_mm: pick(posterior.ring_radius_mm, distal.ring_radius_mm),
            tube_radius_mm: T::splat(distal.tube_radius_mm),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::surface_sample::tests::check_derivatives;

    fn femur() -> GenericFemur {
        GenericFemur::new(GenericFemurShape::default())
    }

    #[test]
    fn verify_lowest_points_of_both_arcs() {
        // The distal centre lies 16 mm from the origin, opposite to the transition.
        let (sine, cosine) = 20f64.to_radians().sin_cos();
        let distal = Vec3::new(16.0 * sine, 16.0 * cosine - 38.0, 23.0);
        assert!(femur().gap_mm(&distal).abs() < 1e-12);
        let posterior = Vec3::new(-22.0, 0.0, -23.0);
        assert!(femur().gap_mm(&posterior).abs() < 1e-12);
    }

    #[test]
    fn arcs_meet_with_one_tangent() {
        let along = Vec3::new(-0.342_020_143_325_668_7, -0.939_692_620_785_908_4, 0.0);
        let across = Vec3::new(along.y, -along.x, 0.0) * 1e-9;
        for z in [20.0, 23.0, 30.0] {
            let at = |shift: Vec3| femur().sample(&(along * 22.0 + shift + Vec3::z() * z), 0.0);
            let (one, other) = (at(across), at(-across));
            assert!((one.gap_mm - other.gap_mm).abs() < 1e-8);
            assert!((one.normal - other.normal).norm() < 1e-8);
        }
    }

    #[test]
    fn derivatives_hold_on_both_condyles_and_arcs() {
        let points = [
            [9.0, -22.0, 25.0],
            [9.0, -22.0, -21.0],
            [-15.0, -16.0, -26.0],
            [-15.0, -16.0, 20.0],
        ];
        for point in points.map(Vec3::from) {
            check_derivatives(|p| femur().sample(p, 0.04), point, 1e-8);
        }
    }
}
