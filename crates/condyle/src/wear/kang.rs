//! A wear factor that depends on cross-shear and pressure: Kang 2008.

use std::sync::Arc;

use super::law::{NodeWear, WearLaw, WearLawKind};
use super::{MM_PER_M, MeanCycle};
use crate::parameter::{Known, Parameter};

pub(super) const KIND: WearLawKind = WearLawKind {
    word: "kang",
    about: "Depth per cycle = sum of K p |ds|, K = exp(a + b ln CS - c p) in mm3/(N m), with p in K the mean \
        over the slip, at most `most_pressure_mpa`, and the cycle's cross-shear ratio CS, at least `least_cross_shear`.",
    known: Known::Approximate,
    parameters: &[
        Parameter {
            name: "log_wear_factor",
            about: "Constant a: the logarithm of the wear factor in mm3/(N m) at CS = 1 and no pressure.",
            default: -13.1,
            least: -30.0,
            most: 0.0,
            source: "kang2008",
            known: Known::Approximate,
        },
        Parameter {
            name: "cross_shear_exponent",
            about: "Constant b: the power of the cross-shear ratio.",
            default: 0.19,
            least: 0.0,
            most: 5.0,
            source: "kang2008",
            known: Known::Approximate,
        },
        Parameter {
            name: "decay_per_mpa",
            about: "Constant c: relative decrease of the wear factor with pressure.",
            default: 0.29,
            least: 0.0,
            most: 5.0,
            source: "kang2008",
            known: Known::Approximate,
        },
        Parameter {
            name: "least_cross_shear",
            about: "Smallest cross-shear ratio in the formula; smaller ratios count as this one.",
            default: 0.01,
            least: 1e-6,
            most: 0.5,
            source: "choice",
            known: Known::Chosen,
        },
        Parameter {
            name: "most_pressure_mpa",
            about: "Pressure at which the wear factor stops falling: higher pressures have the factor of this one.",
            default: 10.0,
            least: 0.0,
            most: 1000.0,
            source: "choice",
            known: Known::Chosen,
        },
    ],
    scaled: |constants, times| {
        let mut scaled = constants.to_vec();
        scaled[0] += times.ln();
        scaled
    },
    make: |constants| {
        Arc::new(Kang {
            log_wear_factor: constants[0],
            cross_shear_exponent: constants[1],
            decay_per_mpa: constants[2],
            least_cross_shear: constants[3],
            most_pressure_mpa: constants[4],
        })
    },
};

#[derive(Debug)]
struct Kang {
    log_wear_factor: f64,
    cross_shear_exponent: f64,
    decay_per_mpa: f64,
    least_cross_shear: f64,
    most_pressure_mpa: f64,
}

impl WearLaw for Kang {
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear {
        let cross_shear = cycle.slip_work.cross_shear();
        // The source correlates the wear of a test with its mean pressure. A share that is partly loaded has the mean of the
        // loaded part.
        let pressed_mm = cycle.pressed_distance_mm.max(f64::MIN_POSITIVE);
        let mean_mpa = cycle.pressure_slip_mpa_mm / pressed_mm;
        let is_outside = cross_shear < self.least_cross_shear || mean_mpa > self.most_pressure_mpa;
        let log_factor = self.log_wear_factor
            + self.cross_shear_exponent * cross_shear.max(self.least_cross_shear).ln()
            - self.decay_per_mpa * mean_mpa.min(self.most_pressure_mpa);
        NodeWear {
            depth_mm: log_factor.exp() / MM_PER_M * cycle.pressure_slip_mpa_mm,
            part_outside: Some(f64::from(u8::from(is_outside))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{
        assert_near, circle, depth_mm, outside, rectangle, straight, turned,
    };
    use super::*;

    fn factor(cross_shear: f64, pressure_mpa: f64) -> f64 {
        (-13.1_f64 - 0.29 * pressure_mpa).exp() * cross_shear.powf(0.19)
    }

    #[test]
    fn verify_depth_on_paths_with_closed_forms() {
        let law = KIND.with_defaults().law;
        // 5 MPa over 20 mm is 0.1 N m on each square millimetre.
        for degrees in [0.0, 33.0, 120.0] {
            let depth = |path: Vec<_>| depth_mm(law.as_ref(), &turned(&path, degrees));
            assert_near(depth(circle(5.0, 20.0)), 0.1 * factor(0.5, 5.0));
            assert_near(depth(rectangle(5.0, [5.0, 5.0])), 0.1 * factor(0.5, 5.0));
            assert_near(depth(rectangle(5.0, [9.0, 1.0])), 0.1 * factor(0.1, 5.0));
            assert_near(depth(straight(5.0, [20.0, 0.0])), 0.1 * factor(0.01, 5.0));
        }
        assert!((factor(0.1, 5.0) / 3.1e-7 - 1.0).abs() < 0.02);
    }

    #[test]
    fn verify_the_factor_is_that_of_the_mean_pressure() {
        let law = KIND.with_defaults().law;
        let at = |mpa: [f64; 2]| mpa.map(|mpa| rectangle(mpa, [3.0, 1.0])).concat();
        // 16 mm at a mean of 7 MPa, and of 12.
        let (within, above) = (at([10.0, 4.0]), at([20.0, 4.0]));
        assert_near(depth_mm(law.as_ref(), &within), 0.112 * factor(0.25, 7.0));
        assert_near(depth_mm(law.as_ref(), &above), 0.192 * factor(0.25, 10.0));
        assert_eq!(outside(law.as_ref(), &within), Some(0.0));
        assert_eq!(outside(law.as_ref(), &above), Some(1.0));
        assert_eq!(outside(law.as_ref(), &straight(4.0, [3.0, 1.0])), Some(1.0));
    }
}
