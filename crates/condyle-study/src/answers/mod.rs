//! The answers of a study, computed from its stored tests.

pub(crate) mod data;
pub(crate) mod effects;
pub(crate) mod emulated;
pub(crate) mod indices;
pub(crate) mod ranking;
pub(crate) mod robust;
pub(crate) mod words;

use std::{cmp::Reverse, collections::BTreeMap};

use condyle_lab::aligned;
use condyle_report::study::title_of_path;
use condyle_results::split_unit;
use serde::Serialize;

use crate::{
    adaptive::Aim,
    answers::{
        data::{Data, Doubtful, Spread, of_design},
        effects::{Effect, Elementary},
        emulated::{Emulated, emulated},
        indices::Indices,
        ranking::{Best, Front, Lead, RankedDesign, Ranking},
        robust::Robust,
        words::{chance_in_words, label, labelled, percent, percents, shown, with_interval},
    },
    error::StudyError,
    plan::Plan,
    search::Standing,
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
        let is_number = number.parse::<f64>().is_ok();
        if is_number {
            word.replace(number, "#")
        } else {
            word.to_owned()
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
        let of_robust = robust
            .iter()
            .map(|robust| robust.comparison.optimum.row as u64);
        let optima = best.iter().filter_map(|best| best.row).chain(of_robust);
        let doubtful_optima = data.doubtful(optima.chain(of_front));
        Ok(Self {
            title: study.title.clone(),
            design: study.design.word(),
            tests: plan.tests(),
            kept: store.count()?,
            failed: counted("failed")?,
            doubtful: counted("done")?,
            spreads: data.spreads(),
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

    /// Sobol indices of a design: those of its first output, the largest total first, then those of each output with a limit in
    /// the same order.
    pub(crate) fn largest_indices(&self, design: Option<&str>) -> Vec<Vec<&Indices>> {
        let own = self.indices.iter();
        let own: Vec<&Indices> = own.filter(|one| one.design.as_deref() == design).collect();
        let mut outputs = own.chunk_by(|one, other| one.output == other.output);
        let Some(first) = outputs.next() else {
            return Vec::new();
        };
        let first = largest_first(first.iter().copied(), |one| one.total);
        let has_limit = |output: &str| {
            let mut spreads = self.spreads.iter();
            spreads.any(|one| one.output == output && !one.beyond.is_empty())
        };
        let limited = outputs.filter(|indices| has_limit(indices[0].output));
        let in_order = |indices: &[&'_ Indices]| {
            let of = |one: &&Indices| indices.iter().position(|other| other.input == one.input);
            first.iter().filter_map(of).collect::<Vec<_>>()
        };
        let limited = limited.map(|indices| {
            in_order(indices)
                .into_iter()
                .map(|place| indices[place])
                .collect()
        });
        let limited: Vec<Vec<&Indices>> = limited.collect();
        std::iter::once(first).chain(limited).collect()
    }

    /// Returns the number of doubtful tests and that of each doubt, the most frequent first, in a sentence; none if all are sound.
    pub(crate) fn doubts(&self) -> Option<String> {
        let mut tests_by_check = BTreeMap::new();
        for TestsByReason { reason, tests } in &self.doubtful {
            for check in reason.split_whitespace() {
                *tests_by_check.entry(check).or_insert(0) += tests;
            }
        }
        let mut by_check: Vec<_> = tests_by_check.into_iter().collect();
        by_check.sort_by_key(|(_, tests)| Reverse(*tests));
        let by_check = by_check
            .into_iter()
            .map(|(check, tests)| format!("{check} in {tests}"));
        let by_check = by_check.collect::<Vec<_>>().join(", ");
        let tests: u64 = self.doubtful.iter().map(|one| one.tests).sum();
        let kept = self.kept;
        (tests > 0).then(|| {
            format!("{tests} of {kept} tests are doubtful ({by_check}): see the column reason of table.csv.\n")
        })
    }

    pub(crate) fn failed_tests(&self) -> u64 {
        self.failed.iter().map(|failed| failed.tests).sum()
    }

    /// Returns the main answer in a sentence; none for a study without one.
    pub(crate) fn sentence(&self) -> Option<String> {
        let of_search = || self.best.as_ref().and_then(sentence_of_search);
        let of_designs = || self.ranking.as_ref().and_then(sentence_of_designs);
        let of_front = || self.front.as_ref().and_then(sentence_of_front);
        let of_optimum = || {
            let of_robust = || self.robust.as_ref().map(Robust::sentence);
            let optimum = of_search().or_else(of_robust).or_else(of_front)?;
            Some(
                format!("{optimum} {}", self.doubts_of_optimum())
                    .trim()
                    .to_owned(),
            )
        };
        let of_aim = || {
            let aim = self.aim.as_ref()?.sentence();
            let indices = self.sentence_of_indices().unwrap_or_default();
            Some(format!("{aim} {indices}").trim().to_owned())
        };
        let of_tests = || {
            let both = [of_designs(), self.sentence_of_indices()];
            let both: Vec<String> = both.into_iter().flatten().collect();
            (!both.is_empty()).then(|| both.join(" "))
        };
        of_aim().or_else(of_optimum).or_else(of_tests)
    }

    /// Returns the doubts about the optimum, or about a front and its knee, in sentences; empty if they are sound.
    fn doubts_of_optimum(&self) -> String {
        let doubtful = &self.doubtful_optima;
        let front = self.front.as_ref().filter(|front| front.is_searched);
        let mut named = doubtful.iter();
        let named = named.find(|one| front.is_none_or(|front| front.knee == Some(one.row)));
        let named = named.map(|Doubtful { row, checks }| {
            format!("Row {row} is doubtful: {}.", checks.replace(' ', ", "))
        });
        let of_front = front.filter(|_| !doubtful.is_empty()).map(|front| {
            let (count, tests) = (doubtful.len(), front.tests.len());
            format!("Doubtful tests on the front: {count} of {tests}.")
        });
        named
            .into_iter()
            .chain(of_front)
            .collect::<Vec<_>>()
            .join(" ")
    }

    fn sentence_of_indices(&self) -> Option<String> {
        let all = self.largest_indices(self.designs()[0]);
        let two = all.first()?.get(..2)?;
        let (named, [sum, low, high]) = indices::sum_of_first(two);
        let (first, output) = (named.first()?, two[0].title());
        // Only an excess that the scatter of both does not explain.
        if low > 1.0 {
            return Some(format!(
                "The {} {} are too few for indices of {output}: those of two inputs add up to {}.",
                first.bases,
                self.kind_of_tests(),
                percent(sum)
            ));
        }
        let title = |index: &Indices| title_of_path(self.name_of(&index.input)).0;
        let explain = match named.get(1) {
            Some(other) => format!("and {} explain", within_sentence(&title(other))),
            None => "explains".to_owned(),
        };
        let [sum, low, high] = [sum, low, high].map(|share| share.clamp(0.0, 1.0));
        let share = with_interval(sum, [low, high]);
        Some(format!(
            "{} {explain} {share} of the variance of {output}.",
            title(first)
        ))
    }

    /// Returns the name that the study gives an input; its key if it gives none.
    pub(crate) fn name_of<'a>(&'a self, input: &'a str) -> &'a str {
        let mut effects = self.effects.iter();
        let own = effects.find(|effect| effect.input == input);
        own.map_or(input, |effect| &effect.name)
    }

    /// Returns how a search for an optimum ended, in a sentence; none for other studies.
    pub(crate) fn end_of_search(&self) -> Option<String> {
        let is_unknown = self.best.as_ref().is_none_or(|best| best.row.is_none());
        let front = self.front.as_ref().filter(|front| !front.tests.is_empty());
        if self.design == "optimise" && is_unknown && self.robust.is_none() && front.is_none() {
            let advice = "widen the ranges of the inputs or the limits, or allow more tests";
            // Without an optimum and a front, the search is robust.
            let needs = if self.best.is_none() && self.front.is_none() {
                "is predicted to keep every limit and to be solved under enough disturbances"
            } else {
                "keeps every limit"
            };
            return Some(format!("No tested design {needs}: {advice}.\n"));
        }
        if let Some(front) = front.filter(|front| front.is_searched) {
            return Some(match front.is_converged {
                Some(true) => {
                    "The search has converged, also after space-filling tests.\n".to_owned()
                }
                _ => "The front may be incomplete; allow more tests.\n".to_owned(),
            });
        }
        let best = self
            .best
            .as_ref()
            .map(|best| (best.standing, best.minimised, best.unit));
        let robust = self.robust.as_ref();
        let robust = robust.map(|robust| (robust.standing, &*robust.statistic, robust.unit));
        let (standing, minimised, unit) = best.or(robust)?;
        Some(end_of_search(&standing?, &label(minimised), unit))
    }

    /// Tables in Markdown, short enough for a terminal.
    pub fn markdown(&self) -> String {
        let designs = self.designs();
        let tables = self.tables(&designs[..1]);
        let mut parts: Vec<String> = tables.iter().map(|(_, rows)| aligned(rows)).collect();
        if let Some(first) = self.failed.first() {
            let (failed, kept, own) = (self.failed_tests(), self.kept, first.tests);
            let reason = &first.reason;
            let failed =
                format!("{failed} of {kept} tests failed, {own} of them because of: {reason}\n");
            parts.insert(1, failed);
        }
        if designs.len() > 1 && !self.effects.is_empty() {
            parts.push("Indices and effects of the other designs are on the page.\n".to_owned());
        }
        parts.extend(self.doubts());
        parts.extend(Some(self.doubts_of_optimum() + "\n").filter(|one| one != "\n"));
        parts.extend(self.end_of_search());
        parts.extend(self.aim.as_ref().map(|aim| aim.sentence() + "\n"));
        parts.join("\n")
    }

    /// Tables with their headings, those of indices and effects for each of `designs`; the first row of each is its head.
    pub(crate) fn tables(&self, designs: &[Option<&str>]) -> Vec<(String, Vec<Vec<String>>)> {
        let of_designs = designs.iter().flat_map(|design| {
            [
                ("Sobol indices", self.table_of_indices(*design)),
                ("Effects of inputs", self.table_of_effects(*design)),
            ]
            .map(|(name, rows)| (of_design(name, *design), rows))
        });
        let tables = [
            ("Best", self.table_of_best()),
            (
                "Robust optimum",
                self.robust.as_ref().map(Robust::table).unwrap_or_default(),
            ),
            ("Pareto front", self.table_of_front()),
            ("Outputs", self.table_of_spreads()),
            ("Ranking", self.table_of_designs()),
            ("Pairs of designs", self.table_of_beats()),
            ("Emulators", self.table_of_emulators()),
            ("Elementary effects of Morris", self.table_of_elementary()),
        ];
        let tables = tables.map(|(name, rows)| (name.to_owned(), without_empty_columns(&rows)));
        let all = tables.into_iter().chain(of_designs);
        all.filter(|(_, rows)| !rows.is_empty()).collect()
    }

    fn table_of_spreads(&self) -> Vec<Vec<String>> {
        // The tests of an adaptive study are no sample; the emulators state the distributions.
        if self.aim.is_some() && self.emulated.iter().any(|one| one.distribution.is_some()) {
            return Vec::new();
        }
        // The output of a test that could not be solved is unknown: the numbers are those of the others.
        let has_unsolved = self.spreads.iter().any(|spread| spread.unsolved > 0);
        let output = ["output", "output, where known"][usize::from(has_unsolved)];
        let mut head = vec![
            output,
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
        head.extend(has_unsolved.then_some("known in"));
        table(&head, &self.spreads, |spread| {
            let [_, p5, _, p50, _, p95, _] = spread.percentiles;
            // An emulator knows the probability better than the tests that it was fitted to.
            let mut emulated = self.emulated.iter();
            let is_emulated = emulated.any(|one| {
                (one.output, &one.design) == (spread.output, &spread.design)
                    && one.distribution.is_some()
            });
            let counted = spread.beyond.iter().filter(|_| !is_emulated);
            let beyond = counted.map(|beyond| {
                let [low, high] = beyond.interval.map(percent);
                let share = percents(beyond.share);
                // The share of tests that a search has chosen is no probability and has no interval.
                match spread.is_sample {
                    true => format!("{share} ({low} to {high})"),
                    false => share,
                }
            });
            let (least, most) = (spread.least, spread.most);
            let numbers = [
                least,
                p5,
                p50,
                p95,
                most,
                spread.mean,
                spread.standard_deviation,
            ];
            let mut row = vec![spread.name(), spread.unit.to_owned()];
            row.extend(numbers.map(shown));
            row.push(beyond.collect::<Vec<_>>().join(", "));
            let solved = || format!("{} of {}", spread.tests, spread.tests + spread.unsolved);
            row.extend(has_unsolved.then(solved));
            row
        })
    }

    fn table_of_designs(&self) -> Vec<Vec<String>> {
        let Some(ranking) = &self.ranking else {
            return Vec::new();
        };
        let (compared, solved) = (ranking.disturbances, ranking.solved);
        let design = format!("design, {compared} disturbances");
        let mut mean = format!("{}, {}", ranking.title, ranking.unit);
        if solved < compared {
            mean += &format!(" ({solved} with all solved)");
        }
        let mut counts: Vec<(&str, CountOfDesign)> = vec![
            ("failed", |design| design.failed),
            ("doubtful", |design| design.doubtful),
        ];
        counts.retain(|(_, count)| ranking.designs.iter().any(|design| count(design) > 0));
        let mut head = vec![design.as_str()];
        head.extend(counts.iter().map(|(name, _)| *name));
        head.extend([&mean, "SD", "within limits", "best", "beats another"]);
        table(&head, &ranking.designs, |design| {
            let counts = counts.iter();
            let counts = counts.map(|(_, count)| format!("{} of {}", count(design), design.tests));
            let numbers = [
                shown(design.mean),
                shown(design.standard_deviation),
                ranking.share(design.within_limits, design.within_limits_interval),
                ranking.share(design.best, design.best_interval),
                percent(design.wins),
            ];
            let name = [design.name.clone()].into_iter();
            name.chain(counts).chain(numbers).collect()
        })
    }

    /// Returns how often each design beats each other one.
    fn table_of_beats(&self) -> Vec<Vec<String>> {
        let ranking = self.ranking.as_ref();
        let Some(ranking) = ranking.filter(|ranking| ranking.designs.len() > 1) else {
            return Vec::new();
        };
        let names = ranking.designs.iter().map(|design| design.name.as_str());
        let head: Vec<&str> = std::iter::once("design, how often it beats")
            .chain(names)
            .collect();
        table(&head, &ranking.designs, |design| {
            let shares = design.beats.iter().zip(&design.beats_intervals);
            let shares = shares
                .zip(&ranking.designs)
                .map(
                    |((share, interval), other)| match other.name == design.name {
                        true => "-".to_owned(),
                        false => ranking.share(*share, *interval),
                    },
                );
            std::iter::once(design.name.clone()).chain(shares).collect()
        })
    }

    fn table_of_emulators(&self) -> Vec<Vec<String>> {
        if self.emulated.is_empty() {
            return Vec::new();
        }
        // The indices of a Saltelli design are those of its tests.
        let used = match self.design {
            "saltelli" => "used for limits",
            _ => "used for indices and limits",
        };
        let head = [
            "emulator of",
            "tests",
            "Q2",
            used,
            "unit",
            "5 %",
            "median",
            "95 %",
            "mean",
            "SD",
            "beyond its limit",
        ];
        table(&head, &self.emulated, |one| {
            let beyond = one.beyond.iter();
            let beyond = beyond.map(|one| chance_in_words(one.probability, one.interval));
            let why_not = one.why_not_used();
            let used = why_not.map_or_else(|| "yes".to_owned(), |why| format!("no, {why}"));
            let numbers = one.distribution.as_ref().map(|own| {
                let [_, p5, _, p50, _, p95, _] = own.percentiles;
                [p5, p50, p95, own.mean, own.standard_deviation].map(shown)
            });
            let mut row = vec![
                of_design(one.title, one.design.as_deref()),
                one.tests.to_string(),
                format!("{:.4}", one.q2),
                used,
                one.unit.to_owned(),
            ];
            row.extend(numbers.unwrap_or_default());
            row.push(beyond.collect::<Vec<_>>().join(", "));
            row
        })
    }

    /// Returns the word for the tests from which indices are computed: those of an emulator, or bases of a Saltelli design.
    fn kind_of_tests(&self) -> &'static str {
        if self.design == "saltelli" {
            "bases"
        } else {
            "tests"
        }
    }

    fn table_of_indices(&self, design: Option<&str>) -> Vec<Vec<String>> {
        let range = |[low, high]: [f64; 2]| format!("{low:.3} to {high:.3}");
        let all = self.largest_indices(design);
        let Some((first, limited)) = all.split_first() else {
            return Vec::new();
        };
        let (counted, kind) = (first[0].bases, self.kind_of_tests());
        let input = format!("input, by {}, {counted} {kind}", first[0].title());
        let limited_heads = limited
            .iter()
            .map(|one| format!("{}: total", label(one[0].output)));
        let limited_heads: Vec<String> = limited_heads.collect();
        let mut head = vec![input.as_str(), "first", "95 %", "total", "95 %"];
        head.extend(limited_heads.iter().flat_map(|one| [one.as_str(), "95 %"]));
        let places: Vec<usize> = (0..first.len()).collect();
        table_of_most(&head, &places.iter().collect::<Vec<_>>(), |place| {
            let index = first[*place];
            let mut row = vec![
                self.name_of(&index.input).to_owned(),
                index.first_in_words(),
                range(index.first_interval),
            ];
            let totals = std::iter::once(first).chain(limited).map(|one| one[*place]);
            row.extend(totals.flat_map(|one| [one.total_in_words(), range(one.total_interval)]));
            row
        })
    }

    fn table_of_elementary(&self) -> Vec<Vec<String>> {
        let all = self.largest_elementary();
        let input = format!(
            "input, by {}",
            all.first()
                .map_or_else(String::new, |one| label(one.output))
        );
        table_of_most(&[&input, "mu*", "mu", "sigma"], &all, |effect| {
            let half = effect.mu_star_half_interval;
            let half = half.map_or_else(String::new, |half| format!(" +/- {}", shown(half)));
            vec![
                self.name_of(&effect.input).to_owned(),
                format!("{}{half}", shown(effect.mu_star)),
                shown(effect.mu),
                shown(effect.sigma),
            ]
        })
    }

    /// Returns the table of effects in a design, for studies without a specific table.
    fn table_of_effects(&self, design: Option<&str>) -> Vec<Vec<String>> {
        let is_counted = self.design == "saltelli";
        if is_counted || !self.elementary.is_empty() {
            return Vec::new();
        }
        let output = self.effects.first().map_or("", |one| one.output);
        let all = self.main_effects_on(output, design);
        let unit = split_unit(output).1.unwrap_or_default();
        let moves = format!("moves {} by, {unit}", label(output));
        let input = of_design("input", design);
        let dash = || "-".to_owned();
        let head = [
            &input,
            &moves,
            "by chance or error up to",
            "rank correlation",
        ];
        table_of_most(&head, &all, |effect| {
            let correlation = effect.rank_correlation.map(|one| format!("{one:+.2}"));
            vec![
                effect.name.clone(),
                shown(effect.span),
                effect.span_by_chance.map_or_else(dash, shown),
                correlation.unwrap_or_else(dash),
            ]
        })
    }

    /// Returns the table of the front of a search for it; other studies show it as a picture.
    fn table_of_front(&self) -> Vec<Vec<String>> {
        let Some(front) = self.front.as_ref().filter(|front| front.is_searched) else {
            return Vec::new();
        };
        let titles = front.titles.iter().zip(front.units);
        let titles = titles.map(|(title, unit)| format!("{title}, {unit}"));
        let names = front.inputs.iter().map(|input| input.name.clone());
        let head: Vec<String> = ["row".to_owned()]
            .into_iter()
            .chain(titles)
            .chain(names)
            .collect();
        let row = |(place, (row, one, other)): (usize, &(u64, f64, f64))| {
            let is_doubtful = self.doubtful_optima.iter().any(|one| one.row == *row);
            let notes = [
                (Some(*row) == front.knee, " knee"),
                (is_doubtful, " doubtful"),
            ];
            let notes = notes.into_iter().filter(|(is, _)| *is);
            let notes: String = notes.map(|(_, note)| note).collect();
            let inputs = front.inputs.iter().map(|input| shown(input.values[place]));
            let outputs = [one, other].map(|value| shown(*value));
            let row = [format!("{row}{notes}")].into_iter().chain(outputs);
            row.chain(inputs).collect::<Vec<_>>()
        };
        let rows = front.tests.iter().enumerate().map(row);
        std::iter::once(head).chain(rows).collect()
    }

    fn table_of_best(&self) -> Vec<Vec<String>> {
        let Some(best) = &self.best else {
            return Vec::new();
        };
        let head = match best.row {
            Some(row) => format!("least {}: row {row}", label(best.minimised)),
            None => "no test keeps every limit".to_owned(),
        };
        let inputs = best.inputs.iter().map(|one| (one, String::new()));
        let outputs = best
            .outputs
            .iter()
            .map(|one| (one, margins(best, &one.name)));
        let values: Vec<_> = inputs.chain(outputs).collect();
        let head = [&head, "value", "first design", "margin to its limit"];
        table(&head, &values, |(one, margins)| {
            vec![
                labelled(&one.name),
                shown(one.value),
                shown(one.first),
                margins.clone(),
            ]
        })
    }
}

/// Returns the ends and the knee of a front in a sentence, the knee with its design; none for a study that did not search for
/// it.
fn sentence_of_front(front: &Front) -> Option<String> {
    let ends = front.tests.first().zip(front.tests.last());
    let (low, high) = ends.filter(|_| front.is_searched)?;
    let ([name, other_name], [unit, other_unit]) = (front.titles, front.units);
    let [from, to] = [low, high].map(|test| {
        let (one, other) = (shown(test.1), shown(test.2));
        format!("{name} {one} {unit} at {other_name} {other} {other_unit}")
    });
    let knee = front.place_of_knee().map_or_else(String::new, |place| {
        let (row, one, other) = &front.tests[place];
        let [one, other] = [one, other].map(|value| shown(*value));
        let design = front.inputs.iter();
        let design = design.map(|input| {
            let (title, unit) = title_of_path(&input.name);
            let words = format!(
                "{} {} {unit}",
                within_sentence(&title),
                shown(input.values[place])
            );
            words.trim_end().to_owned()
        });
        let design = design.collect::<Vec<_>>().join(", ");
        format!("; its knee, row {row}, has {one} {unit} and {other} {other_unit} with {design}")
    });
    Some(format!(
        "The best compromises go from {from} to {to}{knee}."
    ))
}

fn sentence_of_search(best: &Best) -> Option<String> {
    let minimised = best.outputs.iter().find(|one| one.name == best.minimised)?;
    let (name, unit, row) = (label(best.minimised), best.unit, best.row?);
    let (value, first) = (shown(minimised.value), minimised.first);
    let first = if first.is_nan() {
        "is not solved".to_owned()
    } else {
        format!("has {} {unit}", shown(first))
    };
    Some(format!(
        "The least {name} within all limits is {value} {unit}, in row {row}; the first design {first}."
    ))
}

/// Counts tests of a design.
type CountOfDesign = fn(&RankedDesign) -> usize;

fn sentence_of_designs(ranking: &Ranking) -> Option<String> {
    let first = ranking.designs.first()?;
    let compared = ranking.disturbances;
    if ranking.designs.iter().all(|design| design.best == 0.0) {
        return Some(format!(
            "The designs cannot be compared: under none of the {compared} disturbances could a design be solved."
        ));
    }
    let listed = |title: &str, count: CountOfDesign| {
        let designs = ranking.designs.iter();
        let counts = designs.map(|one| format!("{} of {} of {}", count(one), one.tests, one.name));
        let counts = counts.collect::<Vec<_>>().join(", ");
        let has_any = ranking.designs.iter().any(|one| count(one) > 0);
        match has_any {
            true => format!(" {title}: {counts}."),
            false => String::new(),
        }
    };
    let failed = listed(
        "Tests that could not be solved count as worse than solved ones",
        |one| one.failed,
    );
    let doubtful = listed("Doubtful tests", |one| one.doubtful);
    let answer = match first.keeps_limits {
        true => sentence_of_first(ranking, first),
        false => sentence_of_nearest(ranking, first),
    };
    let parts = match ranking.is_sample {
        true => "",
        false => " The disturbances are no random sample: the percentages are parts of them.",
    };
    Some(format!("{answer}{parts}{failed}{doubtful}"))
}

fn sentence_of_first(ranking: &Ranking, first: &RankedDesign) -> String {
    let best = ranking.share(first.best, first.best_interval);
    let within = ranking.share(first.within_limits, first.within_limits_interval);
    let (name, title, compared) = (&first.name, ranking.title, ranking.disturbances);
    let limits = match ranking.limits.len() {
        1 => String::new(),
        _ => format!(", and keeps every limit under {within}"),
    };
    let next = first.lead.as_ref().zip(ranking.designs.get(1));
    let lead = next.map_or_else(String::new, |(lead, next)| {
        in_words_of_lead(ranking, lead, next)
    });
    format!(
        "{name} ranks first{lead}: it has the least {title} under {best} of the {compared} disturbances{limits}."
    )
}

/// Returns how much less the output of the first design is than that of the next one.
fn in_words_of_lead(ranking: &Ranking, lead: &Lead, next: &RankedDesign) -> String {
    let Lead { mean, range } = lead;
    let ([low, high], less) = match *mean >= 0.0 {
        true => (*range, "less"),
        false => (range.map(|end| -end), "more"),
    };
    let [low, high] = [low.min(high), low.max(high)].map(shown);
    let (unit, title) = (ranking.unit, ranking.title);
    let own = shown(next.mean - mean);
    let part = match next.mean {
        0.0 => String::new(),
        all => format!(" ({})", percent(mean.abs() / all.abs())),
    };
    let mean = shown(mean.abs());
    let broken = ["", ", which breaks a limit"][usize::from(!next.keeps_limits)];
    let words = format!(
        " with {title} {own} {unit}, {mean} {unit}{part} {less} than {} ({low} to {high} {unit} {less} under 95 % of the \
         disturbances){broken}",
        next.name
    );
    // Shares have no unit.
    words.replace(" ,", ",").replace("  ", " ")
}

/// Returns that no design keeps the limits, which one comes nearest, and what is wrong with that of the least output.
fn sentence_of_nearest(ranking: &Ranking, nearest: &RankedDesign) -> String {
    let limits = &ranking.limits;
    let probability = limits[0].probability;
    let enough = match limits.iter().all(|one| one.probability == probability) {
        true => format!("{} of the disturbances", percent(probability)),
        false => "the required part of the disturbances".to_owned(),
    };
    let keeps = if limits.len() == 1 {
        "can be solved"
    } else {
        "keeps every limit"
    };
    let name = &nearest.name;
    let within = ranking.share(nearest.within_limits, nearest.within_limits_interval);
    let broken = |design: &RankedDesign| {
        let kept = design.kept.iter().zip(limits);
        let broken = kept.filter(|(kept, limit)| **kept < limit.probability);
        let broken =
            broken.map(|(kept, limit)| format!("{} under {}", limit.words, percent(*kept)));
        broken.collect::<Vec<_>>().join(", ")
    };
    let nearest_one = match nearest.within_limits > 0.0 {
        true => format!("{name} comes nearest, under {within}: {}.", broken(nearest)),
        false => format!(
            "None does under any disturbance; {name} keeps {}.",
            broken(nearest)
        ),
    };
    let mut designs = ranking.designs.iter();
    let least = designs.find(|one| one.wins > nearest.wins && one.best > 0.5);
    let least = least.map_or_else(String::new, |least| {
        let (name, best) = (&least.name, ranking.share(least.best, least.best_interval));
        format!(
            " {name} has the least {} under {best}, but {}: {}.",
            ranking.title,
            ["breaks a limit", "not in enough solved tests"][usize::from(limits.len() == 1)],
            broken(least)
        )
    });
    format!("No design {keeps} under {enough}. {nearest_one}{least}")
}

/// Returns a title as it stands within a sentence: "AP force" keeps its capitals.
fn within_sentence(title: &str) -> String {
    let is_word = title.chars().nth(1).is_none_or(char::is_lowercase);
    let mut letters = title.chars();
    let first = letters.next().filter(|_| is_word);
    first.map_or_else(
        || title.to_owned(),
        |first| first.to_lowercase().chain(letters).collect(),
    )
}

/// Returns the margins of the best test to the limits of an output, in words.
fn margins(best: &Best, output: &str) -> String {
    let own = best.margins.iter().filter(|one| one.output == output);
    let own = own.map(|one| format!("{} to {}", shown(one.margin), shown(one.limit)));
    own.collect::<Vec<_>>().join(", ")
}

/// Returns how a search ended, in a sentence.
fn end_of_search(standing: &Standing, minimised: &str, unit: &str) -> String {
    let [improvement, error] =
        [standing.expected_improvement, standing.left_out_error.abs()].map(shown);
    let end = if standing.is_converged {
        "The search has converged, also after space-filling tests"
    } else {
        "The optimum may be local; allow more tests"
    };
    format!(
        "{end}: another test is expected to lower the {minimised} by {improvement} {unit} at most. Its emulator (Q2 {:.4}) predicts the \
         best test from the others within {error} {unit}.\n",
        standing.q2
    )
}

fn largest_first<'a, T>(own: impl Iterator<Item = &'a T>, size: impl Fn(&T) -> f64) -> Vec<&'a T> {
    let mut own: Vec<&T> = own.collect();
    own.sort_by(|one, other| size(other).total_cmp(&size(one)));
    own
}

/// Returns a table without the columns that are empty below their head, such as that of a limit where no output has one.
fn without_empty_columns(rows: &[Vec<String>]) -> Vec<Vec<String>> {
    let is_filled = |column: usize| {
        rows.iter()
            .skip(1)
            .any(|row| row.get(column).is_some_and(|cell| !cell.is_empty()))
    };
    let filled = |row: &Vec<String>| {
        row.iter()
            .enumerate()
            .filter(|(column, _)| is_filled(*column))
            .map(|(_, cell)| cell.clone())
            .collect()
    };
    rows.iter().map(filled).collect()
}

/// Returns the head and a row for each of `all`.
pub(crate) fn table<T>(
    head: &[&str],
    all: &[T],
    row: impl Fn(&T) -> Vec<String>,
) -> Vec<Vec<String>> {
    let head = head.iter().map(|&title| title.to_owned()).collect();
    std::iter::once(head).chain(all.iter().map(row)).collect()
}

/// Returns the same table for the inputs with the largest effects, with the number of others in its last row. Empty if
/// there are no inputs.
fn table_of_most<T>(
    head: &[&str],
    all: &[&T],
    row: impl Fn(&T) -> Vec<String>,
) -> Vec<Vec<String>> {
    const MAX_ROWS: usize = 24;
    if all.is_empty() {
        return Vec::new();
    }
    let shown = all.len().min(MAX_ROWS);
    let mut rows = table(head, &all[..shown], |one| row(one));
    if all.len() > shown {
        let mut more = vec![String::new(); head.len()];
        more[0] = format!("and {} more, in answers.json", all.len() - shown);
        rows.push(more);
    }
    rows
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
