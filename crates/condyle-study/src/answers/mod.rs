//! What the tests of a study tell.

pub(crate) mod effects;
pub(crate) mod indices;
pub(crate) mod ranking;
pub(crate) mod spread;

use condyle_lab::aligned;
use condyle_results::catalogue::Scalar;
use serde::Serialize;

use crate::{
    answers::{
        effects::{Effect, Elementary},
        indices::Indices,
        ranking::{Best, Front, Ranking},
        spread::{Named, Spread},
    },
    error::StudyError,
    plan::Plan,
    store::Store,
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
    pub(crate) fn of(plan: &Plan, store: &Store) -> Result<Self, StudyError> {
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
            elementary: effects::all_elementary(plan, &outputs),
            indices: indices::all(plan, &outputs),
            ranking: Ranking::of(plan, store)?,
            front: Front::of(plan, store)?,
            best: Best::of(plan, store)?,
        })
    }
}

impl Answers {
    /// Effects of inputs on an output, the largest first.
    pub(crate) fn effects_on(&self, output: &str) -> Vec<&Effect> {
        let own = self.effects.iter().filter(|one| one.output == output);
        largest_first(own, |one| one.span)
    }

    /// Elementary effects of inputs on an output, the largest first.
    pub(crate) fn elementary_on(&self, output: &str) -> Vec<&Elementary> {
        let own = self.elementary.iter().filter(|one| one.output == output);
        largest_first(own, |one| one.mu_star)
    }

    /// Sobol's indices of an output, the largest total first.
    pub(crate) fn indices_of(&self, output: &str) -> Vec<&Indices> {
        let own = self.indices.iter().filter(|one| one.output == output);
        largest_first(own, |one| one.total)
    }
}

fn largest_first<'a, T>(own: impl Iterator<Item = &'a T>, size: impl Fn(&T) -> f64) -> Vec<&'a T> {
    let mut own: Vec<&T> = own.collect();
    own.sort_by(|one, other| size(other).total_cmp(&size(one)));
    own
}

fn outputs<'a>(plan: &Plan, store: &Store) -> Result<Vec<Named<'a, Scalar>>, StudyError> {
    let outputs = plan.study().answers.outputs.iter();
    let named = |of: &&'static Scalar| {
        let column = store.column(plan, of.key)?;
        Ok(Named { of: *of, column })
    };
    outputs.map(named).collect()
}

/// Rows of a table of inputs at most; the page has all.
const MAX_ROWS: usize = 12;

/// A heading, and rows of which the first is the head.
type Table = (String, Vec<Vec<String>>);

impl Answers {
    /// Tables in Markdown, short enough for a terminal.
    pub fn markdown(&self) -> String {
        let tables = self.tables();
        let mut parts: Vec<String> = tables.iter().map(|(_, rows)| aligned(rows)).collect();
        parts.insert(1, failed(self).unwrap_or_default());
        parts.push(self.best.as_ref().map(how_it_ended).unwrap_or_default());
        parts.retain(|part| !part.is_empty());
        parts.join("\n")
    }

    /// Tables with their headings, the first row of each its head.
    pub(crate) fn tables(&self) -> Vec<Table> {
        let parts = [
            Some(spreads(self)),
            self.ranking.as_ref().map(ranking),
            indices(self),
            elementary(self),
            effects(self),
            self.best.as_ref().map(best),
        ];
        parts.into_iter().flatten().collect()
    }
}

fn table(heading: &str, head: &[&str], rows: impl Iterator<Item = Vec<String>>) -> Table {
    let head = head.iter().map(|title| (*title).to_owned()).collect();
    (
        heading.to_owned(),
        std::iter::once(head).chain(rows).collect(),
    )
}

/// Four significant digits.
pub(crate) fn shown(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return format!("{value:.0}");
    }
    let decimals = (3 - value.abs().log10().floor() as i32).max(0) as usize;
    format!("{value:.decimals$}")
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

fn range([low, high]: [f64; 2]) -> String {
    format!("{low:.3} to {high:.3}")
}

fn spreads(answers: &Answers) -> Table {
    let head = [
        "output",
        "unit",
        "least",
        "5 %",
        "median",
        "95 %",
        "most",
        "mean",
        "SD",
        "beyond its limit",
    ];
    let rows = answers.spreads.iter().map(|spread| {
        let [_, p5, _, p50, _, p95, _] = spread.percentiles.map(shown);
        let beyond = spread.beyond.iter().map(|beyond| {
            let [low, high] = beyond.interval.map(percent);
            format!("{} ({low} to {high})", percent(beyond.share))
        });
        let (mean, deviation) = (shown(spread.mean), shown(spread.standard_deviation));
        let beyond: Vec<String> = beyond.collect();
        let names = [
            spread.title.to_owned(),
            spread.unit.to_owned(),
            shown(spread.least),
        ];
        let numbers = [
            p5,
            p50,
            p95,
            shown(spread.most),
            mean,
            deviation,
            beyond.join(", "),
        ];
        names.into_iter().chain(numbers).collect()
    });
    table("Outputs", &head, rows)
}

fn failed(answers: &Answers) -> Option<String> {
    let failed: u64 = answers.failed.iter().map(|failed| failed.tests).sum();
    let first = answers.failed.first()?;
    Some(format!(
        "{failed} of {} tests failed, {} of them since: {}\n",
        answers.kept, first.tests, first.reason
    ))
}

fn ranking(ranking: &Ranking) -> Table {
    let mean = format!("{}, {}", ranking.title, ranking.unit);
    let against = ranking
        .designs
        .iter()
        .map(|design| format!("beats {}", design.name));
    let fixed = [
        "design".to_owned(),
        mean,
        "SD".to_owned(),
        "within limits".to_owned(),
        "best".to_owned(),
    ];
    let head: Vec<String> = fixed.into_iter().chain(against).collect();
    let rows = ranking.designs.iter().enumerate().map(|(own, design)| {
        let beats = design.beats.iter().enumerate().map(|(other, share)| {
            if own == other {
                "-".to_owned()
            } else {
                percent(*share)
            }
        });
        let fixed = [
            design.name.clone(),
            shown(design.mean),
            shown(design.standard_deviation),
            percent(design.within_limits),
            percent(design.best),
        ];
        fixed.into_iter().chain(beats).collect()
    });
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    table("Ranking", &head, rows)
}

fn indices(answers: &Answers) -> Option<Table> {
    let output = answers.indices.first()?.output;
    let own = answers.indices_of(output);
    let rows = own.into_iter().take(MAX_ROWS).map(|index| {
        vec![
            index.input.clone(),
            format!("{:.3}", index.first),
            range(index.first_interval),
            format!("{:.3}", index.total),
            range(index.total_interval),
        ]
    });
    let input = format!("input, by {output}");
    Some(table(
        "Indices of Sobol",
        &[input.as_str(), "first", "95 %", "total", "95 %"],
        rows,
    ))
}

fn elementary(answers: &Answers) -> Option<Table> {
    let output = answers.elementary.first()?.output;
    let own = answers.elementary_on(output);
    let rows = own.into_iter().take(MAX_ROWS).map(|effect| {
        vec![
            effect.input.clone(),
            format!(
                "{} +/- {}",
                shown(effect.mu_star),
                shown(effect.mu_star_half_interval)
            ),
            shown(effect.mu),
            shown(effect.sigma),
        ]
    });
    let input = format!("input, by {output}");
    Some(table(
        "Elementary effects of Morris",
        &[input.as_str(), "mu*", "mu", "sigma"],
        rows,
    ))
}

/// Of designs that have no table of their own.
fn effects(answers: &Answers) -> Option<Table> {
    let output = answers.effects.first()?.output;
    if !answers.indices.is_empty() || !answers.elementary.is_empty() || answers.best.is_some() {
        return None;
    }
    let own = answers.effects_on(output);
    let rows = own.into_iter().take(MAX_ROWS).map(|effect| {
        let correlation = effect.rank_correlation.map(|one| format!("{one:+.2}"));
        vec![
            effect.name.clone(),
            shown(effect.span),
            effect.span_by_chance.map_or_else(|| "-".to_owned(), shown),
            correlation.unwrap_or_else(|| "-".to_owned()),
        ]
    });
    let head = [
        "input".to_owned(),
        format!("moves {output} by"),
        "by chance up to".to_owned(),
        "rank correlation".to_owned(),
    ];
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    Some(table("What moves it", &head, rows))
}

fn best(best: &Best) -> Table {
    let head = match best.row {
        Some(row) => format!("least {}: row {row}", best.minimised),
        None => "no test keeps every limit".to_owned(),
    };
    let inputs = best
        .inputs
        .iter()
        .map(|(key, value)| (key.as_str(), *value));
    let rows = inputs.chain(best.outputs.iter().copied());
    let rows = rows.map(|(name, value)| vec![name.to_owned(), shown(value)]);
    table("Best", &[head.as_str(), "value"], rows)
}

fn how_it_ended(best: &Best) -> String {
    let (generations, step) = (best.generations, percent(best.step));
    if best.is_converged {
        return format!(
            "The search closed in after {generations} generations: its steps are {step} of the ranges.\n"
        );
    }
    format!(
        "The search has not closed in: after {generations} generations its steps are {step} of the ranges. Allow more tests.\n"
    )
}
