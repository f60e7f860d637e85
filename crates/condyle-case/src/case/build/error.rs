//! Cases that cannot be built, and remarks on those that can.

use std::fmt;
use std::path::{Path, PathBuf};

use condyle::anatomy::Recognition;
use condyle::geometry::{InsertError, TriangleMesh};
use condyle_fem::SolidError;
use condyle_mesh::columns::{ColumnError, Hole};
use condyle_mesh::formats::MeshFileError;
use condyle_mesh::repair::RepairError;
use thiserror::Error;

use crate::config::DataFile;

/// One of the two bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Body {
    /// The femoral component.
    Femur,
    /// The tibial insert.
    Insert,
}

impl fmt::Display for Body {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(self.table())
    }
}

impl Body {
    pub(in crate::case) fn table(self) -> &'static str {
        match self {
            Self::Femur => "femur",
            Self::Insert => "insert",
        }
    }

    /// Recognises the orientation of the body from triangles in any frame and unit.
    pub(in crate::case) fn recognise(self, mesh: &TriangleMesh) -> Option<Recognition> {
        match self {
            Self::Femur => Recognition::of_femur(mesh),
            Self::Insert => Recognition::of_insert(mesh),
        }
    }
}

/// A case that cannot be built: cause and remedy in words, and the keys at fault.
#[derive(Debug, Error)]
#[error("{message}")]
pub struct BuildError {
    message: String,
    file: Option<PathBuf>,
    table: Option<&'static str>,
    /// Keys of the table that may be at fault, the likeliest first.
    pub(in crate::case) keys: &'static [&'static str],
}

impl BuildError {
    pub(super) fn new(keys: &'static [&'static str], message: impl Into<String>) -> Self {
        Self {
            message: message.into(),
            file: None,
            table: None,
            keys,
        }
    }

    /// Returns the error of settings of `table` that cannot be used or combined.
    pub(super) fn conflict(
        table: &'static str,
        keys: &'static [&'static str],
        message: impl Into<String>,
    ) -> Self {
        let table = Some(table);
        Self {
            table,
            ..Self::new(keys, message)
        }
    }

    /// Returns the error of a mesh file that can be read but not used.
    pub(in crate::case) fn mesh(
        file: &Path,
        keys: &'static [&'static str],
        message: impl fmt::Display,
    ) -> Self {
        Self {
            file: Some(file.to_path_buf()),
            ..Self::new(keys, format!("{}: {message}", file.display()))
        }
    }

    /// Returns the error of triangles that do not form a shell.
    pub(in crate::case) fn shell(file: &Path, error: &RepairError) -> Self {
        Self::mesh(file, &["file"], error)
    }

    /// Returns the error of a shell that cannot be meshed as an insert.
    pub(super) fn shell_insert(file: &Path, error: &InsertError) -> Self {
        let keys: &[_] = match error {
            InsertError::TooManyNodes(_)
            | InsertError::Columns(
                ColumnError::NoColumns { .. }
                | ColumnError::TooCoarse { .. }
                | ColumnError::TooManyNodes(_),
            ) => &["edge_mm", "file"],
            _ => &["file"],
        };
        Self::mesh(file, keys, error)
    }

    /// Returns the error of a counterface that presses on a hole of the insert in `file`, `when` being the stage of the run.
    pub fn pressed_hole(file: &Path, hole: &Hole, when: &str) -> Self {
        let message = format!(
            "the counterface presses on the insert at a {hole}, {when}, where its surface is interpolated; fill the hole in the \
             mesh, or check the positions of the bodies; an insert with a bore needs shape = \"hexahedra\""
        );
        Self::mesh(file, &["file"], message)
    }

    /// Returns the mesh file at fault.
    pub fn file(&self) -> Option<&Path> {
        self.file.as_deref()
    }

    /// Returns the table at fault; that of the body with the file if none is named.
    pub(in crate::case) fn table(&self, femur: Option<&Path>) -> &'static str {
        let is_femur = self.file.is_some() && self.file() == femur;
        let of_file = if is_femur { Body::Femur } else { Body::Insert };
        self.table.unwrap_or(of_file.table())
    }
}

impl From<MeshFileError> for BuildError {
    fn from(error: MeshFileError) -> Self {
        let file = error.path().map(Path::to_path_buf);
        Self {
            file,
            ..Self::new(&["file"], error.to_string())
        }
    }
}

/// Keys of an insert that the solver rejects.
const INSERT_KEYS: &[&str] = &["backside", "articulating_surface", "file", "edge_mm"];

impl From<SolidError> for BuildError {
    fn from(error: SolidError) -> Self {
        let message = format!("[contact] model = \"deformable\": {error}");
        Self::new(INSERT_KEYS, message)
    }
}

impl From<InsertError> for BuildError {
    fn from(error: InsertError) -> Self {
        let keys = match error {
            InsertError::TooManyNodes(_) => &["edge_mm", "layers"],
            _ => INSERT_KEYS,
        };
        Self::new(keys, format!("the insert cannot be used: {error}"))
    }
}

/// A remark on a case or its meshes, to be shown to the user.
#[derive(Clone, Debug, PartialEq)]
pub struct BuildWarning {
    text: String,
    pub(in crate::case) finding: Finding,
}

/// A finding that later steps of a build or a run use.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::case) enum Finding {
    None,
    /// A body whose orientation likely differs from its axes.
    WrongAxes(Body),
    /// Part of the mesh lies far from the rest.
    StrayPiece,
    /// Vertices that scatter by this much, mm.
    Scatter(f64),
    /// Holes inside the outline of an insert, over which hexahedra stand. Pressure no farther from them than
    /// this, mm, counts as pressure on them.
    Bridged(Vec<Hole>, f64),
}

impl fmt::Display for BuildWarning {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.text)
    }
}

impl BuildWarning {
    /// Scatter of the vertices of a mesh up to which the highest pressure is reliable within 5 %, mm, even if both bodies scatter
    /// (`docs/src/plausibility.md`).
    pub const MAX_SCATTER_MM: f64 = 0.004;

    pub(in crate::case) fn new(text: String) -> Self {
        let finding = Finding::None;
        Self { text, finding }
    }

    /// Returns a remark on a mesh file, without its folder: results repeat the remark, and name no folder.
    pub(super) fn mesh(file: &DataFile, remark: impl fmt::Display) -> Self {
        Self::new(format!("{}: {remark}", file.name()))
    }

    pub(super) fn with(self, finding: Finding) -> Self {
        Self { finding, ..self }
    }

    /// Returns the scatter of the vertices, mm, if the remark is on it.
    pub fn scatter_mm(&self) -> Option<f64> {
        match self.finding {
            Finding::Scatter(scatter_mm) => Some(scatter_mm),
            _ => None,
        }
    }

    /// Returns true if the remark is on holes of an insert, over which its surface is interpolated.
    pub fn is_bridge(&self) -> bool {
        matches!(self.finding, Finding::Bridged(..))
    }

    /// Returns the hole of an insert that contains or adjoins the place (x, z), mm.
    pub fn hole_at(&self, place_mm: [f64; 2]) -> Option<&Hole> {
        let Finding::Bridged(holes, beside_mm) = &self.finding else {
            return None;
        };
        let mut holes = holes.iter();
        holes.find(|hole| hole.distance_mm(place_mm) <= *beside_mm)
    }
}
