//! How far a run's numbers lie from what finer steps and meshes would give.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Where an error comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// Increments in the gait cycle.
    Increments,
    /// Updates of the geometry.
    Updates,
    /// Edge of the mesh.
    Mesh,
    /// Slip tolerance of the friction.
    SlipTolerance,
}

/// Estimated discretisation error of a number, %, by its parts: what a much finer value would
/// change it by; none where a part cannot be estimated.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorParts {
    /// From the increments in the gait cycle.
    pub increments: Option<f64>,
    /// From the updates of the geometry.
    pub updates: Option<f64>,
    /// From the edge of the mesh.
    pub mesh: Option<f64>,
    /// From the slip tolerance of the friction.
    pub slip_tolerance: Option<f64>,
    /// Root of the sum of squares of the parts there are, 0 or more.
    pub total: f64,
}

/// Estimated discretisation errors of a run.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ErrorEstimate {
    /// Of the mass loss, and so of the volume loss.
    pub mass_loss_percent: ErrorParts,
    /// Of the maximum depth.
    pub max_depth_percent: ErrorParts,
    /// Parts that could not be estimated, and why.
    pub not_estimated: BTreeMap<String, String>,
}

impl Part {
    /// Its name in the summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Increments => "increments",
            Self::Updates => "updates",
            Self::Mesh => "mesh",
            Self::SlipTolerance => "slip_tolerance",
        }
    }
}

impl ErrorParts {
    fn set(&mut self, part: Part, percent: Option<f64>) {
        match part {
            Part::Increments => self.increments = percent,
            Part::Updates => self.updates = percent,
            Part::Mesh => self.mesh = percent,
            Part::SlipTolerance => self.slip_tolerance = percent,
        }
        let parts = [
            self.increments,
            self.updates,
            self.mesh,
            self.slip_tolerance,
        ];
        let squares = parts.into_iter().flatten().map(|part| part * part);
        self.total = squares.sum::<f64>().sqrt();
    }
}

impl ErrorEstimate {
    /// Sets a part: % of mass loss and of maximum depth, or why there is none.
    pub fn set(&mut self, part: Part, found: Result<[f64; 2], String>) {
        let found = found.and_then(
            |percent| match percent.iter().all(|part| part.is_finite()) {
                true => Ok(percent),
                false => Err("nothing was worn".to_owned()),
            },
        );
        let [mass, depth] = found.as_ref().map_or([None; 2], |found| found.map(Some));
        self.mass_loss_percent.set(part, mass);
        self.max_depth_percent.set(part, depth);
        match found {
            Ok(_) => self.not_estimated.remove(part.name()),
            Err(why) => self.not_estimated.insert(part.name().to_owned(), why),
        };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_parts_add_in_quadrature_and_the_rest_says_why() {
        let mut estimate = ErrorEstimate::default();
        estimate.set(Part::Increments, Ok([-3.0, 0.5]));
        estimate.set(Part::SlipTolerance, Ok([4.0, 1.2]));
        estimate.set(Part::Mesh, Err("there is no coarser mesh".to_owned()));
        estimate.set(Part::Updates, Ok([0.0, f64::NAN]));
        assert_eq!(estimate.mass_loss_percent.total, 5.0);
        assert_eq!(estimate.max_depth_percent.total, 1.3);
        assert_eq!(estimate.mass_loss_percent.mesh, None);
        assert_eq!(estimate.not_estimated["mesh"], "there is no coarser mesh");
        assert_eq!(estimate.not_estimated["updates"], "nothing was worn");
    }
}
