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

/// Estimated discretisation error of a number by its parts: what a much finer value would change
/// it by; none where a part cannot be estimated.
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
    /// Of the mass loss, and so of the volume loss, %.
    pub mass_loss_percent: ErrorParts,
    /// The same, mg.
    pub mass_loss_mg: ErrorParts,
    /// Of the maximum depth, %.
    pub max_depth_percent: ErrorParts,
    /// The same, mm.
    pub max_depth_mm: ErrorParts,
    /// Parts that could not be estimated, and why.
    pub not_estimated: BTreeMap<String, String>,
    /// Seconds that the estimate took, which are not among those of the solver.
    pub wall_s: f64,
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
    /// Of a mass loss, mg, and a maximum depth, mm: of each part % of both, or why there is none.
    pub fn of(
        mass_loss_mg: f64,
        max_depth_mm: f64,
        parts: impl IntoIterator<Item = (Part, Result<[f64; 2], String>)>,
    ) -> Self {
        let mut estimate = Self::default();
        for (part, found) in parts {
            let found = found.and_then(finite);
            let [mass, depth] = found.as_ref().map_or([None; 2], |found| found.map(Some));
            let share = |percent: Option<f64>, of: f64| percent.map(|percent| percent / 100.0 * of);
            estimate.mass_loss_percent.set(part, mass);
            estimate.mass_loss_mg.set(part, share(mass, mass_loss_mg));
            estimate.max_depth_percent.set(part, depth);
            estimate.max_depth_mm.set(part, share(depth, max_depth_mm));
            if let Err(why) = found {
                estimate.not_estimated.insert(part.name().to_owned(), why);
            }
        }
        estimate
    }
}

fn finite(percent: [f64; 2]) -> Result<[f64; 2], String> {
    if percent.iter().all(|part| part.is_finite()) {
        Ok(percent)
    } else {
        Err("nothing was worn".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_parts_add_in_quadrature_and_the_rest_says_why() {
        let parts = [
            (Part::Increments, Ok([-3.0, 0.5])),
            (Part::SlipTolerance, Ok([4.0, 1.2])),
            (Part::Mesh, Err("there is no coarser mesh".to_owned())),
            (Part::Updates, Ok([0.0, f64::NAN])),
        ];
        let estimate = ErrorEstimate::of(200.0, 0.1, parts);
        assert_eq!(estimate.mass_loss_percent.total, 5.0);
        assert_eq!(estimate.max_depth_percent.total, 1.3);
        assert_eq!(estimate.mass_loss_mg.increments, Some(-6.0));
        assert_eq!(estimate.mass_loss_mg.total, 10.0);
        let of_depth = estimate.max_depth_mm.slip_tolerance;
        assert!((of_depth.expect("it is estimated") - 0.0012).abs() < 1e-12);
        assert_eq!(estimate.mass_loss_percent.mesh, None);
        assert_eq!(estimate.not_estimated["mesh"], "there is no coarser mesh");
        assert_eq!(estimate.not_estimated["updates"], "nothing was worn");
    }
}
