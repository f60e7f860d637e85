//! The file that names measured data: its keys, and the reader.

use std::path::Path;
use std::sync::Arc;

use super::gravimetric::{self, Gravimetric};
use super::kinematics::{self, Kinematics};
use super::reason::MeasuredReason;
use super::scan::{self, Scan};
use crate::case::{Axes, LengthUnit, Side};
use crate::config::{
    Base, DataFile, Log, Names, Problems, Section, choice, read_document, read_source, settings,
    within,
};
use crate::files::{Disk, Files};

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

choice! {
    /// Which cycle of the run a measured one is held against.
    CycleWord {
        /// The first: the insert is unworn.
        First = "first",
        /// The last: the insert is worn.
        Last = "last",
    }

    /// What is done to two curves before they are compared.
    AlignWord {
        /// Nothing.
        None = "none",
        /// The mean difference is taken out of the measured curve.
        Mean = "mean",
    }

    /// What a confidence interval of a wear rate counts as independent.
    IntervalWord {
        /// Every weighing: that of one line through all of them.
        Weighings = "weighings",
        /// Every specimen: that of the mean of their rates.
        Specimens = "specimens",
    }

    /// Which part of a scan is laid onto the prediction.
    FitWord {
        /// Where the prediction is not worn.
        Unworn = "unworn",
        /// Everywhere.
        All = "all",
        /// Within `fit_x_mm` and `fit_z_mm`.
        Region = "region",
    }
}

settings! {
    /// Measured motions and loads, and how they are compared.
    KinematicsKeys {
        /// CSV file; `percent` of the cycle, then columns named as in kinematics.csv.
        file: DataFile;
        /// Which cycle of the run.
        cycle: CycleWord = CycleWord::First;
        /// Whether the mean difference is taken out before the errors are found.
        align: AlignWord = AlignWord::None;
        /// Between measured points farther apart than this, in percent of the cycle, nothing is compared.
        largest_gap_percent: f64 = 10.0, in within(0.1, 100.0);
    }

    /// Measured masses, and how a wear rate is found from them.
    GravimetricKeys {
        /// CSV file; `cycles`, then the mass of each specimen and soak control, each name ending in _mg.
        file: DataFile;
        /// Columns of the soak controls; those whose name starts with "soak" if not given.
        soak_controls: Option<Names> = None;
        /// Confidence of the intervals.
        confidence_percent: f64 = 95.0, in within(50.0, 99.99);
        /// Weighings before this many cycles stay out of the line: running in.
        fit_from_cycles: f64 = 0.0, in within(0.0, 1e10);
        /// What the interval that calibration uses counts as independent.
        interval: IntervalWord = IntervalWord::Weighings;
    }

    /// A scan of a worn insert, and how it is laid onto the prediction.
    ScanKeys {
        /// STL, PLY, OBJ or VTP surface, or points as CSV with the columns x_mm,y_mm,z_mm.
        file: DataFile;
        /// Unit of length of a surface file; a CSV says its own.
        length_unit: LengthUnit = LengthUnit::Millimetre;
        /// Where x, y and z of the file point.
        axes: Axes = Axes::ISB;
        /// Added to every point, in the frame of the results, before the registration starts.
        start_mm: [f64; 3] = [0.0; 3], in within(-1000.0, 1000.0);
        /// Which part is laid onto the prediction.
        fit: FitWord = FitWord::Unworn;
        /// Predicted depth up to which a place counts as unworn.
        unworn_depth_mm: f64 = 0.005, in within(0.0, 10.0);
        /// Range of x, in the frame of the results, with `fit = "region"`.
        fit_x_mm: Option<[f64; 2]> = None, in within(-1000.0, 1000.0);
        /// Range of z, in the frame of the results, with `fit = "region"`.
        fit_z_mm: Option<[f64; 2]> = None, in within(-1000.0, 1000.0);
        /// Points of the scan farther than this from the registered surface are left out.
        farthest_mm: f64 = 2.0, in within(0.01, 50.0);
    }
}
