//! A run beside others.

use std::path::Path;

use crate::error::ReportError;
use crate::results::{contents::Results, read::unworn_surface, surface::SurfaceFields};

/// A results folder that is held against others.
#[derive(Clone, Debug)]
pub struct Run {
    /// What it is called: the folder as it was given.
    pub name: String,
    /// What can be read of it.
    pub results: Results,
    /// Its surface before the first cycle, by which meshes are told apart.
    pub(super) unworn: Option<SurfaceFields>,
}

/// Nodes of one mesh are as far apart as this at most, mm: less than any mesh is made to.
const SAME_PLACE_MM: f64 = 1e-6;

impl Run {
    /// Reads what can be read of a folder; what cannot is in `results.left_out`.
    ///
    /// # Errors
    /// The folder is missing, or nothing in it can be read.
    pub fn read(folder: &Path) -> Result<Self, ReportError> {
        Ok(Self {
            name: folder.display().to_string(),
            results: Results::read_what_can_be(folder)?,
            // A damaged one is no ground to subtract maps on.
            unworn: unworn_surface(folder).unwrap_or(None),
        })
    }

    /// Why the maps of two runs cannot be subtracted; none where they can.
    pub(super) fn maps_apart(&self, other: &Self) -> Option<String> {
        if self.results.surface.is_none() || other.results.surface.is_none() {
            return Some("one of the runs has no last mesh".to_owned());
        }
        let (Some(one), Some(two)) = (&self.unworn, &other.unworn) else {
            return Some(
                "insert_0000.vtu, by which meshes are told apart, is missing or damaged".to_owned(),
            );
        };
        if one.quads != two.quads {
            let [here, there] = [one, two].map(|surface| surface.nodes.len());
            return Some(format!(
                "the inserts have other meshes ({here} and {there} nodes)"
            ));
        }
        let mut pairs = one.nodes.iter().zip(&two.nodes);
        let is_elsewhere = pairs.any(|(here, there)| (here - there).norm() > SAME_PLACE_MM);
        is_elsewhere.then(|| "the inserts are of another shape".to_owned())
    }
}
