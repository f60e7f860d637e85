//! The femoral surface as the contact sees it.

use super::{Cylinder, GenericFemur, SmoothField, Torus};
use crate::{
    Vec3, Vector,
    number::Number,
    number::vector::{dot, scale_add, tangential_part},
};

/// A symmetric 3 by 3 matrix, 1/mm.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "the names are the places in the matrix")]
pub struct Curvature<T> {
    pub xx: T,
    pub yy: T,
    pub zz: T,
    pub xy: T,
    pub xz: T,
    pub yz: T,
}

impl<T: Number> Curvature<T> {
    /// The matrix times a vector.
    #[inline(always)]
    pub fn times(&self, v: &Vector<T>) -> Vector<T> {
        Vector::new(
            dot(&Vector::new(self.xx, self.xy, self.xz), v),
            dot(&Vector::new(self.xy, self.yy, self.yz), v),
            dot(&Vector::new(self.xz, self.yz, self.zz), v),
        )
    }
}

/// How much sharper than the surface its level surfaces inside are, as deep as contact goes.
const DEEPER: f64 = 1.2;

/// As far as contact ever looks, mm.
pub(super) const FAR_MM: f64 = 10.0;

/// The femoral surface around a point of the femoral frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceSample<T> {
    /// Mean gap over the share of the surface around the point, mm; > 0 apart.
    pub gap_mm: T,
    /// Derivative of `gap_mm` by the point, without unit.
    pub gap_gradient: Vector<T>,
    /// Unit normal of the femur, outwards.
    pub normal: Vector<T>,
    /// Symmetric; its part along the surface is the derivative of `normal` by the point, 1/mm: the
    /// curvature of the level surface, > 0 convex.
    pub curvature: Curvature<T>,
}

impl<T: Number> SurfaceSample<T> {
    /// A sample that no surface gives: infinitely far.
    pub fn far() -> Self {
        let (zero, none) = (T::zero(), Vector::repeat(T::zero()));
        Self {
            gap_mm: T::splat(f64::INFINITY),
            gap_gradient: none,
            normal: none,
            curvature: Curvature {
                xx: zero,
                yy: zero,
                zz: zero,
                xy: zero,
                xz: zero,
                yz: zero,
            },
        }
    }

    /// The sample a short `motion` d away: g + G . d + d . K d/2, G + K d and n + (I - n n') K d.
    #[inline(always)]
    pub fn moved(&self, motion: &Vector<T>) -> Self {
        let bend = self.curvature.times(motion);
        let slope = scale_add(&bend, T::splat(0.5), &self.gap_gradient);
        Self {
            gap_mm: self.gap_mm + dot(&slope, motion),
            gap_gradient: self.gap_gradient + bend,
            normal: self.normal + tangential_part(&bend, &self.normal),
            curvature: self.curvature,
        }
    }
}

/// Bounds on the femoral surface around a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureBounds {
    /// How far from the point they hold, mm; less than 0 where nothing is known, as may be 1.5 mm
    /// from a mesh and farther.
    pub radius_mm: f64,
    /// No curvature is larger, 1/mm.
    pub max_curvature_per_mm: f64,
    /// The gap bends back zero_vector by more: no second derivative of it is below minus this, 1/mm.
    pub concavity_per_mm: f64,
    /// No curvature jumps by more, 1/mm: with it the mean gap over a share jumps.
    pub curvature_jump_per_mm: f64,
}

impl CurvatureBounds {
    /// Where nothing is known.
    pub const UNKNOWN: Self = Self {
        radius_mm: f64::NEG_INFINITY,
        max_curvature_per_mm: 0.0,
        concavity_per_mm: 0.0,
        curvature_jump_per_mm: 0.0,
    };

    /// What holds around both of two points; if nothing is known of one, around the other,
    /// but for the radius.
    #[inline(always)]
    pub fn joined(self, other: Self) -> Self {
        let larger = |a: f64, b: f64| if a > b { a } else { b };
        Self {
            radius_mm: -larger(-self.radius_mm, -other.radius_mm),
            max_curvature_per_mm: larger(self.max_curvature_per_mm, other.max_curvature_per_mm),
            concavity_per_mm: larger(self.concavity_per_mm, other.concavity_per_mm),
            curvature_jump_per_mm: larger(self.curvature_jump_per_mm, other.curvature_jump_per_mm),
        }
    }

    /// Those of a convex surface zero_vector sharper than `max_curvature_per_mm`.
    ///
    /// The distance from a convex body is convex. Its mean over a share is nearly so: it bends back
    /// by 6 spread K^3 at most, a few thousandths of K for shares of 2 mm on a ball of 20 mm.
    pub fn convex(max_curvature_per_mm: f64, radius_mm: f64) -> Self {
        Self {
            radius_mm,
            max_curvature_per_mm: DEEPER * max_curvature_per_mm,
            concavity_per_mm: 0.01 * max_curvature_per_mm,
            curvature_jump_per_mm: max_curvature_per_mm,
        }
    }
}

/// A femoral surface that gives gap, normal and curvature anywhere near it, smoothly.
#[derive(Clone, Debug)]
pub enum FemoralSurface {
    /// A pair of condyles made of pieces of torus.
    Generic(GenericFemur),
    /// One ball, for verification.
    Sphere(Torus),
    /// One cylinder about the z axis, for verification.
    Cylinder(Cylinder),
    /// The smooth distance field of a triangle mesh.
    Mesh(SmoothField),
}

impl FemoralSurface {
    /// A ball of radius `radius_mm` about the origin.
    pub fn sphere(radius_mm: f64) -> Self {
        Self::Sphere(Torus::sphere(Vec3::zeros(), radius_mm))
    }

    /// Gap at a point, mm; far from the surface only its sign and that it is large are sure.
    #[inline(always)]
    pub fn gap_mm<T: Number>(&self, point: &Vector<T>) -> T {
        match self {
            Self::Generic(femur) => femur.gap_mm(point),
            Self::Sphere(sphere) => sphere.splat().gap_mm(point),
            Self::Cylinder(cylinder) => cylinder.gap_mm(point),
            Self::Mesh(field) => field.gap_mm(point),
        }
    }

    /// Gap, normal and curvature at a point.
    ///
    /// The gap is the mean over a small flat share of surface around the point: with the share's
    /// second moment M that is g + K:M/2, taken as g + `spread_mm2` div n, and exact to third
    /// order. `spread_mm2` is tr M / 4, a 24th of the area of a square share. A mesh's field holds
    /// its own spread already, see [`SmoothField::averaged_over`].
    #[inline(always)]
    pub fn sample<T: Number>(&self, point: &Vector<T>, spread_mm2: T) -> SurfaceSample<T> {
        match self {
            Self::Generic(femur) => femur.sample(point, spread_mm2),
            Self::Sphere(sphere) => sphere.splat().sample(point, spread_mm2),
            Self::Cylinder(cylinder) => cylinder.sample(point, spread_mm2),
            Self::Mesh(field) => field.sample(point),
        }
    }

    /// How far from the femoral frame's origin any of the femur reaches at most, mm; of a cylinder,
    /// across its axis.
    pub fn reach_mm(&self) -> f64 {
        match self {
            Self::Generic(femur) => femur.reach_mm(),
            Self::Sphere(ball) => ball.centre.norm() + ball.tube_radius_mm,
            Self::Cylinder(cylinder) => cylinder.radius_mm,
            Self::Mesh(field) => field.reach_mm(),
        }
    }

    /// Bounds on the surface around points, in every lane.
    #[inline(always)]
    pub fn curvature_bounds<T: Number>(&self, points: &Vector<T>) -> CurvatureBounds {
        match self {
            Self::Generic(femur) => femur.curvature_bounds(points),
            Self::Sphere(ball) => CurvatureBounds::convex(1.0 / ball.tube_radius_mm, FAR_MM),
            Self::Cylinder(cylinder) => CurvatureBounds::convex(1.0 / cylinder.radius_mm, FAR_MM),
            Self::Mesh(field) => field.curvature_bounds(points),
        }
    }

    /// The same surface, made ready for shares of `spread_mm2`.
    pub fn prepared_for(self, spread_mm2: f64) -> Self {
        match self {
            Self::Mesh(field) => Self::Mesh(field.averaged_over(spread_mm2)),
            exact => exact,
        }
    }
}
