//! Measured motions and loads: a CSV file by percent of the cycle, and phases of the gait cycle.

use condyle::machine::knee::KNEE;
use toml::Spanned;
use toml::de::DeValue;

use super::reason::{MeasuredReason, not_growing, repeated, too_few};
use crate::config::{
    Cell, Columns, DataFile, Log, Placed, Section, Settings, choice, names, nearest, number,
    settings, within,
};

choice! {
    /// The cycle of the run that a measured one is compared with.
    CycleWord {
        /// The first: the insert is unworn.
        First = "first",
        /// The last: the insert is worn.
        Last = "last",
    }

    /// What is done to two curves before they are compared.
    AlignWord {
        /// Nothing.
        None = "none",
        /// The mean difference is taken out of the measured curve.
        Mean = "mean",
    }
}

settings! {
    /// Measured motions and loads, and how they are compared.
    KinematicsKeys {
        /// CSV file; `percent` of the cycle, then columns named as in kinematics.csv.
        file: DataFile;
        /// Which cycle of the run.
        cycle: CycleWord = CycleWord::First;
        /// Whether the mean difference is taken out before the errors are found.
        align: AlignWord = AlignWord::None;
        /// Between measured points farther apart than this, in percent of the cycle, nothing is compared.
        largest_gap_percent: f64 = 10.0, in within(0.1, 100.0);
    }
}

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
    let known: Vec<&str> = names(&KinematicsKeys::keys()).chain([PHASES]).collect();
    section.check_keys(&known, log);
    let phases = read_phases(&section, log);
    let keys = KinematicsKeys::read(&section, log)?;
    let source = keys.file.source(&section, "file", log)?;
    let curves = log.noted(&source, curves(source.inner(), &keys.file.name()))?;
    Some(Kinematics {
        keys,
        phases: phases?,
        curves,
    })
}

fn curves(text: &str, file: &str) -> Result<Vec<MeasuredCurve>, Vec<Placed>> {
    let columns = Columns::split(text, file, EXAMPLE).map_err(|placed| vec![placed])?;
    let known = known_columns(&columns)?;
    let percents = percents(&columns)?;
    let mut curves = Vec::new();
    let mut problems = Vec::new();
    for (index, column) in known {
        match curve(&columns, index, column, &percents) {
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
fn known_columns(columns: &Columns<'_>) -> Result<Vec<(usize, &'static str)>, Vec<Placed>> {
    let written = columns.names();
    let mut problems = repeated(columns);
    if written[0] != "percent" {
        let reason = MeasuredReason::FirstColumn {
            wanted: "percent",
            found: written[0].to_owned(),
        };
        problems.push(Placed::new(columns.name_span(0), reason));
    }
    let mut known = Vec::new();
    for (index, name) in written.iter().enumerate().skip(1) {
        match COLUMNS.iter().find(|column| *column == name) {
            Some(column) => known.push((index, *column)),
            None => problems.push(Placed::new(columns.name_span(index), unknown(name))),
        }
    }
    if problems.is_empty() {
        Ok(known)
    } else {
        Err(problems)
    }
}

fn unknown(column: &str) -> MeasuredReason {
    MeasuredReason::UnknownColumn {
        column: column.to_owned(),
        near: nearest(column, COLUMNS.iter().copied()),
        columns: COLUMNS.join(", "),
    }
}

/// The first column: growing, from 0 to 100.
fn percents(columns: &Columns<'_>) -> Result<Vec<f64>, Vec<Placed>> {
    let cells = columns.numbers(0)?;
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
        Placed::new(cell.span.clone(), reason)
    }));
    if problems.is_empty() {
        Ok(cells.iter().map(|cell| cell.value).collect())
    } else {
        Err(problems)
    }
}

fn curve(
    columns: &Columns<'_>,
    index: usize,
    column: &'static str,
    percents: &[f64],
) -> Result<MeasuredCurve, Vec<Placed>> {
    const LEAST: usize = 2;
    let cells = columns.numbers_given(index)?;
    let sample = |(row, cell): &(usize, Cell)| Sample {
        percent: percents[*row],
        value: cell.value,
    };
    if cells.len() < LEAST {
        return Err(vec![too_few(
            column,
            cells.len(),
            LEAST,
            columns.name_span(index),
        )]);
    }
    let samples = cells.iter().map(sample).collect();
    Ok(MeasuredCurve { column, samples })
}

/// Name of the table of phases.
pub(super) const PHASES: &str = "phases_percent";

/// A named part of the gait cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// What it is called.
    pub name: String,
    /// Where it starts, percent of the cycle; this instant belongs to it.
    pub start_percent: f64,
    /// Where it ends; this instant belongs to the next.
    pub end_percent: f64,
}

impl Phase {
    /// The phases of walking, where a file names none.
    pub fn of_walking() -> Vec<Self> {
        let phase = |(name, start_percent, end_percent): (&str, f64, f64)| Self {
            name: name.to_owned(),
            start_percent,
            end_percent,
        };
        [
            ("loading response", 0.0, 10.0),
            ("mid stance", 10.0, 30.0),
            ("terminal stance", 30.0, 50.0),
            ("pre-swing", 50.0, 60.0),
            ("swing", 60.0, 100.0),
        ]
        .map(phase)
        .into()
    }

    /// Whether an instant belongs to it.
    pub fn holds(&self, percent: f64) -> bool {
        (self.start_percent..self.end_percent).contains(&percent)
    }
}

/// The phases of `[kinematics.phases_percent]`, or those of walking.
fn read_phases(kinematics: &Section<'_>, log: &mut Log<'_>) -> Option<Vec<Phase>> {
    let Some(table) = kinematics.value(PHASES) else {
        return Some(Phase::of_walking());
    };
    let section = kinematics.table(PHASES, log);
    let mut phases = Vec::new();
    for (name, value) in table.get_ref().as_table()? {
        match phase(name.get_ref(), value) {
            Ok(phase) => phases.push(phase),
            Err(reason) => log.problem(section.value_span(name.get_ref()), reason),
        }
    }
    Some(phases)
}

fn phase(name: &str, value: &Spanned<DeValue<'_>>) -> Result<Phase, MeasuredReason> {
    let list: Vec<_> = value.get_ref().as_array().into_iter().flatten().collect();
    let numbers: Vec<f64> = list
        .iter()
        .filter_map(|value| number(value.get_ref()))
        .collect();
    match numbers[..] {
        [start, end] if 0.0 <= start && start < end && end <= 100.0 && list.len() == 2 => {
            Ok(Phase {
                name: name.to_owned(),
                start_percent: start,
                end_percent: end,
            })
        }
        _ => Err(MeasuredReason::Phase {
            name: name.to_owned(),
            found: format!("{numbers:?}"),
        }),
    }
}
