//! The table of Knight et al. 2007 (`knight2007`), computed for a given case.
//!
//! A case in force control runs over 1, 2, 5, 10, 20 and 40 updates; its first cycle becomes the
//! waveforms of a case in displacement control; and the table sets the results next to the figures of the paper.

mod findings;
mod runs;
mod table;

use std::{
    fs,
    path::{Path, PathBuf},
};

use condyle_case::cache::Cache;
use serde::Serialize;

use condyle_study::{ConvergeOptions, Listener, converge};

use findings::Findings;
use runs::{Ran, read_back, reference};
use table::PaperFigure;

pub use runs::StudyError;
pub use table::Stamp;

/// The updates of the runs: the paper's 1 x 5M to 40 x 125k, and two between.
const UPDATES: &str = "updates=1,2,5,10,20,40";

/// The inputs and outputs of the study.
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

/// The contents of `results.json`.
#[derive(Serialize)]
struct File<'a> {
    version: &'static str,
    #[serde(flatten)]
    stamp: &'a Stamp,
    findings: &'a Findings,
    rows: &'a [PaperFigure],
}

/// Runs everything, writes the tables and the pictures, and returns the table in Markdown.
///
/// `listener` receives the events of all runs, and stops the study by breaking.
///
/// # Errors
/// Returns an error for a bad case, unsolved physics, and files that cannot be written.
pub fn study(
    files: &StudyFiles,
    stamp: &Stamp,
    listener: &mut Listener<'_>,
) -> Result<String, StudyError> {
    let out = files.runs.join("force");
    let force = run(&files.force_case, UPDATES, &out, listener)?;
    let folder = files.displacement_case.parent().unwrap_or(Path::new(""));
    for (name, text) in runs::first_cycle(reference(&force))? {
        write(&folder.join(name), &text)?;
    }
    let out = files.runs.join("displacement");
    let displacement = run(&files.displacement_case, UPDATES, &out, listener)?;
    let findings = Findings::of(&force, &displacement)?;
    let rows = table::rows(&findings);
    let text = table::markdown(&rows, stamp);
    write(&files.out.join("results.md"), &text)?;
    write(
        &files.out.join("results.json"),
        &json(stamp, &findings, &rows),
    )?;
    let map = condyle_report::picture_svg(&reference(&force).folder, "wear_map")?;
    write(&files.out.join("wear-map.svg"), &map)?;
    let depth = runs::depth_svg(&force, &displacement)?;
    write(&files.out.join("wear-over-cycles.svg"), &depth)?;
    Ok(text)
}

fn run(
    case: &Path,
    over: &str,
    out: &Path,
    listener: &mut Listener<'_>,
) -> Result<Vec<Ran>, StudyError> {
    let options = ConvergeOptions {
        out: out.to_owned(),
        // One at a time: their times are part of the table.
        threads: 1,
        resume: false,
        cache: Cache::off(),
    };
    read_back(converge(case, over, &options, listener)?, out)
}

fn json(stamp: &Stamp, findings: &Findings, rows: &[PaperFigure]) -> String {
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

#[cfg(test)]
mod tests {
    use condyle_report::Results;

    use super::*;

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
