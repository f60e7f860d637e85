//! The answer of a robust search.

use condyle_case::study::{Bound, Design};
use serde::Serialize;

use crate::{
    answers::{
        data::Data,
        ranking::Valued,
        words::{label, shown, sides_in_words, with_interval},
    },
    error::StudyError,
    search::{Comparison, Estimate, Standing, comparison, standing},
    store::Store,
};

/// The robust optimum compared with the design that the search starts from.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub(crate) struct Robust {
    pub minimised: &'static str,
    pub unit: &'static str,
    /// The statistic that is minimised, in words.
    pub statistic: String,
    /// The chosen inputs.
    pub inputs: Vec<Valued>,
    /// The limits in words, in the order of the probabilities of keeping them.
    pub limits: Vec<String>,
    /// The required probability of keeping each of the limits.
    pub required: Vec<f64>,
    #[serde(flatten)]
    pub comparison: Comparison,
    pub standing: Option<Standing>,
}

impl Robust {
    /// Returns the answer; none for other studies, and while no tested design keeps the limits.
    pub fn read(data: &Data<'_>, store: &Store) -> Result<Option<Self>, StudyError> {
        let (plan, study) = (data.plan, data.plan.study());
        let (Design::Optimise(keys), [minimised]) = (&study.design, &study.objectives()[..]) else {
            return Ok(None);
        };
        let known = store.known(plan, 0)?;
        let Some(comparison) = comparison(plan, &known) else {
            return Ok(None);
        };
        let statistic = keys.percentile.map_or("mean".to_owned(), |percentile| {
            format!("{percentile} % quantile")
        });
        let mut limits: Vec<String> = study.answers.bounds.iter().flat_map(limits).collect();
        // If tests failed.
        if comparison.optimum.kept.len() > limits.len() + 1 {
            limits.push("solved".to_owned());
        }
        limits.push("all of these".to_owned());
        let bounds = study.answers.bounds.iter();
        let required = bounds.flat_map(|bound| bound.sides().map(|_| bound.probability));
        let chosen = study.inputs[..study.chosen()].iter().zip(&data.inputs);
        let rows = [comparison.optimum.row, comparison.first.row];
        let valued = chosen.map(|(input, column)| Valued::new(&input.key, &column.values, rows));
        Ok(Some(Self {
            minimised: minimised.key,
            unit: minimised.unit(),
            statistic: format!("{statistic} of {}", minimised.label),
            inputs: valued.collect(),
            limits,
            required: required.collect(),
            standing: standing(plan, &known),
            comparison,
        }))
    }

    /// Returns the answer in a sentence.
    pub fn sentence(&self) -> String {
        let Comparison {
            optimum,
            first,
            beats,
        } = &self.comparison;
        let all = optimum.kept.last().map(in_percent).unwrap_or_default();
        let [own, other] = [optimum, first].map(|design| in_words(&design.statistic));
        let (row, beats, label) = (optimum.row, in_percent(beats), label(self.minimised));
        let (statistic, unit) = (&self.statistic, self.unit);
        let mut kept = optimum.kept.iter().zip(&self.required);
        let end = if kept.any(|(kept, required)| kept.value < *required) {
            " A limit is kept with less than the required probability: allow more tests, or widen the ranges of the inputs or the limit."
        } else {
            ""
        };
        format!(
            "The {label} of the robust optimum, row {row}, is less than that of the first design under {beats} of the disturbances, \
             and every limit is kept under {all}; its {statistic} is {own} {unit}, that of the first design {other} {unit}.{end}"
        )
    }

    /// Returns rows of a table with the optimum and the first design.
    pub fn table(&self) -> Vec<Vec<String>> {
        let Comparison {
            optimum,
            first,
            beats,
        } = &self.comparison;
        let row = |name: &str, one: String, other: String| vec![name.to_owned(), one, other];
        let head = row(
            &format!("row {}", optimum.row),
            "robust optimum".to_owned(),
            "first design".to_owned(),
        );
        let inputs = self.inputs.iter();
        let inputs = inputs.map(|one| row(&one.name, shown(one.value), shown(one.first)));
        let statistic = format!("{}, {}", self.statistic, self.unit);
        let statistic = row(
            &statistic,
            in_words(&optimum.statistic),
            in_words(&first.statistic),
        );
        let limits = self.limits.iter().zip(optimum.kept.iter().zip(&first.kept));
        let limits = limits.map(|(name, (one, other))| {
            row(
                &format!("probability: {name}"),
                in_percent(one),
                in_percent(other),
            )
        });
        let better = "probability: better than the first design";
        let better = row(better, in_percent(beats), "-".to_owned());
        [head]
            .into_iter()
            .chain(inputs)
            .chain([statistic])
            .chain(limits)
            .chain([better])
            .collect()
    }
}

/// Returns both sides of a limit in words, with its probability.
fn limits(bound: &Bound) -> impl Iterator<Item = String> {
    let required = shown(100.0 * bound.probability);
    sides_in_words(bound).map(move |words| format!("{words} ({required} % required)"))
}

fn in_words(estimate: &Estimate) -> String {
    let [low, high] = estimate.interval.map(shown);
    format!("{} ({low} to {high})", shown(estimate.value))
}

fn in_percent(estimate: &Estimate) -> String {
    with_interval(estimate.value, estimate.interval)
}
