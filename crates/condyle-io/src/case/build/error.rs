//! Why a good case makes no wear test.

use std::path::{Path, PathBuf};

use condyle::geometry::{InsertError, ShellError, ShellInsertError};
use thiserror::Error;

use super::super::axes::AxesError;
use super::super::mesh_file::LengthUnit;
use super::pieces::StrayPiece;
use super::wrong_axes::{Body, WrongAxes};
use crate::mesh::MeshFileError;

/// Why a good case makes no wear test.
#[derive(Debug, Error)]
pub enum BuildError {
    /// A mesh file that cannot be read.
    #[error(transparent)]
    MeshFile(#[from] MeshFileError),
    /// A body that is too small or too large for a knee.
    #[error(
        "{}: the body is {} mm long, and a knee's is 5 mm to 500 mm; {}",
        file.display(),
        rounded(*size_mm),
        in_better_unit(*better)
    )]
    Size {
        /// The file.
        file: PathBuf,
        /// Its longest extent along an axis, mm.
        size_mm: f64,
        /// The unit of length that makes it as long as a knee's, and how long, mm.
        better: Option<(LengthUnit, f64)>,
    },
    /// A body of a whole knee that another unit makes as large as a knee's.
    #[error(
        "{}: this {body} is {} mm long, and that of a whole knee is 40 mm to 120 mm; {}",
        file.display(),
        rounded(*size_mm),
        in_better_unit(Some(*better))
    )]
    WrongUnit {
        /// The file.
        file: PathBuf,
        /// Which body.
        body: Body,
        /// Its longest extent along an axis, mm.
        size_mm: f64,
        /// The unit of length that makes it as long as a knee's, and how long, mm.
        better: (LengthUnit, f64),
    },
    /// A body that lies otherwise than its axes say, for certain.
    #[error("{}: this {} lies {}; {wrong}", file.display(), wrong.body, wrong.how)]
    WrongAxes {
        /// The file.
        file: PathBuf,
        /// How it lies.
        wrong: WrongAxes,
    },
    /// A piece so far from the body that the whole is too large for a knee.
    #[error("{}: {piece}, too far for a knee; delete it", file.display())]
    StrayPiece {
        /// The file.
        file: PathBuf,
        /// The piece.
        piece: StrayPiece,
    },
    /// A femur so large that its field would not fit into memory.
    #[error(
        "{}: the distance field would have {nodes} nodes, and more than {most} take more than \
         2 GB; cut away what never touches the insert, and check length_unit",
        file.display()
    )]
    TooManyNodes {
        /// The file.
        file: PathBuf,
        /// How many.
        nodes: usize,
        /// How many there may be.
        most: usize,
    },
    /// Triangles that are no shell.
    #[error("{}: {source}", file.display())]
    Shell {
        /// The file.
        file: PathBuf,
        /// Why.
        source: ShellError,
    },
    /// A shell that makes no insert.
    #[error("{}: {source}", file.display())]
    ShellInsert {
        /// The file.
        file: PathBuf,
        /// Why.
        source: ShellInsertError,
    },
    /// A thickness for a mesh that has its own.
    #[error(
        "{}: the mesh is closed and has a thickness of its own; remove [insert] `thickness_mm`",
        file.display()
    )]
    ThicknessOfClosed {
        /// The file.
        file: PathBuf,
    },
    /// A surface that is not in the file.
    #[error("{}: there is no surface \"{name}\"; it has {}", file.display(), listed(names))]
    NoSurface {
        /// The file.
        file: PathBuf,
        /// The key that names it.
        key: &'static str,
        /// The name that the case gives.
        name: String,
        /// Names there are.
        names: Vec<String>,
    },
    /// An insert that cannot be used.
    #[error("the insert cannot be used: {0}")]
    Insert(#[from] InsertError),
    /// Axes that are no right-handed frame.
    #[error("`axes`: {0}")]
    Axes(#[from] AxesError),
}

impl BuildError {
    /// The mesh file that is at fault.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::MeshFile(error) => error.path(),
            Self::Size { file, .. }
            | Self::WrongUnit { file, .. }
            | Self::WrongAxes { file, .. }
            | Self::StrayPiece { file, .. }
            | Self::TooManyNodes { file, .. }
            | Self::Shell { file, .. }
            | Self::ShellInsert { file, .. }
            | Self::ThicknessOfClosed { file }
            | Self::NoSurface { file, .. } => Some(file),
            Self::Insert(_) | Self::Axes(_) => None,
        }
    }
}

/// Three digits, for sizes from nanometres to kilometres.
fn rounded(size_mm: f64) -> String {
    if (0.1..1e5).contains(&size_mm) {
        format!("{size_mm:.1}")
    } else {
        format!("{size_mm:.2e}")
    }
}

fn in_better_unit(better: Option<(LengthUnit, f64)>) -> String {
    match better {
        Some((unit, size_mm)) => format!(
            "write length_unit = \"{}\", with which it is {size_mm:.1} mm long",
            unit.word()
        ),
        None => "check length_unit and the mesh".to_owned(),
    }
}

fn listed(names: &[String]) -> String {
    if names.is_empty() {
        "none".to_owned()
    } else {
        names.join(", ")
    }
}

/// What was put right in a mesh, or looks wrong.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum BuildWarning {
    /// A body that likely lies otherwise than its axes say.
    #[error("{}: this {} likely lies {}; {wrong}", file.display(), wrong.body, wrong.how)]
    WrongAxes {
        /// The file, without its folder.
        file: PathBuf,
        /// How it lies.
        wrong: WrongAxes,
    },
    /// A body of a whole knee that is too small or too large for one in any unit.
    #[error(
        "{}: this {body} is {} mm long, and that of a whole knee is 40 mm to 120 mm; check length_unit",
        file.display(),
        rounded(*size_mm)
    )]
    UnusualSize {
        /// The file, without its folder.
        file: PathBuf,
        /// Which body.
        body: Body,
        /// Its longest extent along an axis, mm.
        size_mm: f64,
    },
    /// Part of the mesh lies far from the rest.
    #[error("{}: {piece}; delete it unless it is part of it", file.display())]
    StrayPiece {
        /// The file.
        file: PathBuf,
        /// The piece.
        piece: StrayPiece,
    },
    /// The mesh came inside-out.
    #[error("{}: the triangles faced inwards and were turned round", file.display())]
    TurnedRound {
        /// The file, without its folder.
        file: PathBuf,
    },
    /// Some triangles faced the other way than their neighbours.
    #[error("{}: {count} triangles were turned to face as their neighbours do", file.display())]
    MadeConsistent {
        /// The file, without its folder.
        file: PathBuf,
        /// How many.
        count: usize,
    },
    /// Some neighbouring triangles cross a little.
    #[error(
        "{}: {count} pairs of neighbouring triangles cross a little; they are left as they are",
        file.display()
    )]
    Wrinkles {
        /// The file, without its folder.
        file: PathBuf,
        /// How many pairs.
        count: usize,
    },
    /// Some triangles had no area.
    #[error("{}: {count} triangles without area were left out", file.display())]
    RemovedDegenerate {
        /// The file, without its folder.
        file: PathBuf,
        /// How many.
        count: usize,
    },
}
