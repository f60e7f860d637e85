//! Points and vectors.

/// A point or a vector in space.
pub type Vec3 = nalgebra::Vector3<f64>;
