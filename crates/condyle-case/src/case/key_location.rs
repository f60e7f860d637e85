//! The key of a case that is behind a failed build, so that the message points to it.

use std::collections::BTreeMap;
use std::iter;
use std::ops::Range;

use condyle::evolve::PlacementError;
use condyle::geometry::InsertError;
use condyle::machine::knee;
use condyle_mesh::columns::ColumnError;
use thiserror::Error;

use super::build::{Body, BuildError, BuildWarning};
use super::contents::Case;
use super::machine::DriveWord;
use super::run_options::Limits;
use crate::config::{DataFile, Problem, Problems, Reason};

/// Values that are good one by one and make no wear test together.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{message}")]
pub struct CaseConflict {
    /// Why, and what to do.
    pub message: String,
}

impl Reason for CaseConflict {
    fn advice(&self) -> Option<String> {
        None
    }
}

/// A table of a case and those of its keys that may be at fault, likeliest first.
struct KeyLocation {
    table: &'static str,
    keys: &'static [&'static str],
}

/// What places the femur over the insert.
const START: KeyLocation = KeyLocation {
    table: "femur",
    keys: &["start_mm", "length_unit", "axes", "file", "shape"],
};

const FINENESS: KeyLocation = KeyLocation {
    table: "insert",
    keys: &["edge_mm"],
};

/// A material softer than this, MPa, is likelier at fault for a deep overlap than the shapes.
const SOFT_MPA: f64 = 100.0;

impl Case {
    /// A failed build, at the key of this case that is behind it.
    pub fn at_its_key(&self, error: &BuildError) -> Problems {
        self.errors_at(&[(self.location_of_build(error), error.to_string())])
    }

    /// A failed placement of this case's bodies, at the key that is behind it, after axes that `warnings` say are
    /// likely wrong, which may be why.
    pub fn placement_at_its_key(
        &self,
        error: &PlacementError,
        warnings: &[BuildWarning],
    ) -> Problems {
        let location = match error {
            PlacementError::DeepOverlap { .. } => self.location_of_overlap(),
            PlacementError::Unsteady { .. } => FINENESS,
            _ => START,
        };
        let mut errors = Vec::new();
        for warning in warnings {
            if let BuildWarning::WrongAxes { wrong, .. } = warning {
                errors.push((axes_of(wrong.body), warning.to_string()));
            }
        }
        errors.push((location, error.to_string()));
        self.errors_at(&errors)
    }

    /// A run of this case that needs more memory than it allows, at the key that allows it or else at the insert's mesh.
    pub fn memory_at_its_key(&self, message: String) -> Problems {
        let limits = KeyLocation {
            table: "limits",
            keys: &["memory_gb"],
        };
        let insert = KeyLocation {
            table: "insert",
            keys: &["edge_mm", "layers", "file"],
        };
        let is_given = self.limits.memory_gb != Limits::DEFAULT_GB;
        self.errors_at(&[(if is_given { limits } else { insert }, message)])
    }

    fn location_of_build(&self, error: &BuildError) -> KeyLocation {
        let keys: &[&str] = match error {
            BuildError::RestingBeside { .. } | BuildError::BacksideNotFlat { .. } => {
                return KeyLocation {
                    table: "contact",
                    keys: &["backside"],
                };
            }
            BuildError::StickSlipExplicit | BuildError::RestingExplicit => {
                return KeyLocation {
                    table: "time",
                    keys: &["integrator"],
                };
            }
            BuildError::MeshFile(_)
            | BuildError::StrayPiece { .. }
            | BuildError::Shell { .. }
            | BuildError::PressedHole { .. } => &["file"],
            BuildError::Size { .. }
            | BuildError::WrongUnit { .. }
            | BuildError::TooManyNodes { .. } => &["length_unit", "file"],
            BuildError::ShellInsert { source, .. } => match source {
                InsertError::TooManyNodes(_)
                | InsertError::Columns(
                    ColumnError::NoColumns { .. }
                    | ColumnError::TooCoarse { .. }
                    | ColumnError::TooManyNodes(_),
                ) => &["edge_mm", "file"],
                _ => &["file"],
            },
            BuildError::InsertTooFine { .. } => &["edge_mm", "layers", "file", "length_unit"],
            BuildError::ClipMisses { .. } => &["clip_below_mm"],
            BuildError::UnclearUnderside { .. } => &["clip_below_mm", "file"],
            BuildError::ThicknessOfClosed { .. } => &["thickness_mm"],
            BuildError::NoSurface { key, .. } => match *key {
                "backside" => &["backside"],
                _ => &["articulating_surface"],
            },
            BuildError::Insert(InsertError::TooManyNodes(_)) => &["edge_mm", "layers"],
            BuildError::Insert(_) | BuildError::Solid(_) => {
                &["backside", "articulating_surface", "file", "edge_mm"]
            }
            BuildError::Axes(_) => &["axes"],
            BuildError::WrongAxes { .. } => &["axes", "file"],
        };
        let file = error.file();
        let is_of_femur = file.is_some() && file == self.femur.file().map(DataFile::path);
        let table = if is_of_femur { "femur" } else { "insert" };
        KeyLocation { table, keys }
    }

    fn location_of_overlap(&self) -> KeyLocation {
        if self.machine.freedoms.get(knee::IS).drive() == DriveWord::Locked {
            KeyLocation {
                table: "machine.freedoms.is",
                keys: &["locked_at_mm", "drive"],
            }
        } else if self.material.youngs_modulus_mpa < SOFT_MPA {
            KeyLocation {
                table: "material",
                keys: &["youngs_modulus_mpa"],
            }
        } else {
            START
        }
    }

    fn errors_at(&self, errors: &[(KeyLocation, String)]) -> Problems {
        let source = &self.origin.source;
        let problem = |(location, message): &(KeyLocation, String)| {
            let message = message.clone();
            Problem::at(
                source,
                location.span(&self.origin.places),
                CaseConflict { message },
            )
        };
        Problems::new(errors.iter().map(problem).collect(), source)
    }
}

impl KeyLocation {
    /// The value of its first key that is given, or else the name of its table, or of the nearest table around that.
    fn span(&self, places: &BTreeMap<String, Range<usize>>) -> Range<usize> {
        let keys = self.keys.iter().map(|key| format!("{}.{key}", self.table));
        let tables = iter::successors(Some(self.table), |table| Some(table.rsplit_once('.')?.0));
        let mut names = keys.chain(tables.map(str::to_owned));
        let place = names.find_map(|name| places.get(&name).cloned());
        place.unwrap_or_default()
    }
}

/// The axes of a body.
fn axes_of(body: Body) -> KeyLocation {
    let table = match body {
        Body::Femur => "femur",
        Body::Insert => "insert",
    };
    let keys = &["axes", "file"];
    KeyLocation { table, keys }
}
