//! Why a good case makes no wear test.

use std::fmt;
use std::path::{Path, PathBuf};

use condyle::Vec3;
use condyle::anatomy::Recognition;
use condyle::geometry::{InsertError, TriangleMesh};
use condyle_fem::SolidError;
use condyle_mesh::columns::{Hole, listed_holes};
use condyle_mesh::repair::{Defect, LeftOut, RepairError, WhyLeftOut};
use thiserror::Error;

use super::super::frame::{Axes, AxesError, LengthUnit, Side};
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
    /// What the body lies like, from triangles in any frame and unit.
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

/// A body that lies otherwise than its axes say.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WrongAxes {
    /// Which.
    pub body: Body,
    /// How it lies in the case's frame, such as "upside down".
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
    /// How many triangles it has.
    pub triangles: usize,
    /// Its middle, mm, in the frame of the body.
    pub at_mm: Vec3,
    /// How far its box is from that of the body, mm.
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

/// Why a good case makes no wear test.
#[derive(Debug, Error)]
pub enum BuildError {
    /// A mesh file that cannot be read.
    #[error(transparent)]
    MeshFile(#[from] MeshFileError),
    /// An insert that is no elastic solid.
    #[error("[contact] model = \"deformable\": {0}")]
    Solid(#[from] SolidError),
    /// Friction that remembers in steps that are not solved.
    #[error(
        "[contact] friction_model = \"stick-slip\" goes from one solved increment to the next, and [time] integrator = \
         \"explicit\" solves none; take integrator = \"implicit\", or friction_model = \"regularised\""
    )]
    StickSlipExplicit,
    /// A backside that goes on from increment to increment in steps that are not solved.
    #[error(
        "[contact] backside = \"resting\" goes from one solved increment to the next, and [time] integrator = \"explicit\" \
         solves none; take integrator = \"implicit\", or backside = \"bonded\""
    )]
    RestingExplicit,
    /// A backside that is not flat enough to rest.
    #[error(
        "[contact] backside = \"resting\" needs a flat backside, and {percent:.0} % of this insert's lies in a plane; take \
         backside = \"bonded\", or give an insert with a flat backside"
    )]
    BacksideNotFlat {
        /// How much of it is flat, %.
        percent: f64,
    },
    /// A backside that rests under an insert that yields or sticks and slips.
    #[error(
        "[contact] backside = \"resting\" does not go with {beside}: what that is computed from belongs to an insert that is \
         bonded to its tray; take one of them alone"
    )]
    RestingBeside {
        /// The key and its word.
        beside: &'static str,
    },
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
        "{}: the distance field would have {nodes} nodes, and more than {most} take more than the \
         {memory_gb} GB that [limits] memory_gb allows; cut away what never touches the insert, check length_unit, or \
         allow more",
        file.display()
    )]
    TooManyNodes {
        /// The file.
        file: PathBuf,
        /// How many.
        nodes: usize,
        /// How many there may be.
        most: usize,
        /// Memory that the case allows.
        memory_gb: f64,
    },
    /// An insert of so many nodes that a run would not fit into memory.
    #[error(
        "the insert would have {nodes:.0} nodes, and more than {most} take more than the {memory_gb} GB that [limits] \
         memory_gb allows; use a larger edge_mm or fewer layers, check length_unit, or allow more"
    )]
    InsertTooFine {
        /// How many.
        nodes: f64,
        /// How many there may be.
        most: usize,
        /// Memory that the case allows.
        memory_gb: f64,
    },
    /// Triangles that are no shell.
    #[error("{}: {source}", file.display())]
    Shell {
        /// The file.
        file: PathBuf,
        /// Why.
        source: RepairError,
    },
    /// A height to cut at that the body does not pass.
    #[error(
        "{}: `clip_below_mm` = {height_mm} cuts nothing off or all: with its axes turned, the body reaches from y = {low_mm:.2} mm to {high_mm:.2} mm",
        file.display()
    )]
    ClipMisses {
        /// The file.
        file: PathBuf,
        /// The height.
        height_mm: f64,
        /// The lowest point of the body.
        low_mm: f64,
        /// The highest point of the body.
        high_mm: f64,
    },
    /// An insert in one with what it stands on, whose shape does not show where it ends.
    #[error(
        "{}: this body reaches {reach_mm:.1} mm below its dishes, as an insert does that is one with its tray or stem, and \
         its shape does not show for certain where the polyethylene ends; write [insert] {heights}",
        file.display()
    )]
    UnclearUnderside {
        /// The file.
        file: PathBuf,
        /// How far it reaches below its dishes, mm.
        reach_mm: f64,
        /// Which heights may be meant, in words.
        heights: String,
    },
    /// A shell that makes no insert.
    #[error("{}: {source}", file.display())]
    ShellInsert {
        /// The file.
        file: PathBuf,
        /// Why.
        source: InsertError,
    },
    /// A hole or a post at which the femur presses.
    #[error(
        "{}: the femur presses on the insert at a {hole}, {when}, where its surface is made up; fill the hole in the mesh, \
         or see that the bodies lie as they should",
        file.display()
    )]
    PressedHole {
        /// The file.
        file: PathBuf,
        /// Which.
        hole: Hole,
        /// When it was found.
        when: &'static str,
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
            | Self::ClipMisses { file, .. }
            | Self::UnclearUnderside { file, .. }
            | Self::ShellInsert { file, .. }
            | Self::PressedHole { file, .. }
            | Self::ThicknessOfClosed { file }
            | Self::NoSurface { file, .. } => Some(file),
            Self::InsertTooFine { .. }
            | Self::Insert(_)
            | Self::Axes(_)
            | Self::Solid(_)
            | Self::StickSlipExplicit
            | Self::RestingExplicit
            | Self::BacksideNotFlat { .. }
            | Self::RestingBeside { .. } => None,
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

/// What was put right in a mesh, or looks wrong.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum BuildWarning {
    /// A constant of another wear law than the one chosen from outside.
    #[error("[wear] {written}: left out, since the law \"{law}\" that is set has no such constant")]
    ConstantLeftOut {
        /// As the file writes it.
        written: String,
        /// The law chosen from outside.
        law: &'static str,
    },
    /// A body that likely lies otherwise than its axes say.
    #[error("{}: this {} likely lies {}; {wrong}", file.display(), wrong.body, wrong.how)]
    WrongAxes {
        /// The file, without its folder.
        file: PathBuf,
        /// How it lies.
        wrong: WrongAxes,
    },
    /// A femur that looks like one of the other knee.
    #[error(
        "{}: the flange of the trochlea that side = \"{}\" makes the medial one stands out {} mm beyond the lateral one, \
         as in a {} knee; write side = \"{}\", or see that the axes and the files are of one knee",
        file.display(),
        side.word(),
        rounded(*lead_mm),
        side.other().word(),
        side.other().word()
    )]
    OtherSide {
        /// The file, without its folder.
        file: PathBuf,
        /// The side that the case says.
        side: Side,
        /// How far the medial flange stands out beyond the lateral one, mm.
        lead_mm: f64,
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
    /// The dishes of an insert lie off the origin, where the machine's axes are.
    #[error(
        "{}: the dishes have their middle {}, where the machine's axes are; up to {} mm in front or behind and {} mm \
         to a side would be sound; write origin = \"centre\" in [insert], or move the file's origin",
        file.display(),
        off_origin(*anterior_mm, *lateral_mm),
        most_mm.0,
        most_mm.1
    )]
    OffCentre {
        /// The file, without its folder.
        file: PathBuf,
        /// How far anterior of the origin, mm.
        anterior_mm: f64,
        /// How far lateral of it, mm.
        lateral_mm: f64,
        /// How far they may lie to the front or back, and to a side, mm.
        most_mm: (f64, f64),
    },
    /// Part of the mesh lies far from the rest.
    #[error("{}: {piece}; delete it unless it is part of it", file.display())]
    StrayPiece {
        /// The file.
        file: PathBuf,
        /// The piece.
        piece: StrayPiece,
    },
    /// Parts of the file that are not of the insert.
    #[error("{}: left out, since they are no part of the insert: {}", file.display(), parts_listed(parts))]
    LeftOut {
        /// The file, without its folder.
        file: PathBuf,
        /// What they are.
        parts: Vec<LeftOut>,
    },
    /// An insert that was cut off the tray that its file holds too.
    #[error(
        "{}: this body reaches {reach_mm:.1} mm below its dishes, as an insert does that is one with its tray or stem; it is cut \
         at the ledge at y = {height_mm:.2} mm, which leaves {below_dishes_mm:.2} mm of polyethylene below the dishes; write \
         clip_below_mm = {height_mm:.2} in [insert] if that is right, or the right height",
        file.display()
    )]
    CutOffTray {
        /// The file, without its folder.
        file: PathBuf,
        /// Height of the cut, mm.
        height_mm: f64,
        /// Polyethylene that is left below the dishes, mm.
        below_dishes_mm: f64,
        /// How far the body reaches below its dishes, mm.
        reach_mm: f64,
    },
    /// Holes and posts inside the outline of an insert, over which hexahedra stand.
    #[error(
        "{}: the surface is taken to go on smoothly over a {}; nothing may press there or within {beside_mm} mm, which a run \
         makes sure of",
        file.display(),
        listed_holes(holes)
    )]
    Bridged {
        /// The file, without its folder.
        file: PathBuf,
        /// Where they are.
        holes: Vec<Hole>,
        /// What is pressed no farther from them than this is pressed beside them, mm.
        beside_mm: f64,
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
    /// What was mended, and what was left because nothing touches there.
    #[error("{}: defects that contact does not feel: {}", file.display(), defects_listed(defects))]
    Defects {
        /// The file, without its folder.
        file: PathBuf,
        /// Kinds, counts and places, mm in the frame of the body.
        defects: Vec<Defect>,
    },
}

impl BuildWarning {
    /// The hole of an insert that a place (x, z) is in or beside, mm, over which its surface is made up.
    pub fn hole_at(&self, place_mm: [f64; 2]) -> Option<&Hole> {
        let Self::Bridged {
            holes, beside_mm, ..
        } = self
        else {
            return None;
        };
        holes
            .iter()
            .find(|hole| hole.distance_mm(place_mm) <= *beside_mm)
    }
}

/// Parts that are listed one by one, at most.
const LISTED_PARTS: usize = 5;

/// The first parts, each with its size and place, and why it is none of the insert.
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

/// Kinds and counts, with the first three places of each.
fn defects_listed(defects: &[Defect]) -> String {
    let said: Vec<String> = defects
        .iter()
        .map(|defect| defect.listed_with_repair(3))
        .collect();
    said.join("; ")
}
