//! What a surface is like at a point: gap, normal and curvature.

use crate::{
    Vector,
    number::{Number, dot, scale_add, tangential_part},
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
    /// Its entries xx, yy, zz, xy, xz, yz.
    #[inline(always)]
    pub fn entries(&self) -> [T; 6] {
        [self.xx, self.yy, self.zz, self.xy, self.xz, self.yz]
    }

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
    /// The gap of the point alone, of a sample that is the mean over a spread, mm.
    #[inline(always)]
    pub fn gap_at_point_mm(&self, spread_mm2: T) -> T {
        let Curvature { xx, yy, zz, .. } = self.curvature;
        self.gap_mm - spread_mm2 * (xx + yy + zz)
    }

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

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::Vec3;

    /// Holds gap gradient and curvature of a surface against central differences at `point`.
    pub(crate) fn check_derivatives(
        sample: impl Fn(&Vec3) -> SurfaceSample<f64>,
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
            let column = here.curvature.times(&Vec3::ith(axis, 1.0));
            let along_surface = column - here.normal * here.normal.dot(&column);
            assert!((turn - along_surface).norm() < tolerance, "{turn} {here:?}");
        }
        assert!((here.normal.norm() - 1.0).abs() < 1e-12);
    }
}
