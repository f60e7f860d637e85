//! The answers of a study, written beside its database.

use std::{
    fs,
    io::{self, BufWriter, Write},
    path::Path,
};

use super::{answers::Answers, error::StudyError, pictures, plan::Plan, store::Store};

/// What the study in `folder` tells.
///
/// # Errors
/// A folder without the study.
pub fn answer(plan: &Plan, folder: &Path) -> Result<Answers, StudyError> {
    Answers::of(plan, &Store::existing(folder, plan)?)
}

/// Writes `table.csv`, `answers.json`, the pictures and `study.html` of the study in `folder`, and gives what it tells.
///
/// # Errors
/// A folder without the study, or one that cannot be written.
pub fn write_answers(plan: &Plan, folder: &Path) -> Result<Answers, StudyError> {
    let store = Store::existing(folder, plan)?;
    let answers = Answers::of(plan, &store)?;
    store.export_csv(&folder.join("table.csv"))?;
    let json = serde_json::to_string_pretty(&answers).expect("numbers and text always serialise");
    write(&folder.join("answers.json"), &(json + "\n"))?;
    pictures::write(&answers, folder)?;
    Ok(answers)
}

impl Store {
    /// Writes the table into a file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn export_csv(&self, path: &Path) -> Result<(), StudyError> {
        let refused = |source| refused(path, source);
        let file = fs::File::create(path).map_err(refused)?;
        let mut out = BufWriter::new(file);
        self.write_csv(&mut out)?.map_err(refused)?;
        out.flush().map_err(refused)
    }
}

fn write(path: &Path, text: &str) -> Result<(), StudyError> {
    fs::write(path, text).map_err(|source| refused(path, source))
}

fn refused(path: &Path, source: io::Error) -> StudyError {
    let path = path.to_path_buf();
    StudyError::Refused { path, source }
}
