//! Why a mesh makes no insert.

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
    #[error(
        "the insert would have {nodes:.0} nodes, and more than {most} cannot be numbered; use a larger edge_mm or fewer layers"
    )]
    TooManyNodes {
        /// How many.
        nodes: f64,
        /// How many there may be.
        most: u32,
    },
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
