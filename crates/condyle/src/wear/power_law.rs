//! Powers of pressure and cross-shear, calibrated on tests in laboratories.

use std::sync::Arc;

use super::law::{CIRCLE_FACTOR, NodeWear, WearLaw, WearLawKind, first_times};
use super::{MM_PER_M, MeanCycle};
use crate::parameter::{Known, Parameter};

/// Cross-shear ratio of the circular path that the wear factor refers to.
const CIRCLE_CROSS_SHEAR: f64 = 0.5;

pub(super) const KIND: WearLawKind = WearLawKind {
    word: "power-law",
    about: "Depth per cycle = k g(CS) / g(0.5) sum of p |ds| (p / p0)^-m, g = f + (1 - f) (CS / (CS + c))^b of the \
        cycle's cross-shear ratio CS: f on a line, growing with the power b of CS below c, about 1 above.",
    known: Known::Chosen,
    parameters: &[
        Parameter {
            default: 1.57e-6,
            source: "choice",
            known: Known::Chosen,
            ..CIRCLE_FACTOR
        },
        Parameter {
            name: "reference_pressure_mpa",
            about: "Pressure p0 at which the wear factor on a circle applies.",
            default: 1.1,
            least: 1e-3,
            most: 1000.0,
            source: "saikko2005",
            known: Known::Approximate,
        },
        Parameter {
            name: "pressure_exponent",
            about: "Power m by which the wear factor falls with pressure: 0 is Archard's law, at 1 the depth does not \
                depend on pressure.",
            default: 0.43,
            least: 0.0,
            most: 1.0,
            ..FITTED
        },
        Parameter {
            name: "cross_shear_exponent",
            about: "Power b of cross-shear where there is little.",
            default: 1.0,
            least: 0.0,
            most: 5.0,
            ..FITTED
        },
        Parameter {
            name: "cross_shear_saturation",
            about: "Cross-shear ratio c above which more cross-shear adds little; 1000 gives a plain power.",
            default: 0.03,
            least: 1e-6,
            most: 1000.0,
            ..FITTED
        },
        Parameter {
            name: "line_factor_ratio",
            about: "Part f of the wear at saturated cross-shear that remains on a line.",
            default: 0.026,
            least: 0.0,
            most: 1.0,
            ..FITTED
        },
    ],
    scaled: |constants, times| first_times(1, constants, times),
    make: |constants| {
        let law = PowerLaw {
            factor_mm3_per_nm: 1.0,
            pressure_exponent: constants[2],
            cross_shear_exponent: constants[3],
            cross_shear_saturation: constants[4],
            line_factor_ratio: constants[5],
        };
        let at_1_mpa = constants[0] * constants[1].powf(constants[2]);
        Arc::new(PowerLaw {
            factor_mm3_per_nm: at_1_mpa / law.cross_shear_effect(CIRCLE_CROSS_SHEAR),
            ..law
        })
    },
};

/// The values that its fitted constants share: defaults are rounded medians of the posterior that the book documents
/// with the prediction.
const FITTED: Parameter = Parameter {
    name: "",
    about: "",
    default: 0.0,
    least: 0.0,
    most: 0.0,
    source: "choice",
    known: Known::Chosen,
};

#[derive(Debug)]
struct PowerLaw {
    /// Factor at 1 MPa and saturated cross-shear.
    factor_mm3_per_nm: f64,
    pressure_exponent: f64,
    cross_shear_exponent: f64,
    cross_shear_saturation: f64,
    line_factor_ratio: f64,
}

impl PowerLaw {
    /// Returns the wear at this cross-shear ratio over that at a ratio far above saturation.
    fn cross_shear_effect(&self, cross_shear: f64) -> f64 {
        let saturated = cross_shear / (cross_shear + self.cross_shear_saturation);
        let floor = self.line_factor_ratio;
        floor + (1.0 - floor) * saturated.powf(self.cross_shear_exponent)
    }
}

impl WearLaw for PowerLaw {
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear {
        let mut work = 0.0;
        // `for_each` and not `for`: the chained iterators of all activities run faster from inside.
        cycle.moments().for_each(|(share, moment)| {
            // p |ds| p^-m, which vanishes with the pressure even where p^-m does not exist.
            if moment.pressure_mpa > 0.0 {
                work += share
                    * moment.pressure_mpa.powf(1.0 - self.pressure_exponent)
                    * moment.distance_mm();
            }
        });
        let effect = self.cross_shear_effect(cycle.slip_work.cross_shear());
        NodeWear::of_depth(self.factor_mm3_per_nm / MM_PER_M * effect * work)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{assert_near, circle, depth_mm, rectangle, straight, turned};
    use super::*;

    const FACTOR: f64 = 1.63e-6;

    #[test]
    fn verify_depth_on_paths_with_closed_forms() {
        let law = KIND.law(&[FACTOR, 1.1, 0.5, 0.7, 0.02, 0.04]);
        let effect = |cs: f64| 0.04 + 0.96 * (cs / (cs + 0.02)).powf(0.7);
        for (pressure, degrees) in [(1.1, 0.0), (4.4, 33.0), (30.0, 120.0)] {
            let depth = |path: Vec<_>| depth_mm(law.as_ref(), &turned(&path, degrees));
            // Pressure times a path of 20 mm in N m/mm2, times the factor at that pressure.
            let on_circle = 0.02 * pressure * FACTOR * (1.1_f64 / pressure).sqrt();
            assert_near(depth(circle(pressure, 20.0)), on_circle);
            let on_rectangle = on_circle * effect(0.1) / effect(0.5);
            assert_near(depth(rectangle(pressure, [9.0, 1.0])), on_rectangle);
            let on_line = on_circle * effect(0.0) / effect(0.5);
            // A turned line has a cross-shear of rounding, 1e-16, of which this is the power.
            let error = depth(straight(pressure, [20.0, 0.0])) / on_line - 1.0;
            assert!(error.abs() < 1e-6, "{error:e}");
        }
    }

    #[test]
    fn verify_exponents_of_0_are_archards_law_and_a_large_saturation_a_plain_power() {
        let path = [rectangle(3.0, [3.0, 1.0]), rectangle(8.0, [3.0, 1.0])].concat();
        let archard = KIND.law(&[2.64e-7, 1.1, 0.0, 0.0, 0.03, 0.0]);
        assert_near(depth_mm(archard.as_ref(), &path), 2.64e-7 * 0.088);
        let plain = KIND.law(&[FACTOR, 1.1, 0.0, 0.3, 1000.0, 0.0]);
        let power = depth_mm(plain.as_ref(), &path) / (FACTOR * 0.088);
        assert!((power / 0.5_f64.powf(0.3) - 1.0).abs() < 1e-3, "{power}");
    }

    #[test]
    fn nothing_wears_where_nothing_presses_or_slides() {
        let law = KIND.law(&[FACTOR, 1.1, 1.0, 1.0, 0.03, 0.1]);
        assert_eq!(depth_mm(law.as_ref(), &rectangle(0.0, [1.0, 1.0])), 0.0);
        assert_eq!(depth_mm(law.as_ref(), &rectangle(5.0, [0.0, 0.0])), 0.0);
    }
}
