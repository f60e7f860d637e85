//! Measured masses: a CSV file of specimens and soak controls, as ISO 14243-2 weighs them.

use super::columns::{growing, misnamed_first, outside, repeated, unless};
use crate::config::*;

choice! {
    /// The independent observations of a confidence interval of a wear rate.
    IntervalWord {
        /// Every weighing: that of one line through all of them.
        Weighings = "weighings",
        /// Every specimen: that of the mean of their rates.
        Specimens = "specimens",
    }
}

settings! {
    /// Measured masses and the determination of a wear rate from them.
    GravimetricKeys {
        /// CSV file; `cycles`, then the mass of each specimen and soak control, each name ending in _mg.
        file: DataFile;
        /// Columns of the soak controls; those whose name starts with "soak" if not given.
        soak_controls: Option<Names> = None;
        /// Confidence of the intervals.
        confidence_percent: f64 = 95.0, in within(50.0, 99.99);
        /// Weighings before this many cycles are excluded from the line, as running-in.
        fit_from_cycles: f64 = 0.0, in within(0.0, 1e10);
        /// The independent observations of the interval that calibration uses.
        interval: IntervalWord = IntervalWord::Weighings;
    }
}

const EXAMPLE: &str = "cycles,specimen_1_mg,soak_1_mg";
/// Beginning of the names of soak controls, unless the file gives them.
const SOAK: &str = "soak";
/// Smallest plausible mass of a specimen, mg: a smaller one is in g, or its comma separates thousands. Our choice: a small pin weighs
/// 100 mg.
const MIN_MASS_MG: f64 = 50.0;
/// Largest plausible mass of a specimen, mg: a larger one is in micrograms. Our choice.
const MAX_MASS_MG: f64 = 1e6;
/// Smallest plausible number of cycles at the last weighing; our choice.
const MIN_CYCLES: f64 = 10_000.0;
/// A line with an interval needs one weighing more than it has parameters.
const MIN_WEIGHINGS: usize = 3;

/// Measured masses and the determination of a wear rate from them.
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

impl Gravimetric {
    pub(super) fn read(root: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let section = root.table("gravimetric", log);
        let keys = GravimetricKeys::read_checked(&section, log)?;
        let source = keys.file.source(&section, "file", log)?;
        let split = Columns::split(source.inner(), &keys.file.name(), EXAMPLE);
        let columns = log.noted(&source, split)?;
        let controls = soak_columns(&columns, &keys, &section, log)?;
        let (cycles, all) = log.noted(&source, weighed(&columns))?;
        let is_counted = |cycles: &&f64| **cycles >= keys.fit_from_cycles;
        // The first row is the reference of every loss, so it is no observation.
        let rows = cycles.iter().skip(1).filter(is_counted).count();
        if rows < MIN_WEIGHINGS {
            let fault = Fault::new(
                format!("{rows} weighings remain for the line, and three are needed"),
                "add weighings, or lower `fit_from_cycles`; the first row starts the test, and its loss of 0 does not count",
            );
            return log.reject(section.value_span("file"), fault);
        }
        let last = cycles.last().copied().unwrap_or_default();
        if last < MIN_CYCLES {
            let message = format!("the weighings end at {last} cycles");
            let advice =
                "give whole cycles, not millions, and write them without thousands separators";
            return log.reject(section.value_span("file"), Fault::new(message, advice));
        }
        let (mut specimens, mut soaks) = (Vec::new(), Vec::new());
        for (index, specimen) in (1..).zip(all) {
            if controls.contains(&index) {
                soaks.push(specimen);
            } else {
                specimens.push(specimen);
            }
        }
        Some(Self {
            keys,
            cycles,
            specimens,
            soaks,
        })
    }
}

/// Returns the indices of the columns of soak controls; at least one other column must remain.
fn soak_columns(
    columns: &Columns<'_>,
    keys: &GravimetricKeys,
    section: &Section<'_>,
    log: &mut Log<'_>,
) -> Option<Vec<usize>> {
    let names = columns.names();
    let mut soaks: Vec<usize> = Vec::new();
    match &keys.soak_controls {
        None => {
            let is_soak = |index: &usize| names[*index].to_lowercase().starts_with(SOAK);
            soaks.extend((1..names.len()).filter(is_soak));
        }
        Some(controls) => {
            for name in &controls.0 {
                let Some(index) = (1..names.len()).find(|&index| names[index] == name) else {
                    let fault = no_column(name, &keys.file.name(), &names[1..]);
                    return log.reject(section.value_span("soak_controls"), fault);
                };
                soaks.push(index);
            }
        }
    }
    if soaks.len() + 1 >= names.len() {
        let file = keys.file.name();
        let fault = Fault::new(
            format!("every column of {file} is a soak control: there is no specimen"),
            "name only the soak controls in `soak_controls`",
        );
        return log.reject(section.value_span("soak_controls"), fault);
    }
    Some(soaks)
}

fn weighed(columns: &Columns<'_>) -> Result<(Vec<f64>, Vec<Specimen>), Vec<Placed>> {
    let mut problems = repeated(columns);
    let cycles = match misnamed_first(columns, "cycles") {
        Some(problem) => Err(vec![problem]),
        None => growing(columns, within(0.0, f64::INFINITY), "0 or more"),
    };
    let cycles = cycles.unwrap_or_else(|found| {
        problems.extend(found);
        Vec::new()
    });
    let mut all = Vec::new();
    for index in 1..columns.names().len() {
        match specimen(columns, index) {
            Ok(specimen) => all.push(specimen),
            Err(found) => problems.extend(found),
        }
    }
    unless(problems, (cycles, all))
}

fn specimen(columns: &Columns<'_>, index: usize) -> Result<Specimen, Vec<Placed>> {
    let column = columns.names()[index];
    let Some(name) = column.strip_suffix("_mg") else {
        let message = format!("the name `{column}` does not end with the unit of a mass, _mg");
        let fault = Fault::new(
            message,
            "let its name end with `_mg`, and give the masses in mg",
        );
        return Err(vec![(columns.name_span(index), fault)]);
    };
    let cells = columns.numbers(index)?;
    let limits = within(MIN_MASS_MG, MAX_MASS_MG);
    let specimen = Specimen {
        name: name.to_owned(),
        masses_mg: cells.iter().map(|cell| cell.value).collect(),
    };
    let problems = outside(column, &cells, limits, "a mass of 50 mg to 1 kg");
    unless(problems, specimen)
}
