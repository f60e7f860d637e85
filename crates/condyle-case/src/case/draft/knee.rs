//! Side and origin of a draft.

use std::path::PathBuf;

use condyle::anatomy::flange_lead_mm;
use condyle::geometry::TriangleMesh;
use condyle_mesh::repair::RepairError;
use thiserror::Error;

use crate::case::build::{Body, MAX_ACROSS_MM, middle_of_mesh};
use crate::case::frame::Side;
use crate::config::Problems;
use condyle_mesh::formats::MeshFileError;

/// The side of the knee and the reason for it.
pub(super) struct ConcludedSide {
    pub side: Side,
    pub remark: String,
}

impl ConcludedSide {
    /// Concludes the side from a femur with x anterior, y superior, z right; `said` is the side that the user states.
    pub fn of(femur: &TriangleMesh, said: Option<Side>) -> Self {
        let shown = flange_lead_mm(femur).map(|lead| {
            let side = if lead > 0.0 { Side::Right } else { Side::Left };
            (side, lead.abs())
        });
        let side = said.or(shown.map(|(side, _)| side)).unwrap_or(Side::Right);
        let of_shape = match shown {
            Some((shown, lead_mm)) => format!(
                "likely a {} knee, since one flange of the trochlea stands out by {lead_mm:.1} mm there",
                shown.word()
            ),
            None => "not told by the shape, of which both sides are alike".to_owned(),
        };
        let why = match said {
            Some(_) => "as it was said",
            None if shown.is_some() => "check it",
            None => "assumed: check it",
        };
        let remark = format!("  side \"{}\", {why}; {of_shape}.", side.word());
        Self { side, remark }
    }
}

/// Distance along x from the dishes' middle beyond which an origin is not that of a machine, mm.
const FAR_ALONG_MM: f64 = 20.0;

/// The origin of an insert frame.
pub(super) struct ConcludedOrigin {
    pub key: &'static str,
    pub remark: Option<String>,
}

impl ConcludedOrigin {
    /// Returns the origin of the file, unless the dishes lie off it; then the insert is moved so that the origin lies
    /// between the dishes.
    pub fn centred(insert: &mut TriangleMesh) -> Self {
        let middle = middle_of_mesh(insert);
        // The lowest place of flat dishes along x is uncertain: only a distant one indicates another origin.
        let is_far = middle.z.abs() > MAX_ACROSS_MM || middle.x.abs() > FAR_ALONG_MM;
        if !is_far {
            return Self {
                key: "",
                remark: None,
            };
        }
        *insert = std::mem::take(insert).mapped(|vertex| vertex - middle);
        let remark = format!(
            "  origin \"centre\", since the file has its own {:.0} mm from the middle of the dishes.",
            middle.norm()
        );
        Self {
            key: "origin = \"centre\"\n",
            remark: Some(remark),
        }
    }
}

/// A draft that cannot be made.
#[derive(Debug, Error)]
pub enum DraftError {
    /// A file that cannot be read.
    #[error(transparent)]
    MeshFile(#[from] MeshFileError),
    /// Triangles that do not form a shell.
    #[error("{}: {source}", file.display())]
    Shell {
        /// The file.
        file: PathBuf,
        /// The defect.
        source: RepairError,
    },
    /// A body that no unit makes as large as a knee's.
    #[error(
        "{}: this {body} is {size:.4} long in the unit of the file, and none of mm, cm, m and in makes it \
         40 mm to 120 mm long, as that of a whole knee is; scale it, or write the case by hand",
        file.display()
    )]
    NoUnit {
        /// The file.
        file: PathBuf,
        /// The body.
        body: Body,
        /// Its longest extent, in the unit of the file.
        size: f64,
    },
    /// The draft is not a valid case.
    #[error(transparent)]
    Case(#[from] Problems),
}
