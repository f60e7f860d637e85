//! Measured motions and loads: a CSV file by percent of the cycle.

use std::ops::Range;

use condyle::machine::knee::KNEE;

use super::declared::KinematicsKeys;
use super::phases::{self, Phase};
use super::reason::MeasuredReason;
use crate::case::DataFile;
use crate::case::Reason;
use crate::case::keys::Settings;
use crate::case::parse::{Log, Others, Section, names};
use crate::case::problems::Source;
use crate::case::table::{Cell, Placed, Table, read_source};
use crate::case::unknown::nearest;

/// Name of the table of phases.
pub(super) const PHASES: &str = "phases_percent";

const EXAMPLE: &str = "percent,ap_mm,ie_deg";

/// Columns of kinematics.csv that a measured curve can be compared with.
pub const COLUMNS: [&str; 11] = KNEE.column_names();

/// Measured motions and loads, and how they are compared.
#[derive(Clone, Debug)]
pub struct Kinematics {
    /// The keys of the table.
    pub keys: KinematicsKeys,
    /// Phases of gait that errors are given for.
    pub phases: Vec<Phase>,
    /// The curves, in the order of the file.
    pub curves: Vec<MeasuredCurve>,
}

/// A column of a measured cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCurve {
    /// Its name, one of [`COLUMNS`], which says the unit.
    pub column: &'static str,
    /// Its points, percent growing; cells that are empty are left out.
    pub samples: Vec<Sample>,
}

/// A value at an instant of the cycle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Percent of the cycle, 0 to 100.
    pub percent: f64,
    /// The value, in the unit of its column.
    pub value: f64,
}

/// Reads `[kinematics]` and its CSV file.
pub(super) fn read(root: &Section<'_>, log: &mut Log<'_>) -> Option<Kinematics> {
    let section = root.table("kinematics", log);
    let known: Vec<&str> = names(KinematicsKeys::KEYS).chain([PHASES]).collect();
    section.check_keys(&known, &Others::NONE, log);
    let phases = phases::read(&section, log);
    let keys = KinematicsKeys::read(&section, log)?;
    let source = open(&keys.file, &section, log)?;
    match curves(source.inner(), &shown(&keys.file)) {
        Ok(curves) => Some(Kinematics {
            keys,
            phases: phases?,
            curves,
        }),
        Err(problems) => {
            note(problems, &source, log);
            None
        }
    }
}

/// The text of a data file, or the reason at its key.
pub(super) fn open(file: &DataFile, section: &Section<'_>, log: &mut Log<'_>) -> Option<Source> {
    match read_source(file.path()) {
        Ok(source) => Some(source),
        Err(reason) => {
            log.problem(section.value_span("file"), reason);
            None
        }
    }
}

/// The file's name without its folder.
pub(super) fn shown(file: &DataFile) -> String {
    let name = file.path().file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

pub(super) fn note(problems: Vec<Placed>, source: &Source, log: &mut Log<'_>) {
    for (span, reason) in problems {
        log.problem_in(source, span, reason);
    }
}

fn curves(text: &str, file: &str) -> Result<Vec<MeasuredCurve>, Vec<Placed>> {
    let table = Table::split(text, file, EXAMPLE).map_err(|placed| vec![placed])?;
    let columns = known_columns(&table)?;
    let percents = percents(&table)?;
    let mut curves = Vec::new();
    let mut problems = Vec::new();
    for (index, column) in columns {
        match curve(&table, index, column, &percents) {
            Ok(curve) => curves.push(curve),
            Err(found) => problems.extend(found),
        }
    }
    if problems.is_empty() {
        Ok(curves)
    } else {
        Err(problems)
    }
}

/// Number and name of every column after the first.
fn known_columns(table: &Table<'_>) -> Result<Vec<(usize, &'static str)>, Vec<Placed>> {
    let written = table.columns();
    let mut problems = repeated(table);
    if written[0] != "percent" {
        let reason = MeasuredReason::FirstColumn {
            wanted: "percent",
            found: written[0].to_owned(),
        };
        problems.push((table.column_span(0), reason.into()));
    }
    let mut known = Vec::new();
    for (index, name) in written.iter().enumerate().skip(1) {
        match COLUMNS.iter().find(|column| *column == name) {
            Some(column) => known.push((index, *column)),
            None => problems.push((table.column_span(index), unknown(name))),
        }
    }
    if problems.is_empty() {
        Ok(known)
    } else {
        Err(problems)
    }
}

/// Every column whose name stands before it already.
pub(super) fn repeated(table: &Table<'_>) -> Vec<Placed> {
    let columns = table.columns();
    let again = |index: &usize| columns[..*index].contains(&columns[*index]);
    let problem = |index: usize| {
        let column = columns[index].to_owned();
        let reason = MeasuredReason::RepeatedColumn { column };
        (table.column_span(index), Reason::from(reason))
    };
    (0..columns.len()).filter(again).map(problem).collect()
}

fn unknown(column: &str) -> Reason {
    MeasuredReason::UnknownColumn {
        column: column.to_owned(),
        near: nearest(column, COLUMNS.iter().copied()),
        columns: COLUMNS.join(", "),
    }
    .into()
}

/// The first column: growing, from 0 to 100.
fn percents(table: &Table<'_>) -> Result<Vec<f64>, Vec<Placed>> {
    let cells = table.numbers(0)?;
    let mut problems = not_growing("percent", &cells);
    let outside = cells
        .iter()
        .filter(|cell| !(0.0..=100.0).contains(&cell.value));
    problems.extend(outside.map(|cell| {
        let reason = MeasuredReason::OutOfRange {
            column: "percent".to_owned(),
            value: cell.value,
            range: "0 to 100",
        };
        (cell.span.clone(), reason.into())
    }));
    if problems.is_empty() {
        Ok(cells.iter().map(|cell| cell.value).collect())
    } else {
        Err(problems)
    }
}

/// Every number that is not larger than the one above.
pub(super) fn not_growing(column: &str, cells: &[Cell]) -> Vec<Placed> {
    let falls = |pair: &&[Cell]| pair[1].value <= pair[0].value;
    let problem = |pair: &[Cell]| {
        let reason = MeasuredReason::NotGrowing {
            column: column.to_owned(),
            value: pair[1].value,
            before: pair[0].value,
        };
        (pair[1].span.clone(), Reason::from(reason))
    };
    cells.windows(2).filter(falls).map(problem).collect()
}

fn curve(
    table: &Table<'_>,
    index: usize,
    column: &'static str,
    percents: &[f64],
) -> Result<MeasuredCurve, Vec<Placed>> {
    const LEAST: usize = 2;
    let cells = table.numbers_given(index)?;
    let sample = |(row, cell): &(usize, Cell)| Sample {
        percent: percents[*row],
        value: cell.value,
    };
    if cells.len() < LEAST {
        return Err(vec![too_few(
            column,
            cells.len(),
            LEAST,
            table.column_span(index),
        )]);
    }
    let samples = cells.iter().map(sample).collect();
    Ok(MeasuredCurve { column, samples })
}

pub(super) fn too_few(column: &str, found: usize, needed: usize, span: Range<usize>) -> Placed {
    let column = column.to_owned();
    let reason = MeasuredReason::TooFew {
        column,
        found,
        needed,
    };
    (span, reason.into())
}
