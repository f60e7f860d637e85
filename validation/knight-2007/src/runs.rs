//! The runs of the study, read back from their folders; the waveforms and the picture made from them.

use condyle_results::catalogue;
use std::{
    fmt::Write,
    io,
    path::{Path, PathBuf},
};

use condyle_report::{Plot, ReportError, Results, plots_svg};
use condyle_results::Summary;
use condyle_study::Convergence;
use thiserror::Error;

/// The reasons why the study fails.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The runs.
    #[error(transparent)]
    Converge(#[from] condyle_study::StudyError),
    /// The results of a run.
    #[error(transparent)]
    Report(#[from] ReportError),
    /// A run that lacks what the study needs.
    #[error("{}: there is no {what} in it; the study needs whole results folders", folder.display())]
    Lacking {
        /// The results folder.
        folder: PathBuf,
        /// What it lacks.
        what: &'static str,
    },
    /// The system refused to write.
    #[error("{}: {source}; check that the folder can be written and the disk is not full", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
}

/// A run, read back from its folder.
pub(crate) struct Ran {
    pub updates: usize,
    pub folder: PathBuf,
    pub summary: Summary,
    pub results: Results,
}

/// The run of the paper's interval, 500 000 cycles of 5 million.
pub(crate) fn reference(runs: &[Ran]) -> &Ran {
    let is_reference = |ran: &&Ran| ran.updates == 10;
    runs.iter().find(is_reference).unwrap_or(&runs[0])
}

/// All runs of a study.
pub(crate) fn read_back(convergence: Convergence, out: &Path) -> Result<Vec<Ran>, StudyError> {
    let points = convergence.points.into_iter();
    points
        .map(|point| {
            let folder = out.join(&point.folder);
            Ok(Ran {
                updates: point.summary[&catalogue::UPDATES] as usize,
                results: Results::read(&folder)?,
                summary: point.summary,
                folder,
            })
        })
        .collect()
}

impl Ran {
    /// A column of wear.csv or kinematics.csv.
    pub fn column(&self, table: TableOf, name: &'static str) -> Result<&[f64], StudyError> {
        column_of(&self.results, table, name).ok_or_else(|| self.lacks(name))
    }

    /// Cycles and deepest wear after every update.
    pub fn depths(&self) -> Result<(&[f64], &[f64]), StudyError> {
        Ok((
            self.column(TableOf::Wear, "cycles")?,
            self.column(TableOf::Wear, "max_depth_mm")?,
        ))
    }

    /// The error for a missing part of the results.
    pub fn lacks(&self, what: &'static str) -> StudyError {
        lacks(&self.folder, what)
    }
}

fn column_of<'a>(results: &'a Results, table: TableOf, name: &str) -> Option<&'a [f64]> {
    let table = match table {
        TableOf::Wear => &results.wear,
        TableOf::Kinematics => &results.kinematics,
    };
    table.as_ref()?.column(name)
}

fn lacks(folder: &Path, what: &'static str) -> StudyError {
    StudyError::Lacking {
        folder: folder.to_owned(),
        what,
    }
}

/// A table of a results folder.
#[derive(Clone, Copy)]
pub(crate) enum TableOf {
    Wear,
    Kinematics,
}

/// Columns of kinematics.csv and the files they become.
const MOTIONS: [(&str, &str); 2] = [("ap_mm", "ap-motion.csv"), ("ie_deg", "ie-motion.csv")];

/// Names and texts of the waveform files: percent of the cycle, and the motion of the first cycle.
pub(crate) fn first_cycle(ran: &Ran) -> Result<Vec<(&'static str, String)>, StudyError> {
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

/// Updates of the runs that are shown against the finest.
const SHOWN: [usize; 2] = [5, 10];

/// Depth over cycles at two intervals, volume, and volume in displacement control, each against 40 updates.
pub(crate) fn depth_svg(force: &[Ran], displacement: &[Ran]) -> Result<String, StudyError> {
    let finest = &force[force.len() - 1];
    let held = reference(displacement);
    let mut plots = Vec::new();
    for ran in force.iter().filter(|ran| SHOWN.contains(&ran.updates)) {
        let title = format!("Deepest wear, {}", updates_of(ran));
        plots.push(plot(title, "mm", "max_depth_mm", ran, finest)?);
    }
    let named = [
        ("Volume loss, force control", &force[0]),
        ("Volume loss, displacement control", held),
    ];
    for (title, ran) in named {
        let title = format!("{title}, {}", updates_of(ran));
        plots.push(plot(title, "mm\u{b3}", "volume_loss_mm3", ran, finest)?);
    }
    let reference = updates_of(finest);
    let keys = [reference.as_str(), "", "as titled"];
    Ok(plots_svg("Wear over the test", &plots, 2, &keys))
}

fn updates_of(ran: &Ran) -> String {
    match ran.updates {
        1 => "1 update".to_owned(),
        updates => format!("{updates} updates"),
    }
}

fn plot(
    title: String,
    unit: &str,
    column: &'static str,
    ran: &Ran,
    finest: &Ran,
) -> Result<Plot, StudyError> {
    Ok(Plot {
        title,
        unit: unit.to_owned(),
        x_title: "million cycles".to_owned(),
        from_zero: true,
        min_span: f64::MIN_POSITIVE,
        reference: points(finest, column)?,
        line: points(ran, column)?,
        ..Plot::default()
    })
}

/// (million cycles, value), from nothing worn at the start.
fn points(ran: &Ran, column: &'static str) -> Result<Vec<(f64, f64)>, StudyError> {
    let cycles = ran.column(TableOf::Wear, "cycles")?;
    let values = ran.column(TableOf::Wear, column)?;
    let after = cycles
        .iter()
        .map(|cycles| cycles / 1e6)
        .zip(values.iter().copied());
    Ok([(0.0, 0.0)].into_iter().chain(after).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_results_folder_lacks_is_said() {
        let empty = Results::default();
        assert_eq!(column_of(&empty, TableOf::Wear, "max_depth_mm"), None);
        assert_eq!(column_of(&empty, TableOf::Kinematics, "ap_mm"), None);
        let said = lacks(Path::new("runs/updates-5"), "max_depth_mm").to_string();
        assert!(
            said.starts_with("runs/updates-5: there is no max_depth_mm in it; "),
            "{said}"
        );
    }
}
