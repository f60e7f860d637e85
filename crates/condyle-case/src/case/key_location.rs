//! The key of a case at fault for a failed build, so that the message points to it.

use std::collections::BTreeMap;
use std::iter;
use std::ops::Range;

use condyle::evolve::PlacementError;
use condyle::machine::knee;

use super::build::{BuildError, BuildWarning, Finding};
use super::contents::Case;
use super::drive::DriveWord;
use super::run_options::Limits;
use crate::config::*;

/// A table of a case and those of its keys that may be at fault, the likeliest first.
type KeyLocation = (&'static str, &'static [&'static str]);

/// The keys that place the femur over the insert.
const START: KeyLocation = (
    "femur",
    &["start_mm", "length_unit", "axes", "file", "shape"],
);

/// Young's modulus, MPa, below which the material is a likelier cause of a deep overlap than the shapes.
const SOFT_MPA: f64 = 100.0;

impl Case {
    /// Returns a failed build as a problem at the key of this case at fault.
    pub fn at_its_key(&self, error: &BuildError) -> Problems {
        let table = error.table(self.femur.file().map(DataFile::path));
        let mut errors = Vec::new();
        // A mesh that cannot be used may be another body than its table says.
        if error.file().is_some() && error.keys == ["file"] {
            let misfits = self.misfits_at_their_keys();
            errors.extend(misfits.filter(|((of, _), _)| *of == table));
        }
        errors.push(((table, error.keys), error.to_string()));
        self.errors_at(&errors)
    }

    fn misfits_at_their_keys(&self) -> impl Iterator<Item = (KeyLocation, String)> {
        let misfits = self.misfits().into_iter();
        misfits.map(|misfit| ((misfit.body.table(), misfit.keys), misfit.text))
    }

    /// Returns a failed placement of this case's bodies as a problem at the key at fault, after axes that `warnings` find
    /// likely wrong, which may be the cause.
    pub fn placement_at_its_key(
        &self,
        error: &PlacementError,
        warnings: &[BuildWarning],
    ) -> Problems {
        let is_held = self.machine.rig.is_none()
            && self.machine.freedoms.get(knee::IS).drive == DriveWord::Locked;
        let location: KeyLocation = match error {
            PlacementError::DeepOverlap { .. } if is_held => {
                ("machine.freedoms.is", &["locked_at_mm", "drive"])
            }
            PlacementError::DeepOverlap { .. } if self.material.youngs_modulus_mpa < SOFT_MPA => {
                ("material", &["youngs_modulus_mpa"])
            }
            PlacementError::Unsteady { .. } => ("insert", &["edge_mm"]),
            PlacementError::TightLigament { .. } => ("machine.ligaments", &["slack_length_mm"]),
            PlacementError::SprungLoad { .. } => ("machine", &["joints", "file", "preset"]),
            _ => START,
        };
        let mut errors: Vec<(KeyLocation, String)> = Vec::new();
        for warning in warnings {
            if let Finding::WrongAxes(body) = warning.finding {
                errors.push(((body.table(), &["axes", "file"]), warning.to_string()));
            }
        }
        errors.extend(self.misfits_at_their_keys());
        errors.push((location, error.to_string()));
        self.errors_at(&errors)
    }

    /// Returns a run that needs more memory than the case allows as a problem at that limit, or else at the insert's mesh.
    pub fn memory_at_its_key(&self, message: String) -> Problems {
        let location: KeyLocation = match self.limits.memory_gb {
            Limits::DEFAULT_GB => ("insert", &["edge_mm", "layers", "file"]),
            _ => ("limits", &["memory_gb"]),
        };
        self.errors_at(&[(location, message)])
    }

    /// Returns a problem of a table of the case.
    pub fn problem_at(&self, table: &'static str, message: String) -> Problems {
        self.errors_at(&[((table, &[]), message)])
    }

    fn errors_at(&self, errors: &[(KeyLocation, String)]) -> Problems {
        let source = &self.origin.source;
        let problem = |(location, message): &(KeyLocation, String)| {
            let (key, span) = place(*location, &self.origin.places);
            Problem::at(source, (span, Fault::new(message, "")), key)
        };
        Problems::new(errors.iter().map(problem).collect(), source)
    }
}

/// Returns the path and place of the first key that is given, or else of its table, or of the nearest table around that.
fn place(
    (table, keys): KeyLocation,
    places: &BTreeMap<String, Range<usize>>,
) -> (Option<String>, Range<usize>) {
    let keys = keys.iter().map(|key| format!("{table}.{key}"));
    let tables = iter::successors(Some(table), |table| Some(table.rsplit_once('.')?.0));
    let mut names = keys.chain(tables.map(str::to_owned));
    let place = names.find_map(|name| Some((places.get(&name)?.clone(), name)));
    place.map_or((None, 0..0), |(place, name)| (Some(name), place))
}
