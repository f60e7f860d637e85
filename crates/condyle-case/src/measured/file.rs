//! The file that names measured data.

use std::path::Path;
use std::sync::Arc;

use super::gravimetric::{self, Gravimetric};
use super::kinematics::{self, Kinematics};
use super::reason::MeasuredReason;
use super::scan::{self, Scan};
use crate::case::Side;
use crate::config::{Base, Log, Problems, Section, read_document, read_source};
#[cfg(feature = "file-system")]
use condyle_mesh::files::Disk;
use condyle_mesh::files::Files;

/// What a laboratory measured; a part that the file does not name is `None`.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Motions and loads by percent of the cycle.
    pub kinematics: Option<Kinematics>,
    /// Masses of specimens and soak controls.
    pub gravimetric: Option<Gravimetric>,
    /// The worn surface.
    pub scan: Option<Scan>,
}

const TABLES: &[&str] = &["kinematics", "gravimetric", "surface"];

impl Measured {
    /// Reads the one of `files` at `path` for a `side` knee; paths in it count from its folder.
    ///
    /// # Errors
    /// Everything that is wrong with it and with the files it names, or that it names no data.
    pub fn read_from(files: &Arc<dyn Files>, path: &Path, side: Side) -> Result<Self, Problems> {
        let source = read_source(files.as_ref(), path).map_err(Problems::unreadable)?;
        let base = Base::of(files, path);
        read_document(&source, base, |root, log| read_tables(root, side, log))
    }
}

/// Reads every table before giving up on any, so that all problems are found at once.
fn read_tables(root: &Section<'_>, side: Side, log: &mut Log<'_>) -> Option<Measured> {
    root.check_keys(TABLES, log);
    let given = |name: &str| root.value(name).is_some();
    if !TABLES.iter().any(|name| given(name)) {
        log.problem(0..0, MeasuredReason::Nothing);
        return None;
    }
    let kinematics = given("kinematics").then(|| kinematics::read(root, log));
    let gravimetric = given("gravimetric").then(|| gravimetric::read(root, log));
    let scan = given("surface").then(|| scan::read(root, side, log));
    Some(Measured {
        kinematics: all_or_none(kinematics)?,
        gravimetric: all_or_none(gravimetric)?,
        scan: all_or_none(scan)?,
    })
}

/// A part that is given must have been read.
fn all_or_none<T>(part: Option<Option<T>>) -> Option<Option<T>> {
    match part {
        Some(None) => None,
        Some(Some(read)) => Some(Some(read)),
        None => Some(None),
    }
}

#[cfg(feature = "file-system")]
impl Measured {
    /// Reads the file at `path` for a `side` knee; paths in it count from its folder.
    ///
    /// # Errors
    /// As [`Self::read_from`].
    pub fn read(path: &Path, side: Side) -> Result<Self, Problems> {
        let disk: Arc<dyn Files> = Arc::new(Disk);
        Self::read_from(&disk, path, side)
    }
}
