//! Measured masses: a CSV file of specimens and soak controls, as ISO 14243-2 weighs them.

use super::declared::GravimetricKeys;
use super::kinematics::{not_growing, note, open, repeated, shown};
use super::reason::MeasuredReason;
use crate::case::Reason;
use crate::case::keys::{Settings, within};
use crate::case::parse::{Log, Others, Section, names};
use crate::case::table::{Cell, Placed, Table};

const EXAMPLE: &str = "cycles,specimen_1_mg,soak_1_mg";
/// What a column's name begins with where the file does not name its soak controls.
const SOAK: &str = "soak";
/// A line with an interval needs one weighing more than it has numbers.
const LEAST_WEIGHINGS: usize = 3;

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
    let known: Vec<&str> = names(GravimetricKeys::KEYS).collect();
    section.check_keys(&known, &Others::NONE, log);
    let keys = GravimetricKeys::read(&section, log)?;
    let source = open(&keys.file, &section, log)?;
    let file = shown(&keys.file);
    let table = match Table::split(source.inner(), &file, EXAMPLE) {
        Ok(table) => table,
        Err(placed) => {
            note(vec![placed], &source, log);
            return None;
        }
    };
    let soaks = match soak_columns(&table, &keys, &file) {
        Ok(soaks) => soaks,
        Err(reason) => {
            log.problem(section.value_span("soak_controls"), reason);
            return None;
        }
    };
    match weighed(&table, &soaks) {
        Ok(weighed) => checked(weighed, keys, &section, log),
        Err(problems) => {
            note(problems, &source, log);
            None
        }
    }
}

/// Which columns are soak controls.
fn soak_columns(
    table: &Table<'_>,
    keys: &GravimetricKeys,
    file: &str,
) -> Result<Vec<usize>, Reason> {
    let columns = table.columns();
    let soaks = match &keys.soak_controls {
        Some(names) => {
            let place = |name: &String| {
                let found = columns.iter().skip(1).position(|column| column == name);
                found
                    .map(|index| index + 1)
                    .ok_or_else(|| Reason::NoColumn {
                        column: name.clone(),
                        file: file.to_owned(),
                        columns: columns[1..].iter().map(|&name| name.to_owned()).collect(),
                    })
            };
            names.0.iter().map(place).collect::<Result<Vec<_>, _>>()?
        }
        None => {
            let is_soak = |index: &usize| columns[*index].to_lowercase().starts_with(SOAK);
            (1..columns.len()).filter(is_soak).collect()
        }
    };
    if soaks.len() + 1 < columns.len() {
        return Ok(soaks);
    }
    let file = file.to_owned();
    Err(MeasuredReason::NoSpecimen { file }.into())
}

/// Cycles, specimens and soak controls.
type Weighed = (Vec<f64>, Vec<Specimen>, Vec<Specimen>);

fn weighed(table: &Table<'_>, soaks: &[usize]) -> Result<Weighed, Vec<Placed>> {
    let mut problems = repeated(table);
    let cycles = cycles(table).map_err(|found| problems.extend(found));
    let (mut worn, mut soaked) = (Vec::new(), Vec::new());
    for index in 1..table.columns().len() {
        let kind = match soaks.contains(&index) {
            true => &mut soaked,
            false => &mut worn,
        };
        match specimen(table, index) {
            Ok(specimen) => kind.push(specimen),
            Err(found) => problems.extend(found),
        }
    }
    match cycles {
        Ok(cycles) if problems.is_empty() => Ok((cycles, worn, soaked)),
        Ok(_) | Err(()) => Err(problems),
    }
}

fn cycles(table: &Table<'_>) -> Result<Vec<f64>, Vec<Placed>> {
    let found = table.columns()[0];
    if found != "cycles" {
        let (wanted, found) = ("cycles", found.to_owned());
        let reason = MeasuredReason::FirstColumn { wanted, found };
        return Err(vec![(table.column_span(0), reason.into())]);
    }
    let cells = table.numbers(0)?;
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
        (cell.span.clone(), Reason::from(reason))
    };
    wrong.map(problem).collect()
}

fn specimen(table: &Table<'_>, index: usize) -> Result<Specimen, Vec<Placed>> {
    let column = table.columns()[index];
    let Some(name) = column.strip_suffix("_mg") else {
        let column = column.to_owned();
        let reason = MeasuredReason::NoMass { column };
        return Err(vec![(table.column_span(index), reason.into())]);
    };
    let cells = table.numbers(index)?;
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
    if rows < LEAST_WEIGHINGS {
        let reason = MeasuredReason::TooFewWeighings { rows };
        log.problem(section.value_span("file"), reason.into());
        return None;
    }
    Some(Gravimetric {
        keys,
        cycles,
        specimens,
        soaks,
    })
}
