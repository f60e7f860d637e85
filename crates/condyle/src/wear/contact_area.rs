//! Wear in proportion to the sliding distance under pressure, at any pressure: Liu 2011, Abdelgaied 2011.

use std::sync::Arc;

use super::MeanCycle;
use super::law::{NodeWear, WearLaw, WearLawKind, first_times};
use crate::parameter::{Known, Parameter};

pub(super) const KIND: WearLawKind = WearLawKind {
    word: "contact-area",
    about: "Depth per cycle = C S, S the sliding distance under pressure and C = slope CS + offset of the cycle's \
        cross-shear ratio CS, by one line below `cross_shear_between` and another above.",
    known: Known::Approximate,
    parameters: &[
        Parameter {
            name: "low_slope",
            about: "Slope of C where cross-shear is low, mm deep for each mm slid.",
            default: 32e-9,
            ..COEFFICIENT
        },
        Parameter {
            name: "low_offset",
            about: "C without cross-shear, mm deep for each mm slid.",
            default: 0.3e-9,
            ..COEFFICIENT
        },
        Parameter {
            name: "high_slope",
            about: "Slope of C where cross-shear is high, mm deep for each mm slid.",
            default: 1.9e-9,
            ..COEFFICIENT
        },
        Parameter {
            name: "high_offset",
            about: "Intercept of the line of high cross-shear, mm deep for each mm slid.",
            default: 1.6e-9,
            ..COEFFICIENT
        },
        Parameter {
            name: "cross_shear_between",
            about: "Cross-shear ratio between the two lines.",
            default: 0.04,
            most: 0.5,
            ..COEFFICIENT
        },
    ],
    scaled: |constants, times| first_times(4, constants, times),
    make: |constants| {
        Arc::new(ContactArea {
            low: [constants[0], constants[1]],
            high: [constants[2], constants[3]],
            cross_shear_between: constants[4],
        })
    },
};

/// The values that its constants share.
const COEFFICIENT: Parameter = Parameter {
    name: "",
    about: "",
    default: 0.0,
    least: 0.0,
    most: 1e-4,
    source: "abdelgaied2011",
    known: Known::Approximate,
};

#[derive(Debug)]
struct ContactArea {
    /// Slope and offset.
    low: [f64; 2],
    high: [f64; 2],
    cross_shear_between: f64,
}

impl WearLaw for ContactArea {
    fn wear(&self, cycle: &MeanCycle<'_>) -> NodeWear {
        let cross_shear = cycle.slip_work.cross_shear();
        let [slope, offset] = if cross_shear < self.cross_shear_between {
            self.low
        } else {
            self.high
        };
        NodeWear::of_depth((slope * cross_shear + offset) * cycle.pressed_distance_mm)
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{
        assert_near, circle, depth_mm, outside, rectangle, straight, turned,
    };
    use super::*;

    #[test]
    fn verify_depth_on_paths_with_closed_forms_whatever_the_pressure() {
        let law = KIND.with_defaults().law;
        for (pressure, degrees) in [(1.0, 0.0), (5.0, 33.0), (30.0, 120.0)] {
            let depth = |path: Vec<_>| depth_mm(law.as_ref(), &turned(&path, degrees));
            assert_near(depth(circle(pressure, 20.0)), 20.0 * 2.55e-9);
            assert_near(depth(rectangle(pressure, [9.0, 1.0])), 20.0 * 1.79e-9);
            assert_near(depth(rectangle(pressure, [49.0, 1.0])), 100.0 * 0.94e-9);
            assert_near(depth(straight(pressure, [20.0, 0.0])), 20.0 * 0.3e-9);
        }
        assert_eq!(outside(law.as_ref(), &circle(5.0, 20.0)), None);
    }

    #[test]
    fn verify_it_gives_the_factor_that_is_told_of_it() {
        // At a cross-shear of 0.1 and 5 MPa it wears as a factor of 3.6e-7 mm3/(N m).
        let law = KIND.with_defaults().law;
        let factor = depth_mm(law.as_ref(), &rectangle(5.0, [9.0, 1.0])) / 0.1;
        assert!((factor / 3.6e-7 - 1.0).abs() < 0.01, "{factor:e}");
    }
}
