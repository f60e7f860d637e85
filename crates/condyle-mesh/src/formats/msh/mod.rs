//! Gmsh meshes, versions 2.2 and 4.1 as text: hexahedra, and quads and nodes of physical groups.

mod elements;
mod groups;
mod lines;
mod nodes;
mod parse;

pub(super) use parse::parse;
