//! Several runs side by side on one page.

use std::path::{Path, PathBuf};

use super::{differences::Differences, numbers::NumberDifference, pictures, run::Run};
use crate::error::ReportError;
use crate::file::write_text;
use crate::number::significant;
use condyle_results::catalogue::{self, Scalar};

use crate::page::{label_of, shown, unit_of};
use crate::sheets::Sheets;

/// A table: its heading, and rows of which the first is the head.
type Table = (String, Vec<Vec<String>>);
/// A picture: name of its file, what it shows, its text.
type Sheet = (&'static str, String, String);

/// Curves and maps of a difference that are listed, at most; the others are smaller.
const MAX_ROWS: usize = 12;

/// Writes the page of several runs, held against the first, and returns its path.
///
/// # Errors
/// The page cannot be written.
pub fn write_runs(path: &Path, runs: &[Run]) -> Result<PathBuf, ReportError> {
    write_text(path.to_owned(), &runs_html(runs))
}

/// Several runs side by side as one HTML page: numbers with their errors, what differs from the first run, ranked, curves on
/// the same axes and maps in the same colours. It asks for nothing outside itself.
pub fn runs_html(runs: &[Run]) -> String {
    let Some((first, others)) = runs.split_first() else {
        return String::new();
    };
    let differences: Vec<_> = others
        .iter()
        .map(|run| Differences::of(first, run))
        .collect();
    let mut tables = vec![numbers(runs)];
    for difference in &differences {
        tables.extend(of_difference(difference));
    }
    let title = format!("{} runs side by side", runs.len());
    let lede = format!("Every run is held against the first, {}.", first.name);
    let mut notes: Vec<String> = differences
        .iter()
        .flat_map(|one| one.notes.clone())
        .collect();
    let mut known = Vec::new();
    notes.retain(|note| {
        !known.contains(note) && {
            known.push(note.clone());
            true
        }
    });
    let sheets = Sheets {
        kicker: "condyle \u{b7} virtual wear tests",
        title: &title,
        lede: &lede,
        notes: &notes,
        tables: &tables,
        pictures: &sheets(runs),
    };
    sheets.html()
}

fn sheets(runs: &[Run]) -> Vec<Sheet> {
    let curves = [
        (
            "runs_wear.svg",
            "Wear over the test, a line a run.",
            pictures::wear(runs),
        ),
        (
            "runs_first_cycle.svg",
            "The first cycle, on unworn inserts.",
            pictures::motion(runs, "Motion and load in the first cycle", true),
        ),
        (
            "runs_last_cycle.svg",
            "The last cycle that each run solved.",
            pictures::motion(runs, "Motion and load in the last cycle", false),
        ),
    ];
    let curves = curves.into_iter();
    let curves = curves.filter_map(|(name, caption, svg)| Some((name, caption.to_owned(), svg?)));
    let maps = pictures::maps(runs).into_iter().map(|(name, title, svg)| {
        let caption = format!(
            "{title} after the last update, all runs in the same colours; below, where meshes are the same, what each differs by \
             from the first, in colours of its own."
        );
        (name, caption, svg)
    });
    curves.chain(maps).collect()
}

/// Every number that a run has, with its error.
fn numbers(runs: &[Run]) -> Table {
    let names = runs.iter().map(|run| run.name.clone());
    let head = ["Quantity".to_owned(), "Unit".to_owned()];
    let mut rows = vec![head.into_iter().chain(names).collect()];
    for scalar in catalogue::results() {
        let cells: Vec<Option<String>> = runs.iter().map(|run| with_error(run, scalar)).collect();
        if cells.iter().any(Option::is_some) {
            let cells = cells.into_iter();
            let cells = cells.map(|cell| cell.unwrap_or_else(|| "\u{2013}".to_owned()));
            let named = [label_of(scalar), unit_of(scalar)];
            rows.push(named.into_iter().chain(cells).collect());
        }
    }
    ("All numbers".to_owned(), rows)
}

fn with_error(run: &Run, scalar: &Scalar) -> Option<String> {
    let summary = run.results.summary.as_ref()?;
    let value = shown(scalar, summary.get(scalar)?, 4);
    Some(match summary.total_error(scalar) {
        Some(error) => format!("{value} \u{b1} {}", significant(error, 2)),
        None => value,
    })
}

fn of_difference(difference: &Differences) -> Vec<Table> {
    let [first, second] = &difference.runs;
    let against = |what: &str| format!("{second} against {first}: {what}");
    let tables = [
        (against("what was set otherwise"), settings(difference)),
        (
            against("numbers, by size over their errors"),
            differing(difference),
        ),
        (
            against("curves, by size over their range"),
            curves(difference),
        ),
        (
            against("maps, by size over their largest value"),
            maps(difference),
        ),
    ];
    // A head alone tells nothing.
    tables
        .into_iter()
        .filter(|(_, rows)| rows.len() > 1)
        .collect()
}

fn head<const N: usize>(names: [&str; N]) -> Vec<Vec<String>> {
    vec![names.map(str::to_owned).to_vec()]
}

fn settings(difference: &Differences) -> Vec<Vec<String>> {
    let [first, second] = &difference.runs;
    let mut rows = head(["Key", first, second]);
    let said = |value: &Option<String>| value.clone().unwrap_or_else(|| "\u{2013}".to_owned());
    let cells = difference.settings.iter();
    rows.extend(cells.map(|one| vec![one.key.clone(), said(&one.first), said(&one.second)]));
    rows
}

fn differing(difference: &Differences) -> Vec<Vec<String>> {
    let mut rows = head([
        "Quantity",
        "Unit",
        "Difference",
        "%",
        "Errors together",
        "That is",
    ]);
    let row = |one: &NumberDifference| {
        let errors = one.errors();
        vec![
            label_of(one.scalar),
            unit_of(one.scalar),
            signed(one.difference, &shown(one.scalar, one.difference.abs(), 3)),
            percent(one.difference_percent),
            errors.map_or_else(|| "\u{2013}".to_owned(), |errors| significant(errors, 2)),
            one.verdict(),
        ]
    };
    rows.extend(difference.numbers.iter().map(row));
    rows
}

fn curves(difference: &Differences) -> Vec<Vec<String>> {
    let mut rows = head([
        "Curve",
        "Cycle",
        "Unit",
        "Root mean square",
        "% of range",
        "Largest",
        "At %",
    ]);
    let cells = difference.curves.iter().take(MAX_ROWS).map(|one| {
        vec![
            one.title.to_owned(),
            one.cycle.to_owned(),
            one.unit.to_owned(),
            significant(one.rms, 3),
            percent(one.rms_percent_of_range),
            signed(one.largest, &significant(one.largest.abs(), 3)),
            significant(one.largest_at_percent, 3),
        ]
    });
    rows.extend(cells);
    rows
}

fn maps(difference: &Differences) -> Vec<Vec<String>> {
    let mut rows = head([
        "Map",
        "Unit",
        "Largest",
        "% of the largest value",
        "At x, z, mm",
        "Mean size",
    ]);
    let cells = difference.maps.iter().map(|one| {
        vec![
            one.title.to_owned(),
            one.unit.to_owned(),
            signed(one.largest, &significant(one.largest.abs(), 3)),
            percent(one.largest_percent),
            format!("{}, {}", significant(one.x_mm, 3), significant(one.z_mm, 3)),
            significant(one.mean_absolute, 3),
        ]
    });
    rows.extend(cells);
    rows
}

fn percent(value: Option<f64>) -> String {
    value.map_or_else(|| "\u{2013}".to_owned(), |value| significant(value, 3))
}

/// A size with the sign of a value.
fn signed(value: f64, size: &str) -> String {
    let sign = if value < 0.0 { '\u{2212}' } else { '+' };
    format!("{sign}{size}")
}
