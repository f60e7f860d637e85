//! Drives, waveforms and activities that make no test.

use thiserror::Error;

use crate::config::Reason;

/// Why a drive or a waveform cannot be used.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum DriveReason {
    /// A waveform of a freedom that is driven otherwise.
    #[error("[{section}] is given, but the {freedom} freedom is {drive}: the two contradict")]
    UnusedWaveform {
        /// The table of the waveform.
        section: String,
        /// The freedom it would drive.
        freedom: &'static str,
        /// How that is driven.
        drive: &'static str,
        /// The drive the waveform is for.
        wanted: &'static str,
    },
    /// A drive that no waveform exists for.
    #[error("the {freedom} freedom cannot be {drive}: a case has no waveform for that")]
    NoSuchDrive {
        /// The freedom.
        freedom: &'static str,
        /// As written.
        drive: &'static str,
        /// Drives it can have.
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
pub enum ActivityReason {
    /// A name that is no word of a path and of a file.
    #[error("an activity cannot be called \"{name}\"")]
    Name {
        /// As written.
        name: String,
    },
    /// A name that an activity before has.
    #[error("two activities are called \"{name}\"")]
    SameName {
        /// As written.
        name: String,
    },
    /// No word of how many cycles.
    #[error("the activity \"{name}\" does not say how many of the cycles it is")]
    NoShare {
        /// Its name.
        name: String,
    },
    /// Both a share and cycles of a sequence.
    #[error("the activity \"{name}\" has both a `share` and `cycles_in_sequence`")]
    TwoShares {
        /// Its name.
        name: String,
    },
    /// A share among cycles of a sequence.
    #[error("the activity \"{name}\" has a `share`, and another has `cycles_in_sequence`")]
    Mixed {
        /// Its name.
        name: String,
    },
    /// Shares that are not all of the cycles.
    #[error("the shares of the activities sum up to {sum:.4} and not to 1")]
    Sum {
        /// What they sum up to.
        sum: f64,
    },
    /// A waveform that it needs is not there.
    #[error("the activity \"{name}\" has no {}", if *is_load { "load" } else { table })]
    LacksInput {
        /// Its name.
        name: String,
        /// The table of the waveform.
        table: &'static str,
        /// Whether it is what presses.
        is_load: bool,
    },
    /// An axial force that is never more than nothing.
    #[error("the activity \"{name}\" has no load: its axial force is never above 0 N")]
    NoLoad {
        /// Its name.
        name: String,
    },
    /// An input of the machine beside activities.
    #[error("[machine.{table}] is given, but the machine does what each [[activity]] says")]
    OfMachine {
        /// The table of the waveform.
        table: &'static str,
    },
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
