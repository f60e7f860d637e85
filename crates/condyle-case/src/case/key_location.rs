//! The key of a case at fault for a failed build, so that the message points to it.

use std::collections::BTreeMap;
use std::iter;
use std::ops::Range;

use condyle::evolve::PlacementError;
use condyle::machine::knee;

use super::build::{BuildError, BuildWarning, Finding};
use super::contents::Case;
use super::machine::DriveWord;
use super::run_options::Limits;
use crate::config::*;

/// A table of a case and those of its keys that may be at fault, the likeliest first.
struct KeyLocation {
    table: &'static str,
    keys: &'static [&'static str],
}

/// The keys that place the femur over the insert.
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
    /// Returns a failed build as a problem at the key of this case at fault.
    pub fn at_its_key(&self, error: &BuildError) -> Problems {
        let table = error.table(self.femur.file().map(DataFile::path));
        let keys = error.keys;
        self.errors_at(&[(KeyLocation { table, keys }, error.to_string())])
    }

    /// Returns a failed placement of this case's bodies as a problem at the key at fault, after axes that `warnings` find
    /// likely wrong, which may be the cause.
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
            if let Finding::WrongAxes(body) = warning.finding {
                let (table, keys) = (body.table(), &["axes", "file"]);
                errors.push((KeyLocation { table, keys }, warning.to_string()));
            }
        }
        errors.push((location, error.to_string()));
        self.errors_at(&errors)
    }

    /// Returns a run that needs more memory than the case allows as a problem at that limit, or else at the insert's mesh.
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

    fn location_of_overlap(&self) -> KeyLocation {
        if self.machine.freedoms.get(knee::IS).drive == DriveWord::Locked {
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
            let (key, span) = location.place(&self.origin.places);
            Problem::at(source, (span, Fault::new(message, "")), key)
        };
        Problems::new(errors.iter().map(problem).collect(), source)
    }
}

impl KeyLocation {
    /// Returns the path and place of its first key that is given, or else of its table, or of the nearest table around that.
    fn place(&self, places: &BTreeMap<String, Range<usize>>) -> (Option<String>, Range<usize>) {
        let keys = self.keys.iter().map(|key| format!("{}.{key}", self.table));
        let tables = iter::successors(Some(self.table), |table| Some(table.rsplit_once('.')?.0));
        let mut names = keys.chain(tables.map(str::to_owned));
        let place = names.find_map(|name| Some((places.get(&name)?.clone(), name)));
        place.map_or((None, 0..0), |(place, name)| (Some(name), place))
    }
}
