//! Abaqus input files: the mesh, its sets and its element surfaces; the rest is passed over.

mod bodies;
mod keyword;
mod parse;
mod reading;
mod sets;
mod surfaces;

pub(super) use parse::parse;
