//! A hexahedral mesh with its named parts, whatever the format.

use condyle_fem::HexMesh;

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
