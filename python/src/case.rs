//! A case as Python holds it: what it was read from, and what that says.

use std::collections::BTreeMap;
use std::path::PathBuf;

use condyle_case::case::{Assignment, AssignmentError, Case, CaseReader, ChangeError};
use condyle_lab::Preview;
use pyo3::prelude::*;
use toml_edit::DocumentMut;

use crate::errors;
use crate::files::FilesOfCase;

/// A case, checked.
#[pyclass(frozen, module = "condyle._condyle")]
pub struct RawCase {
    pub case: Case,
}

#[pymethods]
impl RawCase {
    /// Reads a case from `text`, as if it stood in the file `path`; what that names is looked for in `files` first,
    /// and from the folder `base` on. `changes` are written as `key=value`.
    #[new]
    fn new(
        path: PathBuf,
        text: &str,
        base: PathBuf,
        files: BTreeMap<PathBuf, Vec<u8>>,
        changes: Vec<String>,
    ) -> PyResult<Self> {
        let changes = assignments(&changes).map_err(|error| errors::bad_input(&error))?;
        let files = FilesOfCase::new(&path, text, base, files);
        let reader = CaseReader::new(files);
        match reader.read_changed(&path, &changes) {
            Ok(case) => Ok(Self { case }),
            Err(ChangeError::Case(problems)) => Err(errors::of_problems(&problems)),
            Err(ChangeError::Assignment(error)) => Err(errors::bad_input(&error)),
        }
    }

    /// The text of a case file on the disk.
    #[staticmethod]
    fn read_text(path: PathBuf) -> PyResult<String> {
        std::fs::read_to_string(&path).map_err(|_| {
            // The reader of cases says it as the command does; a file that can be read by now is a case without text.
            match Case::read(&path) {
                Err(problems) => errors::of_problems(&problems),
                Ok(_) => errors::bad_input(&"the case file is changing while it is read"),
            }
        })
    }

    /// The case as run, every default written out.
    fn toml(&self) -> String {
        self.case.to_toml()
    }

    /// The same, with its files named from `folder`.
    fn toml_in(&self, folder: PathBuf) -> String {
        self.case.to_toml_in(&folder)
    }

    /// The same as JSON.
    fn json(&self) -> String {
        let tables: toml::Table = self
            .toml()
            .parse()
            .expect("a case that was written reads back");
        serde_json::to_string(&tables).expect("tables always serialise")
    }

    /// Hash of the case as run and of its meshes, in hexadecimal.
    fn inputs_blake3(&self) -> PyResult<String> {
        let hash = self.case.inputs_blake3();
        hash.map_err(|error| {
            errors::bad_input(&format!("a mesh of the case cannot be read: {error}"))
        })
    }

    /// What the case comes to before it runs, as JSON, and a picture of both bodies, as SVG.
    fn preview(&self, py: Python<'_>, threads: usize) -> PyResult<(String, String)> {
        let preview = py.detach(|| Preview::of_case(self.case.clone(), threads));
        let preview = preview.map_err(|error| errors::of_run(&error))?;
        let json = serde_json::to_string(&preview).expect("numbers and text always serialise");
        Ok((json, preview.picture_svg()))
    }
}

fn assignments(changes: &[String]) -> Result<Vec<Assignment>, AssignmentError> {
    let changes = changes.iter();
    changes.map(|change| Assignment::parse(change)).collect()
}

/// The text of a case with the table `table` replaced by one of `keys`, each written as TOML; a text that is not TOML
/// stays as it is.
#[pyfunction]
pub fn with_table(text: &str, table: &str, keys: &str) -> String {
    let (Ok(mut document), Ok(keys)) = (text.parse::<DocumentMut>(), keys.parse::<DocumentMut>())
    else {
        return text.to_owned();
    };
    document.insert(table, toml_edit::Item::Table(keys.as_table().clone()));
    document.to_string()
}
