//! A run that is compared with others.

use std::path::Path;

use crate::error::ReportError;
use crate::results::{Results, SurfaceFields, unworn_surface};

/// A results folder that is compared with others.
#[derive(Clone, Debug)]
pub struct Run {
    /// The name of the run: the folder as it was given.
    pub name: String,
    /// The readable part of the folder.
    pub results: Results,
    /// The surface before the first cycle, by which meshes are compared.
    unworn: Option<SurfaceFields>,
}

/// Distance up to which nodes of two meshes are the same, mm: far less than the length of any edge.
const SAME_PLACE_MM: f64 = 1e-6;

impl Run {
    /// Reads the readable part of a folder; `results.left_out` lists the rest.
    ///
    /// # Errors
    /// The folder is missing, or nothing in it can be read.
    pub fn read(folder: &Path) -> Result<Self, ReportError> {
        Ok(Self {
            name: folder.display().to_string(),
            results: Results::read_readable(folder)?,
            // With a damaged one, maps are not subtracted.
            unworn: unworn_surface(folder).unwrap_or(None),
        })
    }

    /// Returns the last surfaces of two runs, if their maps can be subtracted.
    pub(super) fn comparable_surfaces<'a>(
        &'a self,
        other: &'a Self,
    ) -> Option<(&'a SurfaceFields, &'a SurfaceFields)> {
        let surfaces = self
            .results
            .surface
            .as_ref()
            .zip(other.results.surface.as_ref());
        surfaces.filter(|_| self.maps_obstacle(other).is_none())
    }

    /// Returns the reason why the maps of two runs cannot be subtracted; none if they can.
    pub(super) fn maps_obstacle(&self, other: &Self) -> Option<String> {
        if self.results.surface.is_none() || other.results.surface.is_none() {
            return Some("one of the runs has no last mesh".to_owned());
        }
        let (Some(one), Some(two)) = (&self.unworn, &other.unworn) else {
            let file = "insert_0000.vtu, by which meshes are compared, is missing or damaged";
            return Some(file.to_owned());
        };
        if one.quads != two.quads {
            let [here, there] = [one, two].map(|surface| surface.nodes.len());
            return Some(format!(
                "the inserts have different meshes ({here} and {there} nodes)"
            ));
        }
        let mut pairs = one.nodes.iter().zip(&two.nodes);
        let is_elsewhere = pairs.any(|(here, there)| (here - there).norm() > SAME_PLACE_MM);
        is_elsewhere.then(|| "the inserts have different shapes".to_owned())
    }
}
