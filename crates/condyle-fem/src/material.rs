//! Materials: the response of a point to strain.

use std::fmt::Debug;

use crate::{elastic::Elastic, stress::Strain};

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
