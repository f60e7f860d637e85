//! What cases are read with.

use std::path::Path;
use std::sync::Arc;

use condyle::wear::WEAR_LAWS;
use miette::NamedSource;

use super::contents::Case;
use super::overriding::Override;
use super::read::read_case;
use super::wear::WearLaws;
use crate::keyed::{Problems, Source, read_document, read_source};

/// Reads cases.
#[derive(Clone, Debug)]
pub struct CaseReader {
    wear_laws: WearLaws,
}

impl Default for CaseReader {
    fn default() -> Self {
        let wear_laws = WEAR_LAWS;
        Self { wear_laws }
    }
}

impl CaseReader {
    /// The same with other wear laws to choose from.
    pub fn with_wear_laws(self, wear_laws: WearLaws) -> Self {
        Self { wear_laws }
    }

    /// Reads the case file at `path`; paths in it count from its folder.
    ///
    /// # Errors
    /// Everything that is wrong with it, or that it cannot be read.
    pub fn read(&self, path: &Path) -> Result<Case, Problems> {
        let source = read_source(path).map_err(Problems::unreadable)?;
        self.read_source(&source, folder_of(path))
    }

    /// Reads the case file at `path` with one number changed. Messages show the changed text, and
    /// say so in its name.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_with(&self, path: &Path, number: &Override) -> Result<Case, Problems> {
        let file = read_source(path).map_err(Problems::unreadable)?;
        let name = format!("{} with {} = {}", file.name(), number.path(), number.text());
        self.parse(&number.applied_to(file.inner()), &name, folder_of(path))
    }

    /// Reads a case from `text`, called `name` in messages; paths count from `folder`.
    ///
    /// # Errors
    /// Everything that is wrong with it.
    pub fn parse(&self, text: &str, name: &str, folder: &Path) -> Result<Case, Problems> {
        let source = Arc::new(NamedSource::new(name, text.to_owned()));
        self.read_source(&source, folder)
    }

    fn read_source(&self, source: &Source, folder: &Path) -> Result<Case, Problems> {
        read_document(source, folder, |root, log| {
            read_case(root, self.wear_laws, log)
        })
    }
}

/// The folder that paths in a file count from.
fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}

impl Case {
    /// Reads the case file at `path`; paths in it count from its folder.
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

    /// Reads a case from `text`, called `name` in messages; paths count from `folder`.
    ///
    /// # Errors
    /// As [`CaseReader::parse`].
    pub fn parse(text: &str, name: &str, folder: &Path) -> Result<Self, Problems> {
        CaseReader::default().parse(text, name, folder)
    }
}
