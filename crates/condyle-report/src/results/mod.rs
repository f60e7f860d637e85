//! A results folder, read.

pub(crate) mod case;
pub(crate) mod contents;
pub(crate) mod measure;
pub(crate) mod read;
pub(crate) mod surface;
pub(crate) mod surface_of_mesh;
pub(crate) mod table;
