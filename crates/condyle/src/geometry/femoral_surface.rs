//! The femoral surface as the contact sees it.

use super::{GenericFemur, SmoothField, Torus};
use crate::{Mat3, Vec3};

/// The femoral surface around a point of the femoral frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceSample {
    /// Mean gap over the share of the surface around the point, mm; > 0 apart.
    pub gap_mm: f64,
    /// Derivative of `gap_mm` by the point, without unit.
    pub gap_gradient: Vec3,
    /// Unit normal of the femur, outwards.
    pub normal: Vec3,
    /// Symmetric; its part along the surface is the derivative of `normal` by the point, 1/mm: the
    /// curvature of the level surface, > 0 convex.
    pub curvature: Mat3,
}

/// A femoral surface that gives gap, normal and curvature anywhere near it, smoothly.
#[derive(Clone, Debug)]
pub enum FemoralSurface {
    /// A pair of condyles made of pieces of torus.
    Generic(GenericFemur),
    /// One ball, for verification.
    Sphere(Torus),
    /// The smooth distance field of a triangle mesh.
    Mesh(SmoothField),
}

impl FemoralSurface {
    /// A ball of radius `radius_mm` about the origin.
    pub fn sphere(radius_mm: f64) -> Self {
        Self::Sphere(Torus::sphere(Vec3::zeros(), radius_mm))
    }

    /// Gap at a point, mm; far from the surface only its sign and that it is large are sure.
    #[inline]
    pub fn gap_mm(&self, point: &Vec3) -> f64 {
        match self {
            Self::Generic(femur) => femur.gap_mm(point),
            Self::Sphere(sphere) => sphere.gap_mm(point),
            Self::Mesh(field) => field.gap_mm(point),
        }
    }

    /// Gap, normal and curvature at a point.
    ///
    /// The gap is the mean over a small flat share of surface around the point: with the share's
    /// second moment M that is g + K:M/2, taken as g + `spread_mm2` div n, and exact to third
    /// order. `spread_mm2` is tr M / 4, a 24th of the area of a square share. A mesh's field holds
    /// its own spread already, see [`SmoothField::averaged_over`].
    #[inline]
    pub fn sample(&self, point: &Vec3, spread_mm2: f64) -> SurfaceSample {
        match self {
            Self::Generic(femur) => femur.sample(point, spread_mm2),
            Self::Sphere(sphere) => sphere.sample(point, spread_mm2),
            Self::Mesh(field) => field.sample(point),
        }
    }

    /// How far from the femoral frame's origin any of the femur reaches at most, mm.
    pub fn reach_mm(&self) -> f64 {
        match self {
            Self::Generic(femur) => femur.reach_mm(),
            Self::Sphere(ball) => ball.centre.norm() + ball.tube_radius_mm,
            Self::Mesh(field) => field.reach_mm(),
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
