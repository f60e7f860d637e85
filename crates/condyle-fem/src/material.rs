//! Materials: the response of a point to strain.

use crate::{
    elastic::Elastic,
    stress::{Strain, Stress},
};

/// A material of small strains, of which elastic stiffness is a bound: what yields is softer.
///
/// The elements ask every Gauss point for its response; a new material is one file with an implementation of this
/// trait. The solvers factor the elastic stiffness once and correct it where the response is softer.
pub trait Material {
    /// The internal variables of a point, from load to load; the default is the virgin material.
    type Point: Copy + Default + PartialEq;

    /// Returns the elastic constants.
    fn elastic(&self) -> Elastic;

    /// Returns the part of the strain that needs no stress.
    fn eigenstrain(point: &Self::Point) -> Strain;

    /// Returns the response to a strain, from the internal variables before the load.
    fn respond(&self, strain: &Strain, before: &Self::Point) -> Response<Self::Point>;

    /// Returns the equivalent stress over the yield stress that an elastic step to a strain would cause; more than 1
    /// where the material yields, and 0 if it never does.
    fn use_of_yield(&self, strain: &Strain, before: &Self::Point) -> f64;
}

/// The response of a material point to a strain.
#[derive(Clone, Copy, Debug)]
pub struct Response<P> {
    /// Stress.
    pub stress: Stress,
    /// The internal variables if the load is accepted.
    pub point: P,
    /// The loss of stiffness against elastic, if the point yields.
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

    fn eigenstrain((): &()) -> Strain {
        Strain::default()
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
