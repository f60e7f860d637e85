//! The answers of a study, computed from its stored tests.

pub(crate) mod data;
pub(crate) mod effects;
pub(crate) mod emulated;
pub(crate) mod indices;
pub(crate) mod ranking;
pub(crate) mod robust;
mod sentences;
pub(crate) mod tables;
pub(crate) mod words;

use std::cmp::Reverse;

use serde::Serialize;

use crate::{
    adaptive::Aim,
    answers::{
        data::{Data, Doubtful, Spread},
        effects::{Effect, Elementary},
        emulated::{Emulated, emulated},
        indices::Indices,
        ranking::{Best, Front, Ranking},
        robust::Robust,
    },
    error::StudyError,
    plan::Plan,
    store::Store,
};

/// The answers of a study; serialised, they are `answers.json`.
#[derive(Clone, Debug, Serialize)]
pub struct Answers {
    pub(crate) title: String,
    pub(crate) design: &'static str,
    tests: u64,
    pub(crate) kept: u64,
    pub(crate) failed: Vec<TestsByReason>,
    /// Sets of plausibility checks that tests do not pass.
    pub(crate) doubtful: Vec<TestsByReason>,
    pub(crate) spreads: Vec<Spread>,
    pub(crate) effects: Vec<Effect>,
    pub(crate) elementary: Vec<Elementary>,
    pub(crate) indices: Vec<Indices>,
    pub(crate) emulated: Vec<Emulated>,
    pub(crate) ranking: Option<Ranking>,
    pub(crate) front: Option<Front>,
    pub(crate) best: Option<Best>,
    pub(crate) robust: Option<Robust>,
    /// Of the optimum, or of the tests of a front that the study searched for, those that are doubtful.
    doubtful_optima: Vec<Doubtful>,
    pub(crate) aim: Option<Aim>,
}

#[derive(Clone, Debug, Serialize)]
pub(crate) struct TestsByReason {
    reason: String,
    pub(crate) tests: u64,
}

impl TestsByReason {
    /// Returns the number of tests of all `reasons`.
    pub fn count(reasons: &[Self]) -> u64 {
        reasons.iter().map(|one| one.tests).sum()
    }
}

/// Joins reasons that differ in their numbers only, such as the places of a failure; the most frequent kind first.
fn by_kind(reasons: Vec<(String, u64)>) -> Vec<TestsByReason> {
    let mut kinds: Vec<TestsByReason> = Vec::new();
    for (reason, tests) in reasons {
        let reason = without_numbers(&reason);
        match kinds.iter_mut().find(|kind| kind.reason == reason) {
            Some(kind) => kind.tests += tests,
            None => kinds.push(TestsByReason { reason, tests }),
        }
    }
    kinds.sort_by_key(|kind| Reverse(kind.tests));
    kinds
}

/// Returns a text with every number replaced by `#`.
fn without_numbers(text: &str) -> String {
    let is_part = |c: char| c.is_ascii_digit() || c == '.' || c == '-' || c == '+';
    let word = |word: &str| {
        let number = word
            .trim_start_matches(|c: char| !is_part(c))
            .trim_end_matches(|c: char| !c.is_ascii_digit());
        match number.parse::<f64>() {
            Ok(_) => word.replace(number, "#"),
            Err(_) => word.to_owned(),
        }
    };
    text.split(' ').map(word).collect::<Vec<_>>().join(" ")
}

impl Answers {
    pub(crate) fn read(plan: &Plan, store: &Store) -> Result<Self, StudyError> {
        let study = plan.study();
        let data = Data::read(plan, store)?;
        let counted = |status| -> Result<Vec<TestsByReason>, StudyError> {
            Ok(by_kind(store.reasons(status)?))
        };
        let counted_indices = indices::indices(&data);
        let (emulated, emulated_indices) = emulated(&data);
        let (best, robust) = (Best::read(&data, store)?, Robust::read(&data, store)?);
        let front = Front::read(&data, store)?;
        let of_front = front.iter().filter(|front| front.is_searched);
        let of_front = of_front.flat_map(|front| front.tests.iter().map(|test| test.0));
        let of_robust = robust.iter().map(|own| own.comparison.optimum.row as u64);
        let optima = best.iter().filter_map(|best| best.row).chain(of_robust);
        let doubtful_optima = data.doubtful(optima.chain(of_front));
        Ok(Self {
            title: study.title.clone(),
            design: study.design.word(),
            tests: plan.tests(),
            kept: store.count()?,
            failed: counted("failed")?,
            doubtful: counted("done")?,
            spreads: data
                .outputs_of_designs()
                .map(|own| Spread::new(&data, own))
                .collect(),
            effects: effects::effects(&data, &emulated),
            elementary: effects::elementary_effects(&data),
            // Counted indices need no emulator.
            indices: if counted_indices.is_empty() {
                emulated_indices
            } else {
                counted_indices
            },
            emulated,
            ranking: Ranking::read(&data, store)?,
            front,
            best,
            robust,
            doubtful_optima,
            aim: Aim::read(plan, store)?,
        })
    }

    /// Returns the names of the designs that are compared, the one that ranks first before the others; a single one without a name
    /// in other studies.
    pub(crate) fn designs(&self) -> Vec<Option<&str>> {
        let designs = self.ranking.iter().flat_map(|ranking| &ranking.designs);
        let names: Vec<_> = designs.map(|design| Some(design.name.as_str())).collect();
        if names.is_empty() { vec![None] } else { names }
    }

    /// Returns the distribution of the first output of a design.
    pub(crate) fn first_spread(&self, design: Option<&str>) -> Option<&Spread> {
        let mut spreads = self.spreads.iter();
        spreads.find(|one| one.design.as_deref() == design)
    }

    /// Effects of inputs on an output of a design, the largest first.
    pub(crate) fn effects_on(&self, output: &str, design: Option<&str>) -> Vec<&Effect> {
        let is_own = |one: &&Effect| one.output == output && one.design.as_deref() == design;
        largest_first(self.effects.iter().filter(is_own), |one| one.span)
    }

    /// Effects of inputs on an output of a design that are means over an input, the largest first; none where tests were chosen by
    /// those before them, unless the means are those of an emulator.
    pub(crate) fn main_effects_on(&self, output: &str, design: Option<&str>) -> Vec<&Effect> {
        let is_sequential = ["optimise", "adaptive"].contains(&self.design);
        let mut own = self.effects_on(output, design);
        own.retain(|effect| effect.is_emulated || !is_sequential);
        own
    }

    /// Elementary effects on the first output, the largest first.
    pub(crate) fn largest_elementary(&self) -> Vec<&Elementary> {
        let first = self.elementary.first().map(|one| one.output);
        let own = self.elementary.iter();
        largest_first(own.filter(|one| Some(one.output) == first), |one| {
            one.mu_star
        })
    }

    /// Sobol indices of the first output of a design, the largest total first.
    pub(crate) fn largest_indices(&self, design: Option<&str>) -> Vec<&Indices> {
        let own = self.indices.iter();
        let own = own.filter(|one| one.design.as_deref() == design);
        let first = own.clone().next().map(|one| one.output);
        largest_first(own.filter(|one| Some(one.output) == first), |one| one.total)
    }

    /// Sobol indices of the same input and design for each other output with a limit.
    fn indices_of_limited(&self, index: &Indices) -> impl Iterator<Item = &Indices> {
        let has_limit = |output: &str| {
            let mut spreads = self.spreads.iter();
            spreads.any(|one| one.output == output && !one.beyond.is_empty())
        };
        let own = (index.output, index.input.clone(), index.design.clone());
        self.indices.iter().filter(move |one| {
            let is_other = one.output != own.0 && has_limit(one.output);
            is_other && (&one.input, &one.design) == (&own.1, &own.2)
        })
    }

    /// Returns the name that the study gives an input; its key if it gives none.
    pub(crate) fn name_of<'a>(&'a self, input: &'a str) -> &'a str {
        let mut effects = self.effects.iter();
        let own = effects.find(|effect| effect.input == input);
        own.map_or(input, |effect| &effect.name)
    }
}

fn largest_first<'a, T>(own: impl Iterator<Item = &'a T>, size: impl Fn(&T) -> f64) -> Vec<&'a T> {
    let mut own: Vec<&T> = own.collect();
    own.sort_by(|one, other| size(other).total_cmp(&size(one)));
    own
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failures_that_differ_in_their_numbers_are_of_one_kind() {
        let reasons = [
            (
                "no equilibrium at 12.5 % of the cycle, residual 3.1e-2 N",
                2,
            ),
            ("the insert is 7.9 mm thick (at least 8).", 4),
            ("no equilibrium at 98 % of the cycle, residual -1e3 N", 3),
        ];
        let kinds = by_kind(
            reasons
                .map(|(reason, tests)| (reason.to_owned(), tests))
                .to_vec(),
        );
        let kinds: Vec<(&str, u64)> = kinds
            .iter()
            .map(|kind| (kind.reason.as_str(), kind.tests))
            .collect();
        assert_eq!(
            kinds,
            [
                ("no equilibrium at # % of the cycle, residual # N", 5),
                ("the insert is # mm thick (at least #).", 4),
            ]
        );
    }

    #[test]
    fn an_index_is_noise_if_its_interval_lies_above_its_most() {
        let index = |first, total, half: f64| Indices {
            output: "mass_loss_mg",
            design: None,
            input: "contact.friction".to_owned(),
            first,
            first_interval: [first - half, first + half],
            total,
            total_interval: [total - half, total + half],
            bases: 10,
        };
        assert_eq!(index(0.31, 0.3, 0.005).first_in_words(), "0.310 (noise)");
        assert_eq!(index(0.31, 0.3, 0.02).first_in_words(), "0.310");
        assert_eq!(index(0.3, 0.3, 0.0).first_in_words(), "0.300");
        assert_eq!(index(0.995_01, 0.995, 0.0).first_in_words(), "0.995");
        assert_eq!(index(0.3, 1.01, 0.005).total_in_words(), "1.010 (noise)");
        assert_eq!(index(0.3, 1.0 + 1e-9, 0.0).total_in_words(), "1.000");
    }
}
