//! The outputs of a study, and the questions about them.

use condyle_results::catalogue::Scalar;

use super::declared::{AnswersKeys, BoundKeys};
use super::outputs::Outputs;
use crate::config::*;

/// The questions that a study answers.
#[derive(Clone, Debug)]
pub struct Answers {
    /// Outputs in answers and pictures, one or more.
    pub outputs: Vec<&'static Scalar>,
    /// The output that designs are ranked by; smaller is better.
    pub rank_by: &'static Scalar,
    /// Two outputs to be minimised together.
    pub pareto: Option<[&'static Scalar; 2]>,
    /// True if the study names these two.
    pub names_pareto: bool,
    /// The limits of outputs.
    pub bounds: Vec<Bound>,
}

/// The limits of an output.
#[derive(Clone, Copy, Debug)]
pub struct Bound {
    /// The output.
    pub output: &'static Scalar,
    /// The smallest value allowed.
    pub least: Option<f64>,
    /// The largest value allowed.
    pub most: Option<f64>,
    /// The probability with which a robust search keeps it, and which an alternative must reach to rank first.
    pub probability: f64,
}

impl Answers {
    /// Returns the limits of an output.
    pub fn bounds_of(&self, output: &Scalar) -> impl Iterator<Item = &Bound> {
        let bounds = self.bounds.iter();
        bounds.filter(move |bound| bound.output.key == output.key)
    }

    pub(super) fn read(root: &Section<'_>, own: &Outputs, log: &mut Log<'_>) -> Option<Self> {
        let bounds = root.read_list("limit", log, |one, log| Bound::read(one, own, log));
        let section = root.table("answers", log);
        let keys = AnswersKeys::read_checked(&section, log)?;
        let mut output = |key: &str, name: &String| own.named(name, key, &section, log);
        let outputs = keys.outputs.0.iter();
        let outputs: Option<Vec<_>> = outputs.map(|name| output("outputs", name)).collect();
        let rank_by = keys.rank_by.map(|name| output("rank_by", &name));
        let pareto: Option<Option<Vec<_>>> = keys
            .pareto
            .map(|two| two.0.iter().map(|name| output("pareto", name)).collect());
        let names_pareto = pareto.is_some();
        let mut outputs = outputs?;
        let Some(&first) = outputs.first() else {
            let advice = "name one, such as `mass_loss_mg`, or omit the key";
            let fault = Fault::new("the study names no output", advice);
            return log.reject(section.value_span("outputs"), fault);
        };
        let two = pareto.map_or(Some(outputs.clone()), |two| two)?;
        let bounds = bounds?;
        // A limit is a question about its output too.
        for bound in &bounds {
            if outputs.iter().all(|output| output.key != bound.output.key) {
                outputs.push(bound.output);
            }
        }
        Some(Self {
            rank_by: rank_by.unwrap_or(Some(first))?,
            pareto: two.first_chunk().copied(),
            names_pareto,
            bounds,
            outputs,
        })
    }
}

impl Bound {
    fn read(section: &Section<'_>, own: &Outputs, log: &mut Log<'_>) -> Option<Self> {
        let keys = BoundKeys::read_checked(section, log)?;
        let output = own.named(&keys.output, "output", section, log)?;
        let (least, most) = (keys.least, keys.most);
        if least.or(most).is_none() {
            let fault = Fault::new("a limit needs `least`, `most` or both", "add `most = 40.0`");
            return log.reject(section.span(), fault);
        }
        Some(Self {
            output,
            least,
            most,
            probability: keys.probability,
        })
    }

    /// Returns the limits, each with the sign of the direction beyond it: a value exceeds it by sign (value - limit).
    pub fn sides(&self) -> impl Iterator<Item = (f64, f64)> {
        let least = self.least.map(|least| (-1.0, least));
        let most = self.most.map(|most| (1.0, most));
        [least, most].into_iter().flatten()
    }

    /// Returns the distance of a value beyond the limits; 0 within them.
    pub fn excess(&self, value: f64) -> f64 {
        self.distance(value).max(0.0)
    }

    /// Returns the distance of a value beyond the nearest limit, negative within it.
    pub fn distance(&self, value: f64) -> f64 {
        let distances = self.sides().map(|(sign, limit)| sign * (value - limit));
        distances.fold(f64::NEG_INFINITY, f64::max)
    }
}
