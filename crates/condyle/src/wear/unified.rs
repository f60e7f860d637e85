//! Wear by the work across the molecules alone: Wang 2001.

use std::sync::Arc;

use super::law::{CIRCLE_FACTOR, MEASURED_AT, NodeWear, WearLaw, WearLawKind, first_times};
use super::{MM_PER_M, MeanCycle};
use crate::parameter::{Known, Parameter};

pub(super) const KIND: WearLawKind = WearLawKind {
    word: "unified",
    about: "Depth per cycle = 2 K E, E the part of sum of p |ds| across the cycle's principal direction; a path \
        that spreads evenly over angles within a of it wears by K (1 - sin 2a / 2a), a straight one not at all.",
    known: Known::Approximate,
    parameters: &[
        Parameter {
            about: "Wear factor K on a circular path.",
            ..CIRCLE_FACTOR
        },
        MEASURED_AT,
    ],
    scaled: |constants, times| first_times(1, constants, times),
    make: |constants| {
        Arc::new(Unified {
            circle_factor_mm3_per_nm: constants[0],
            measured_at_mpa: constants[1],
        })
    },
};

#[derive(Debug)]
struct Unified {
    circle_factor_mm3_per_nm: f64,
    measured_at_mpa: f64,
}

impl WearLaw for Unified {
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear {
        let across_mpa_mm = cycle.slip_work.across_mpa_mm();
        NodeWear {
            depth_mm: 2.0 * self.circle_factor_mm3_per_nm / MM_PER_M * across_mpa_mm,
            part_outside: Some(cycle.part_above(self.measured_at_mpa)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{
        assert_near, circle, depth_mm, outside, rectangle, straight, turned,
    };
    use super::*;

    #[test]
    fn verify_depth_on_paths_with_closed_forms() {
        let law = KIND.with_defaults().law;
        // 1 MPa over 20 mm is 0.02 N m on each square millimetre.
        for degrees in [0.0, 33.0, 120.0] {
            let depth = |path: Vec<_>| depth_mm(law.as_ref(), &turned(&path, degrees));
            assert_near(depth(circle(1.0, 20.0)), 0.02 * 1.63e-6);
            assert_near(depth(rectangle(1.0, [5.0, 5.0])), 0.02 * 1.63e-6);
            assert_near(depth(rectangle(1.0, [9.0, 1.0])), 0.02 * 1.63e-6 * 0.2);
            assert!(depth(straight(1.0, [20.0, 0.0])) < 1e-22);
        }
    }

    #[test]
    fn verify_wangs_formula_of_the_largest_angle() {
        let law = KIND.with_defaults().law;
        for spread in [0.2_f64, 0.7, 1.3] {
            const PARTS: usize = 2000;
            let step = |part| {
                let angle = spread * ((2 * part + 1) as f64 / PARTS as f64 - 1.0);
                let (sine, cosine) = angle.sin_cos();
                (1.0, [0.01 * cosine, 0.01 * sine])
            };
            let path: Vec<_> = (0..PARTS).map(step).collect();
            let wang = 1.0 - (2.0 * spread).sin() / (2.0 * spread);
            let exact = 0.02 * 1.63e-6 * wang;
            assert!((depth_mm(law.as_ref(), &path) / exact - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn work_above_the_measured_pressure_is_outside() {
        let law = KIND.with_defaults().law;
        assert_eq!(outside(law.as_ref(), &circle(1.1, 5.0)), Some(0.0));
        let path = [rectangle(3.0, [1.0, 1.0]), rectangle(1.0, [1.0, 1.0])].concat();
        assert_eq!(outside(law.as_ref(), &path), Some(0.75));
    }
}
