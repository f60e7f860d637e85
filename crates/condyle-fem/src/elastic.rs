//! Isotropic linear elasticity.

use thiserror::Error;

use crate::stress::{Strain, Stress};

/// The two constants of an isotropic, linearly elastic material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Elastic {
    /// Young's modulus, in the unit of stress (condyle: MPa).
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poissons_ratio: f64,
}

/// Elastic constants outside the range of the elements.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum ElasticError {
    /// The modulus is not a positive number.
    #[error("Young's modulus is {youngs_modulus}; it must be a positive number")]
    Modulus { youngs_modulus: f64 },
    /// At a ratio of one half the volume cannot change, and pressure does not follow from strain.
    #[error(
        "Poisson's ratio is 0.5: the material would be incompressible, which these elements cannot be; 0.49 is near enough for polyethylene"
    )]
    Incompressible,
    /// Poisson's ratio is outside the range.
    #[error("Poisson's ratio is {poissons_ratio}; it must be at least 0 and below 0.5")]
    Ratio { poissons_ratio: f64 },
}

impl Elastic {
    /// Returns a material with these constants.
    ///
    /// # Errors
    /// If the modulus is not positive, or Poisson's ratio not in `0 <= v < 0.5`.
    pub fn new(youngs_modulus: f64, poissons_ratio: f64) -> Result<Self, ElasticError> {
        let material = Self {
            youngs_modulus,
            poissons_ratio,
        };
        material.checked()
    }

    pub(crate) fn checked(self) -> Result<Self, ElasticError> {
        let Self {
            youngs_modulus,
            poissons_ratio,
        } = self;
        if !(youngs_modulus > 0.0 && youngs_modulus.is_finite()) {
            return Err(ElasticError::Modulus { youngs_modulus });
        }
        if poissons_ratio == 0.5 {
            return Err(ElasticError::Incompressible);
        }
        if !(0.0..0.5).contains(&poissons_ratio) {
            return Err(ElasticError::Ratio { poissons_ratio });
        }
        Ok(self)
    }

    /// Shear modulus $G = E/(2 (1 + \nu))$.
    pub fn shear_modulus(&self) -> f64 {
        self.youngs_modulus / (2.0 * (1.0 + self.poissons_ratio))
    }

    /// Bulk modulus $K = E/(3 (1 - 2 \nu))$.
    pub fn bulk_modulus(&self) -> f64 {
        self.youngs_modulus / (3.0 * (1.0 - 2.0 * self.poissons_ratio))
    }

    /// Stress $2 G \operatorname{dev} \varepsilon + K \operatorname{tr} \varepsilon\thinspace 1$ of a strain.
    pub(crate) fn stress(&self, strain: &Strain) -> Stress {
        let (g, mean) = (self.shear_modulus(), strain.trace() / 3.0);
        let pressure = 3.0 * self.bulk_modulus() * mean;
        // Deviator and pressure apart: near incompressibility the second Lame constant would swamp the first.
        let normal = |strain: f64| 2.0 * g * (strain - mean) + pressure;
        let e = &strain.0;
        Stress([
            normal(e[0]),
            normal(e[1]),
            normal(e[2]),
            2.0 * g * e[3],
            2.0 * g * e[4],
            2.0 * g * e[5],
        ])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moduli_are_those_of_steel() {
        let steel = Elastic::new(210e3, 0.3).unwrap();
        assert!((steel.shear_modulus() - 80_769.2).abs() < 0.1);
        assert!((steel.bulk_modulus() - 175e3).abs() < 1e-6);
    }

    #[test]
    fn impossible_constants_are_named() {
        let error = |e, v| Elastic::new(e, v).unwrap_err().to_string();
        assert!(error(-3.0, 0.3).starts_with("Young's modulus is -3;"));
        assert!(error(f64::NAN, 0.3).contains("positive"));
        assert!(error(1.0, 0.5).contains("incompressible"));
        assert!(error(1.0, 0.51).starts_with("Poisson's ratio is 0.51;"));
        assert!(error(1.0, -0.1).contains("at least 0"));
    }
}
