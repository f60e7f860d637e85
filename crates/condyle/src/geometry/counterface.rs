//! The counterface as the contact sees it: one of several shapes.

use super::{
    generic_femur::{GenericFemur, PlacedFemur},
    smooth_field::SmoothField,
    surface_sample::{CurvatureBounds, SurfaceSample},
    torus::{Cylinder, Torus},
};
use crate::{Vec3, Vector, number::Number};

/// A counterface that gives gap, normal and curvature anywhere near it, smoothly.
///
/// Clones share large arrays.
#[derive(Clone, Debug)]
pub enum Counterface {
    /// A pair of condyles made of pieces of torus.
    Generic(GenericFemur),
    /// A generic pair, rotated and shifted in the counterface frame.
    Placed(PlacedFemur),
    /// One ball, for verification.
    Sphere(Torus),
    /// One cylinder about the z axis, for verification.
    Cylinder(Cylinder),
    /// The plane y = 0 of the counterface frame with the body above it: the disc of a pin-on-disc machine.
    Plane,
    /// The smooth distance field of a triangle mesh.
    Mesh(SmoothField),
}

impl Counterface {
    /// Creates a ball of radius `radius_mm` about the origin.
    pub fn sphere(radius_mm: f64) -> Self {
        Self::Sphere(Torus::sphere(Vec3::zeros(), radius_mm))
    }

    /// Returns the gap at a point, mm; far from the surface a lower bound of its magnitude with the right sign.
    #[inline(always)]
    pub fn gap_mm<T: Number>(&self, point: &Vector<T>) -> T {
        match self {
            Self::Generic(counterface) => counterface.gap_mm(point),
            Self::Placed(counterface) => counterface.gap_mm(point),
            Self::Sphere(sphere) => sphere.splat().gap_mm(point),
            Self::Cylinder(cylinder) => cylinder.gap_mm(point),
            Self::Plane => -point.y,
            Self::Mesh(field) => field.gap_mm(point),
        }
    }

    /// Returns gap, normal and curvature at a point.
    ///
    /// The gap is the mean over a small flat share of surface around the point: with the share's
    /// second moment M that is g + K:M/2, taken as g + `spread_mm2` div n, and exact to third
    /// order. `spread_mm2` is tr M / 4, a 24th of the area of a square share. A mesh's field includes
    /// its own spread already.
    #[inline(always)]
    pub fn sample<T: Number>(&self, point: &Vector<T>, spread_mm2: T) -> SurfaceSample<T> {
        match self {
            Self::Generic(counterface) => counterface.sample(point, spread_mm2),
            Self::Placed(counterface) => counterface.sample(point, spread_mm2),
            Self::Sphere(sphere) => sphere.splat().sample(point, spread_mm2),
            Self::Cylinder(cylinder) => cylinder.sample(point, spread_mm2),
            Self::Plane => SurfaceSample::of_plane(-point.y),
            Self::Mesh(field) => field.sample(point),
        }
    }

    /// Returns the spread over which all its samples are averaged, mm2; see [`Counterface::prepared_for`].
    pub(crate) fn prepared_spread_mm2(&self) -> f64 {
        match self {
            Self::Mesh(field) => field.spread_mm2,
            _ => 0.0,
        }
    }

    /// Returns the largest distance of the counterface from the counterface frame's origin, mm; of a cylinder,
    /// across its axis.
    pub fn reach_mm(&self) -> f64 {
        match self {
            Self::Generic(counterface) => counterface.reach_mm(),
            Self::Placed(counterface) => counterface.reach_mm(),
            Self::Sphere(ball) => ball.centre.norm() + ball.tube_radius_mm,
            Self::Cylinder(cylinder) => cylinder.radius_mm,
            // It has no end; the approach starts this far above the highest node.
            Self::Plane => 1.0,
            Self::Mesh(field) => field.reach_mm(),
        }
    }

    /// Returns the largest distance between the surface and the triangles that it is made from next to a point, mm; 0 of
    /// a shape by dimensions.
    pub fn deviation_mm(&self, point: &Vec3) -> f64 {
        match self {
            Self::Mesh(field) => field.deviation_mm(point),
            _ => 0.0,
        }
    }

    /// Returns bounds on the surface around points, in every lane.
    #[inline(always)]
    pub(crate) fn curvature_bounds<T: Number>(&self, points: &Vector<T>) -> CurvatureBounds {
        match self {
            Self::Generic(counterface) => counterface.curvature_bounds(points),
            Self::Placed(counterface) => counterface.curvature_bounds(points),
            Self::Sphere(ball) => {
                CurvatureBounds::convex(1.0 / ball.tube_radius_mm, CurvatureBounds::FARTHEST_MM)
            }
            Self::Cylinder(cylinder) => {
                CurvatureBounds::convex(1.0 / cylinder.radius_mm, CurvatureBounds::FARTHEST_MM)
            }
            Self::Plane => CurvatureBounds::convex(0.0, CurvatureBounds::FARTHEST_MM),
            Self::Mesh(field) => field.curvature_bounds(points),
        }
    }

    /// Returns the surface prepared for shares with a further spread of `spread_mm2`.
    pub fn prepared_for(&self, spread_mm2: f64) -> Self {
        match self {
            Self::Mesh(field) => Self::Mesh(field.averaged_over(spread_mm2)),
            exact => exact.clone(),
        }
    }
}
