//! Measured data to hold a run against: a TOML file in, checked and typed data out.
//!
//! The file names any of three: kinematics, gravimetric wear, and a scan of the worn surface. Its
//! problems are reported as those of a case are: all at once, each with a caret under its place.

mod declared;
mod gravimetric;
mod kinematics;
mod phases;
mod reason;
mod scan;
mod setting;

use std::path::Path;

use toml::de::DeTable;

use crate::case::parse::{Log, Others, Section};
use crate::case::problems::Source;
use crate::case::table::read_source;
use crate::case::{CaseError, Reason, Side};

pub use declared::{
    AlignWord, CycleWord, FitWord, GravimetricKeys, IntervalWord, KinematicsKeys, ScanKeys,
};
pub use gravimetric::{Gravimetric, Specimen};
pub use kinematics::{COLUMNS, Kinematics, MeasuredCurve, Sample};
pub use phases::Phase;
pub use reason::MeasuredReason;
pub use scan::Scan;
pub use setting::Names;

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
    /// Reads the file at `path` for a `side` knee; paths in it count from its folder.
    ///
    /// # Errors
    /// Everything that is wrong with it and with the files it names, or that it names no data.
    pub fn read(path: &Path, side: Side) -> Result<Self, CaseError> {
        let source = read_source(path).map_err(CaseError::unreadable)?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let (document, errors) = DeTable::parse_recoverable(source.inner());
        let mut log = Log::new(&source, folder);
        for error in &errors {
            let message = error.message().to_owned();
            log.problem(error.span().unwrap_or(0..0), Reason::Syntax { message });
        }
        let measured = match errors.is_empty() {
            true => read_tables(&Section::root(document.get_ref()), side, &mut log),
            false => None,
        };
        finished(measured, log, &source)
    }
}

fn finished(
    measured: Option<Measured>,
    log: Log<'_>,
    source: &Source,
) -> Result<Measured, CaseError> {
    let problems = log.into_problems();
    match measured {
        Some(measured) if problems.is_empty() => Ok(measured),
        Some(_) | None => Err(CaseError::new(problems, source)),
    }
}

/// Reads every table before giving up on any, so that all problems are found at once.
fn read_tables(root: &Section<'_>, side: Side, log: &mut Log<'_>) -> Option<Measured> {
    root.check_keys(TABLES, &Others::NONE, log);
    let given = |name: &str| root.value(name).is_some();
    if !TABLES.iter().any(|name| given(name)) {
        log.problem(0..0, MeasuredReason::Nothing.into());
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
