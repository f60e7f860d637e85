//! The physics of a virtual wear test of a joint replacement.
//!
//! No terminal, no files, no global state. Millimetre, newton, second, MPa, tonne and radian
//! everywhere inside; frames and signs are in `NOTATION.md`.

pub mod anatomy;
pub mod contact;
pub mod creep;
pub mod evolve;
pub mod geometry;
pub mod machine;
pub mod number;
pub mod parameter;
pub mod spatial;
pub mod wear;

/// A point or a vector in space, mm unless said otherwise.
pub type Vec3 = nalgebra::Vector3<f64>;
/// A vector of numbers, or of several side by side.
pub type Vector<T> = nalgebra::Vector3<T>;
/// A 3 by 3 matrix.
pub type Mat3 = nalgebra::Matrix3<f64>;
