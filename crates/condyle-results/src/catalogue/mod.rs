//! The catalogue of results: every entry of `summary.json`, declared once.
//!
//! A [`Scalar`] has a key, a name, a unit (the end of its key), decimals, a description and a definition (its doc
//! comment), the function that computes it, the way in which its error is found, and the joints that have it. One file
//! has one [`Section`]; [`SECTIONS`] lists them all. `summary.json`, the terminal, the report, its comparison of runs,
//! the outputs of studies, the JSON schema and the types for Python and TypeScript follow from it.
//!
//! ```
//! use condyle_results::catalogue;
//!
//! let mass = catalogue::scalar("mass_loss_mg").expect("is in the catalogue");
//! assert_eq!((mass.label, mass.unit()), ("mass loss", "mg"));
//! assert_eq!(mass.text(10.909), "10.91");
//! ```

mod finished;
mod scalar;

pub use finished::{FinishedRun, RunFacts};
pub use scalar::{ErrorMethod, Prominence, Scalar, Section};

scalar::sections! {
    wear,
    creep,
    contact,
    below_surface,
    motion,
    hip,
    computation,
}

/// All numbers, in the order of `summary.json`.
pub fn scalars() -> impl Iterator<Item = &'static Scalar> {
    let all = SECTIONS.iter().flat_map(|section| section.scalars);
    all.copied()
}

/// Numbers of the test, without those of the computation, which is the last section.
pub fn results() -> impl Iterator<Item = &'static Scalar> {
    let of_test = SECTIONS[..SECTIONS.len() - 1].iter();
    of_test.flat_map(|section| section.scalars).copied()
}

/// The number with this key.
pub fn scalar(key: &str) -> Option<&'static Scalar> {
    scalars().find(|scalar| scalar.key == key)
}

/// Numbers in large type.
pub fn headlines() -> impl Iterator<Item = &'static Scalar> {
    results().filter(|scalar| scalar.prominence == Prominence::Headline)
}

/// Numbers that a study keeps of every test: results that every run has, in the order of its table.
pub fn outputs() -> impl Iterator<Item = &'static Scalar> {
    results().filter(|scalar| scalar.is_always_there() && scalar.prominence >= Prominence::Shown)
}

/// The output of a study with this key.
pub fn output(key: &str) -> Option<&'static Scalar> {
    outputs().find(|scalar| scalar.key == key)
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use condyle::machine::TestedJoint;

    use super::*;

    #[test]
    fn keys_differ_and_end_in_units_that_are_known() {
        let keys: BTreeSet<_> = scalars().map(|scalar| scalar.key).collect();
        assert_eq!(keys.len(), scalars().count());
        for (key, unit) in [
            ("mass_loss_mg", "mg"),
            ("volume_loss_mm3", "mm3"),
            ("peak_contact_area_mm2", "mm2"),
            ("backside_lifted_percent", "%"),
            ("medial_load_share", ""),
            ("wall_s", "s"),
        ] {
            assert_eq!(scalar(key).map(Scalar::unit), Some(unit));
        }
    }

    #[test]
    fn a_hip_has_wear_and_no_range_of_ap() {
        assert!(MASS_LOSS_MG.applies_to(None) && !AP_RANGE_MM.applies_to(Some(TestedJoint::Hip)));
        assert!(AP_RANGE_MM.applies_to(Some(TestedJoint::Knee)));
    }

    #[test]
    fn every_number_is_described_and_names_a_cycle_that_there_is() {
        for each in scalars() {
            assert!(
                each.description().ends_with('.'),
                "{}: {}",
                each.key,
                each.description()
            );
            assert!(
                each.cycle_key.is_none_or(|key| scalar(key).is_some()),
                "{}",
                each.key
            );
        }
        let mass = &MASS_LOSS_MG;
        assert_eq!(mass.description(), "Worn mass.");
        assert!(mass.definition().starts_with("Volume loss from depth"));
    }
}
