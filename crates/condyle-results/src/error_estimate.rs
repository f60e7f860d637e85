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

/// A number of a run whose discretisation error is estimated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Mass loss, and so volume loss.
    MassLoss,
    /// Maximum depth.
    MaxDepth,
    /// Highest pressure, in the cycle that has it.
    PeakPressure,
    /// Largest contact area, in the cycle that has it.
    PeakContactArea,
    /// AP range of the first cycle.
    ApRange,
    /// IE range of the first cycle.
    IeRange,
}

/// Of each of [`Quantity::ALL`] in that order: an error in %, or why there is none.
pub type QuantityErrors = [Result<f64, String>; Quantity::ALL.len()];

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
    /// Of the highest pressure, in the cycle that has it, %.
    #[serde(default)]
    pub peak_pressure_percent: ErrorParts,
    /// The same, MPa.
    #[serde(default)]
    pub peak_pressure_mpa: ErrorParts,
    /// Of the largest contact area, in the cycle that has it, %.
    #[serde(default)]
    pub peak_contact_area_percent: ErrorParts,
    /// The same, mm2.
    #[serde(default)]
    pub peak_contact_area_mm2: ErrorParts,
    /// Of the AP range of the first cycle, %.
    #[serde(default)]
    pub ap_range_percent: ErrorParts,
    /// The same, mm.
    #[serde(default)]
    pub ap_range_mm: ErrorParts,
    /// Of the IE range of the first cycle, %.
    #[serde(default)]
    pub ie_range_percent: ErrorParts,
    /// The same, degrees.
    #[serde(default)]
    pub ie_range_deg: ErrorParts,
    /// Parts that could not be estimated, and why; `mesh_of_ap_range` where that of one number alone could not.
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

impl Quantity {
    /// All of them.
    pub const ALL: [Self; 6] = [
        Self::MassLoss,
        Self::MaxDepth,
        Self::PeakPressure,
        Self::PeakContactArea,
        Self::ApRange,
        Self::IeRange,
    ];

    /// Its name in the summary, without a unit.
    pub fn name(self) -> &'static str {
        match self {
            Self::MassLoss => "mass_loss",
            Self::MaxDepth => "max_depth",
            Self::PeakPressure => "peak_pressure",
            Self::PeakContactArea => "peak_contact_area",
            Self::ApRange => "ap_range",
            Self::IeRange => "ie_range",
        }
    }
}

impl ErrorEstimate {
    /// Of the numbers `values`, in the order of [`Quantity::ALL`]: of each part % of every one, or why there is
    /// none.
    pub fn of(
        values: [f64; Quantity::ALL.len()],
        parts: impl IntoIterator<Item = (Part, QuantityErrors)>,
    ) -> Self {
        let mut estimate = Self::default();
        for (part, errors) in parts {
            let numbers = Quantity::ALL.into_iter().zip(values);
            for ((quantity, value), error) in numbers.zip(errors) {
                let error = error.and_then(finite);
                let percent = error.as_ref().ok().copied();
                let [in_percent, in_unit] = estimate.tables(quantity);
                in_percent.set(part, percent);
                in_unit.set(part, percent.map(|percent| percent / 100.0 * value));
                if let Err(why) = error {
                    estimate.leave_out(part, quantity, why);
                }
            }
        }
        estimate
    }

    /// What is stated of a number: % of it, and in its unit.
    fn tables(&mut self, quantity: Quantity) -> [&mut ErrorParts; 2] {
        match quantity {
            Quantity::MassLoss => [&mut self.mass_loss_percent, &mut self.mass_loss_mg],
            Quantity::MaxDepth => [&mut self.max_depth_percent, &mut self.max_depth_mm],
            Quantity::PeakPressure => {
                [&mut self.peak_pressure_percent, &mut self.peak_pressure_mpa]
            }
            Quantity::PeakContactArea => [
                &mut self.peak_contact_area_percent,
                &mut self.peak_contact_area_mm2,
            ],
            Quantity::ApRange => [&mut self.ap_range_percent, &mut self.ap_range_mm],
            Quantity::IeRange => [&mut self.ie_range_percent, &mut self.ie_range_deg],
        }
    }

    /// Says why a part of a number's error has no estimate; once, where that is so of the mass loss too.
    fn leave_out(&mut self, part: Part, quantity: Quantity, why: String) {
        if self.not_estimated.get(part.name()) == Some(&why) {
            return;
        }
        let name = match quantity {
            Quantity::MassLoss => part.name().to_owned(),
            other => format!("{}_of_{}", part.name(), other.name()),
        };
        self.not_estimated.insert(name, why);
    }
}

fn finite(percent: f64) -> Result<f64, String> {
    if percent.is_finite() {
        Ok(percent)
    } else {
        Err("nothing was worn".to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Errors of mass and depth, with none of the other numbers.
    fn of_wear(percent: [f64; 2]) -> QuantityErrors {
        let [mass, depth] = percent;
        [mass, depth, 0.0, 0.0, 0.0, 0.0].map(Ok)
    }

    #[test]
    fn verify_parts_add_in_quadrature_and_the_rest_says_why() {
        let no_mesh = || Err("there is no coarser mesh".to_owned());
        let parts = [
            (Part::Increments, of_wear([-3.0, 0.5])),
            (Part::SlipTolerance, of_wear([4.0, 1.2])),
            (Part::Mesh, std::array::from_fn(|_| no_mesh())),
            (Part::Updates, of_wear([f64::NAN, 0.0])),
        ];
        let estimate = ErrorEstimate::of([200.0, 0.1, 20.0, 300.0, 5.0, 8.0], parts);
        assert_eq!(estimate.mass_loss_percent.total, 5.0);
        assert_eq!(estimate.max_depth_percent.total, 1.3);
        assert_eq!(estimate.mass_loss_mg.increments, Some(-6.0));
        assert_eq!(estimate.mass_loss_mg.total, 10.0);
        let of_depth = estimate.max_depth_mm.slip_tolerance;
        assert!((of_depth.expect("it is estimated") - 0.0012).abs() < 1e-12);
        assert_eq!(estimate.mass_loss_percent.mesh, None);
        assert_eq!(estimate.not_estimated["mesh"], "there is no coarser mesh");
        assert_eq!(estimate.not_estimated["updates"], "nothing was worn");
        assert_eq!(estimate.not_estimated.len(), 2);
    }

    #[test]
    fn what_is_unknown_of_one_number_alone_is_said_of_that() {
        let mut errors = of_wear([1.0, 1.0]);
        errors[3] = Err("it is apart".to_owned());
        let estimate = ErrorEstimate::of([1.0; 6], [(Part::Updates, errors)]);
        assert_eq!(estimate.peak_contact_area_percent.updates, None);
        assert_eq!(estimate.ap_range_mm.updates, Some(0.0));
        let said: Vec<_> = estimate.not_estimated.keys().collect();
        assert_eq!(said, ["updates_of_peak_contact_area"]);
    }
}
