//! Symmetric tensors of stress and strain, and their invariants.

use nalgebra::Matrix3;

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
}
