//! What can be wrong with a mesh file, and where.

use std::fmt;
use std::path::{Path, PathBuf};

/// A place in a file: the line where the format is text, else the file alone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileLine {
    /// The file as the caller named it.
    pub path: PathBuf,
    /// Line number from 1; none in binary formats.
    pub line: Option<usize>,
}

impl FileLine {
    pub(crate) fn file(path: &Path) -> Self {
        Self::new(path, None)
    }

    pub(crate) fn line(path: &Path, line: usize) -> Self {
        Self::new(path, Some(line))
    }

    pub(crate) fn new(path: &Path, line: Option<usize>) -> Self {
        let path = path.to_path_buf();
        Self { path, line }
    }

    pub(crate) fn error(self, what: impl Into<String>) -> MeshFileError {
        let what = what.into();
        MeshFileError::Parse { at: self, what }
    }
}

impl fmt::Display for FileLine {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}", self.path.display())?;
        self.line.map_or(Ok(()), |line| write!(out, ":{line}"))
    }
}

/// Why a mesh file could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum MeshFileError {
    /// Nothing is at the path.
    #[error("{}: there is no such file; check the path", path.display())]
    Missing {
        /// The path asked for.
        path: PathBuf,
    },
    /// The system would not read the file.
    #[error("{}: cannot be read: {source}", path.display())]
    Unreadable {
        /// The path asked for.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The system would not write the file.
    #[error("{}: cannot be written: {source}", path.display())]
    Unwritable {
        /// The path asked for.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The name does not end in a format that is known for this use.
    #[error("{}: the ending {ending:?} is not a known format; use one of {known}", path.display())]
    UnknownExtension {
        /// The path asked for.
        path: PathBuf,
        /// The ending, without the dot.
        ending: String,
        /// The endings that would do.
        known: String,
    },
    /// The content does not follow the format.
    #[error("{at}: {what}")]
    Parse {
        /// Where.
        at: FileLine,
        /// What is wrong and what to do.
        what: String,
    },
    /// A surface file without a single triangle or polygon.
    #[error("{}: holds no triangles; export the surface as triangles", path.display())]
    NoTriangles {
        /// The file.
        path: PathBuf,
    },
    /// A volume file without a single hexahedron.
    #[error("{}: holds no hexahedra; export the volume mesh with 8-node hexahedra", path.display())]
    NoHexahedra {
        /// The file.
        path: PathBuf,
    },
    /// A coordinate that is not a number or infinite.
    #[error("{at}: {what} has a coordinate that is not a finite number; repair the mesh")]
    NonFinite {
        /// Where.
        at: FileLine,
        /// Which vertex or node, in the words of the format.
        what: String,
    },
    /// A polygon or an element that names a vertex that the file does not have.
    #[error("{at}: {what} names vertex {index}, but the file numbers its vertices {numbering}")]
    IndexOutOfRange {
        /// Where.
        at: FileLine,
        /// Which polygon or element.
        what: String,
        /// The number as the file gives it.
        index: i64,
        /// What numbers would do, such as "from 0 to 11" or "otherwise".
        numbering: String,
    },
    /// A volume element that is not an 8-node hexahedron.
    #[error(
        "{at}: element {element} is of type {kind}; only 8-node hexahedra can be read, \
         so mesh the insert with those"
    )]
    NotHexahedron {
        /// Where.
        at: FileLine,
        /// The element's number in the file.
        element: u64,
        /// Its type in the words of the format.
        kind: String,
    },
    /// A hexahedron that is flat or inverted at a corner.
    #[error(
        "{at}: hexahedron {element} is inverted or flat (scaled Jacobian {quality:.3}); \
         check its node order, or mesh again"
    )]
    Inverted {
        /// Where.
        at: FileLine,
        /// The element's number in the file.
        element: u64,
        /// Smallest scaled Jacobian, 0 or less.
        quality: f64,
    },
    /// A quad of a named surface that is not a face on the outside of the mesh.
    #[error(
        "{at}: a face of surface {surface:?} is not on the outside of the hexahedra; \
         choose the surface on the boundary of the mesh"
    )]
    NotOnBoundary {
        /// Where.
        at: FileLine,
        /// Name of the surface.
        surface: String,
    },
    /// An assembly of several parts or instances.
    #[error(
        "{at}: a second {what} starts here; give a file with one only, \
         or write the model flat (no parts and assemblies)"
    )]
    SeveralBodies {
        /// Where the second one starts.
        at: FileLine,
        /// "instance" or "part".
        what: &'static str,
    },
    /// Values to be written that are not one a node.
    #[error("array {name:?} has {values} values for {nodes} nodes; give one a node")]
    ArrayLength {
        /// Name of the array.
        name: String,
        /// Values given.
        values: usize,
        /// Nodes of the mesh.
        nodes: usize,
    },
}

impl MeshFileError {
    /// The file that is at fault; none for values given by a caller.
    pub fn path(&self) -> Option<&Path> {
        match self {
            Self::Missing { path }
            | Self::Unreadable { path, .. }
            | Self::Unwritable { path, .. }
            | Self::UnknownExtension { path, .. }
            | Self::NoTriangles { path }
            | Self::NoHexahedra { path } => Some(path),
            Self::Parse { at, .. }
            | Self::NonFinite { at, .. }
            | Self::IndexOutOfRange { at, .. }
            | Self::NotHexahedron { at, .. }
            | Self::Inverted { at, .. }
            | Self::NotOnBoundary { at, .. }
            | Self::SeveralBodies { at, .. } => Some(&at.path),
            Self::ArrayLength { .. } => None,
        }
    }
}
