//! Numbers of two summaries, beside the discretisation errors that both state.

use serde::Serialize;

use condyle_results::{
    Summary,
    catalogue::{self, Scalar},
};

use crate::page::{label_of, unit_of};

/// A number in which two runs differ.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NumberDifference {
    /// The number, as the catalogue describes it.
    #[serde(skip)]
    pub scalar: &'static Scalar,
    /// Its key in `summary.json`, which ends in its unit.
    pub key: &'static str,
    /// Its name in words.
    pub label: String,
    /// Its unit as the report shows it.
    pub unit: String,
    /// Of the first run.
    pub first: f64,
    /// Of the second.
    pub second: f64,
    /// Second less first.
    pub difference: f64,
    /// The same in percent of the first; none where that is 0.
    pub difference_percent: Option<f64>,
    /// Estimated discretisation error of the first.
    pub first_error: Option<f64>,
    /// Of the second.
    pub second_error: Option<f64>,
    /// Size of the difference over the sum of both errors: below 1 the difference may be one of discretisation alone. None
    /// where not both are stated.
    pub times_errors: Option<f64>,
}

impl NumberDifference {
    /// What the errors say of the difference.
    pub fn verdict(&self) -> String {
        match self.times_errors {
            None => "no error stated".to_owned(),
            Some(times) if times < 1.0 => "smaller than the errors".to_owned(),
            Some(times) if times < 10.0 => format!("{times:.1} times the errors"),
            Some(times) => format!("{times:.0} times the errors"),
        }
    }

    /// The sum of both errors.
    pub fn errors(&self) -> Option<f64> {
        Some(self.first_error? + self.second_error?)
    }
}

/// Numbers that differ: by size over errors, then those without errors by their percent.
pub(super) fn numbers(first: &Summary, second: &Summary) -> Vec<NumberDifference> {
    let difference = |scalar: &'static Scalar| {
        let (one, two) = (first.get(scalar)?, second.get(scalar)?);
        let [first_error, second_error] =
            [first, second].map(|summary| summary.total_error(scalar));
        let difference = two - one;
        let errors = first_error.zip(second_error).map(|(one, two)| one + two);
        let errors = errors.filter(|errors| *errors > 0.0);
        (difference != 0.0).then(|| NumberDifference {
            scalar,
            key: scalar.key,
            label: label_of(scalar),
            unit: unit_of(scalar),
            first: one,
            second: two,
            difference,
            difference_percent: (one != 0.0).then(|| 100.0 * difference / one.abs()),
            first_error,
            second_error,
            times_errors: errors.map(|errors| difference.abs() / errors),
        })
    };
    let mut numbers: Vec<_> = catalogue::results().filter_map(difference).collect();
    numbers.sort_by(|one, two| {
        rank(two)
            .partial_cmp(&rank(one))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    numbers
}

fn rank(number: &NumberDifference) -> (f64, f64) {
    let percent = number.difference_percent.map_or(f64::INFINITY, f64::abs);
    (number.times_errors.unwrap_or(-1.0), percent)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn summary(mass: f64, depth: f64, ap: f64) -> Summary {
        let text = format!(
            r#"{{"mass_loss_mg": {mass}, "max_depth_mm": {depth}, "ap_range_mm": {ap}, "ie_range_deg": 5,
                "error": {{"mass_loss_mg": {{"total": 0.5}}, "max_depth_mm": {{"total": 0.01}}}}}}"#
        );
        serde_json::from_str(&text).expect("is JSON")
    }

    #[test]
    fn differences_rank_by_size_over_errors_and_equal_numbers_are_left_out() {
        let told = numbers(&summary(80.0, 0.4, 4.0), &summary(80.5, 0.5, 5.0));
        let keys: Vec<&str> = told.iter().map(|told| told.key).collect();
        assert_eq!(keys, ["max_depth_mm", "mass_loss_mg", "ap_range_mm"]);
        assert!((told[0].times_errors.expect("has errors") - 5.0).abs() < 1e-9);
        assert_eq!(told[0].verdict(), "5.0 times the errors");
        assert_eq!(told[1].verdict(), "smaller than the errors");
        assert_eq!(told[2].verdict(), "no error stated");
        assert_eq!(told[2].difference_percent, Some(25.0));
    }
}
