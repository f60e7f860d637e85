//! Measured masses: a CSV file of specimens and soak controls, as ISO 14243-2 weighs them.

use super::reason::{MeasuredReason, not_growing, repeated};
use crate::config::{
    Cell, ColumnReason, Columns, DataFile, Log, Names, Placed, Section, Settings, choice, names,
    settings, within,
};

choice! {
    /// What a confidence interval of a wear rate counts as independent.
    IntervalWord {
        /// Every weighing: that of one line through all of them.
        Weighings = "weighings",
        /// Every specimen: that of the mean of their rates.
        Specimens = "specimens",
    }
}

settings! {
    /// Measured masses, and how a wear rate is found from them.
    GravimetricKeys {
        /// CSV file; `cycles`, then the mass of each specimen and soak control, each name ending in _mg.
        file: DataFile;
        /// Columns of the soak controls; those whose name starts with "soak" if not given.
        soak_controls: Option<Names> = None;
        /// Confidence of the intervals.
        confidence_percent: f64 = 95.0, in within(50.0, 99.99);
        /// Weighings before this many cycles stay out of the line: running in.
        fit_from_cycles: f64 = 0.0, in within(0.0, 1e10);
        /// What the interval that calibration uses counts as independent.
        interval: IntervalWord = IntervalWord::Weighings;
    }
}

const EXAMPLE: &str = "cycles,specimen_1_mg,soak_1_mg";
/// What a column's name begins with where the file does not name its soak controls.
const SOAK: &str = "soak";
/// A line with an interval needs one weighing more than it has numbers.
const MIN_WEIGHINGS: usize = 3;

/// Measured masses, and how a wear rate is found from them.
#[derive(Clone, Debug)]
pub struct Gravimetric {
    /// The keys of the table.
    pub keys: GravimetricKeys,
    /// Cycles at each weighing, growing; the first starts the test.
    pub cycles: Vec<f64>,
    /// Specimens that were worn, one or more.
    pub specimens: Vec<Specimen>,
    /// Soak controls, which only took up fluid; may be none.
    pub soaks: Vec<Specimen>,
}

/// A component and its mass at each weighing.
#[derive(Clone, Debug, PartialEq)]
pub struct Specimen {
    /// Its name: that of the column without the unit.
    pub name: String,
    /// Mass at each weighing, mg.
    pub masses_mg: Vec<f64>,
}

/// Reads `[gravimetric]` and its CSV file.
pub(super) fn read(root: &Section<'_>, log: &mut Log<'_>) -> Option<Gravimetric> {
    let section = root.table("gravimetric", log);
    let known: Vec<&str> = names(&GravimetricKeys::keys()).collect();
    section.check_keys(&known, log);
    let keys = GravimetricKeys::read(&section, log)?;
    let source = keys.file.source(&section, "file", log)?;
    let split = Columns::split(source.inner(), &keys.file.name(), EXAMPLE);
    let columns = log.noted(&source, split.map_err(|placed| vec![placed]))?;
    let soaks = soak_columns(&columns, &keys, &section, log)?;
    let weighed = log.noted(&source, weighed(&columns, &soaks))?;
    checked(weighed, keys, &section, log)
}

/// Which columns are soak controls.
fn soak_columns(
    columns: &Columns<'_>,
    keys: &GravimetricKeys,
    section: &Section<'_>,
    log: &mut Log<'_>,
) -> Option<Vec<usize>> {
    let names = columns.names();
    let soaks = match &keys.soak_controls {
        Some(soaks) => {
            let place = |name: &String| place_of(name, &names, keys);
            let places: Result<Vec<_>, _> = soaks.0.iter().map(place).collect();
            let report = |reason| log.problem(section.value_span("soak_controls"), reason);
            places.map_err(report).ok()?
        }
        None => {
            let is_soak = |index: &usize| names[*index].to_lowercase().starts_with(SOAK);
            (1..names.len()).filter(is_soak).collect()
        }
    };
    if soaks.len() + 1 < names.len() {
        return Some(soaks);
    }
    let file = keys.file.name();
    let reason = MeasuredReason::NoSpecimen { file };
    log.problem(section.value_span("soak_controls"), reason);
    None
}

/// Which column is called `name`; the first is none of the specimens.
fn place_of(name: &str, names: &[&str], keys: &GravimetricKeys) -> Result<usize, ColumnReason> {
    let found = (1..names.len()).find(|&index| names[index] == name);
    found.ok_or_else(|| ColumnReason::NoColumn {
        column: name.to_owned(),
        file: keys.file.name(),
        columns: names[1..].iter().map(|&name| name.to_owned()).collect(),
    })
}

/// Cycles, specimens and soak controls.
type Weighed = (Vec<f64>, Vec<Specimen>, Vec<Specimen>);

fn weighed(columns: &Columns<'_>, soaks: &[usize]) -> Result<Weighed, Vec<Placed>> {
    let mut problems = repeated(columns);
    let cycles = cycles(columns).map_err(|found| problems.extend(found));
    let (mut worn, mut soaked) = (Vec::new(), Vec::new());
    for index in 1..columns.names().len() {
        let kind = if soaks.contains(&index) {
            &mut soaked
        } else {
            &mut worn
        };
        match specimen(columns, index) {
            Ok(specimen) => kind.push(specimen),
            Err(found) => problems.extend(found),
        }
    }
    match cycles {
        Ok(cycles) if problems.is_empty() => Ok((cycles, worn, soaked)),
        Ok(_) | Err(()) => Err(problems),
    }
}

fn cycles(columns: &Columns<'_>) -> Result<Vec<f64>, Vec<Placed>> {
    let found = columns.names()[0];
    if found != "cycles" {
        let (wanted, found) = ("cycles", found.to_owned());
        let reason = MeasuredReason::FirstColumn { wanted, found };
        return Err(vec![Placed::new(columns.name_span(0), reason)]);
    }
    let cells = columns.numbers(0)?;
    let mut problems = not_growing("cycles", &cells);
    problems.extend(outside("cycles", &cells, 0.0, "0 or more"));
    if problems.is_empty() {
        Ok(cells.iter().map(|cell| cell.value).collect())
    } else {
        Err(problems)
    }
}

/// Every number below `least`.
fn outside(column: &str, cells: &[Cell], least: f64, range: &'static str) -> Vec<Placed> {
    let limits = within(least, f64::INFINITY);
    let wrong = cells.iter().filter(|cell| !limits.allow(cell.value));
    let problem = |cell: &Cell| {
        let reason = MeasuredReason::OutOfRange {
            column: column.to_owned(),
            value: cell.value,
            range,
        };
        Placed::new(cell.span.clone(), reason)
    };
    wrong.map(problem).collect()
}

fn specimen(columns: &Columns<'_>, index: usize) -> Result<Specimen, Vec<Placed>> {
    let column = columns.names()[index];
    let Some(name) = column.strip_suffix("_mg") else {
        let column = column.to_owned();
        let reason = MeasuredReason::NoMass { column };
        return Err(vec![Placed::new(columns.name_span(index), reason)]);
    };
    let cells = columns.numbers(index)?;
    let problems = outside(column, &cells, 1.0, "a mass of 1 mg or more");
    if !problems.is_empty() {
        return Err(problems);
    }
    Ok(Specimen {
        name: name.to_owned(),
        masses_mg: cells.iter().map(|cell| cell.value).collect(),
    })
}

/// The weighings, if enough of them are left for a line.
fn checked(
    (cycles, specimens, soaks): Weighed,
    keys: GravimetricKeys,
    section: &Section<'_>,
    log: &mut Log<'_>,
) -> Option<Gravimetric> {
    let counts = |cycles: &&f64| **cycles >= keys.fit_from_cycles;
    let rows = cycles.iter().skip(1).filter(counts).count();
    if rows < MIN_WEIGHINGS {
        let reason = MeasuredReason::TooFewWeighings { rows };
        log.problem(section.value_span("file"), reason);
        return None;
    }
    Some(Gravimetric {
        keys,
        cycles,
        specimens,
        soaks,
    })
}
