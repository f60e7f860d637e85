//! Drives, waveforms and activities that cannot be used.

use thiserror::Error;

use crate::config::Reason;

/// Why a drive or a waveform cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub(crate) enum DriveReason {
    #[error("[{section}] is given, but the {freedom} freedom is {drive}: the two contradict")]
    UnusedWaveform {
        section: String,
        freedom: &'static str,
        drive: &'static str,
        wanted: &'static str,
    },
    #[error("the {freedom} freedom cannot be {drive}: a case has no waveform for that")]
    NoSuchDrive {
        freedom: &'static str,
        drive: &'static str,
        drives: String,
    },
}

impl Reason for DriveReason {
    fn advice(&self) -> Option<String> {
        Some(match self {
            Self::UnusedWaveform {
                section, wanted, ..
            } => format!("remove [{section}], or make the freedom `drive = \"{wanted}\"`"),
            Self::NoSuchDrive { drives, .. } => format!("it can be {drives}"),
        })
    }
}

/// Why an activity cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum ActivityReason {
    #[error("an activity cannot be called \"{name}\"")]
    Name { name: String },
    #[error("two activities are called \"{name}\"")]
    SameName { name: String },
    #[error("the activity \"{name}\" does not say how many of the cycles it is")]
    NoShare { name: String },
    #[error("the activity \"{name}\" has both a `share` and `cycles_in_sequence`")]
    TwoShares { name: String },
    #[error("the activity \"{name}\" has a `share`, and another has `cycles_in_sequence`")]
    Mixed { name: String },
    #[error("the shares of the activities sum up to {sum:.4} and not to 1")]
    Sum { sum: f64 },
    #[error("the activity \"{name}\" has no {}", if *is_load { "load" } else { table })]
    LacksInput {
        name: String,
        table: &'static str,
        is_load: bool,
    },
    #[error("the activity \"{name}\" has no load: its axial force is never above 0 N")]
    NoLoad { name: String },
    #[error("[machine.{table}] is given, but the machine does what each [[activity]] says")]
    OfMachine { table: &'static str },
}

impl Reason for ActivityReason {
    fn advice(&self) -> Option<String> {
        Some(match self {
            Self::Name { .. } => {
                "write 1 to 40 small letters, digits and hyphens, such as \"stairs\"".to_owned()
            }
            Self::SameName { .. } => "give each a name of its own".to_owned(),
            Self::NoShare { .. } => {
                "write `share = 0.15`, or in all of them `cycles_in_sequence = 3`".to_owned()
            }
            Self::TwoShares { .. } => "leave one of them out".to_owned(),
            Self::Mixed { .. } => "give all of them the one or the other".to_owned(),
            Self::Sum { .. } => {
                "change them so that they do, or write `cycles_in_sequence`".to_owned()
            }
            Self::LacksInput { table, is_load, .. } => {
                let none = if *is_load {
                    ""
                } else {
                    ", or its `waveform = \"none\"`"
                };
                format!(
                    "write its [activity.{table}]{none}: nothing is taken from another activity"
                )
            }
            Self::NoLoad { .. } => "give it an axial force that presses".to_owned(),
            Self::OfMachine { table } => {
                format!("move it into the activities, as [activity.{table}]")
            }
        })
    }
}
