//! The first cycle of a run as waveforms of another.

use std::fmt::Write;

use super::{
    error::StudyError,
    ran::{Ran, TableOf},
};

/// Columns of kinematics.csv and the files they become.
const MOTIONS: [(&str, &str); 2] = [("ap_mm", "ap-motion.csv"), ("ie_deg", "ie-motion.csv")];

/// Names and texts of the waveform files: percent of the cycle, and the motion of the first cycle.
pub(super) fn of_first_cycle(ran: &Ran) -> Result<Vec<(&'static str, String)>, StudyError> {
    let percent = ran.column(TableOf::Kinematics, "percent")?;
    let cycles = ran.column(TableOf::Kinematics, "cycles")?;
    let of = |(column, file): (&'static str, &'static str)| {
        let values = ran.column(TableOf::Kinematics, column)?;
        let mut text = format!("percent,{column}\n");
        let rows = cycles.iter().zip(percent).zip(values);
        for ((_, percent), value) in rows.filter(|((cycles, _), _)| **cycles == 0.0) {
            writeln!(text, "{percent},{value}").expect("writing to a string cannot fail");
        }
        Ok((file, text))
    };
    MOTIONS.into_iter().map(of).collect()
}
