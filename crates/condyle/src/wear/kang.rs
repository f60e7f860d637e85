//! A wear factor that depends on cross-shear and pressure: Kang 2008.

use std::sync::Arc;

use super::law::{NodeWear, WearLaw, WearLawKind};
use super::{MM_PER_M, MeanCycle};
use crate::parameter::{Known, Parameter};

pub(super) const KIND: WearLawKind = WearLawKind {
    word: "kang",
    about: "Depth per cycle = sum of K p |ds|, K = exp(a + b ln CS - c p) in mm3/(N m), with p of the instant, \
        at most `most_pressure_mpa`, and the cycle's cross-shear ratio CS, at least `least_cross_shear`.",
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
            about: "Constant c: how fast the wear factor falls with pressure.",
            default: 0.29,
            least: 0.0,
            most: 5.0,
            source: "kang2008",
            known: Known::Approximate,
        },
        Parameter {
            name: "least_cross_shear",
            about: "Where less cross-shear is taken for this much.",
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

impl Kang {
    /// Returns the sum of p |ds| exp(-c p), MPa mm, below and above the pressure at which the factor stops falling.
    fn weighed_work_mpa_mm(&self, cycle: &MeanCycle<'_>) -> [f64; 2] {
        let mut work = [0.0; 2];
        let at_most = (-self.decay_per_mpa * self.most_pressure_mpa).exp();
        // `for_each` and not `for`: the chained iterators of all activities run faster from inside.
        cycle.moments().for_each(|(share, moment)| {
            let slip_work = share * moment.pressure_mpa * moment.distance_mm();
            if moment.pressure_mpa > self.most_pressure_mpa {
                work[1] += slip_work * at_most;
            } else {
                work[0] += slip_work * (-self.decay_per_mpa * moment.pressure_mpa).exp();
            }
        });
        work
    }
}

impl WearLaw for Kang {
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear {
        let cross_shear = cycle.slip_work.cross_shear();
        let [within, above] = self.weighed_work_mpa_mm(cycle);
        let work_mpa_mm = within + above;
        let outside = if cross_shear < self.least_cross_shear {
            1.0
        } else {
            above / work_mpa_mm.max(f64::MIN_POSITIVE)
        };
        let log_cross_shear = cross_shear.max(self.least_cross_shear).ln();
        let unpressed_mm3_per_nm =
            (self.log_wear_factor + self.cross_shear_exponent * log_cross_shear).exp();
        NodeWear {
            depth_mm: unpressed_mm3_per_nm / MM_PER_M * work_mpa_mm,
            part_outside: Some(outside),
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
    fn verify_pressures_above_the_most_have_its_factor_and_are_reported() {
        let law = KIND.with_defaults().law;
        let path = [rectangle(20.0, [3.0, 1.0]), rectangle(4.0, [3.0, 1.0])].concat();
        let within = 4.0 * 8.0 / 1000.0 * factor(0.25, 4.0);
        let above = 20.0 * 8.0 / 1000.0 * factor(0.25, 10.0);
        assert_near(depth_mm(law.as_ref(), &path), within + above);
        let outside_part = outside(law.as_ref(), &path).unwrap();
        assert_near(outside_part, above / (within + above));
        assert_eq!(
            outside(law.as_ref(), &rectangle(4.0, [3.0, 1.0])),
            Some(0.0)
        );
        assert_eq!(outside(law.as_ref(), &straight(4.0, [3.0, 1.0])), Some(1.0));
    }
}
