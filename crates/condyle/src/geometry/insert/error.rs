//! Why a mesh makes no insert.

use condyle_mesh::columns::{ColumnError, TooManyNodes};
use thiserror::Error;

/// Why a mesh makes no insert.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum InsertError {
    /// No element or no articulating face.
    #[error("the insert has no {what}; name or give some")]
    Empty {
        /// What is missing.
        what: &'static str,
    },
    /// More nodes than can be numbered.
    #[error(transparent)]
    TooManyNodes(#[from] TooManyNodes),
    /// A surface below which no columns of hexahedra can stand.
    #[error(transparent)]
    Columns(#[from] ColumnError),
    /// A hexahedron that is inverted or flat.
    #[error(
        "hexahedron {hex} of the insert is inverted or flat (scaled Jacobian {quality:.3}); mend the mesh or use a larger edge"
    )]
    BadElement {
        /// Which one, from 0.
        hex: usize,
        /// Its scaled Jacobian.
        quality: f64,
    },
    /// A node with no insert below it.
    #[error(
        "the backside lies nowhere below the articulating surface at ({x:.2}, {y:.2}, {z:.2}) mm; check which surface is the backside"
    )]
    NoThickness {
        /// Place of the node, mm.
        x: f64,
        /// Place of the node, mm.
        y: f64,
        /// Place of the node, mm.
        z: f64,
    },
}
