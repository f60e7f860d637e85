//! All that the tests of a study tell.

use serde::Serialize;

use condyle_io::{config::Variants, study::Output};

use super::super::{error::StudyError, plan::Plan, store::Store};
use super::{
    best::Best,
    effects::{self, Effect},
    elementary::{self, Elementary},
    front::Front,
    indices::{self, Indices},
    named::Named,
    ranking::Ranking,
    spread::Spread,
};

/// What the tests of a study tell; `answers.json` has all of it.
#[derive(Clone, Debug, Serialize)]
pub struct Answers {
    /// Of the study.
    pub title: String,
    /// How tests were chosen.
    pub design: &'static str,
    /// Tests in all; of a search, at most.
    pub tests: u64,
    /// Tests that are kept.
    pub kept: u64,
    /// Tests that failed, by their reasons.
    pub failed: Vec<FailedTests>,
    /// How each output is distributed.
    pub spreads: Vec<Spread>,
    /// How each output goes with each input.
    pub effects: Vec<Effect>,
    /// Elementary effects of a Morris design.
    pub elementary: Vec<Elementary>,
    /// Sobol's indices of a Saltelli design.
    pub indices: Vec<Indices>,
    /// How the designs compare.
    pub ranking: Option<Ranking>,
    /// Tests than which none is better in both of two outputs.
    pub front: Option<Front>,
    /// What a search found.
    pub best: Option<Best>,
}

/// Tests that failed for one reason.
#[derive(Clone, Debug, Serialize)]
pub struct FailedTests {
    /// What was said.
    pub reason: String,
    /// How many.
    pub tests: u64,
}

impl Answers {
    /// What the tests in `store` tell.
    pub(in super::super) fn of(plan: &Plan, store: &Store) -> Result<Self, StudyError> {
        let study = plan.study();
        let outputs = outputs(plan, store)?;
        let failed = store.reasons()?.into_iter();
        Ok(Self {
            title: study.title.clone(),
            design: study.design.word(),
            tests: plan.tests(),
            kept: store.count()?,
            failed: failed
                .map(|(reason, tests)| FailedTests { reason, tests })
                .collect(),
            spreads: outputs
                .iter()
                .map(|output| Spread::of(plan, output))
                .collect(),
            effects: effects::all(plan, store, &outputs)?,
            elementary: elementary::all(plan, &outputs),
            indices: indices::all(plan, &outputs),
            ranking: Ranking::of(plan, store)?,
            front: Front::of(plan, store)?,
            best: Best::of(plan, store)?,
        })
    }
}

impl Answers {
    /// Effects of inputs on an output, the largest first.
    pub(in super::super) fn effects_on(&self, output: &str) -> Vec<&Effect> {
        let own = self.effects.iter().filter(|one| one.output == output);
        largest_first(own, |one| one.span)
    }

    /// Elementary effects of inputs on an output, the largest first.
    pub(in super::super) fn elementary_on(&self, output: &str) -> Vec<&Elementary> {
        let own = self.elementary.iter().filter(|one| one.output == output);
        largest_first(own, |one| one.mu_star)
    }

    /// Sobol's indices of an output, the largest total first.
    pub(in super::super) fn indices_of(&self, output: &str) -> Vec<&Indices> {
        let own = self.indices.iter().filter(|one| one.output == output);
        largest_first(own, |one| one.total)
    }
}

fn largest_first<'a, T>(own: impl Iterator<Item = &'a T>, size: impl Fn(&T) -> f64) -> Vec<&'a T> {
    let mut own: Vec<&T> = own.collect();
    own.sort_by(|one, other| size(other).total_cmp(&size(one)));
    own
}

fn outputs<'a>(plan: &Plan, store: &Store) -> Result<Vec<Named<'a, Output>>, StudyError> {
    let outputs = plan.study().answers.outputs.iter();
    let named = |of: &&'static Output| {
        let column = store.column(plan, of.name)?;
        Ok(Named { of: *of, column })
    };
    outputs.map(named).collect()
}
