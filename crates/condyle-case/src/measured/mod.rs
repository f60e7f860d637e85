//! Measured data that a run is compared with: a TOML file in, checked and typed data out.
//!
//! The file names any of three: kinematics, gravimetric wear, and a scan of the worn surface. Its
//! problems are reported as those of a case are: all at once, each with a caret under its place.

mod columns;
mod gravimetric;
mod kinematics;
mod scan;

pub use crate::config::Names;
pub use gravimetric::{Gravimetric, GravimetricKeys, IntervalWord, Specimen};
pub use kinematics::{
    AlignWord, CycleWord, Kinematics, KinematicsKeys, MeasuredCurve, Phase, Sample,
};
pub use scan::{FitWord, Scan, ScanKeys};

use std::path::Path;
use std::sync::Arc;

use crate::case::Side;
use crate::config::*;
#[cfg(feature = "file-system")]
use condyle_mesh::files::Disk;
use condyle_mesh::files::Files;

/// Measurements of a laboratory; a part that the file does not name is `None`.
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
    /// Reads the file at `path` among `files` for a `side` knee; paths in it are relative to its folder.
    ///
    /// # Errors
    /// Every problem of it and of the files it names, or that it names no data.
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
        let advice = "add one of [kinematics], [gravimetric] and [surface], each with `file = `";
        return log.reject(0..0, Fault::new("the file names no measured data", advice));
    }
    let kinematics = given("kinematics").then(|| Kinematics::read(root, log));
    let gravimetric = given("gravimetric").then(|| Gravimetric::read(root, log));
    let scan = given("surface").then(|| Scan::read(root, side, log));
    Some(Measured {
        kinematics: all_or_none(kinematics)?,
        gravimetric: all_or_none(gravimetric)?,
        scan: all_or_none(scan)?,
    })
}

/// Returns `None` for a part that is given and could not be read.
fn all_or_none<T>(part: Option<Option<T>>) -> Option<Option<T>> {
    part.map_or(Some(None), |read| read.map(Some))
}

#[cfg(feature = "file-system")]
impl Measured {
    /// Reads the file at `path` on the disk for a `side` knee; paths in it are relative to its folder.
    ///
    /// # Errors
    /// As [`Self::read_from`].
    pub fn read(path: &Path, side: Side) -> Result<Self, Problems> {
        let disk: Arc<dyn Files> = Arc::new(Disk);
        Self::read_from(&disk, path, side)
    }
}
