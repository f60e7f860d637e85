//! Measured motions and loads: a CSV file by percent of the cycle, and phases of the gait cycle.

use condyle::{machine::knee::KNEE, parameter::unit_of};

use super::columns::{growing, misnamed_first, repeated, too_few, unless};
use crate::case::parts_of_a_cycle;
use crate::config::*;

choice! {
    /// The cycle of the run that a measured one is compared with.
    CycleWord {
        /// The first: the insert is unworn.
        First = "first",
        /// The last: the insert is worn.
        Last = "last",
    }

    /// Alignment of two curves before they are compared.
    AlignWord {
        /// Nothing.
        None = "none",
        /// The mean difference is removed from the measured curve.
        Mean = "mean",
    }
}

settings! {
    /// Measured motions and loads and their comparison.
    KinematicsKeys {
        /// CSV file; `percent` of the cycle, then columns named as in kinematics.csv.
        file: DataFile;
        /// Cycle of the run.
        cycle: CycleWord = CycleWord::First;
        /// Alignment before the errors are computed: the mean difference can be removed.
        align: AlignWord = AlignWord::None;
        /// Between measured points farther apart than this, in percent of the cycle, nothing is compared.
        largest_gap_percent: f64 = 10.0, in within(0.1, 100.0);
    }
}

const EXAMPLE: &str = "percent,ap_mm,ie_deg";

/// Measured motions and loads and their comparison.
#[derive(Clone, Debug)]
pub struct Kinematics {
    /// The keys of the table.
    pub keys: KinematicsKeys,
    /// Phases of gait with errors of their own.
    pub phases: Vec<Phase>,
    /// The curves, in the order of the file.
    pub curves: Vec<MeasuredCurve>,
}

/// A column of a measured cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredCurve {
    /// Its name, that of a column of the run, which ends in the unit.
    pub column: String,
    /// Its points, by increasing percent, without empty cells.
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

impl Kinematics {
    pub(super) fn read(root: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let section = root.table("kinematics", log);
        let known: Vec<&str> = names(&KinematicsKeys::keys()).chain([PHASES]).collect();
        section.check_keys(&known, log);
        let phases = read_phases(&section, log);
        let keys = KinematicsKeys::read(&section, log)?;
        let source = keys.file.source(&section, "file", log)?;
        let curves = log.noted(&source, curves(source.inner(), &keys.file.name()))?;
        Some(Self {
            keys,
            phases: phases?,
            curves,
        })
    }
}

fn curves(text: &str, file: &str) -> Result<Vec<MeasuredCurve>, Vec<Placed>> {
    let columns = Columns::split(text, file, EXAMPLE)?;
    let mut problems = repeated(&columns);
    problems.extend(misnamed_first(&columns, "percent"));
    for (index, name) in columns.names().iter().enumerate().skip(1) {
        // Those of other joints than a knee are compared with the run's own columns.
        if unit_of(name).is_none() {
            let known: [&str; 11] = KNEE.column_names();
            let all = known.join(", ");
            let advice = match nearest(name, known.into_iter()) {
                Some(near) => format!("did you mean `{near}`? It can be {all}"),
                None => format!(
                    "remove it, or name it one of {all}, or as another joint's with its unit"
                ),
            };
            let message = format!("a run has no column `{name}` to compare with");
            problems.push((columns.name_span(index), Fault::new(message, advice)));
        }
    }
    unless(problems, ())?;
    let percents = growing(&columns, within(0.0, 100.0), "0 to 100")?;
    if let Some(fault) = parts_of_a_cycle(percents.iter().copied()) {
        return Err(vec![(columns.name_span(0), fault)]);
    }
    let (mut curves, mut problems) = (Vec::new(), Vec::new());
    for index in 1..columns.names().len() {
        match curve(&columns, index, &percents) {
            Ok(curve) => curves.push(curve),
            Err(found) => problems.extend(found),
        }
    }
    unless(problems, curves)
}

fn curve(
    columns: &Columns<'_>,
    index: usize,
    percents: &[f64],
) -> Result<MeasuredCurve, Vec<Placed>> {
    const MIN_SAMPLES: usize = 2;
    let column = columns.names()[index];
    let cells = columns.numbers_given(index)?;
    if cells.len() < MIN_SAMPLES {
        let span = columns.name_span(index);
        let fault = too_few(column, cells.len(), MIN_SAMPLES);
        return Err(vec![(span, fault)]);
    }
    let sample = |cell: &Cell| Sample {
        percent: percents[cell.row],
        value: cell.value,
    };
    let samples = cells.iter().map(sample).collect();
    let column = column.to_owned();
    Ok(MeasuredCurve { column, samples })
}

pub(super) const PHASES: &str = "phases_percent";

/// A named part of the gait cycle.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// Its name.
    pub name: String,
    /// Its start, percent of the cycle; this instant belongs to it.
    pub start_percent: f64,
    /// Its end; this instant belongs to the next.
    pub end_percent: f64,
}

impl Phase {
    /// Returns the phases of walking, the default.
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

    /// Returns true if an instant belongs to the phase.
    pub fn holds(&self, percent: f64) -> bool {
        (self.start_percent..self.end_percent).contains(&percent)
    }
}

/// Reads the phases of `[kinematics.phases_percent]`, or returns those of walking.
fn read_phases(kinematics: &Section<'_>, log: &mut Log<'_>) -> Option<Vec<Phase>> {
    let Some(table) = kinematics.value(PHASES) else {
        return Some(Phase::of_walking());
    };
    let section = kinematics.table(PHASES, log);
    let mut phases = Vec::new();
    for (name, value) in table.get_ref().as_table()? {
        let name: &str = name.get_ref();
        let list: Vec<_> = value.get_ref().as_array().into_iter().flatten().collect();
        let numbers: Vec<Option<f64>> = list.iter().map(|item| number(item.get_ref())).collect();
        match numbers[..] {
            [Some(start), Some(end)] if 0.0 <= start && start < end && end <= 100.0 => {
                phases.push(Phase {
                    name: name.to_owned(),
                    start_percent: start,
                    end_percent: end,
                });
            }
            _ => {
                let given: Vec<f64> = numbers.into_iter().flatten().collect();
                let fault = Fault::new(
                    format!(
                        "the phase `{name}` is {given:?}: it must be [start, end] in percent, 0 to 100"
                    ),
                    "write it as `\"mid stance\" = [10, 30]`",
                );
                log.problem(section.value_span(name), fault);
            }
        }
    }
    Some(phases)
}
