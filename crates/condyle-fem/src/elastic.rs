//! Symmetric tensors of stress and strain, their invariants, and isotropic linear elasticity between them.

use nalgebra::Matrix3;
use thiserror::Error;

use crate::Vec3;

/// A symmetric stress: xx, yy, zz, xy, yz, zx; tension is positive.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stress(pub [f64; 6]);

impl Stress {
    /// Returns the mean of the three normal stresses.
    pub fn mean(&self) -> f64 {
        (self.0[0] + self.0[1] + self.0[2]) / 3.0
    }

    /// Returns the deviator, $\sigma - \tfrac{1}{3} \operatorname{tr} \sigma$.
    pub fn deviator(&self) -> Self {
        let [xx, yy, zz, xy, yz, zx] = self.0;
        let mean = self.mean();
        Self([xx - mean, yy - mean, zz - mean, xy, yz, zx])
    }

    /// Returns the length of the tensor, $\sqrt{\sigma : \sigma}$.
    pub fn norm(&self) -> f64 {
        self.dot(self).sqrt()
    }

    /// Product with another symmetric tensor, over all nine components.
    pub(crate) fn dot(&self, other: &Self) -> f64 {
        let part = |i: usize| self.0[i] * other.0[i];
        part(0) + part(1) + part(2) + 2.0 * (part(3) + part(4) + part(5))
    }

    pub(crate) fn times(&self, v: &Vec3) -> Vec3 {
        let [xx, yy, zz, xy, yz, zx] = self.0;
        Vec3::new(
            xx * v.x + xy * v.y + zx * v.z,
            xy * v.x + yy * v.y + yz * v.z,
            zx * v.x + yz * v.y + zz * v.z,
        )
    }

    /// Itself and some of another.
    pub(crate) fn plus(&self, factor: f64, other: &Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + factor * other.0[i]))
    }

    /// Equivalent stress of von Mises, $\sqrt{\tfrac{3}{2} s : s}$ of the deviator.
    pub fn von_mises(&self) -> f64 {
        1.5f64.sqrt() * self.deviator().norm()
    }

    /// Principal stresses, the largest first.
    pub fn principal(&self) -> [f64; 3] {
        let [xx, yy, zz, xy, yz, zx] = self.0;
        let values = Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz).symmetric_eigenvalues();
        let mut values = [values[0], values[1], values[2]];
        values.sort_by(|a, b| b.total_cmp(a));
        values
    }

    /// Returns the largest shear stress: half of the difference of the outer principal stresses.
    pub fn max_shear(&self) -> f64 {
        let [first, _, third] = self.principal();
        0.5 * (first - third)
    }
}

/// A symmetric strain: xx, yy, zz, xy, yz, zx, the last three those of the tensor, half of the angles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Strain(pub [f64; 6]);

impl Strain {
    /// Creates the symmetric part of a displacement gradient.
    pub(crate) fn from_gradient(gradient: &Matrix3<f64>) -> Self {
        let both = |i, j| 0.5 * (gradient[(i, j)] + gradient[(j, i)]);
        Self([
            both(0, 0),
            both(1, 1),
            both(2, 2),
            both(0, 1),
            both(1, 2),
            both(2, 0),
        ])
    }

    /// Change of volume.
    pub fn trace(&self) -> f64 {
        self.0[0] + self.0[1] + self.0[2]
    }

    /// Returns the difference to another strain.
    pub fn less(&self, part: &Self) -> Self {
        Self(std::array::from_fn(|i| self.0[i] - part.0[i]))
    }

    /// Itself and some of a stress.
    pub(crate) fn plus(&self, factor: f64, stress: &Stress) -> Self {
        Self(std::array::from_fn(|i| self.0[i] + factor * stress.0[i]))
    }

    /// Returns a tensor with the same shear and another change of volume.
    pub(crate) fn with_trace(mut self, trace: f64) -> Self {
        let add = (trace - self.trace()) / 3.0;
        for normal in &mut self.0[..3] {
            *normal += add;
        }
        self
    }

    /// Equivalent strain, $\sqrt{2/3\thinspace e : e}$, of a strain without change of volume.
    pub fn equivalent(&self) -> f64 {
        let [x, y, z, shears @ ..] = self.0;
        let shears = shears.iter().map(|shear| shear * shear).sum::<f64>();
        (2.0 / 3.0 * (x * x + y * y + z * z + 2.0 * shears)).sqrt()
    }
}

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
    fn verify_invariants_of_tension_and_of_shear() {
        let tension = Stress([0.0, 30.0, 0.0, 0.0, 0.0, 0.0]);
        assert!((tension.von_mises() - 30.0).abs() < 1e-12);
        assert!((tension.max_shear() - 15.0).abs() < 1e-12);
        let shear = Stress([-5.0, -5.0, -5.0, 0.0, 8.0, 0.0]);
        assert!((shear.von_mises() - 8.0 * 3f64.sqrt()).abs() < 1e-12);
        assert!((shear.max_shear() - 8.0).abs() < 1e-12);
        assert!((shear.principal()[0] - 3.0).abs() < 1e-12);
    }

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
