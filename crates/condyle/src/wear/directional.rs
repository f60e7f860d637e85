//! Wear by the work along and across the molecules, each with its factor: Schwenke and Wimmer 2013.

use std::sync::Arc;

use super::law::{CIRCLE_FACTOR, MEASURED_AT, NodeWear, WearLaw, WearLawKind, first_times};
use super::{MM_PER_M, MeanCycle};
use crate::parameter::{Known, Parameter};

pub(super) const KIND: WearLawKind = WearLawKind {
    word: "directional",
    about: "Depth per cycle = sum of p |ds| (Kx sin^2 + Ka cos^2) of the angle between slip and principal \
        direction; Kx is Ka times `across_over_along`, and both together give the factor on a circle.",
    known: Known::Approximate,
    parameters: &[
        Parameter {
            about: "Wear factor on a circular path, the mean of Kx and Ka.",
            ..CIRCLE_FACTOR
        },
        Parameter {
            name: "across_over_along",
            about: "Wear by work across the molecules, relative to the same work along them.",
            default: 6.4,
            least: 1.0,
            most: 1000.0,
            source: "schwenke2013",
            known: Known::Read,
        },
        MEASURED_AT,
    ],
    scaled: |constants, times| first_times(1, constants, times),
    make: |constants| {
        let [circle, ratio] = [constants[0], constants[1]];
        let along_mm3_per_nm = 2.0 * circle / (1.0 + ratio);
        Arc::new(Directional {
            along_mm3_per_nm,
            across_mm3_per_nm: ratio * along_mm3_per_nm,
            measured_at_mpa: constants[2],
        })
    },
};

#[derive(Debug)]
struct Directional {
    along_mm3_per_nm: f64,
    across_mm3_per_nm: f64,
    measured_at_mpa: f64,
}

impl WearLaw for Directional {
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear {
        let along = self.along_mm3_per_nm * cycle.slip_work.along_mpa_mm();
        let across = self.across_mm3_per_nm * cycle.slip_work.across_mpa_mm();
        NodeWear {
            depth_mm: (along + across) / MM_PER_M,
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
        let along = 2.0 * 1.63e-6 / 7.4;
        // 1 MPa over 20 mm is 0.02 N m on each square millimetre.
        for degrees in [0.0, 33.0, 120.0] {
            let depth = |path: Vec<_>| depth_mm(law.as_ref(), &turned(&path, degrees));
            assert_near(depth(circle(1.0, 20.0)), 0.02 * 1.63e-6);
            assert_near(depth(straight(1.0, [20.0, 0.0])), 0.02 * along);
            let mixed = 0.9 * along + 0.1 * 6.4 * along;
            assert_near(depth(rectangle(1.0, [9.0, 1.0])), 0.02 * mixed);
        }
        assert_eq!(outside(law.as_ref(), &circle(2.0, 5.0)), Some(1.0));
    }

    #[test]
    fn verify_a_ratio_of_one_is_archards_law() {
        let law = KIND.law(&[2.64e-7, 1.0, 1.1]);
        let path = [rectangle(3.0, [2.0, 1.0]), straight(8.0, [1.0, 7.0])].concat();
        let work: f64 = path
            .iter()
            .map(|(p, [x, z])| p * x.hypot(*z) / 1000.0)
            .sum();
        assert_near(depth_mm(law.as_ref(), &path), 2.64e-7 * work);
    }
}
