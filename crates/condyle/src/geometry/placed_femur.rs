//! The generic femoral component turned and shifted in the femoral frame.

use super::{
    curvature_bounds::CurvatureBounds,
    generic_femur::GenericFemur,
    surface_sample::{Curvature, SurfaceSample},
};
use crate::{
    Mat3, Vec3, Vector,
    number::{Number, dot},
};

/// A generic femoral component at a place of its own: its point p is at R p + t in the femoral frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedFemur {
    femur: GenericFemur,
    /// R.
    rotation: Mat3,
    /// t.
    shift_mm: Vec3,
}

impl PlacedFemur {
    /// `femur` turned by `rotation`, and then shifted by `shift_mm`.
    pub fn new(femur: GenericFemur, rotation: Mat3, shift_mm: Vec3) -> Self {
        Self {
            femur,
            rotation,
            shift_mm,
        }
    }

    /// The component in its own frame.
    pub fn femur(&self) -> &GenericFemur {
        &self.femur
    }

    /// A point of the component's own frame in the femoral frame.
    pub fn to_frame(&self, point: &Vec3) -> Vec3 {
        self.rotation * point + self.shift_mm
    }

    /// How far from the origin the component reaches at most, mm.
    pub fn reach_mm(&self) -> f64 {
        self.femur.reach_mm() + self.shift_mm.norm()
    }

    /// Gap at a point, mm.
    #[inline(always)]
    pub fn gap_mm<T: Number>(&self, point: &Vector<T>) -> T {
        self.femur.gap_mm(&self.in_component(point))
    }

    /// Gap, normal and curvature at a point; with the component's own, R G, R n and R K R'.
    #[inline(always)]
    pub fn sample<T: Number>(&self, point: &Vector<T>, spread_mm2: T) -> SurfaceSample<T> {
        let own = self.femur.sample(&self.in_component(point), spread_mm2);
        let rows = self.rows();
        let turned =
            |v: &Vector<T>| Vector::new(dot(&rows[0], v), dot(&rows[1], v), dot(&rows[2], v));
        let [along_x, along_y, along_z] = rows.map(|row| own.curvature.times(&row));
        SurfaceSample {
            gap_mm: own.gap_mm,
            gap_gradient: turned(&own.gap_gradient),
            normal: turned(&own.normal),
            curvature: Curvature {
                xx: dot(&rows[0], &along_x),
                yy: dot(&rows[1], &along_y),
                zz: dot(&rows[2], &along_z),
                xy: dot(&rows[0], &along_y),
                xz: dot(&rows[0], &along_z),
                yz: dot(&rows[1], &along_z),
            },
        }
    }

    /// Bounds around points, which turn with the component.
    #[inline(always)]
    pub fn curvature_bounds<T: Number>(&self, points: &Vector<T>) -> CurvatureBounds {
        self.femur.curvature_bounds(&self.in_component(points))
    }

    /// The rows of R, in every lane.
    #[inline(always)]
    fn rows<T: Number>(&self) -> [Vector<T>; 3] {
        [0, 1, 2].map(|i| Vector::from_fn(|j, _| T::splat(self.rotation[(i, j)])))
    }

    /// R' (p - t)
    #[inline(always)]
    fn in_component<T: Number>(&self, point: &Vector<T>) -> Vector<T> {
        let from = |axis: usize| point[axis] - T::splat(self.shift_mm[axis]);
        let moved = Vector::new(from(0), from(1), from(2));
        let column = |j: usize| Vector::from_fn(|i, _| T::splat(self.rotation[(i, j)]));
        Vector::new(
            dot(&column(0), &moved),
            dot(&column(1), &moved),
            dot(&column(2), &moved),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    use crate::geometry::{GenericFemurShape, surface_sample::tests::check_derivatives};

    fn placed() -> PlacedFemur {
        let femur = GenericFemur::new(GenericFemurShape::default());
        let rotation = Rotation3::from_euler_angles(0.05, -0.08, 0.1).into_inner();
        PlacedFemur::new(femur, rotation, Vec3::new(1.0, -2.0, 0.5))
    }

    #[test]
    fn derivatives_hold_on_both_condyles() {
        for point in [[9.0, -22.0, 25.0], [-15.0, -16.0, -26.0]] {
            check_derivatives(|p| placed().sample(p, 0.04), Vec3::from(point), 1e-8);
        }
    }

    #[test]
    fn a_point_carried_along_keeps_its_gap() {
        let (placed, point) = (placed(), Vec3::new(9.0, -22.0, 25.0));
        let there = placed.to_frame(&point);
        let gap = placed.femur().gap_mm(&point);
        assert!((placed.gap_mm(&there) - gap).abs() < 1e-12);
        assert!(there.norm() < placed.reach_mm());
    }
}
