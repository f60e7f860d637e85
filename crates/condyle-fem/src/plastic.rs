//! Materials that yield: the response of a point to strain, and plasticity of von Mises with isotropic and kinematic hardening.
//!
//! Stress beyond the yield surface returns to it along the radius (Wilkins; Simo and Hughes 1998, section 3.3),
//! which is the implicit step, exact for proportional straining.

use std::fmt::Debug;

use thiserror::Error;

use crate::elastic::{Elastic, Strain, Stress};

/// A material under small strains: its stress is elastic in the strain less the stress-free part.
///
/// The elements ask every Gauss point for its flow; a new material is one file with an implementation of this trait and
/// of [`MaterialPoint`]. The solvers factor the elastic stiffness once, and apply the stress-free strains as loads.
pub trait Material {
    /// The internal variables of a point.
    type Point: MaterialPoint;

    /// Returns the elastic constants.
    fn elastic(&self) -> Elastic;

    /// Returns the equivalent stress at which the virgin material yields.
    fn initial_yield_stress(&self) -> f64;

    /// Returns the internal variables under a strain, from those before the load.
    fn flow(&self, strain: &Strain, before: &Self::Point) -> Self::Point;

    /// Returns the equivalent stress over the yield stress that an elastic step to a strain would cause; more than 1
    /// where the material yields.
    fn use_of_yield(&self, strain: &Strain, before: &Self::Point) -> f64;
}

/// The internal variables of a material point, from load to load; the default is the virgin material.
pub trait MaterialPoint: Copy + Debug + Default + PartialEq {
    /// The name of the field in which a checkpoint stores them.
    const FIELD: &'static str;
    /// The count of their numbers there.
    const NUMBERS: usize;

    /// Returns the stress-free part of the strain.
    fn eigenstrain(&self) -> Strain;

    /// Replaces that strain, without changing the other variables.
    fn set_eigenstrain(&mut self, strain: Strain);

    /// Returns the accumulated equivalent plastic strain, which never falls.
    fn accumulated(&self) -> f64;

    /// Returns the numbers for the checkpoint.
    fn numbers(&self) -> Vec<f64>;

    /// Returns the point with these numbers.
    ///
    /// # Panics
    /// If there are fewer than [`MaterialPoint::NUMBERS`].
    fn from_numbers(numbers: &[f64]) -> Self;
}

/// The internal variables of a material point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PlasticPoint {
    /// Plastic strain, without change of volume.
    pub strain: Strain,
    /// Centre of the yield surface, a deviator.
    pub backstress: Stress,
    /// Accumulated equivalent plastic strain, which never falls.
    pub accumulated: f64,
}

/// An elastic-plastic material.
#[derive(Clone, Debug, PartialEq)]
pub struct ElasticPlastic {
    /// Its elastic part.
    pub elastic: Elastic,
    /// Its yield stress.
    pub hardening: Hardening,
}

impl Material for ElasticPlastic {
    type Point = PlasticPoint;

    fn elastic(&self) -> Elastic {
        self.elastic
    }

    fn initial_yield_stress(&self) -> f64 {
        self.hardening.yield_stress(0.0)
    }

    fn use_of_yield(&self, strain: &Strain, before: &PlasticPoint) -> f64 {
        let trial = self.elastic.stress(&strain.less(&before.strain));
        let relative = trial.deviator().plus(-1.0, &before.backstress);
        relative.von_mises() / self.hardening.yield_stress(before.accumulated)
    }

    /// Returns the state after the plastic flow of a strain, by the radial return.
    ///
    /// With the trial stress $s$ and $\xi = s - \beta$, $q = \sqrt{3/2} |\xi|$, the step $\Delta p$ solves
    /// $q - (3 G + H_k) \Delta p = \sigma_y(p + \Delta p)$.
    fn flow(&self, strain: &Strain, before: &PlasticPoint) -> PlasticPoint {
        let trial = self.elastic.stress(&strain.less(&before.strain));
        let relative = trial.deviator().plus(-1.0, &before.backstress);
        let q = 1.5f64.sqrt() * relative.norm();
        let kinematic = self.hardening.kinematic_modulus();
        let softening = 3.0 * self.elastic.shear_modulus() + kinematic;
        let Some(step) = self.hardening.step(q, before.accumulated, softening) else {
            return *before;
        };
        // The return is along the radius, so the trial stress has the final direction.
        let flow = Stress::default().plus(1.0 / relative.norm(), &relative);
        let length = 1.5f64.sqrt() * step;
        PlasticPoint {
            strain: before.strain.plus(length, &flow),
            backstress: before
                .backstress
                .plus(2.0 / 3.0 * kinematic * length, &flow),
            accumulated: before.accumulated + step,
        }
    }
}

/// Six numbers of strain, six of backstress, and the accumulated strain.
impl MaterialPoint for PlasticPoint {
    const FIELD: &'static str = "plastic_strain_and_backstress_mpa";
    const NUMBERS: usize = 13;

    fn eigenstrain(&self) -> Strain {
        self.strain
    }

    fn set_eigenstrain(&mut self, strain: Strain) {
        self.strain = strain;
    }

    fn accumulated(&self) -> f64 {
        self.accumulated
    }

    fn numbers(&self) -> Vec<f64> {
        [&self.strain.0[..], &self.backstress.0, &[self.accumulated]].concat()
    }

    fn from_numbers(numbers: &[f64]) -> Self {
        Self {
            strain: Strain(std::array::from_fn(|i| numbers[i])),
            backstress: Stress(std::array::from_fn(|i| numbers[6 + i])),
            accumulated: numbers[12],
        }
    }
}

/// Isotropic hardening by a table, combined with linear kinematic hardening.
///
/// The yield stress is linear between the points of the table and constant after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Hardening {
    /// Accumulated plastic strain and yield stress.
    points: Vec<(f64, f64)>,
    /// Stress of the centre of the yield surface over plastic strain, uniaxial.
    kinematic_modulus: f64,
}

/// A hardening curve that is physically impossible.
#[derive(Clone, Debug, Error, PartialEq)]
#[error("{problem}")]
pub struct HardeningError {
    /// Index of the point at fault, from 0; 0 if no single point is.
    pub point: usize,
    /// The problem and its remedy.
    pub problem: String,
}

impl Hardening {
    /// Isotropic hardening by (accumulated plastic strain, yield stress), with kinematic hardening of a modulus.
    ///
    /// # Errors
    /// If the table does not start at plastic strain 0, has a stress that is not positive or falls, or strains
    /// that do not rise; or if the modulus is negative.
    pub fn new(points: Vec<(f64, f64)>, kinematic_modulus: f64) -> Result<Self, HardeningError> {
        let fault = |point, problem: String| Err(HardeningError { point, problem });
        let Some(&(strain, stress)) = points.first() else {
            let problem = "the hardening curve has no point; give at least the yield stress, at plastic strain 0";
            return fault(0, problem.to_owned());
        };
        if strain != 0.0 {
            return fault(
                0,
                format!(
                    "the hardening curve must start at plastic strain 0 with the yield stress, but starts at \
                     {strain}; plastic strain is the strain that remains after unloading"
                ),
            );
        }
        if !(stress > 0.0 && stress.is_finite()) {
            let problem = format!("the yield stress is {stress}; it must be a positive number");
            return fault(0, problem);
        }
        for (before, ends) in points.windows(2).enumerate() {
            let [(strain0, stress0), (strain, stress)] = [ends[0], ends[1]];
            let (point, number) = (before + 1, before + 2);
            if strain.is_nan() || strain <= strain0 {
                return fault(
                    point,
                    format!(
                        "point {number} of the hardening curve has plastic strain {strain}, which is not above \
                         {strain0} of the point before"
                    ),
                );
            }
            if stress.is_nan() || stress < stress0 {
                return fault(
                    point,
                    format!(
                        "the hardening curve falls at point {number}, from {stress0} to {stress}; a material that \
                         softens has no unique answer on a mesh"
                    ),
                );
            }
        }
        if !(kinematic_modulus >= 0.0 && kinematic_modulus.is_finite()) {
            let problem = format!(
                "the kinematic hardening modulus is {kinematic_modulus}; it must be 0 or positive"
            );
            return fault(0, problem);
        }
        Ok(Self {
            points,
            kinematic_modulus,
        })
    }

    /// Creates a constant yield stress.
    ///
    /// # Errors
    /// If it is not positive.
    pub fn perfectly_plastic(yield_stress: f64) -> Result<Self, HardeningError> {
        Self::new(vec![(0.0, yield_stress)], 0.0)
    }

    /// Accumulated plastic strains and the yield stress at each.
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// Modulus of kinematic hardening.
    pub fn kinematic_modulus(&self) -> f64 {
        self.kinematic_modulus
    }

    /// Yield stress at an accumulated plastic strain.
    pub fn yield_stress(&self, strain: f64) -> f64 {
        let (start, stress, slope) = self.piece(self.piece_of(strain));
        stress + slope * (strain - start)
    }

    /// Returns the plastic strain that brings an equivalent stress down to the yield surface; none if it does not
    /// yield.
    ///
    /// Solves `trial - softening * step = yield_stress(before + step)`, piece by piece, so exactly.
    pub(crate) fn step(&self, trial: f64, before: f64, softening: f64) -> Option<f64> {
        if trial <= self.yield_stress(before) {
            return None;
        }
        let first = self.piece_of(before);
        (first..self.points.len()).find_map(|at| {
            let (start, stress, slope) = self.piece(at);
            let step = (trial - stress - slope * (before - start)) / (softening + slope);
            let end = self.points.get(at + 1).map_or(f64::INFINITY, |next| next.0);
            // The step ends in the first piece that it does not leave: the curve never falls.
            (before + step <= end).then_some(step)
        })
    }

    /// Returns the number of the piece in which a plastic strain lies.
    fn piece_of(&self, strain: f64) -> usize {
        let after = self.points.partition_point(|point| point.0 <= strain);
        after.saturating_sub(1)
    }

    /// Returns the start of a piece of the curve and its slope.
    fn piece(&self, at: usize) -> (f64, f64, f64) {
        let (strain, stress) = self.points[at];
        let slope = self
            .points
            .get(at + 1)
            .map_or(0.0, |next| (next.1 - stress) / (next.0 - strain));
        (strain, stress, slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::material;

    #[test]
    fn stress_stays_on_the_yield_surface_and_flow_keeps_the_volume() {
        let material = material(60.0);
        let mut point = PlasticPoint::default();
        for k in 0..20 {
            let strain = Strain(std::array::from_fn(|i| {
                0.1 * ((5 * i + 7 * k) as f64).cos()
            }));
            point = material.flow(&strain, &point);
            let stress = material.elastic.stress(&strain.less(&point.strain));
            let relative = stress.deviator().plus(-1.0, &point.backstress);
            let limit = material.hardening.yield_stress(point.accumulated);
            assert!(relative.von_mises() <= limit * (1.0 + 1e-12));
            assert!(point.strain.trace().abs() < 1e-14);
        }
        assert!(point.accumulated > 1.0);
    }

    #[test]
    fn the_yield_stress_is_linear_between_points_and_constant_after() {
        let curve = Hardening::new(vec![(0.0, 14.0), (0.02, 20.0), (0.1, 28.0)], 0.0).unwrap();
        let stresses = [0.0, 0.01, 0.02, 0.06, 0.1, 1.0].map(|strain| curve.yield_stress(strain));
        for (found, exact) in std::iter::zip(stresses, [14.0, 17.0, 20.0, 24.0, 28.0, 28.0]) {
            assert!((found - exact).abs() < 1e-12);
        }
    }

    #[test]
    fn a_step_ends_on_the_curve_over_any_number_of_points() {
        let curve = Hardening::new(vec![(0.0, 14.0), (0.02, 20.0), (0.1, 28.0)], 0.0).unwrap();
        for trial in [15.0, 25.0, 60.0, 200.0] {
            for before in [0.0, 0.015, 0.05, 0.3] {
                match curve.step(trial, before, 500.0) {
                    None => assert!(trial <= curve.yield_stress(before)),
                    Some(step) => {
                        let left = trial - 500.0 * step - curve.yield_stress(before + step);
                        assert!(step > 0.0 && left.abs() < 1e-12);
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_no_curve_is_named() {
        let error = |points: &[(f64, f64)]| {
            let curve = Hardening::new(points.to_vec(), 0.0);
            curve.unwrap_err().to_string()
        };
        assert!(error(&[]).contains("no point"));
        assert!(error(&[(0.01, 14.0)]).contains("must start at plastic strain 0"));
        assert!(error(&[(0.0, 0.0)]).contains("the yield stress is 0"));
        assert!(error(&[(0.0, 14.0), (0.1, 13.0)]).contains("falls at point 2, from 14 to 13"));
        assert!(error(&[(0.0, 14.0), (0.0, 15.0)]).contains("not above 0"));
        let negative = Hardening::new(vec![(0.0, 14.0)], -1.0);
        assert!(
            negative
                .unwrap_err()
                .to_string()
                .contains("kinematic hardening modulus is -1")
        );
    }
}
