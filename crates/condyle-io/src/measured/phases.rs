//! Phases of the gait cycle.

use toml::Spanned;
use toml::de::DeValue;

use super::reason::MeasuredReason;
use crate::config::{Log, Section, number};

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
pub(super) fn read(kinematics: &Section<'_>, log: &mut Log<'_>) -> Option<Vec<Phase>> {
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
