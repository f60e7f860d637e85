//! Files of condyle: mesh formats, case files and the results folder, one file a format.
//!
//! Numbers cross this border with their unit in the name, and every error says which file, which
//! line where the format is text, and what to do.

pub mod abaqus;
pub mod cache;
pub mod case;
pub mod files;
pub mod keyed;
pub mod measured;
pub mod mesh;
pub mod results;
