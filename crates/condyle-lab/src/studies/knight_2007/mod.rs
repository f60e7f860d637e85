//! The table of Knight et al. 2007 (`knight2007`), run on a case of one's own.
//!
//! A case in force control runs over 1, 2, 5, 10, 20 and 40 updates; its first cycle becomes the
//! waveforms of a case in displacement control; and what the paper found is set beside what comes out.

mod findings;
mod motions;
mod pictures;
mod rows;
mod series;

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use condyle_io::{cache::Cache, results::Summary};
use condyle_report::{ReportError, Results};
use serde::Serialize;
use thiserror::Error;

use super::{
    ConvergeError, ConvergeOptions, ConvergePlan, Converged, Convergence, Listener, converge,
};
pub use findings::{Findings, Scar};
pub use rows::Row;

/// The updates of the force-controlled runs: the paper's 1 x 5M to 40 x 125k, and two between.
const UPDATES: &str = "updates=1,2,5,10,20,40";
/// Of the displacement-controlled ones.
const DISPLACEMENT_UPDATES: &str = "updates=1,10";

/// What a study is made from, and where it goes.
#[derive(Clone, Debug)]
pub struct StudyFiles {
    /// The case in force control.
    pub force_case: PathBuf,
    /// The case in displacement control, which reads `ap-motion.csv` and `ie-motion.csv` from its
    /// own folder: both are written here.
    pub displacement_case: PathBuf,
    /// An empty folder for the runs.
    pub runs: PathBuf,
    /// A folder for `results.md`, `results.json` and the pictures.
    pub out: PathBuf,
}

/// When and from what the results were made.
#[derive(Clone, Debug, Serialize)]
pub struct Stamp {
    /// Commit of the source.
    pub commit: String,
    /// Date of the run.
    pub date: String,
}

/// Why a study is not done.
#[derive(Debug, Error)]
pub enum StudyError {
    /// The runs.
    #[error(transparent)]
    Converge(#[from] ConvergeError),
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
    /// Somebody asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// What `results.json` holds.
#[derive(Serialize)]
struct File<'a> {
    version: &'static str,
    #[serde(flatten)]
    stamp: &'a Stamp,
    findings: &'a Findings,
    rows: &'a [Row],
}

/// A run, read back from its folder.
struct Ran {
    updates: usize,
    folder: PathBuf,
    summary: Summary,
    results: Results,
}

/// Runs everything, writes the tables and the pictures, and gives the Markdown of the table.
///
/// `listener` hears of every run, and may stop the study by breaking.
///
/// # Errors
/// A bad case, physics that cannot be solved, or files that cannot be written.
pub fn study(
    files: &StudyFiles,
    stamp: &Stamp,
    listener: &Listener<'_>,
) -> Result<String, StudyError> {
    let out = files.runs.join("force");
    let force = run(&files.force_case, UPDATES, &out, listener)?;
    let folder = files.displacement_case.parent().unwrap_or(Path::new(""));
    for (name, text) in motions::of_first_cycle(reference(&force))? {
        write(&folder.join(name), &text)?;
    }
    let out = files.runs.join("displacement");
    let displacement = run(
        &files.displacement_case,
        DISPLACEMENT_UPDATES,
        &out,
        listener,
    )?;
    let findings = Findings::of(&force, &displacement)?;
    let rows = rows::rows(&findings);
    let text = rows::markdown(&rows, stamp);
    write(&files.out.join("results.md"), &text)?;
    write(
        &files.out.join("results.json"),
        &json(stamp, &findings, &rows),
    )?;
    let map = condyle_report::wear_map_svg(&reference(&force).folder)?;
    write(&files.out.join("wear-map.svg"), &map)?;
    let depth = pictures::depth_svg(&force, &displacement)?;
    write(&files.out.join("wear-over-cycles.svg"), &depth)?;
    Ok(text)
}

/// The run of the paper's interval, 500 000 cycles of 5 million.
fn reference(force: &[Ran]) -> &Ran {
    let is_reference = |ran: &&Ran| ran.updates == 10;
    force.iter().find(is_reference).unwrap_or(&force[0])
}

fn run(
    case: &Path,
    over: &str,
    out: &Path,
    listener: &Listener<'_>,
) -> Result<Vec<Ran>, StudyError> {
    let plan = ConvergePlan::new(case, over)?;
    let options = ConvergeOptions {
        out: out.to_owned(),
        // One at a time: their times are part of the table.
        threads: 1,
        resume: false,
        cache: Cache::off(),
    };
    match converge(&plan, &options, listener)? {
        Converged::Done(convergence) => read_back(convergence, out),
        Converged::Interrupted => Err(StudyError::Interrupted),
    }
}

fn read_back(convergence: Convergence, out: &Path) -> Result<Vec<Ran>, StudyError> {
    let points = convergence.points.into_iter();
    points
        .map(|point| {
            let folder = out.join(&point.folder);
            Ok(Ran {
                updates: point.summary.updates,
                results: Results::read(&folder)?,
                summary: point.summary,
                folder,
            })
        })
        .collect()
}

fn json(stamp: &Stamp, findings: &Findings, rows: &[Row]) -> String {
    let file = File {
        version: env!("CARGO_PKG_VERSION"),
        stamp,
        findings,
        rows,
    };
    serde_json::to_string_pretty(&file).expect("numbers and text always serialise") + "\n"
}

fn write(path: &Path, text: &str) -> Result<(), StudyError> {
    fs::write(path, text).map_err(|source| StudyError::Refused {
        path: path.to_owned(),
        source,
    })
}

impl Ran {
    /// A column of wear.csv or kinematics.csv.
    fn column(&self, table: Table, name: &'static str) -> Result<&[f64], StudyError> {
        column_of(&self.results, table, name).ok_or_else(|| self.lacks(name))
    }

    fn lacks(&self, what: &'static str) -> StudyError {
        lacks(&self.folder, what)
    }
}

fn column_of<'a>(results: &'a Results, table: Table, name: &str) -> Option<&'a [f64]> {
    let table = match table {
        Table::Wear => &results.wear,
        Table::Kinematics => &results.kinematics,
    };
    table.as_ref()?.column(name)
}

fn lacks(folder: &Path, what: &'static str) -> StudyError {
    StudyError::Lacking {
        folder: folder.to_owned(),
        what,
    }
}

/// Tables of a results folder.
#[derive(Clone, Copy)]
enum Table {
    Wear,
    Kinematics,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_results_folder_lacks_is_said() {
        let empty = Results::default();
        assert_eq!(column_of(&empty, Table::Wear, "max_depth_mm"), None);
        assert_eq!(column_of(&empty, Table::Kinematics, "ap_mm"), None);
        let said = lacks(Path::new("runs/updates-5"), "max_depth_mm").to_string();
        assert!(
            said.starts_with("runs/updates-5: there is no max_depth_mm in it; "),
            "{said}"
        );
    }

    #[test]
    fn a_results_folder_that_is_gone_is_said() {
        let error: StudyError = Results::read(Path::new("no-such-folder"))
            .expect_err("it is not there")
            .into();
        assert!(error.to_string().contains("no-such-folder"), "{error}");
    }

    #[test]
    fn a_file_that_cannot_be_written_is_said() {
        let error = write(Path::new("no-such-folder/results.md"), "").expect_err("no folder");
        let said = error.to_string();
        assert!(said.starts_with("no-such-folder/results.md: "), "{said}");
        assert!(
            said.contains("check that the folder can be written"),
            "{said}"
        );
    }
}
