//! Reading of cases from files, and the hash of the inputs of a run.

#[cfg(feature = "file-system")]
use std::fs;
use std::io;
use std::path::Path;
use std::sync::Arc;

use condyle::wear::WEAR_LAWS;
use miette::NamedSource;

use super::assignment::{Assignment, AssignmentError, ChangeError, Lines};
use super::contents::Case;
use super::machine::Preset;
use super::renamed::rename_keys;
use super::wear::WearLaws;
use crate::config::*;
#[cfg(feature = "file-system")]
use condyle_mesh::files::Disk;
use condyle_mesh::files::{Files, MemoryFiles};

/// Reads cases.
#[derive(Clone, Debug)]
pub struct CaseReader {
    pub(crate) files: Arc<dyn Files>,
    /// Wear laws to choose from.
    pub(super) wear_laws: WearLaws,
}

impl CaseReader {
    /// Returns a reader of cases, and of the files that they name, from `files`.
    pub fn new(files: impl Files + 'static) -> Self {
        Self::sharing(Arc::new(files))
    }

    pub(crate) fn sharing(files: Arc<dyn Files>) -> Self {
        let wear_laws = WEAR_LAWS;
        Self { files, wear_laws }
    }

    /// Reads the case file at `path`; paths in it are relative to its folder.
    ///
    /// # Errors
    /// The file cannot be read, or it has problems; all of them are reported.
    pub fn read(&self, path: &Path) -> Result<Case, Problems> {
        self.case_of(&self.source(path)?, Base::of(&self.files, path), &[])
    }

    /// Reads the case file at `path` with some of its values changed, the last of several for the same key.
    ///
    /// Messages show the changes as lines below the file. If a choice such as a wear law is set, the keys of the file
    /// that do not apply to it are omitted, with a warning when the case is built.
    ///
    /// # Errors
    /// As [`Self::read`]; a name that no key has, or several.
    pub fn read_changed(&self, path: &Path, changes: &[Assignment]) -> Result<Case, ChangeError> {
        let (file, base) = (self.source(path)?, Base::of(&self.files, path));
        let is_placed = |change: &&Assignment| change.key().contains('.');
        if changes.iter().all(|change| is_placed(&change)) {
            return Ok(self.case_of(&file, base, changes)?);
        }
        let items = Case::items_with(self.wear_laws);
        let changes: Vec<Assignment> = changes.iter().map(|one| one.placed(&items)).collect();
        // A name that several keys have is looked up in the case with all other changes: a shape that is set brings keys.
        let others: Vec<Assignment> = changes.iter().filter(is_placed).cloned().collect();
        let case = self.case_of(&file, base, &others)?;
        let path_of = |change: &Assignment| case.path_of_key(change.key());
        let placed = changes
            .iter()
            .map(|change| Ok(Assignment::new(&path_of(change)?, change.text())))
            .collect::<Result<Vec<_>, AssignmentError>>()?;
        Ok(self.case_of(&file, base, &placed)?)
    }

    /// Reads a case from `text`, called `name` in messages; paths in it are relative to `folder`.
    ///
    /// # Errors
    /// Every problem of the text.
    pub fn parse(&self, text: &str, name: &str, folder: &Path) -> Result<Case, Problems> {
        let source = Arc::new(NamedSource::new(name, text.to_owned()));
        let files = &self.files;
        self.case_of(&source, Base { files, folder }, &[])
    }

    fn source(&self, path: &Path) -> Result<Source, Problems> {
        read_source(self.files.as_ref(), path).map_err(Problems::unreadable)
    }

    fn case_of(
        &self,
        file: &Source,
        base: Base<'_>,
        changes: &[Assignment],
    ) -> Result<Case, Problems> {
        let lines = Lines::new(file, changes);
        let source = if changes.is_empty() {
            Arc::clone(file)
        } else {
            let set: Vec<String> = changes.iter().map(Assignment::line).collect();
            let name = format!("{} with {}", file.name(), set.join(", "));
            Arc::new(NamedSource::new(name, lines.shown.clone()))
        };
        read_part(&source, file.inner(), base, |document, log| {
            let items = Case::items_with(self.wear_laws);
            // Old names are replaced first: values that are set have the current ones.
            let mut notes = rename_keys(document);
            notes.extend(lines.leave_out_drives(document));
            notes.extend(lines.leave_out(document, &items));
            lines.apply(document);
            let root = Section::root(document);
            log.places = root.places();
            log.wear_laws = self.wear_laws;
            check(&root, &items, log);
            let mut case = <Case as Settings>::read(&root, log)?;
            case.origin.notes = notes;
            Some(case)
        })
    }
}

impl Case {
    /// Returns the case as a file that reads back as an equal case: every default written out, waveforms as points, files
    /// by their absolute paths.
    pub fn to_toml(&self) -> String {
        self.written(false)
    }
}

/// Returns the tables of bodies that fit a machine other than a knee simulator.
fn bodies_for(preset: Preset) -> &'static str {
    match preset {
        Preset::Iso142421Like | Preset::Iso142423Like | Preset::Iso142424Like => {
            "[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n[insert]\nshape = \"cup\"\n"
        }
        Preset::Iso181921LumbarLike | Preset::Iso181921CervicalLike => {
            "[femur]\nshape = \"sphere\"\nradius_mm = 13.0\n\
             [insert]\nshape = \"cup\"\nradius_mm = 13.1\nthickness_mm = 5.0\nopening_deg = 50.0\ninclination_deg = 0.0\n"
        }
        Preset::Iso22622Like => {
            "[femur]\nshape = \"cylinder\"\nradius_mm = 24.5\n[insert]\nshape = \"trough\"\n"
        }
        Preset::Iso22622DisplacementLike => {
            "[femur]\nshape = \"generic\"\ndistal_radius_mm = 24.0\nposterior_radius_mm = 24.0\n\
             coronal_radius_mm = 20.0\nspacing_mm = 18.0\n[insert]\nshape = \"generic\"\nsagittal_radius_mm = 28.0\n\
             coronal_radius_mm = 25.0\nspacing_mm = 18.0\nthickness_mm = 6.0\n"
        }
        Preset::PinOnDisc => "[femur]\nshape = \"plane\"\n[insert]\nshape = \"pin\"\n",
        _ => "",
    }
}

/// Returns a case to start from: every key with its default and its meaning.
pub fn template(preset: Preset) -> String {
    let bodies = bodies_for(preset);
    let text = format!("{bodies}[machine]\npreset = {:?}\n", preset.word());
    match CaseReader::new(MemoryFiles::default()).parse(&text, "template", Path::new("")) {
        Ok(case) => case.written(true),
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
    /// Reads the case file at `path` on the disk; paths in it are relative to its folder.
    ///
    /// # Errors
    /// As [`CaseReader::read`].
    pub fn read(path: &Path) -> Result<Self, Problems> {
        CaseReader::default().read(path)
    }

    /// Reads the case file at `path` with some of its values changed.
    ///
    /// # Errors
    /// As [`CaseReader::read_changed`].
    pub fn read_changed(path: &Path, changes: &[Assignment]) -> Result<Self, ChangeError> {
        CaseReader::default().read_changed(path, changes)
    }

    /// Reads a case from `text`, called `name` in messages; paths in it are relative to `folder`.
    ///
    /// # Errors
    /// As [`CaseReader::parse`].
    pub fn parse(text: &str, name: &str, folder: &Path) -> Result<Self, Problems> {
        CaseReader::default().parse(text, name, folder)
    }

    /// Returns the case as [`Self::to_toml`] for a file in the existing `folder`: its files by relative paths, so that it
    /// can be moved with them.
    pub fn to_toml_in(&self, folder: &Path) -> String {
        self.named_from(folder).to_toml()
    }

    /// Returns the same with waveforms by their names, as a case to be edited.
    pub(super) fn as_draft_in(&self, folder: &Path) -> String {
        self.named_from(folder).written(true)
    }

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
    /// Returns the hash of the case as run and of the content of its meshes, whatever their paths, in hexadecimal.
    ///
    /// # Errors
    /// A mesh can no longer be read.
    pub fn inputs_blake3(&self) -> io::Result<String> {
        let mut text = self.to_toml();
        let mut hasher = blake3::Hasher::new();
        for file in [self.femur.file(), self.insert.file()]
            .into_iter()
            .flatten()
        {
            // The number of blanks after a path depends on its length.
            let path = toml::Value::String(file.path().to_string_lossy().into_owned()).to_string();
            let (mut parts, mut rest) = (text.split(&path), String::new());
            rest += parts.next().unwrap_or_default();
            parts.for_each(|after| rest += &format!(" {}", after.trim_start_matches(' ')));
            text = rest;
            hasher.update(blake3::hash(&file.files().read(file.path())?).as_bytes());
        }
        hasher.update(text.as_bytes());
        Ok(hasher.finalize().to_hex().to_string())
    }
}
