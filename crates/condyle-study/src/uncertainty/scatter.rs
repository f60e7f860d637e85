//! What of a test is never quite the same, and by how much.

use By::{Part, Step};
use condyle::parameter::unit_of;
use condyle_case::case::{Assignment, Case};
use statrs::distribution::{ContinuousCDF, Normal};

/// Values farther off than so many standard deviations do not occur: they are found out and thrown away.
const FARTHEST: f64 = 3.0;

/// An input that scatters from test to test.
#[derive(Debug)]
pub(crate) struct Scatter {
    /// What a reader calls it.
    pub name: &'static str,
    /// Its keys, of which a case may have some; all that it has go together.
    keys: &'static [&'static str],
    by: By,
    /// What a key is worth that is not written.
    otherwise: Option<f64>,
    /// Where the number is from.
    pub source: &'static str,
}

/// One standard deviation.
#[derive(Clone, Copy, Debug)]
enum By {
    /// As a part of the value.
    Part(f64),
    /// In the unit of the key.
    Step(f64),
}

const SET_UP: &str = "assumed: how well parts are set up";
const MACHINE: &str = "approximate: ISO 14243-1 lets a machine miss 5 % of the greatest value, taken as 2.5 deviations";

/// All of them. What a value is worth that nobody measured, its source says.
const SCATTERS: &[Scatter] = &[
    Scatter {
        name: "friction",
        keys: &["contact.friction"],
        by: Part(0.2),
        otherwise: None,
        source: "assumed: 0.07 in serum is between 0.04 and 0.1",
    },
    Scatter {
        name: "axial force",
        keys: &["machine.axial_force.scale"],
        by: Part(0.02),
        otherwise: Some(1.0),
        source: MACHINE,
    },
    Scatter {
        name: "AP force",
        keys: &["machine.ap_force.scale"],
        by: Part(0.02),
        otherwise: Some(1.0),
        source: MACHINE,
    },
    Scatter {
        name: "IE torque",
        keys: &["machine.ie_torque.scale"],
        by: Part(0.02),
        otherwise: Some(1.0),
        source: MACHINE,
    },
    Scatter {
        name: "stiffness of springs",
        keys: &[
            "machine.springs.posterior_n_per_mm",
            "machine.springs.anterior_n_per_mm",
        ],
        by: Part(0.05),
        otherwise: None,
        source: "assumed: how springs of a drawing differ",
    },
    Scatter {
        name: "free play of springs",
        keys: &["machine.springs.free_play_mm"],
        by: Step(0.25),
        otherwise: None,
        source: SET_UP,
    },
    Scatter {
        name: "varus-valgus axis, medial",
        keys: &["machine.vv_axis_medial_mm"],
        by: Step(0.5),
        otherwise: None,
        source: SET_UP,
    },
    Scatter {
        name: "flexion of the femur",
        keys: &["femur.flexion_deg"],
        by: Step(0.5),
        otherwise: None,
        source: SET_UP,
    },
    Scatter {
        name: "external rotation of the femur",
        keys: &["femur.external_rotation_deg"],
        by: Step(0.5),
        otherwise: None,
        source: SET_UP,
    },
    Scatter {
        name: "posterior slope",
        keys: &["insert.posterior_slope_deg"],
        by: Step(0.5),
        otherwise: None,
        source: SET_UP,
    },
    Scatter {
        name: "axial rotation of the insert",
        keys: &["insert.axial_rotation_deg"],
        by: Step(0.5),
        otherwise: None,
        source: SET_UP,
    },
    Scatter {
        name: "thickness",
        keys: &["insert.thickness_mm"],
        by: Step(0.05),
        otherwise: None,
        source: "assumed: a tolerance of 0.1 mm, taken as two deviations",
    },
    Scatter {
        name: "Young's modulus",
        keys: &["material.youngs_modulus_mpa"],
        by: Part(0.1),
        otherwise: None,
        source: "sathasivam-walker1994: 400 to 600 MPa, taken as two deviations to either side",
    },
    Scatter {
        name: "wear factor",
        keys: &["wear.wear_factor_mm3_per_nm"],
        by: Part(0.054),
        otherwise: None,
        source: "saikko2005: 5.4 % from pin to pin of one material on one machine",
    },
    Scatter {
        name: "cross-linked over conventional",
        keys: &["material.wear_over_conventional"],
        by: Part(0.16),
        otherwise: None,
        source: "haider2012: 0.14 to 0.27 in knees of two designs, taken as two deviations to either side",
    },
];

/// All scatters, whether a case has keys for them or not.
pub(crate) fn scatters() -> impl Iterator<Item = &'static Scatter> {
    SCATTERS.iter()
}

/// How many standard deviations off a value is below which lies this share of all: normal, cut off at
/// [`FARTHEST`].
pub(crate) fn deviations(share: f64) -> f64 {
    let normal = Normal::standard();
    let least = normal.cdf(-FARTHEST);
    normal.inverse_cdf(least + share * (1.0 - 2.0 * least))
}

impl Scatter {
    /// One standard deviation in words, such as `2 %` or `0.5 mm`.
    pub fn deviation(&self) -> String {
        match self.by {
            Part(part) => format!("{} %", rounded(100.0 * part)),
            Step(step) => {
                let unit = self.keys.first().and_then(|key| unit_of(key));
                format!("{step} {}", unit.unwrap_or_default())
            }
        }
    }

    /// The keys with values that are so many standard deviations off; none where the case has no such keys.
    pub fn off_by(&self, case: &Case, deviations: f64) -> Vec<Assignment> {
        let other = |value: f64| match self.by {
            Part(part) => value * (1.0 + part * deviations),
            Step(step) => value + step * deviations,
        };
        let set = |(key, value): (&str, f64)| {
            let text = format!("{key}={:?}", rounded(other(value)));
            Assignment::parse(&text).expect("a key and a value")
        };
        self.values(case).into_iter().map(set).collect()
    }

    /// Keys that the case has, each a number that scatters.
    fn values(&self, case: &Case) -> Vec<(&'static str, f64)> {
        let value = |key: &&'static str| Some((*key, case.number_at(key).or(self.otherwise)?));
        let scatters = |(_, value): &(&str, f64)| *value != 0.0 || matches!(self.by, Step(_));
        self.keys
            .iter()
            .filter_map(value)
            .filter(scatters)
            .collect()
    }
}

/// To twelve digits: sums of decimal numbers end in ones that nobody wrote.
fn rounded(value: f64) -> f64 {
    format!("{value:.11e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn default_case() -> Case {
        Case::parse("", "case", Path::new("")).unwrap()
    }

    #[test]
    fn verify_deviations_are_normal_and_cut_off() {
        assert!(deviations(0.5).abs() < 1e-9);
        // 68.27 % of all are within one, but for those beyond three.
        assert!((deviations(0.841_6) - 1.0).abs() < 5e-3);
        assert!(deviations(1e-9) >= -FARTHEST && deviations(1.0 - 1e-9) <= FARTHEST);
        assert!((deviations(0.2) + deviations(0.8)).abs() < 1e-9);
    }

    #[test]
    fn all_keys_of_a_scatter_move_together() {
        let case = default_case();
        let springs = scatters().find(|scatter| scatter.name == "stiffness of springs");
        let springs = springs.unwrap();
        let set = springs.off_by(&case, 2.0).into_iter();
        let set: Vec<String> = set.map(|set| set.to_string()).collect();
        assert_eq!(set.len(), 2, "{set:?}");
        assert!(set[0].contains("37.18"), "{set:?}");
        assert_eq!(springs.deviation(), "5 %");
    }

    #[test]
    fn the_factor_of_cross_linking_scatters_where_the_insert_is_cross_linked() {
        let factor = scatters().find(|scatter| scatter.name == "cross-linked over conventional");
        let off = |text: &str| {
            let case = Case::parse(text, "case", Path::new("")).unwrap();
            factor.unwrap().off_by(&case, -1.0)
        };
        assert!(off("").is_empty());
        let [set] = &off("[material]\ncross_linking = \"high\"\n")[..] else {
            panic!("one key");
        };
        assert!(set.to_string().contains("0.168"), "{set}");
    }

    #[test]
    fn what_is_nothing_has_no_part_of_itself() {
        let case = Case::parse("[contact]\nfriction = 0.0\n", "case", Path::new("")).unwrap();
        let friction = scatters().find(|scatter| scatter.name == "friction");
        assert!(friction.unwrap().off_by(&case, 1.0).is_empty());
    }
}
