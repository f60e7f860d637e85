//! The answers of a study in sentences.

use std::{cmp::Reverse, collections::BTreeMap};

use condyle_report::study::title_of_path;

use crate::{
    answers::{
        Answers, TestsByReason,
        data::Doubtful,
        indices::{Indices, sum_of_first},
        ranking::{Best, Front, RankedDesign, Ranking},
        robust::Robust,
        words::{label, percent, shown, with_interval, within_sentence},
    },
    search::Standing,
};

impl Answers {
    /// Returns the main answer in sentences; empty for a study without one.
    pub(crate) fn sentence(&self) -> String {
        let best = self.best.as_ref().and_then(Best::sentence);
        let robust = || self.robust.as_ref().map(Robust::sentence);
        let front = || self.front.as_ref().and_then(Front::sentence);
        let ranking = || self.ranking.as_ref().and_then(Ranking::sentence);
        let parts = match (&self.aim, best.or_else(robust).or_else(front)) {
            (Some(aim), _) => [Some(aim.sentence()), self.sentence_of_indices()],
            (None, Some(optimum)) => [Some(optimum), self.doubts_of_optimum()],
            (None, None) => [ranking(), self.sentence_of_indices()],
        };
        joined(parts).unwrap_or_default()
    }

    /// Returns the doubts about the optimum, or about a front and its knee; none if they are sound.
    pub(super) fn doubts_of_optimum(&self) -> Option<String> {
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
        joined([named, of_front])
    }

    fn sentence_of_indices(&self) -> Option<String> {
        let all = self.largest_indices(self.designs()[0]);
        let (named, [sum, low, high]) = sum_of_first(all.get(..2)?);
        let (first, output) = (named.first()?, all[0].title());
        // Only an excess that the scatter of both does not explain.
        if low > 1.0 {
            let (counted, kind, sum) = (first.bases, self.kind_of_tests(), percent(sum));
            return Some(format!(
                "The {counted} {kind} are too few for indices of {output}: those of two inputs add up to {sum}."
            ));
        }
        let title = |index: &Indices| title_of_path(self.name_of(&index.input)).0;
        let explain = match named.get(1) {
            Some(other) => format!("and {} explain", within_sentence(&title(other))),
            None => "explains".to_owned(),
        };
        let [sum, low, high] = [sum, low, high].map(|share| share.clamp(0.0, 1.0));
        let (first, share) = (title(first), with_interval(sum, [low, high]));
        Some(format!(
            "{first} {explain} {share} of the variance of {output}."
        ))
    }

    /// Returns the word for the tests from which indices are computed: those of an emulator, or bases of a Saltelli design.
    pub(super) fn kind_of_tests(&self) -> &'static str {
        match self.design {
            "saltelli" => "bases",
            _ => "tests",
        }
    }

    /// Returns the number of doubtful tests and that of each doubt, the most frequent first; none if all are sound.
    pub(crate) fn doubts(&self) -> Option<String> {
        let mut tests_by_check = BTreeMap::new();
        for TestsByReason { reason, tests } in &self.doubtful {
            for check in reason.split_whitespace() {
                *tests_by_check.entry(check).or_insert(0) += tests;
            }
        }
        let mut by_check: Vec<_> = tests_by_check.into_iter().collect();
        by_check.sort_by_key(|(_, tests)| Reverse(*tests));
        let by_check = by_check.iter();
        let by_check = by_check.map(|(check, tests)| format!("{check} in {tests}"));
        let by_check = by_check.collect::<Vec<_>>().join(", ");
        let (tests, kept) = (TestsByReason::count(&self.doubtful), self.kept);
        (tests > 0).then(|| {
            format!("{tests} of {kept} tests are doubtful ({by_check}): see the column reason of table.csv.\n")
        })
    }

    /// Returns how a search for an optimum ended; none for other studies.
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
            let end = match front.is_converged {
                Some(true) => "The search has converged, also after space-filling tests.\n",
                _ => "The front may be incomplete; allow more tests.\n",
            };
            return Some(end.to_owned());
        }
        if let Some(best) = &self.best {
            return Some(best.standing?.sentence(&label(best.minimised), best.unit));
        }
        let robust = self.robust.as_ref()?;
        Some(robust.standing?.sentence(&robust.statistic, robust.unit))
    }
}

/// Joins the sentences that there are; none if there is none.
fn joined(sentences: [Option<String>; 2]) -> Option<String> {
    let all: Vec<String> = sentences.into_iter().flatten().collect();
    (!all.is_empty()).then(|| all.join(" "))
}

/// Counts tests of a design.
type CountOfDesign = fn(&RankedDesign) -> usize;

impl Ranking {
    /// Returns the counts of failed and of doubtful tests, each with its name in a table and at the beginning of a sentence; without
    /// those that are zero for every design.
    pub fn counts(&self) -> Vec<(&'static str, &'static str, CountOfDesign)> {
        let mut counts: Vec<(_, _, CountOfDesign)> = vec![
            (
                "failed",
                "Tests that could not be solved count as worse than solved ones",
                |design| design.failed,
            ),
            ("doubtful", "Doubtful tests", |design| design.doubtful),
        ];
        counts.retain(|(_, _, count)| self.designs.iter().any(|design| count(design) > 0));
        counts
    }

    /// Returns the answer in a sentence, and the failed and doubtful tests in others; none without designs.
    pub fn sentence(&self) -> Option<String> {
        let first = self.designs.first()?;
        if self.designs.iter().all(|design| design.best == 0.0) {
            return Some(format!(
                "The designs cannot be compared: under none of the {} disturbances could a design be solved.",
                self.disturbances
            ));
        }
        let mut answer = match first.keeps_limits {
            true => self.sentence_of_first(first),
            false => self.sentence_of_nearest(first),
        };
        if !self.is_sample {
            answer += " The disturbances are no random sample: the percentages are parts of them.";
        }
        for (_, title, count) in self.counts() {
            answer += &format!(" {title}: {}.", self.counted(count));
        }
        Some(answer)
    }

    /// Returns a count of each design in words.
    fn counted(&self, count: CountOfDesign) -> String {
        let designs = self.designs.iter();
        let counts = designs.map(|one| format!("{} of {} of {}", count(one), one.tests, one.name));
        counts.collect::<Vec<_>>().join(", ")
    }

    /// Returns the limits that a design breaks, with how often it keeps them.
    fn broken_in_words(&self, design: &RankedDesign) -> String {
        let kept = design.kept.iter().zip(&self.limits);
        let broken = kept.filter(|(kept, limit)| **kept < limit.probability);
        let words = broken.map(|(kept, limit)| format!("{} under {}", limit.words, percent(*kept)));
        words.collect::<Vec<_>>().join(", ")
    }

    fn sentence_of_first(&self, first: &RankedDesign) -> String {
        let best = self.share(first.best, first.best_interval);
        let within = self.share(first.within_limits, first.within_limits_interval);
        let (name, title, compared) = (&first.name, self.title, self.disturbances);
        let limits = match self.limits.len() {
            1 => String::new(),
            _ => format!(", and keeps every limit under {within}"),
        };
        let next = first.lead.zip(self.designs.get(1));
        let lead = next.map(|(lead, next)| self.lead_in_words(first, lead, next));
        let lead = lead.unwrap_or_default();
        format!(
            "{name} ranks first{lead}: it has the least {title} under {best} of the {compared} disturbances{limits}."
        )
    }

    /// Returns how much less the output of the first design is than that of the next one, with the range of the differences.
    fn lead_in_words(
        &self,
        first: &RankedDesign,
        [low, high]: [f64; 2],
        next: &RankedDesign,
    ) -> String {
        let lead = next.mean - first.mean;
        let ([low, high], less) = match lead >= 0.0 {
            true => ([low, high].map(shown), "less"),
            false => ([-high, -low].map(shown), "more"),
        };
        let (unit, title, own) = (self.unit, self.title, shown(first.mean));
        let part = match next.mean {
            0.0 => String::new(),
            all => format!(" ({})", percent(lead.abs() / all.abs())),
        };
        let lead = shown(lead.abs());
        let broken = ["", ", which breaks a limit"][usize::from(!next.keeps_limits)];
        let words = format!(
            " with {title} {own} {unit}, {lead} {unit}{part} {less} than {} ({low} to {high} {unit} {less} under 95 % of the \
             disturbances){broken}",
            next.name
        );
        // Shares have no unit.
        words.replace(" ,", ",").replace("  ", " ")
    }

    /// Returns that no design keeps the limits, which one comes nearest, and what is wrong with that of the least output.
    fn sentence_of_nearest(&self, nearest: &RankedDesign) -> String {
        let limits = &self.limits;
        let probability = limits[0].probability;
        let enough = match limits.iter().all(|one| one.probability == probability) {
            true => format!("{} of the disturbances", percent(probability)),
            false => "the required part of the disturbances".to_owned(),
        };
        let (keeps, breaks) = match limits.len() {
            1 => ("can be solved", "not in enough solved tests"),
            _ => ("keeps every limit", "breaks a limit"),
        };
        let (name, own) = (&nearest.name, self.broken_in_words(nearest));
        let within = self.share(nearest.within_limits, nearest.within_limits_interval);
        let nearest_one = match nearest.within_limits > 0.0 {
            true => format!("{name} comes nearest, under {within}: {own}."),
            false => format!("None does under any disturbance; {name} keeps {own}."),
        };
        let mut designs = self.designs.iter();
        let least = designs.find(|one| one.wins > nearest.wins && one.best > 0.5);
        let least = least.map_or_else(String::new, |least| {
            let (name, title, broken) = (&least.name, self.title, self.broken_in_words(least));
            let best = self.share(least.best, least.best_interval);
            format!(" {name} has the least {title} under {best}, but {breaks}: {broken}.")
        });
        format!("No design {keeps} under {enough}. {nearest_one}{least}")
    }
}

impl Front {
    /// Returns the ends and the knee in a sentence, the knee with its design; none for a study that did not search for the front.
    pub fn sentence(&self) -> Option<String> {
        let ends = self.tests.first().zip(self.tests.last());
        let (low, high) = ends.filter(|_| self.is_searched)?;
        let ([name, other_name], [unit, other_unit]) = (self.titles, self.units);
        let [from, to] = [low, high].map(|(_, one, other)| {
            let [one, other] = [one, other].map(|value| shown(*value));
            format!("{name} {one} {unit} at {other_name} {other} {other_unit}")
        });
        let knee = self.place_of_knee().map_or_else(String::new, |place| {
            let (row, one, other) = &self.tests[place];
            let [one, other] = [one, other].map(|value| shown(*value));
            let design = self.inputs.iter().map(|input| {
                let (title, unit) = title_of_path(&input.name);
                let (title, value) = (within_sentence(&title), shown(input.values[place]));
                format!("{title} {value} {unit}").trim_end().to_owned()
            });
            let design = design.collect::<Vec<_>>().join(", ");
            format!(
                "; its knee, row {row}, has {one} {unit} and {other} {other_unit} with {design}"
            )
        });
        Some(format!(
            "The best compromises go from {from} to {to}{knee}."
        ))
    }
}

impl Best {
    /// Returns the optimum in a sentence; none if no test keeps the limits.
    pub fn sentence(&self) -> Option<String> {
        let minimised = self.outputs.iter().find(|one| one.name == self.minimised)?;
        let (name, unit, row) = (label(self.minimised), self.unit, self.row?);
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
}

impl Standing {
    /// Returns how the search for the least of an output ended, in a sentence.
    pub fn sentence(&self, minimised: &str, unit: &str) -> String {
        let [improvement, error] =
            [self.expected_improvement, self.left_out_error.abs()].map(shown);
        let end = if self.is_converged {
            "The search has converged, also after space-filling tests"
        } else {
            "The optimum may be local; allow more tests"
        };
        format!(
            "{end}: another test is expected to lower the {minimised} by {improvement} {unit} at most. Its emulator (Q2 {:.4}) predicts the \
             best test from the others within {error} {unit}.\n",
            self.q2
        )
    }
}
