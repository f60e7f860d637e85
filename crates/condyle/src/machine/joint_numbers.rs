//! One number a freedom.

/// One number a freedom, in the order of the chain.
pub(in crate::machine) type Vec6 = nalgebra::Vector6<f64>;
/// How each freedom's number changes with each other's.
pub(in crate::machine) type Mat6 = nalgebra::Matrix6<f64>;
