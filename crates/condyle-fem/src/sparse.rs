//! Sparse Cholesky factorisation of stiffness, by nested dissection of the mesh.

mod dissection;
mod factor;
mod front;
mod rhs;
mod solve;
mod tiles;

pub(crate) use dissection::Dissection;
pub(crate) use factor::{Factor, Loose};
pub(crate) use rhs::Rhs;
