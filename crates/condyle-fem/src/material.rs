//! Materials: the response of a point to strain.

use std::fmt::Debug;

use crate::{
    elastic::Elastic,
    stress::{Strain, Stress},
};

/// A material under small strains whose stiffness never exceeds the elastic one: yielding only softens it.
///
/// The elements ask every Gauss point for its response; a new material is one file with an implementation of this
/// trait and of [`MaterialPoint`]. The solvers factor the elastic stiffness once and correct it where the response is
/// softer.
pub trait Material {
    /// The internal variables of a point.
    type Point: MaterialPoint;

    /// Returns the elastic constants.
    fn elastic(&self) -> Elastic;

    /// Returns the equivalent stress at which the virgin material yields, infinite if it never does.
    fn initial_yield_stress(&self) -> f64;

    /// Returns the response to a strain, from the internal variables before the load.
    fn respond(&self, strain: &Strain, before: &Self::Point) -> Response<Self::Point>;

    /// Returns the equivalent stress over the yield stress that an elastic step to a strain would cause; more than 1
    /// where the material yields, and 0 if it never does.
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

/// The response of a material point to a strain.
#[derive(Clone, Copy, Debug)]
pub struct Response<P> {
    /// Stress.
    pub stress: Stress,
    /// The internal variables if the load is accepted.
    pub point: P,
    /// The loss of stiffness relative to the elastic one, if the point yields.
    pub softening: Option<Softening>,
}

/// The elastic tangent less the consistent one: $a\thinspace I_\text{dev} + b\thinspace n \otimes n$.
#[derive(Clone, Copy, Debug)]
pub struct Softening {
    /// a, stress over strain of any deviator.
    pub deviatoric: f64,
    /// b, stress over strain along the flow.
    pub along_flow: f64,
    /// n, direction of the flow, a deviator of length 1.
    pub flow: Stress,
}

impl Material for Elastic {
    type Point = ();

    fn elastic(&self) -> Elastic {
        *self
    }

    fn initial_yield_stress(&self) -> f64 {
        f64::INFINITY
    }

    fn respond(&self, strain: &Strain, (): &()) -> Response<()> {
        Response {
            stress: self.stress(strain),
            point: (),
            softening: None,
        }
    }

    fn use_of_yield(&self, _: &Strain, (): &()) -> f64 {
        0.0
    }
}

/// An elastic point has no internal variables.
impl MaterialPoint for () {
    const FIELD: &'static str = "";
    const NUMBERS: usize = 0;

    fn eigenstrain(&self) -> Strain {
        Strain::default()
    }

    fn set_eigenstrain(&mut self, _: Strain) {}

    fn accumulated(&self) -> f64 {
        0.0
    }

    fn numbers(&self) -> Vec<f64> {
        Vec::new()
    }

    fn from_numbers(_: &[f64]) -> Self {}
}
