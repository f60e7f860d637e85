//! The answers of a study in tables.

use std::iter::once;

use condyle_lab::aligned;
use condyle_results::split_unit;

use crate::answers::{
    Answers, TestsByReason,
    data::{Spread, of_design},
    robust::Robust,
    words::{chance_in_words, label, labelled, percent, percents, shown},
};

/// A table; its first row is its head.
type Rows = Vec<Vec<String>>;

impl Answers {
    /// Tables in Markdown, short enough for a terminal.
    pub fn markdown(&self) -> String {
        let designs = self.designs();
        let tables = self.tables(&designs[..1]);
        let mut parts: Vec<String> = tables.iter().map(|(_, rows)| aligned(rows)).collect();
        if let Some(TestsByReason { reason, tests }) = self.failed.first() {
            let (failed, kept) = (TestsByReason::count(&self.failed), self.kept);
            let failed =
                format!("{failed} of {kept} tests failed, {tests} of them because of: {reason}\n");
            parts.insert(1, failed);
        }
        if designs.len() > 1 && !self.effects.is_empty() {
            parts.push("Indices and effects of the other designs are on the page.\n".to_owned());
        }
        parts.extend(self.doubts());
        parts.extend(self.doubts_of_optimum().map(|one| one + "\n"));
        parts.extend(self.end_of_search());
        parts.extend(self.aim.as_ref().map(|aim| aim.sentence() + "\n"));
        parts.join("\n")
    }

    /// Tables with their headings, those of indices and effects for each of `designs`; without those that have no rows.
    pub(crate) fn tables(&self, designs: &[Option<&str>]) -> Vec<(String, Rows)> {
        let robust = self.robust.as_ref();
        let tables = [
            ("Best", self.table_of_best()),
            (
                "Robust optimum",
                robust.map_or_else(Vec::new, Robust::table),
            ),
            ("Pareto front", self.table_of_front()),
            ("Outputs", self.table_of_spreads()),
            ("Ranking", self.table_of_designs()),
            ("Pairs of designs", self.table_of_beats()),
            ("Emulators", self.table_of_emulators()),
            ("Elementary effects of Morris", self.table_of_elementary()),
        ];
        let tables = tables.map(|(name, rows)| (name.to_owned(), without_empty_columns(&rows)));
        let of_designs = designs.iter().flat_map(|design| {
            [
                ("Sobol indices", self.table_of_indices(*design)),
                ("Effects of inputs", self.table_of_effects(*design)),
            ]
            .map(|(name, rows)| (of_design(name, *design), rows))
        });
        let all = tables.into_iter().chain(of_designs);
        all.filter(|(_, rows)| rows.len() > 1).collect()
    }

    fn table_of_spreads(&self) -> Rows {
        // The tests of an adaptive study are no sample; the emulators state the distributions.
        if self.aim.is_some() && self.emulated.iter().any(|one| one.distribution.is_some()) {
            return Vec::new();
        }
        // The output of a test that could not be solved is unknown: the numbers are those of the others.
        let has_unsolved = self.spreads.iter().any(|spread| spread.unsolved > 0);
        let head = [
            ["output", "output, where known"][usize::from(has_unsolved)],
            "unit",
            "least",
            "5 %",
            "median",
            "95 %",
            "most",
            "mean",
            "SD",
            "beyond its limit",
            "known in",
        ];
        table(&head, &self.spreads, |spread| {
            let (least, most, own) = (spread.least, spread.most, &spread.distribution);
            let [_, p5, _, p50, _, p95, _] = own.percentiles;
            let numbers = [least, p5, p50, p95, most, own.mean, own.standard_deviation];
            let known = || format!("{} of {}", spread.tests, spread.tests + spread.unsolved);
            let mut row = vec![spread.name(), spread.unit.to_owned()];
            row.extend(numbers.map(shown));
            row.push(self.beyond_in_words(spread));
            row.extend(has_unsolved.then(known));
            row
        })
    }

    /// Returns the shares of the tests beyond each limit; empty if an emulator knows the probabilities better than the tests that it
    /// was fitted to.
    fn beyond_in_words(&self, spread: &Spread) -> String {
        let own = (spread.output, &spread.design);
        let mut emulated = self.emulated.iter();
        if emulated.any(|one| (one.output, &one.design) == own && one.distribution.is_some()) {
            return String::new();
        }
        let beyond = spread.beyond.iter().map(|beyond| {
            let [low, high] = beyond.interval.map(percent);
            let share = percents(beyond.share);
            // The share of tests that a search has chosen is no probability and has no interval.
            match spread.is_sample {
                true => format!("{share} ({low} to {high})"),
                false => share,
            }
        });
        beyond.collect::<Vec<_>>().join(", ")
    }

    fn table_of_designs(&self) -> Rows {
        let Some(ranking) = &self.ranking else {
            return Vec::new();
        };
        let (compared, solved) = (ranking.disturbances, ranking.solved);
        let design = format!("design, {compared} disturbances");
        let mut mean = format!("{}, {}", ranking.title, ranking.unit);
        if solved < compared {
            mean += &format!(" ({solved} with all solved)");
        }
        let counts = ranking.counts();
        let mut head = vec![design.as_str()];
        head.extend(counts.iter().map(|(name, _, _)| *name));
        head.extend([&mean, "SD", "within limits", "best", "beats another"]);
        table(&head, &ranking.designs, |design| {
            let counts = counts.iter();
            let counts =
                counts.map(|(_, _, count)| format!("{} of {}", count(design), design.tests));
            let numbers = [
                shown(design.mean),
                shown(design.standard_deviation),
                ranking.share(design.within_limits, design.within_limits_interval),
                ranking.share(design.best, design.best_interval),
            ];
            // A single design has no other to beat.
            let wins = match ranking.designs.len() {
                1 => String::new(),
                _ => percent(design.wins),
            };
            let name = once(design.name.clone());
            name.chain(counts).chain(numbers).chain([wins]).collect()
        })
    }

    /// Returns how often each design beats each other one.
    fn table_of_beats(&self) -> Rows {
        let ranking = self.ranking.as_ref();
        let Some(ranking) = ranking.filter(|ranking| ranking.designs.len() > 1) else {
            return Vec::new();
        };
        let names = ranking.designs.iter().map(|design| design.name.as_str());
        let head: Vec<&str> = once("design, how often it beats").chain(names).collect();
        table(&head, &ranking.designs, |design| {
            let shares = design.beats.iter().zip(&design.beats_intervals);
            let shares = shares.zip(&ranking.designs);
            let shares = shares.map(
                |((share, interval), other)| match other.name == design.name {
                    true => "-".to_owned(),
                    false => ranking.share(*share, *interval),
                },
            );
            once(design.name.clone()).chain(shares).collect()
        })
    }

    fn table_of_emulators(&self) -> Rows {
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

    fn table_of_indices(&self, design: Option<&str>) -> Rows {
        let range = |[low, high]: [f64; 2]| format!("{low:.3} to {high:.3}");
        let all = self.largest_indices(design);
        let Some(first) = all.first() else {
            return Vec::new();
        };
        let (counted, kind) = (first.bases, self.kind_of_tests());
        let input = format!("input, by {}, {counted} {kind}", first.title());
        let limited = self.indices_of_limited(first);
        let limited = limited.map(|one| format!("{}: total", label(one.output)));
        let limited: Vec<String> = limited.collect();
        let mut head = vec![input.as_str(), "first", "95 %", "total", "95 %"];
        head.extend(limited.iter().flat_map(|one| [one.as_str(), "95 %"]));
        table_of_most(&head, &all, |index| {
            let mut row = vec![
                self.name_of(&index.input).to_owned(),
                index.first_in_words(),
                range(index.first_interval),
            ];
            let totals = once(index).chain(self.indices_of_limited(index));
            row.extend(totals.flat_map(|one| [one.total_in_words(), range(one.total_interval)]));
            row
        })
    }

    fn table_of_elementary(&self) -> Rows {
        let all = self.largest_elementary();
        let output = all.first().map_or("", |one| one.output);
        let input = format!("input, by {}", label(output));
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
    fn table_of_effects(&self, design: Option<&str>) -> Rows {
        if self.design == "saltelli" || !self.elementary.is_empty() {
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
    fn table_of_front(&self) -> Rows {
        let Some(front) = self.front.as_ref().filter(|front| front.is_searched) else {
            return Vec::new();
        };
        let titles = front.titles.iter().zip(front.units);
        let titles = titles.map(|(title, unit)| format!("{title}, {unit}"));
        let names = front.inputs.iter().map(|input| input.name.clone());
        let head = once("row".to_owned()).chain(titles).chain(names).collect();
        let row = |(place, (row, one, other)): (usize, &(u64, f64, f64))| {
            let is_doubtful = self.doubtful_optima.iter().any(|one| one.row == *row);
            let knee = ["", " knee"][usize::from(Some(*row) == front.knee)];
            let doubtful = ["", " doubtful"][usize::from(is_doubtful)];
            let inputs = front.inputs.iter().map(|input| input.values[place]);
            let numbers = [*one, *other].into_iter().chain(inputs);
            once(format!("{row}{knee}{doubtful}"))
                .chain(numbers.map(shown))
                .collect()
        };
        once(head)
            .chain(front.tests.iter().enumerate().map(row))
            .collect()
    }

    fn table_of_best(&self) -> Rows {
        let Some(best) = &self.best else {
            return Vec::new();
        };
        let row = best.row.unwrap_or_default();
        let head = format!("least {}: row {row}", label(best.minimised));
        let head = [&head, "value", "first design", "margin to its limit"];
        let values: Vec<_> = best.inputs.iter().chain(&best.outputs).collect();
        table(&head, &values, |one| {
            let own = best
                .margins
                .iter()
                .filter(|margin| margin.output == one.name);
            let own = own.map(|one| format!("{} to {}", shown(one.margin), shown(one.limit)));
            vec![
                labelled(&one.name),
                shown(one.value),
                shown(one.first),
                own.collect::<Vec<_>>().join(", "),
            ]
        })
    }
}

/// Returns a table without the columns that are empty below their head, such as that of a limit where no output has one.
fn without_empty_columns(rows: &[Vec<String>]) -> Rows {
    let is_filled = |column: usize| {
        let mut cells = rows.iter().skip(1).filter_map(|row| row.get(column));
        cells.any(|cell| !cell.is_empty())
    };
    let filled = |row: &Vec<String>| {
        let cells = (0..).zip(row).filter(|(column, _)| is_filled(*column));
        cells.map(|(_, cell)| cell.clone()).collect()
    };
    rows.iter().map(filled).collect()
}

pub(crate) fn table<T>(head: &[&str], all: &[T], row: impl Fn(&T) -> Vec<String>) -> Rows {
    let head = head.iter().map(|&title| title.to_owned()).collect();
    once(head).chain(all.iter().map(row)).collect()
}

/// Returns the same table for the inputs with the largest effects, with the number of others in its last row.
fn table_of_most<T>(head: &[&str], all: &[&T], row: impl Fn(&T) -> Vec<String>) -> Rows {
    const MAX_ROWS: usize = 24;
    let shown = all.len().min(MAX_ROWS);
    let mut rows = table(head, &all[..shown], |one| row(one));
    if all.len() > shown {
        let mut more = vec![String::new(); head.len()];
        more[0] = format!("and {} more, in answers.json", all.len() - shown);
        rows.push(more);
    }
    rows
}
