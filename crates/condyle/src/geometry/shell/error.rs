//! Why a triangle mesh is not a shell.

use crate::Vec3;

/// Why a triangle mesh is not a shell. Triangles are numbered from 0 as they came in.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ShellError {
    /// There is no triangle with an area.
    #[error("the mesh has no triangle with an area; check the export")]
    Empty,
    /// More than two triangles meet in an edge.
    #[error(
        "{triangles} triangles share the edge from {} to {} mm; a shell has at most two, \
         so take out inner walls and doubled faces",
        point(from_mm),
        point(to_mm)
    )]
    NonManifoldEdge {
        /// One end of the edge.
        from_mm: Vec3,
        /// The other end.
        to_mm: Vec3,
        /// How many triangles share it.
        triangles: usize,
    },
    /// The surface has one side only, like a Moebius strip.
    #[error(
        "the surface cannot be given an outer side: going round it comes back turned at {} mm; \
         repair the mesh there",
        point(at_mm)
    )]
    NotOrientable {
        /// The middle of an edge where the contradiction shows.
        at_mm: Vec3,
    },
    /// Two triangles pass through one another.
    #[error(
        "the surface crosses itself: triangles {first} and {second} cut one another at {} mm; \
         repair the mesh there",
        point(at_mm)
    )]
    CrossesItself {
        /// The lower number.
        first: usize,
        /// The higher number.
        second: usize,
        /// A point of the cut.
        at_mm: Vec3,
    },
}

fn point(at: &Vec3) -> String {
    format!("({:.4}, {:.4}, {:.4})", at.x, at.y, at.z)
}
