//! Gap, normal and curvature of a surface at a point, and bounds on them around it.

use crate::{
    Vector,
    number::{Number, dot, scale_add, tangential_part},
};

/// A symmetric 3 by 3 matrix, 1/mm.
#[derive(Clone, Copy, Debug, PartialEq)]
#[expect(missing_docs, reason = "the names are the indices in the matrix")]
pub struct Curvature<T> {
    pub xx: T,
    pub yy: T,
    pub zz: T,
    pub xy: T,
    pub xz: T,
    pub yz: T,
}

impl<T: Number> Curvature<T> {
    /// Returns the entries xx, yy, zz, xy, xz, yz.
    #[inline(always)]
    pub(super) fn entries(&self) -> [T; 6] {
        [self.xx, self.yy, self.zz, self.xy, self.xz, self.yz]
    }

    /// Multiplies a vector.
    #[inline(always)]
    pub fn times(&self, v: &Vector<T>) -> Vector<T> {
        Vector::new(
            dot(&Vector::new(self.xx, self.xy, self.xz), v),
            dot(&Vector::new(self.xy, self.yy, self.yz), v),
            dot(&Vector::new(self.xz, self.yz, self.zz), v),
        )
    }
}

/// The counterface around a point of the counterface frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceSample<T> {
    /// Mean gap over the share of the surface around the point, mm; > 0 apart.
    pub gap_mm: T,
    /// Derivative of `gap_mm` by the point, without unit.
    pub gap_gradient: Vector<T>,
    /// Unit normal of the counterface, outwards.
    pub normal: Vector<T>,
    /// Symmetric; its part along the surface is the derivative of `normal` by the point, 1/mm: the
    /// curvature of the level surface, > 0 convex.
    pub curvature: Curvature<T>,
}

impl<T: Number> SurfaceSample<T> {
    /// Returns the gap at the point itself, of a sample that is the mean over a spread, mm.
    #[inline(always)]
    pub(crate) fn gap_at_point_mm(&self, spread_mm2: T) -> T {
        let Curvature { xx, yy, zz, .. } = self.curvature;
        self.gap_mm - spread_mm2 * (xx + yy + zz)
    }

    /// Creates a sample infinitely far from any surface.
    pub(crate) fn far() -> Self {
        Self::flat(T::splat(f64::INFINITY), Vector::repeat(T::zero()))
    }

    /// Creates a sample `gap_mm` below a plane that faces down.
    #[inline(always)]
    pub(super) fn of_plane(gap_mm: T) -> Self {
        let down = Vector::new(T::zero(), T::splat(-1.0), T::zero());
        Self::flat(gap_mm, down)
    }

    #[inline(always)]
    fn flat(gap_mm: T, normal: Vector<T>) -> Self {
        let zero = T::zero();
        Self {
            gap_mm,
            gap_gradient: normal,
            normal,
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

    /// Extrapolates the sample by a short `motion` d: g + G . d + d . K d/2, G + K d and n + (I - n n') K d.
    #[inline(always)]
    pub(crate) fn moved(&self, motion: &Vector<T>) -> Self {
        let turn = self.curvature.times(motion);
        let slope = scale_add(&turn, T::splat(0.5), &self.gap_gradient);
        Self {
            gap_mm: self.gap_mm + dot(&slope, motion),
            gap_gradient: self.gap_gradient + turn,
            normal: self.normal + tangential_part(&turn, &self.normal),
            curvature: self.curvature,
        }
    }
}

/// Upper bound of the slope of a gap.
///
/// A distance has slope 1. The field of a mesh is only nearly a distance, since it is a spline between the gaps
/// at its nodes.
pub(crate) const MAX_GAP_SLOPE: f64 = 1.05;

/// Curvature of the level surfaces inside over that of the surface, as deep as contact reaches.
const SHARPER_INSIDE: f64 = 1.2;

/// Largest negative second derivative of the mean gap over a share, as a part of the largest
/// curvature of a convex surface.
const CONCAVITY_OF_MEANS: f64 = 0.01;

/// Bounds on the counterface around a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CurvatureBounds {
    /// Distance from the point within which they hold, mm; negative where nothing is known, which is possible
    /// [`CurvatureBounds::KNOWN_GAP_MM`] or more away from a mesh.
    pub radius_mm: f64,
    /// Upper bound of the curvature, 1/mm.
    pub max_curvature_per_mm: f64,
    /// Bound of the deviation from a convex gap: no second derivative is below minus this, 1/mm.
    pub concavity_per_mm: f64,
    /// Upper bound of a jump of the curvature, 1/mm: the mean gap over a share jumps with it.
    pub curvature_jump_per_mm: f64,
}

impl CurvatureBounds {
    /// Radius of bounds that hold everywhere, mm: beyond any search of the contact.
    pub const FARTHEST_MM: f64 = 10.0;

    /// Gap below which any surface has bounds, mm.
    pub const KNOWN_GAP_MM: f64 = 1.5;

    /// No bounds.
    pub const UNKNOWN: Self = Self {
        radius_mm: f64::NEG_INFINITY,
        max_curvature_per_mm: 0.0,
        concavity_per_mm: 0.0,
        curvature_jump_per_mm: 0.0,
    };

    /// Returns the bounds that hold around both of two points; if one has none, those of the other except for the
    /// radius.
    #[inline(always)]
    pub fn joined(self, other: Self) -> Self {
        // The maximum of `Number` and not of f64: one instruction, and no NaN occurs.
        let larger = <f64 as Number>::max;
        Self {
            radius_mm: <f64 as Number>::min(self.radius_mm, other.radius_mm),
            max_curvature_per_mm: larger(self.max_curvature_per_mm, other.max_curvature_per_mm),
            concavity_per_mm: larger(self.concavity_per_mm, other.concavity_per_mm),
            curvature_jump_per_mm: larger(self.curvature_jump_per_mm, other.curvature_jump_per_mm),
        }
    }

    /// Creates the bounds of a convex surface with curvatures up to `max_curvature_per_mm`.
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
