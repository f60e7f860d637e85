//! The check of surfaces against their differences.

use super::SurfaceSample;
use crate::Vec3;

/// Compares gap gradient and curvature of a surface with central differences at `point`.
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
