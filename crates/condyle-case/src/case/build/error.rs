//! Cases that cannot be built, and remarks on those that can.

use std::fmt;
use std::path::{Path, PathBuf};

use condyle::Vec3;
use condyle::anatomy::Recognition;
use condyle::geometry::{InsertError, TriangleMesh};
use condyle_fem::SolidError;
use condyle_mesh::columns::{ColumnError, Hole, listed_holes};
use condyle_mesh::repair::{Defect, LeftOut, RepairError, WhyLeftOut};
use thiserror::Error;

use super::super::frame::{Axes, AxesError, LengthUnit, Side};
use crate::config::DataFile;
use condyle_mesh::formats::MeshFileError;

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
        out.write_str(match self {
            Self::Femur => "femur",
            Self::Insert => "insert",
        })
    }
}

impl Body {
    /// Recognises the orientation of the body from triangles in any frame and unit.
    pub(crate) fn recognise(self, mesh: &TriangleMesh) -> Option<Recognition> {
        match self {
            Self::Femur => Recognition::of_femur(mesh),
            Self::Insert => Recognition::of_insert(mesh),
        }
    }

    fn signs(self) -> &'static str {
        match self {
            Self::Femur => {
                "the box open above, the trochlea in front and the notch between the condyles behind"
            }
            Self::Insert => {
                "two dishes above, the flat backside below, the notch or the lower lip behind"
            }
        }
    }
}

/// A body whose orientation differs from its axes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrongAxes {
    /// The body.
    pub body: Body,
    /// Its orientation in the case's frame, such as "upside down".
    pub how: &'static str,
    /// The axes that its shape shows.
    pub better: Axes,
}

impl fmt::Display for WrongAxes {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [x, y, z] = self.better.words();
        write!(
            out,
            "write axes = [\"{x}\", \"{y}\", \"{z}\"], which its shape shows ({})",
            self.body.signs()
        )
    }
}

/// A piece of a mesh that lies far from the largest one, the body.
#[derive(Clone, Debug, PartialEq)]
pub struct StrayPiece {
    /// Its number of triangles.
    pub triangles: usize,
    /// Its middle, mm, in the frame of the body.
    pub at_mm: Vec3,
    /// Distance of its box from that of the body, mm.
    pub away_mm: f64,
    /// Longest edge of the body's box, mm.
    pub body_mm: f64,
}

impl fmt::Display for StrayPiece {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (at, away) = (self.at_mm, self.away_mm);
        write!(
            out,
            "a piece of {} triangles at ({:.0}, {:.0}, {:.0}) mm lies {away:.0} mm from the body",
            self.triangles, at.x, at.y, at.z
        )
    }
}

/// A case that cannot be built.
#[derive(Debug, Error)]
pub enum BuildError {
    /// A mesh file that cannot be read.
    #[error(transparent)]
    MeshFile(#[from] MeshFileError),
    /// An insert that cannot be modelled as an elastic solid.
    #[error("[contact] model = \"deformable\": {0}")]
    Solid(#[from] SolidError),
    /// An insert that cannot be used.
    #[error("the insert cannot be used: {0}")]
    Insert(#[from] InsertError),
    /// Axes that do not form a right-handed frame.
    #[error("`axes`: {0}")]
    Axes(#[from] AxesError),
    /// Settings that cannot be combined.
    #[error("{message}")]
    Conflict {
        /// Table of the setting at fault.
        table: &'static str,
        /// Keys that may be at fault, the likeliest first.
        keys: &'static [&'static str],
        /// Cause and remedy.
        message: String,
    },
    /// A mesh that cannot be used.
    #[error("{}: {fault}", file.display())]
    Mesh {
        /// The file.
        file: PathBuf,
        /// The fault.
        fault: MeshFault,
    },
}

impl BuildError {
    pub(super) fn mesh(file: &Path, fault: MeshFault) -> Self {
        let file = file.to_path_buf();
        Self::Mesh { file, fault }
    }

    /// Returns the mesh file at fault.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::MeshFile(error) => error.path(),
            Self::Mesh { file, .. } => Some(file),
            _ => None,
        }
    }

    /// Returns the keys of the body's table that may be at fault, the likeliest first.
    pub(in crate::case) fn keys(&self) -> &'static [&'static str] {
        match self {
            Self::MeshFile(_) => &["file"],
            Self::Insert(InsertError::TooManyNodes(_)) => &["edge_mm", "layers"],
            Self::Insert(_) | Self::Solid(_) => {
                &["backside", "articulating_surface", "file", "edge_mm"]
            }
            Self::Axes(_) => &["axes"],
            Self::Conflict { keys, .. } => keys,
            Self::Mesh { fault, .. } => fault.keys(),
        }
    }
}

/// A mesh that cannot be used.
#[derive(Debug, Error)]
pub enum MeshFault {
    /// A body that is too small or too large for a knee.
    #[error(
        "the body is {} mm long, and a knee's is 5 mm to 500 mm; {}",
        rounded(*size_mm),
        in_better_unit(*better)
    )]
    Size {
        /// Its longest extent along an axis, mm.
        size_mm: f64,
        /// The unit of length that makes it as long as a knee's, and its length then, mm.
        better: Option<(LengthUnit, f64)>,
    },
    /// A body of a whole knee that another unit makes as large as a knee's.
    #[error(
        "this {body} is {} mm long, and that of a whole knee is 40 mm to 120 mm; {}",
        rounded(*size_mm),
        in_better_unit(Some(*better))
    )]
    WrongUnit {
        /// The body.
        body: Body,
        /// Its longest extent along an axis, mm.
        size_mm: f64,
        /// The unit of length that makes it as long as a knee's, and its length then, mm.
        better: (LengthUnit, f64),
    },
    /// A body whose orientation certainly differs from its axes.
    #[error("this {} lies {}; {wrong}", wrong.body, wrong.how)]
    WrongAxes {
        /// Its orientation.
        wrong: WrongAxes,
    },
    /// A piece so far from the body that the whole is too large for a knee.
    #[error("{0}, too far for a knee; delete it")]
    StrayPiece(StrayPiece),
    /// A femur so large that its distance field exceeds the memory.
    #[error(
        "the distance field would have {nodes} nodes, and more than {most} take more than the {memory_gb} GB that [limits] \
         memory_gb allows; cut away what never touches the insert, check length_unit, or allow more"
    )]
    TooManyNodes {
        /// Nodes of the field.
        nodes: usize,
        /// Nodes that the memory allows.
        most: usize,
        /// Memory that the case allows.
        memory_gb: f64,
    },
    /// Triangles that do not form a shell.
    #[error("{0}")]
    Shell(RepairError),
    /// A height of the cut that is outside the body.
    #[error(
        "`clip_below_mm` = {height_mm} cuts nothing off or all: with its axes turned, the body reaches from y = {low_mm:.2} mm to {high_mm:.2} mm"
    )]
    ClipMisses {
        /// The height.
        height_mm: f64,
        /// The lowest point of the body.
        low_mm: f64,
        /// The highest point of the body.
        high_mm: f64,
    },
    /// An insert in one piece with its tray or stem, whose boundary the shape does not show.
    #[error(
        "this body reaches {reach_mm:.1} mm below its dishes, as an insert does that is one with its tray or stem, and \
         its shape does not show for certain where the polyethylene ends; write [insert] {heights}"
    )]
    UnclearUnderside {
        /// Its reach below the dishes, mm.
        reach_mm: f64,
        /// The heights to choose from, in words.
        heights: String,
    },
    /// A shell that cannot be meshed as an insert.
    #[error("{0}")]
    ShellInsert(InsertError),
    /// A hole or a post at which the femur presses.
    #[error(
        "the femur presses on the insert at a {hole}, {when}, where its surface is made up; fill the hole in the mesh, \
         or see that the bodies lie as they should"
    )]
    PressedHole {
        /// The hole.
        hole: Hole,
        /// The stage of the run.
        when: &'static str,
    },
    /// A thickness for a mesh that has its own.
    #[error("the mesh is closed and has a thickness of its own; remove [insert] `thickness_mm`")]
    ThicknessOfClosed,
    /// A surface that is not in the file.
    #[error("there is no surface \"{name}\"; it has {}", listed(names))]
    NoSurface {
        /// The key that names it.
        key: &'static str,
        /// The name that the case gives.
        name: String,
        /// The names in the file.
        names: Vec<String>,
    },
}

impl MeshFault {
    fn keys(&self) -> &'static [&'static str] {
        match self {
            Self::ShellInsert(
                InsertError::TooManyNodes(_)
                | InsertError::Columns(
                    ColumnError::NoColumns { .. }
                    | ColumnError::TooCoarse { .. }
                    | ColumnError::TooManyNodes(_),
                ),
            ) => &["edge_mm", "file"],
            Self::StrayPiece(_)
            | Self::Shell(_)
            | Self::ShellInsert(_)
            | Self::PressedHole { .. } => &["file"],
            Self::Size { .. } | Self::WrongUnit { .. } | Self::TooManyNodes { .. } => {
                &["length_unit", "file"]
            }
            Self::ClipMisses { .. } => &["clip_below_mm"],
            Self::UnclearUnderside { .. } => &["clip_below_mm", "file"],
            Self::ThicknessOfClosed => &["thickness_mm"],
            Self::NoSurface {
                key: "backside", ..
            } => &["backside"],
            Self::NoSurface { .. } => &["articulating_surface"],
            Self::WrongAxes { .. } => &["axes", "file"],
        }
    }
}

/// Formats sizes from nanometres to kilometres with three digits.
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

fn off_origin(anterior_mm: f64, lateral_mm: f64) -> String {
    let (along, across) = (anterior_mm.abs(), lateral_mm.abs());
    let (front, side) = (
        if anterior_mm < 0.0 {
            "posterior"
        } else {
            "anterior"
        },
        if lateral_mm < 0.0 {
            "medial"
        } else {
            "lateral"
        },
    );
    format!("{along:.1} mm {front} and {across:.1} mm {side} of the origin")
}

fn listed(names: &[String]) -> String {
    if names.is_empty() {
        "none".to_owned()
    } else {
        names.join(", ")
    }
}

/// A remark on a case or its meshes, to be shown to the user.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum BuildWarning {
    /// A key that does not apply to a choice set from outside.
    #[error("{written}: left out, since it does not go with {chosen}, which is set")]
    LeftOutKey {
        /// The key with its value, or the table.
        written: String,
        /// The choice with its word.
        chosen: String,
    },
    /// A key under a name that it had in the previous version.
    #[error("`{old}` is called `{new}`; the next version does not read the old name")]
    RenamedKey {
        /// The old dotted path.
        old: &'static str,
        /// The new one.
        new: &'static str,
    },
    /// A repair or a suspicious property of a mesh.
    #[error("{}: {remark}", file.display())]
    Mesh {
        /// The file, without its folder: results repeat the remark, and name no folder.
        file: PathBuf,
        /// The remark.
        remark: MeshRemark,
    },
}

/// A repair or a suspicious property of a mesh.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum MeshRemark {
    /// A body whose orientation likely differs from its axes.
    #[error("this {} likely lies {}; {wrong}", wrong.body, wrong.how)]
    WrongAxes {
        /// Its orientation.
        wrong: WrongAxes,
    },
    /// A femur that looks like one of the other knee.
    #[error(
        "the flange of the trochlea that side = \"{}\" makes the medial one stands out {} mm beyond the lateral one, \
         as in a {} knee; write side = \"{}\", or see that the axes and the files are of one knee",
        side.word(),
        rounded(*lead_mm),
        side.other().word(),
        side.other().word()
    )]
    OtherSide {
        /// The side of the case.
        side: Side,
        /// Distance by which the medial flange stands out beyond the lateral one, mm.
        lead_mm: f64,
    },
    /// A body of a whole knee that is too small or too large for one in any unit.
    #[error(
        "this {body} is {} mm long, and that of a whole knee is 40 mm to 120 mm; check length_unit",
        rounded(*size_mm)
    )]
    UnusualSize {
        /// The body.
        body: Body,
        /// Its longest extent along an axis, mm.
        size_mm: f64,
    },
    /// The dishes of an insert lie off the origin, where the machine's axes are.
    #[error(
        "the dishes have their middle {}, where the machine's axes are; up to {} mm in front or behind and {} mm \
         to a side would be sound; write origin = \"centre\" in [insert], or move the file's origin",
        off_origin(*anterior_mm, *lateral_mm),
        most_mm.0,
        most_mm.1
    )]
    OffCentre {
        /// Distance anterior of the origin, mm.
        anterior_mm: f64,
        /// Distance lateral of it, mm.
        lateral_mm: f64,
        /// Largest sound distances to the front or back, and to a side, mm.
        most_mm: (f64, f64),
    },
    /// Part of the mesh lies far from the rest.
    #[error("{0}; delete it unless it is part of it")]
    StrayPiece(StrayPiece),
    /// Parts of the file that do not belong to the insert.
    #[error("left out, since they are no part of the insert: {}", parts_listed(.0))]
    LeftOut(Vec<LeftOut>),
    /// An insert that was cut off the tray in its file.
    #[error(
        "this body reaches {reach_mm:.1} mm below its dishes, as an insert does that is one with its tray or stem; it is cut \
         at the ledge at y = {height_mm:.2} mm, which leaves {below_dishes_mm:.2} mm of polyethylene below the dishes; write \
         clip_below_mm = {height_mm:.2} in [insert] if that is right, or the right height"
    )]
    CutOffTray {
        /// Height of the cut, mm.
        height_mm: f64,
        /// Polyethylene that is left below the dishes, mm.
        below_dishes_mm: f64,
        /// Reach of the body below its dishes, mm.
        reach_mm: f64,
    },
    /// Holes and posts inside the outline of an insert, over which hexahedra stand.
    #[error(
        "the surface is taken to go on smoothly over a {}; nothing may press there or within {beside_mm} mm, which a run \
         makes sure of",
        listed_holes(holes)
    )]
    Bridged {
        /// The holes.
        holes: Vec<Hole>,
        /// Pressure no farther from them than this counts as pressure on them, mm.
        beside_mm: f64,
    },
    /// The mesh came inside-out.
    #[error("the triangles faced inwards and were turned round")]
    TurnedRound,
    /// So many triangles faced the other way than their neighbours.
    #[error("{0} triangles were turned to face as their neighbours do")]
    MadeConsistent(usize),
    /// So many pairs of neighbouring triangles cross a little.
    #[error("{0} pairs of neighbouring triangles cross a little; they are left as they are")]
    Wrinkles(usize),
    /// So many triangles had no area.
    #[error("{0} triangles without area were left out")]
    RemovedDegenerate(usize),
    /// Defects that were repaired, or left because nothing touches there.
    #[error("defects that contact does not feel: {}", defects_listed(.0))]
    Defects(Vec<Defect>),
}

impl BuildWarning {
    pub(super) fn mesh(file: &DataFile, remark: MeshRemark) -> Self {
        let file = PathBuf::from(file.name());
        Self::Mesh { file, remark }
    }

    /// Returns the hole of an insert that a place (x, z), mm, is in or next to, over which its surface is made up.
    pub fn hole_at(&self, place_mm: [f64; 2]) -> Option<&Hole> {
        let Self::Mesh {
            remark: MeshRemark::Bridged { holes, beside_mm },
            ..
        } = self
        else {
            return None;
        };
        holes
            .iter()
            .find(|hole| hole.distance_mm(place_mm) <= *beside_mm)
    }
}

const LISTED_PARTS: usize = 5;

/// Lists the first parts, each with its size, its place and the reason.
fn parts_listed(parts: &[LeftOut]) -> String {
    let said = parts.iter().take(LISTED_PARTS).map(|part| {
        let why = match part.why {
            WhyLeftOut::Below => "below it",
            WhyLeftOut::Speck => "beside it",
        };
        let ([x, y, z], [long, high, wide]) = (part.at_mm.into(), part.size_mm.into());
        format!(
            "{} triangles {why} around ({x:.1}, {y:.1}, {z:.1}) mm, {long:.1} mm long, {high:.1} mm high and {wide:.1} mm wide",
            part.triangles
        )
    });
    let mut said: Vec<String> = said.collect();
    if parts.len() > LISTED_PARTS {
        said.push(format!("{} more", parts.len() - LISTED_PARTS));
    }
    said.join("; ")
}

fn defects_listed(defects: &[Defect]) -> String {
    let said: Vec<String> = defects
        .iter()
        .map(|defect| defect.listed_with_repair(3))
        .collect();
    said.join("; ")
}
