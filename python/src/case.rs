//! Cases for Python: read with files in memory over those on the disk, changed, written.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};

use condyle_case::case::{Assignment, Case, CaseReader, ChangeError};
use condyle_lab::Preview;
use condyle_mesh::files::{Disk, Files, MemoryFiles};
use pyo3::prelude::*;
use toml_edit::DocumentMut;

use crate::errors;

/// A checked case.
#[pyclass(frozen, module = "condyle._condyle")]
pub struct RawCase {
    pub case: Case,
}

#[pymethods]
impl RawCase {
    /// Reads a case from `text` as if it stood in the file `path`. Files that it names are looked up in `files` first,
    /// then from the folder `base`. `changes` are written as `key=value`.
    #[new]
    fn new(
        path: PathBuf,
        text: &str,
        base: PathBuf,
        files: BTreeMap<PathBuf, Vec<u8>>,
        changes: Vec<String>,
    ) -> PyResult<Self> {
        let changes = changes.iter().map(|change| Assignment::parse(change));
        let changes: Vec<_> = changes
            .collect::<Result<_, _>>()
            .map_err(errors::bad_input)?;
        let reader = CaseReader::new(CaseFiles::new(&path, text, base, files));
        match reader.read_changed(&path, &changes) {
            Ok(case) => Ok(Self { case }),
            Err(ChangeError::Case(problems)) => Err(errors::of_problems(problems)),
            Err(ChangeError::Assignment(error)) => Err(errors::bad_input(error)),
        }
    }

    /// The text of a case file on the disk.
    #[staticmethod]
    fn read_text(path: PathBuf) -> PyResult<String> {
        std::fs::read_to_string(&path).map_err(|_| {
            // The reader of cases has the command's message; if it succeeds, the file appeared meanwhile.
            match Case::read(&path) {
                Err(problems) => errors::of_problems(problems),
                Ok(_) => errors::bad_input("the case file is changing while it is read"),
            }
        })
    }

    /// The case as run, with all defaults.
    fn toml(&self) -> String {
        self.case.to_toml()
    }

    /// The same, with paths relative to `folder`.
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
        self.case.inputs_blake3().map_err(|error| {
            errors::bad_input(format!("a mesh of the case cannot be read: {error}"))
        })
    }

    /// The facts known before a run, as JSON, and a picture of both bodies, as SVG.
    fn preview(&self, py: Python<'_>, threads: usize) -> PyResult<(String, String)> {
        let preview = py.detach(|| Preview::of_case(self.case.clone(), threads));
        let preview = preview.map_err(errors::of_run)?;
        let json = serde_json::to_string(&preview).expect("numbers and text always serialise");
        Ok((json, preview.picture_svg()))
    }
}

/// Converts a JSON object to the text of a TOML file.
#[pyfunction]
pub fn toml_document(json: &str) -> PyResult<String> {
    toml::to_string(&value_from_json(json)?).map_err(errors::bad_input)
}

/// Converts a JSON value to a TOML value on one line.
#[pyfunction]
pub fn toml_value(json: &str) -> PyResult<String> {
    Ok(value_from_json(json)?.to_string())
}

fn value_from_json(json: &str) -> PyResult<toml::Value> {
    serde_json::from_str(json).map_err(errors::bad_input)
}

/// Replaces the table `table` in the text of a case by that of the TOML text `keys`. A text that is not TOML is
/// returned unchanged, for the reader to report.
#[pyfunction]
pub fn with_table(text: &str, table: &str, keys: &str) -> String {
    let (Ok(mut document), Ok(keys)) = (text.parse::<DocumentMut>(), keys.parse::<DocumentMut>())
    else {
        return text.to_owned();
    };
    document.insert(table, toml_edit::Item::Table(keys.as_table().clone()));
    document.to_string()
}

/// Files in memory over those on the disk. Relative paths count from `base`, whatever the working folder becomes.
#[derive(Debug)]
pub struct CaseFiles {
    memory: MemoryFiles,
    base: PathBuf,
}

impl CaseFiles {
    /// `text` as the file at `path`, and `files` next to it.
    pub fn new(path: &Path, text: &str, base: PathBuf, files: BTreeMap<PathBuf, Vec<u8>>) -> Self {
        let memory = MemoryFiles::default().with(path, text);
        let files = files.into_iter();
        let memory = files.fold(memory, |memory, (path, bytes)| memory.with(path, bytes));
        Self { memory, base }
    }
}

impl Files for CaseFiles {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let in_memory = self.memory.read(path);
        in_memory.or_else(|_| Disk.read(&self.base.join(path)))
    }

    fn find(&self, written: &str, folder: &Path) -> Result<PathBuf, PathBuf> {
        let in_memory = self.memory.find(written, folder);
        in_memory.or_else(|_| Disk.find(written, &self.base.join(folder)))
    }
}
