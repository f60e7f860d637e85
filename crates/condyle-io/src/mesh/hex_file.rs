//! A hexahedral mesh from any of the formats, by the ending of its name.

use std::path::Path;

use condyle_fem::HexMesh;

use super::surface::{ending, read_bytes, unknown_ending};
use super::{MeshFileError, inp, msh, vtu};

/// A hexahedral mesh as a file gives it, with its named surfaces and node sets.
#[derive(Clone, Debug, PartialEq)]
pub struct HexFile {
    /// The hexahedra and their nodes, in the file's unit and axes and in its order; nodes that no
    /// hexahedron uses are left out.
    pub mesh: HexMesh,
    /// Named parts of the boundary, in the order of the file.
    pub surfaces: Vec<NamedSurface>,
    /// Named sets of nodes, in the order of the file.
    pub node_sets: Vec<NamedNodes>,
}

impl HexFile {
    /// The surface of that name, in whatever case the letters are.
    pub fn surface(&self, name: &str) -> Option<&NamedSurface> {
        self.surfaces
            .iter()
            .find(|surface| surface.name.eq_ignore_ascii_case(name))
    }

    /// The node set of that name, in whatever case the letters are.
    pub fn node_set(&self, name: &str) -> Option<&NamedNodes> {
        self.node_sets
            .iter()
            .find(|set| set.name.eq_ignore_ascii_case(name))
    }
}

/// A part of the boundary of a hexahedral mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedSurface {
    /// Name as written in the file.
    pub name: String,
    /// Node numbers from 0, anticlockwise seen from outside.
    pub quads: Vec<[u32; 4]>,
}

/// A set of nodes of a hexahedral mesh.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedNodes {
    /// Name as written in the file.
    pub name: String,
    /// Node numbers from 0, rising, each once.
    pub nodes: Vec<u32>,
}

/// Reads a mesh of 8-node hexahedra from Abaqus `.inp`, Gmsh `.msh` (2.2 and 4.1, text) or `.vtu`.
///
/// Named surfaces come from `*SURFACE`, from physical groups of quads, and from arrays of 0 and 1
/// over points or cells; their quads are turned to face outwards. Lengths and axes are the file's
/// own.
///
/// # Errors
/// Names the file, and the line where the format is text: missing or unreadable file, unknown
/// ending, content that does not follow the format or is not understood, several parts or
/// instances, an element that is no hexahedron, one that is inverted or flat, a node that is not
/// there or not finite, a surface that is not on the boundary.
pub fn read_hexahedra(path: impl AsRef<Path>) -> Result<HexFile, MeshFileError> {
    let path = path.as_ref();
    let parse = match ending(path).as_str() {
        "inp" => inp::parse,
        "msh" => msh::parse,
        "vtu" => vtu::parse,
        _ => return Err(unknown_ending(path, ".inp, .msh, .vtu")),
    };
    parse(path, &read_bytes(path)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::fixtures::message;

    #[test]
    fn a_missing_file_and_an_unknown_ending_say_so() {
        let said = message(read_hexahedra("nowhere/insert.inp"));
        assert!(said.contains("there is no such file"), "{said}");
        let said = message(read_hexahedra("insert.k"));
        assert!(
            said.contains("\"k\" is not a known format; use one of .inp, .msh, .vtu"),
            "{said}"
        );
    }
}
