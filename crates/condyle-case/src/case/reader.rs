//! Reading of cases from files, and the hash of what goes into a run.

#[cfg(feature = "file-system")]
use std::fs;
use std::io;
use std::path::Path;
use std::sync::Arc;

use condyle::wear::WEAR_LAWS;
use miette::NamedSource;

use super::assignment::{Assignment, ChangeError, Override, without_other_laws};
use super::contents::Case;
use super::contents::read_case;
use super::machine::{Preset, write_knots, write_name};
use super::table::WearLaws;
use crate::config::{Base, DataFile, Problems, Source, read_document, read_source};
#[cfg(feature = "file-system")]
use condyle_mesh::files::Disk;
use condyle_mesh::files::{Files, MemoryFiles};

/// Reads cases.
#[derive(Clone, Debug)]
pub struct CaseReader {
    files: Arc<dyn Files>,
    wear_laws: WearLaws,
}

impl CaseReader {
    /// Reads cases, and the files that they name, from `files`.
    pub fn new(files: impl Files + 'static) -> Self {
        Self::sharing(Arc::new(files))
    }

    /// Reads cases from files that others read as well.
    pub(crate) fn sharing(files: Arc<dyn Files>) -> Self {
        let wear_laws = WEAR_LAWS;
        Self { files, wear_laws }
    }

    /// What they are read from.
    pub(crate) fn files(&self) -> &dyn Files {
        self.files.as_ref()
    }

    /// The same with other wear laws to choose from.
    pub fn with_wear_laws(self, wear_laws: WearLaws) -> Self {
        Self { wear_laws, ..self }
    }

    /// Reads the case file at `path`; paths in it count from its folder.
    ///
    /// # Errors
    /// Everything that is wrong with it, or that it cannot be read.
    pub fn read(&self, path: &Path) -> Result<Case, Problems> {
        let source = self.source(path)?;
        self.case_of(&source, Base::of(&self.files, path))
    }

    /// Reads the case file at `path` with one number changed. Messages show the changed text, and
    /// say so in its name.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_with(&self, path: &Path, number: &Override) -> Result<Case, Problems> {
        let file = self.source(path)?;
        let name = format!("{} with {} = {}", file.name(), number.path(), number.text());
        let source = Arc::new(NamedSource::new(name, number.applied_to(file.inner())));
        self.case_of(&source, Base::of(&self.files, path))
    }

    /// Reads the case file at `path` with some of its values changed, the last of several for the
    /// same key. Messages show the changed text, and say so in its name. A wear law that is set takes
    /// the place of the file's with all of its constants, of which building the case warns.
    ///
    /// # Errors
    /// As [`Self::read`]; a key that the case does not have, or more than once.
    pub fn read_changed(&self, path: &Path, changes: &[Assignment]) -> Result<Case, ChangeError> {
        if changes.is_empty() {
            return Ok(self.read(path)?);
        }
        let changes = self.placed(path, changes)?;
        let file = self.source(path)?;
        let said: Vec<String> = changes.iter().map(Assignment::in_words).collect();
        let name = format!("{} with {}", file.name(), said.join(", "));
        let apply = |text: String, change: &Assignment| change.applied_to(&text);
        let text = changes.iter().fold(file.inner().clone(), apply);
        let set: Vec<&str> = changes.iter().map(Assignment::key).collect();
        let (text, left_out) = without_other_laws(&text, &set, self.wear_laws);
        let source = Arc::new(NamedSource::new(name, text));
        let mut case = self.case_of(&source, Base::of(&self.files, path))?;
        case.origin.left_out = left_out;
        Ok(case)
    }

    /// The same changes with the dotted paths of their keys. Where they do not tell themselves, the case is read with
    /// those that do: a law that is set brings keys of its own.
    fn placed(&self, path: &Path, changes: &[Assignment]) -> Result<Vec<Assignment>, ChangeError> {
        if changes.iter().all(Assignment::is_placed) {
            return Ok(changes.to_vec());
        }
        let told = changes.iter().filter(|change| change.is_placed());
        let case = self.read_changed(path, &told.cloned().collect::<Vec<_>>())?;
        let placed = |change: &Assignment| {
            if change.is_placed() {
                Ok(change.clone())
            } else {
                change.placed_in(&case)
            }
        };
        let all: Result<Vec<_>, _> = changes.iter().map(placed).collect();
        Ok(all?)
    }

    /// Reads a case from `text`, called `name` in messages; paths count from `folder`.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn parse(&self, text: &str, name: &str, folder: &Path) -> Result<Case, Problems> {
        let source = Arc::new(NamedSource::new(name, text.to_owned()));
        let files = &self.files;
        self.case_of(&source, Base { files, folder })
    }

    fn source(&self, path: &Path) -> Result<Source, Problems> {
        read_source(self.files.as_ref(), path).map_err(Problems::unreadable)
    }

    fn case_of(&self, source: &Source, base: Base<'_>) -> Result<Case, Problems> {
        read_document(source, base, |root, log| {
            read_case(root, self.wear_laws, log)
        })
    }
}

impl Case {
    /// The case as a file that reads back as an equal case: every default written out, waveforms
    /// as points, files by their absolute paths.
    pub fn to_toml(&self) -> String {
        self.written(write_knots)
    }
}

/// A case to start from: every key with its default and its meaning.
pub fn template(preset: Preset) -> String {
    let text = format!("[machine]\npreset = {:?}\n", preset.word());
    match CaseReader::new(MemoryFiles::default()).parse(&text, "template", Path::new("")) {
        Ok(case) => case.written(write_name),
        Err(error) => unreachable!("the defaults are a case, a test reads them: {error}"),
    }
}

#[cfg(feature = "file-system")]
impl Default for CaseReader {
    fn default() -> Self {
        Self::new(Disk)
    }
}

#[cfg(feature = "file-system")]
impl Case {
    /// Reads the case file at `path` on the disk; paths in it count from its folder.
    ///
    /// # Errors
    /// As [`CaseReader::read`].
    pub fn read(path: &Path) -> Result<Self, Problems> {
        CaseReader::default().read(path)
    }

    /// Reads the case file at `path` with one number changed.
    ///
    /// # Errors
    /// As [`CaseReader::read_with`].
    pub fn read_with(path: &Path, number: &Override) -> Result<Self, Problems> {
        CaseReader::default().read_with(path, number)
    }

    /// Reads the case file at `path` with some of its values changed.
    ///
    /// # Errors
    /// As [`CaseReader::read_changed`].
    pub fn read_changed(path: &Path, changes: &[Assignment]) -> Result<Self, ChangeError> {
        CaseReader::default().read_changed(path, changes)
    }

    /// Reads a case from `text`, called `name` in messages; paths count from `folder`.
    ///
    /// # Errors
    /// As [`CaseReader::parse`].
    pub fn parse(text: &str, name: &str, folder: &Path) -> Result<Self, Problems> {
        CaseReader::default().parse(text, name, folder)
    }

    /// The case as [`Self::to_toml`] has it, to be kept in `folder`, which is there: its files by
    /// their paths counted from that folder, so that nothing in it names a place of one machine.
    pub fn to_toml_in(&self, folder: &Path) -> String {
        self.named_from(folder).to_toml()
    }

    /// The same, with waveforms by their names, as a case to go on from.
    pub(super) fn as_draft_in(&self, folder: &Path) -> String {
        self.named_from(folder).written(write_name)
    }

    /// The case with its files named from `folder`.
    fn named_from(&self, folder: &Path) -> Self {
        let mut case = self.clone();
        if let Ok(folder) = fs::canonicalize(folder) {
            let files = [case.femur.file_mut(), case.insert.file_mut()];
            for file in files.into_iter().flatten() {
                *file = file.named_from(&folder);
            }
        }
        case
    }
}

impl Case {
    /// Hash of the case as run and of the bytes of its meshes, in hexadecimal.
    ///
    /// Where the meshes lie does not count, what is in them does.
    ///
    /// # Errors
    /// A mesh that can no longer be read.
    pub fn inputs_blake3(&self) -> io::Result<String> {
        let mut text = self.to_toml();
        let mut hasher = blake3::Hasher::new();
        for file in [self.femur.file(), self.insert.file()]
            .into_iter()
            .flatten()
        {
            text = without_path(&text, file);
            hasher.update(blake3::hash(&file.files().read(file.path())?).as_bytes());
        }
        hasher.update(text.as_bytes());
        Ok(hasher.finalize().to_hex().to_string())
    }
}

/// A case as written, without the path of a file and without the blanks that fill its line up to
/// the comment, which are as many as the path is short.
fn without_path(text: &str, file: &DataFile) -> String {
    let path = toml::Value::String(file.path().to_string_lossy().into_owned()).to_string();
    let mut parts = text.split(&path);
    let first = parts.next().unwrap_or_default().to_owned();
    parts.fold(first, |before, after| {
        before + " " + after.trim_start_matches(' ')
    })
}
