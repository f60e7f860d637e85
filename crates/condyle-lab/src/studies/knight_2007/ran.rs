//! A run of the study, read back from its folder.

use std::path::{Path, PathBuf};

use condyle_io::results::Summary;
use condyle_report::Results;

use super::{super::Convergence, error::StudyError};

/// A run, read back from its folder.
pub(super) struct Ran {
    pub updates: usize,
    pub folder: PathBuf,
    pub summary: Summary,
    pub results: Results,
}

/// The run of the paper's interval, 500 000 cycles of 5 million.
pub(super) fn reference(runs: &[Ran]) -> &Ran {
    let is_reference = |ran: &&Ran| ran.updates == 10;
    runs.iter().find(is_reference).unwrap_or(&runs[0])
}

/// All runs of a study.
pub(super) fn read_back(convergence: Convergence, out: &Path) -> Result<Vec<Ran>, StudyError> {
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

    /// That it lacks something.
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
pub(super) enum TableOf {
    Wear,
    Kinematics,
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
