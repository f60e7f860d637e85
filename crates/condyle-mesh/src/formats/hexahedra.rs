//! A hexahedral mesh from any of the formats, by the ending of its name.

use std::path::Path;

use super::error::MeshFileError;
use super::hex_draft::HexFile;
use super::text::{Parser, parser, read_bytes};
use crate::files::Files;

/// Every format by the ending of its name.
const FORMATS: &[(&str, Parser<HexFile>)] = &[
    ("inp", super::inp::parse),
    ("msh", super::msh::parse),
    ("vtu", super::vtu::parse),
];

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
pub fn read_hexahedra(files: &dyn Files, path: impl AsRef<Path>) -> Result<HexFile, MeshFileError> {
    let path = path.as_ref();
    parser(path, FORMATS)?(path, &read_bytes(files, path)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::Disk;
    use crate::formats::fixtures::message;

    #[test]
    fn a_missing_file_and_an_unknown_ending_say_so() {
        let said = message(read_hexahedra(&Disk, "nowhere/insert.inp"));
        assert!(said.contains("there is no such file"), "{said}");
        let said = message(read_hexahedra(&Disk, "insert.k"));
        assert!(
            said.contains("\"k\" is not a known format; use one of .inp, .msh, .vtu"),
            "{said}"
        );
    }
}
