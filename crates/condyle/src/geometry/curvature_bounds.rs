//! Bounds on a femoral surface around a point: how far a sample there tells of the rest.

use crate::number::Number;

/// The slope of a gap is never larger, without unit.
///
/// A distance has slope 1. The field of a mesh is a distance only nearly, since a spline runs
/// between the gaps at its nodes.
pub const MAX_GAP_SLOPE: f64 = 1.05;

/// How much sharper than the surface its level surfaces inside are, as deep as contact goes.
const SHARPER_INSIDE: f64 = 1.2;

/// Second derivatives of the mean gap over a share that are below zero, as a part of the largest
/// curvature of a convex surface.
const CONCAVITY_OF_MEANS: f64 = 0.01;

/// Bounds on the femoral surface around a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureBounds {
    /// How far from the point they hold, mm; less than 0 where nothing is known, as may be
    /// [`CurvatureBounds::KNOWN_GAP_MM`] from a mesh and farther.
    pub radius_mm: f64,
    /// No curvature is larger, 1/mm.
    pub max_curvature_per_mm: f64,
    /// How far the gap is from convex: no second derivative of it is below minus this, 1/mm.
    pub concavity_per_mm: f64,
    /// No curvature jumps by more, 1/mm: with it the mean gap over a share jumps.
    pub curvature_jump_per_mm: f64,
}

impl CurvatureBounds {
    /// As far as contact ever asks, mm: bounds that hold everywhere hold so far.
    pub const FARTHEST_MM: f64 = 10.0;

    /// Where the gap is smaller, any surface has bounds, mm.
    pub const KNOWN_GAP_MM: f64 = 1.5;

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
        let larger = <f64 as Number>::max;
        Self {
            radius_mm: <f64 as Number>::min(self.radius_mm, other.radius_mm),
            max_curvature_per_mm: larger(self.max_curvature_per_mm, other.max_curvature_per_mm),
            concavity_per_mm: larger(self.concavity_per_mm, other.concavity_per_mm),
            curvature_jump_per_mm: larger(self.curvature_jump_per_mm, other.curvature_jump_per_mm),
        }
    }

    /// Those of a convex surface nowhere sharper than `max_curvature_per_mm`.
    ///
    /// The distance from a convex body is convex. Its mean over a share is nearly so: its second
    /// derivatives go below zero by 6 spread K^3 at most, a few thousandths of K for shares of
    /// 2 mm on a ball of 20 mm.
    pub fn convex(max_curvature_per_mm: f64, radius_mm: f64) -> Self {
        Self {
            radius_mm,
            max_curvature_per_mm: SHARPER_INSIDE * max_curvature_per_mm,
            concavity_per_mm: CONCAVITY_OF_MEANS * max_curvature_per_mm,
            curvature_jump_per_mm: max_curvature_per_mm,
        }
    }
}
