//! Estimated discretisation errors of a run: the differences from finer steps and meshes.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

use super::catalogue::{self, ErrorMethod, MASS_LOSS_MG, Scalar};

/// The source of an error.
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

/// Ratio of a stated error to the root of the sum of squares of its parts.
///
/// Two values of a setting give no order of convergence, so that Roache's grid convergence index takes a factor as well
/// [roache1994]. In forty varied cases, finer runs are within the root alone in 83 % of all numbers, and within twice the
/// root in 96 % (`scripts/evidence stated-errors`).
const SAFETY_FACTOR: f64 = 2.0;

/// For each estimated number, the error in %, or the reason why it is missing.
pub type QuantityErrors = Vec<(&'static Scalar, Result<f64, String>)>;

/// Estimated discretisation error of a number by its parts: the change that a much finer value would make; none if a
/// part cannot be estimated.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ErrorParts {
    /// From the increments in the gait cycle.
    pub increments: Option<f64>,
    /// From the updates of the geometry.
    pub updates: Option<f64>,
    /// From the edge of the mesh.
    pub mesh: Option<f64>,
    /// From the slip tolerance of the friction.
    pub slip_tolerance: Option<f64>,
    /// Bound of the error: twice the root of the sum of squares of the parts that are estimated.
    pub total: f64,
}

/// Estimated discretisation error of one number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuantityError<'a> {
    /// The number.
    pub scalar: &'static Scalar,
    /// In % of the number.
    pub percent: &'a ErrorParts,
    /// In its unit.
    pub in_unit: &'a ErrorParts,
}

/// Estimated discretisation errors of a run; the error of the mass loss is that of the volume loss too.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct ErrorEstimate {
    /// For every number its error in %, such as `mass_loss_percent`, and in its unit, such as `mass_loss_mg`.
    #[serde(flatten)]
    errors: BTreeMap<String, ErrorParts>,
    /// Reasons why parts could not be estimated; `mesh_of_ap_range` where that of one number alone could not.
    pub not_estimated: BTreeMap<String, String>,
    /// Time of the estimate, s, in addition to that of the solver.
    pub wall_s: f64,
}

impl Part {
    /// Returns the name in files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Increments => "increments",
            Self::Updates => "updates",
            Self::Mesh => "mesh",
            Self::SlipTolerance => "slip_tolerance",
        }
    }
}

impl ErrorParts {
    fn set(&mut self, part: Part, error: Option<f64>) {
        match part {
            Part::Increments => self.increments = error,
            Part::Updates => self.updates = error,
            Part::Mesh => self.mesh = error,
            Part::SlipTolerance => self.slip_tolerance = error,
        }
        // The parts have different causes and are taken as independent: their squares add.
        let parts = self.parts().into_iter().filter_map(|(_, part)| part);
        self.total = SAFETY_FACTOR * parts.map(|part| part * part).sum::<f64>().sqrt();
    }

    /// Each part with its error; none if it could not be estimated.
    pub fn parts(&self) -> [(Part, Option<f64>); 4] {
        [
            (Part::Increments, self.increments),
            (Part::Updates, self.updates),
            (Part::Mesh, self.mesh),
            (Part::SlipTolerance, self.slip_tolerance),
        ]
    }
}

impl ErrorEstimate {
    /// Creates an estimate from the errors of numbers by their parts; `value_of` returns the value of each number.
    pub fn new(
        value_of: impl Fn(&Scalar) -> f64,
        parts: impl IntoIterator<Item = (Part, QuantityErrors)>,
    ) -> Self {
        let mut estimate = Self::default();
        for (part, errors) in parts {
            for (scalar, error) in errors {
                let error = error.and_then(|percent| match percent.is_finite() {
                    true => Ok(percent),
                    false => Err("nothing was worn".to_owned()),
                });
                let percent = error.as_ref().ok().copied();
                let in_unit = percent.map(|percent| percent / 100.0 * value_of(scalar));
                // Both are stored: readers of the file need no value of the number.
                for (key, error) in [
                    (percent_key(scalar), percent),
                    (scalar.key.to_owned(), in_unit),
                ] {
                    estimate.errors.entry(key).or_default().set(part, error);
                }
                // A reason that the mass loss has too is stored once, for all numbers.
                if let Err(why) = error
                    && estimate.not_estimated.get(part.name()) != Some(&why)
                {
                    let name = match *scalar == MASS_LOSS_MG {
                        true => part.name().to_owned(),
                        false => format!("{}_of_{}", part.name(), scalar.stem()),
                    };
                    estimate.not_estimated.insert(name, why);
                }
            }
        }
        estimate
    }

    /// Returns the errors of all numbers that were estimated, in the order of the catalogue.
    pub fn quantities(&self) -> impl Iterator<Item = QuantityError<'_>> {
        estimated().filter_map(|scalar| self.get(scalar))
    }

    /// Returns the error of a number; none if it was not estimated.
    pub fn get(&self, scalar: &Scalar) -> Option<QuantityError<'_>> {
        // The relative error of another number may have the key of this one.
        if scalar.error != ErrorMethod::Estimated {
            return None;
        }
        Some(QuantityError {
            scalar: catalogue::scalar(scalar.key)?,
            percent: self.errors.get(&percent_key(scalar))?,
            in_unit: self.errors.get(scalar.key)?,
        })
    }

    /// Returns the error of a number that every estimate has.
    ///
    /// # Panics
    /// The error of the number was not estimated.
    pub fn of(&self, scalar: &Scalar) -> QuantityError<'_> {
        self.get(scalar)
            .expect("the error of the number is estimated")
    }
}

fn percent_key(scalar: &Scalar) -> String {
    format!("{}_percent", scalar.stem())
}

fn estimated() -> impl Iterator<Item = &'static Scalar> {
    catalogue::scalars().filter(|scalar| scalar.error == ErrorMethod::Estimated)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue::{AP_RANGE_MM, MAX_DEPTH_MM, PEAK_CONTACT_AREA_MM2};

    /// Errors of mass and depth, with none of the other numbers.
    fn of_wear(percent: [f64; 2]) -> QuantityErrors {
        let [mass, depth] = percent;
        let others = estimated().skip(2).map(|scalar| (scalar, Ok(0.0)));
        let of_wear = [(&MASS_LOSS_MG, Ok(mass)), (&MAX_DEPTH_MM, Ok(depth))];
        of_wear.into_iter().chain(others).collect()
    }

    #[test]
    fn verify_parts_add_in_quadrature_and_the_rest_says_why() {
        let no_mesh = |scalar| (scalar, Err("there is no coarser mesh".to_owned()));
        let parts = [
            (Part::Increments, of_wear([-3.0, 0.5])),
            (Part::SlipTolerance, of_wear([4.0, 1.2])),
            (Part::Mesh, estimated().map(no_mesh).collect()),
            (Part::Updates, of_wear([f64::NAN, 0.0])),
        ];
        let value_of = |scalar: &Scalar| if *scalar == MASS_LOSS_MG { 200.0 } else { 0.1 };
        let estimate = ErrorEstimate::new(value_of, parts);
        let (mass, depth) = (estimate.of(&MASS_LOSS_MG), estimate.of(&MAX_DEPTH_MM));
        assert_eq!(mass.percent.total, 10.0);
        assert_eq!(depth.percent.total, 2.6);
        assert_eq!(mass.in_unit.increments, Some(-6.0));
        assert_eq!(mass.in_unit.total, 20.0);
        let of_depth = depth.in_unit.slip_tolerance;
        assert!((of_depth.expect("it is estimated") - 0.0012).abs() < 1e-12);
        assert_eq!(mass.percent.mesh, None);
        assert_eq!(estimate.not_estimated["mesh"], "there is no coarser mesh");
        assert_eq!(estimate.not_estimated["updates"], "nothing was worn");
        assert_eq!(estimate.not_estimated.len(), 2);
    }

    #[test]
    fn a_reason_of_one_number_alone_names_that_number() {
        let mut errors = of_wear([1.0, 1.0]);
        errors[3].1 = Err("it is apart".to_owned());
        assert_eq!(*errors[3].0, PEAK_CONTACT_AREA_MM2);
        let estimate = ErrorEstimate::new(|_| 1.0, [(Part::Updates, errors)]);
        assert_eq!(estimate.of(&PEAK_CONTACT_AREA_MM2).percent.updates, None);
        assert_eq!(estimate.of(&AP_RANGE_MM).in_unit.updates, Some(0.0));
        let said: Vec<_> = estimate.not_estimated.keys().collect();
        assert_eq!(said, ["updates_of_peak_contact_area"]);
    }

    #[test]
    fn a_file_gives_the_same_estimate_back() {
        let estimate = ErrorEstimate::new(|_| 2.0, [(Part::Mesh, of_wear([1.0, 3.0]))]);
        let text = serde_json::to_string(&estimate).expect("it can be written");
        let mass = r#""mass_loss_percent":{"increments":null,"updates":null,"mesh":1.0,"slip_tolerance":null,"total":2.0}"#;
        assert!(text.contains(mass), "{text}");
        assert_eq!(
            serde_json::from_str::<ErrorEstimate>(&text).expect("is read"),
            estimate
        );
    }

    #[test]
    fn the_relative_error_of_one_number_is_not_the_error_of_another() {
        let percent = catalogue::scalar("peak_max_shear_percent").unwrap();
        let mpa = catalogue::scalar("peak_max_shear_mpa").unwrap();
        let errors = vec![(mpa, Ok(10.0))];
        let estimate = ErrorEstimate::new(|_| 7.0, [(Part::Mesh, errors)]);
        assert!(estimate.get(mpa).is_some() && estimate.get(percent).is_none());
    }
}
