//! The femoral surface as the contact sees it.

use super::{Cylinder, GenericFemur, SmoothField, Torus};
use crate::{Vec3, Vector, number::Number};

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
            self.xx * v.x + self.xy * v.y + self.xz * v.z,
            self.xy * v.x + self.yy * v.y + self.yz * v.z,
            self.xz * v.x + self.yz * v.y + self.zz * v.z,
        )
    }
}

/// How much sharper than the surface its level surfaces inside are, as deep as contact goes.
const DEEPER: f64 = 1.2;

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

    /// Curvature that the surface nowhere exceeds where it articulates, 1/mm.
    ///
    /// Of a mesh it is not known: 0.2, sharper than any condyle.
    pub fn sharpest_per_mm(&self) -> f64 {
        match self {
            Self::Generic(femur) => DEEPER * femur.sharpest_per_mm(),
            Self::Sphere(ball) => DEEPER / ball.tube_radius_mm,
            Self::Cylinder(cylinder) => DEEPER / cylinder.radius_mm,
            Self::Mesh(_) => 0.2,
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
