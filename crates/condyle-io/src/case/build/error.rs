//! Why a good case makes no wear test.

use std::path::{Path, PathBuf};

use condyle::geometry::{InsertError, ShellError, ShellInsertError};
use thiserror::Error;

use super::super::axes::AxesError;
use crate::mesh::MeshFileError;

/// Why a good case makes no wear test.
#[derive(Debug, Error)]
pub enum BuildError {
    /// A mesh file that cannot be read.
    #[error(transparent)]
    MeshFile(#[from] MeshFileError),
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
            Self::Shell { file, .. }
            | Self::ShellInsert { file, .. }
            | Self::ThicknessOfClosed { file }
            | Self::NoSurface { file, .. } => Some(file),
            Self::Insert(_) | Self::Axes(_) => None,
        }
    }
}

fn listed(names: &[String]) -> String {
    if names.is_empty() {
        "none".to_owned()
    } else {
        names.join(", ")
    }
}

/// What was put right in a mesh.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum BuildWarning {
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
