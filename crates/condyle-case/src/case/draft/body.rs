//! The bodies of a draft: unit, orientation and outline that their shapes show.

use std::path::{Path, PathBuf};

use condyle::Mat3;
use condyle::anatomy::{Orientation, Recognition, Sureness};
use condyle::geometry::{TriangleMesh, Underside};
use condyle_mesh::repair::{CheckedMesh, RepairError};

use super::knee::DraftError;
use crate::case::build::{
    Body, checks_of, cut_at, heights_to_write, longest_mm, rounded_up, usual_unit,
};
use crate::case::frame::{Axes, LengthUnit};
use condyle_mesh::files::Disk;
use condyle_mesh::formats::{parse_surface, surface_bytes};

/// A body of the draft, with the conclusions from its shape.
pub(super) struct Concluded<'a> {
    body: Body,
    pub file: PathBuf,
    written: &'a Path,
    mesh: TriangleMesh,
    pub unit: LengthUnit,
    recognition: Option<Recognition>,
}

impl<'a> Concluded<'a> {
    pub fn from(body: Body, written: &'a Path) -> Result<Self, DraftError> {
        let file = std::path::absolute(written).unwrap_or_else(|_| written.to_path_buf());
        let mesh = parse_surface(&file, &surface_bytes(&Disk, &file)?)?;
        let size = longest_mm(&mesh);
        let Some((unit, _)) = usual_unit(size) else {
            return Err(DraftError::NoUnit { file, body, size });
        };
        let mesh = mesh.mapped(|vertex| vertex * unit.in_mm());
        let recognition = match (body, body.recognise(&mesh)) {
            (Body::Insert, None) => recognised_alone(&mesh),
            (_, recognition) => recognition,
        };
        Ok(Self {
            body,
            file,
            written,
            recognition,
            mesh,
            unit,
        })
    }

    /// Returns the orientations that agree with its shape, best first.
    pub fn best(&self) -> Vec<Orientation> {
        self.recognition
            .iter()
            .flat_map(Recognition::best)
            .collect()
    }

    /// Returns its orientation: that of the other body if its own shape permits it, since the files of one implant
    /// mostly share their axes.
    pub fn orientation(&self, of_other: &[Orientation]) -> Orientation {
        let Some(recognition) = &self.recognition else {
            return of_other.first().copied().unwrap_or(Orientation::ISB);
        };
        let shared = recognition.best().find(|best| of_other.contains(best));
        shared.unwrap_or_else(|| recognition.nearest())
    }

    fn placed(&self, lies: &Orientation) -> TriangleMesh {
        let rotation: Mat3 = lies.rotation();
        self.mesh.clone().mapped(|vertex| rotation * vertex)
    }

    /// Returns the mesh, repaired and checked as in a run.
    pub fn shell(&self, lies: &Orientation) -> Result<CheckedMesh, DraftError> {
        checks_of(self.body)
            .check(self.placed(lies))
            .map_err(|source| self.refused(source))
    }

    pub fn refused(&self, source: RepairError) -> DraftError {
        DraftError::Shell {
            file: self.file.clone(),
            source,
        }
    }

    pub fn remarks(&self, lies: &Orientation, shell: &CheckedMesh) -> Vec<String> {
        let (low, high) = shell.mesh.bounds();
        let size = high - low;
        let mut remarks = vec![
            format!(
                "{}, concluded from the shape of {}:",
                self.body,
                self.written.display()
            ),
            format!(
                "  length_unit \"{}\", which makes it {:.1} mm from back to front, {:.1} mm high and {:.1} mm wide;",
                self.unit.word(),
                size.x,
                size.y,
                size.z
            ),
            format!("  axes {}.", self.how_sure(lies)),
        ];
        if self.body == Body::Femur {
            let start = "  start_mm: the lowest points of the condyles over those of the dishes.";
            remarks.push(start.to_owned());
        } else if !shell.closed {
            let thickness =
                "  The surface is open: thickness_mm is assumed, write that of the insert.";
            remarks.push(thickness.to_owned());
        }
        remarks
    }

    fn how_sure(&self, lies: &Orientation) -> String {
        let Some(recognition) = &self.recognition else {
            return "could not be told, since the shape is not that of a whole knee: check them"
                .to_owned();
        };
        match recognition.sureness() {
            Some(Sureness::Certain) => "for certain".to_owned(),
            Some(Sureness::Likely) => {
                "likely, since one sign of the shape tells back from front: check them".to_owned()
            }
            None => {
                let others = recognition.best().filter(|other| other != lies);
                let others: Vec<String> = others
                    .map(|other| format!("{:?}", Axes::of(&other.rotation()).words()))
                    .collect();
                format!(
                    "not for certain, since {} fits about as well: check them",
                    others.join(" or ")
                )
            }
        }
    }
}

/// An insert without the tray that may be in its file.
pub(super) struct Alone {
    pub shell: CheckedMesh,
    underside: Underside,
}

impl Alone {
    pub fn of(whole: CheckedMesh) -> Result<Self, RepairError> {
        let underside = if whole.closed {
            Underside::find(&whole.mesh)
        } else {
            Underside::Whole
        };
        let shell = match &underside {
            Underside::Ledge { height_mm, .. } => cut_at(whole, rounded_up(*height_mm))?,
            Underside::Whole | Underside::Unclear { .. } => whole,
        };
        Ok(Self { shell, underside })
    }

    fn is_part(&self) -> bool {
        matches!(self.underside, Underside::Ledge { .. }) || !self.shell.left_out.is_empty()
    }

    /// Returns the height at which it is cut.
    pub fn key(&self) -> String {
        match &self.underside {
            Underside::Ledge { height_mm, .. } => {
                format!("clip_below_mm = {:?}\n", rounded_up(*height_mm))
            }
            _ => String::new(),
        }
    }

    pub fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        let parts = self.shell.left_out.len();
        if parts > 0 {
            remarks.push(format!(
                "  The file has {parts} more parts, below the insert or beside it: they are left out."
            ));
        }
        match &self.underside {
            Underside::Whole => {}
            Underside::Ledge {
                below_dishes_mm,
                reach_mm,
                ..
            } => remarks.push(format!(
                "  clip_below_mm: the body reaches {reach_mm:.1} mm below its dishes, as with a tray or stem; cut at the ledge \
                 around it, {below_dishes_mm:.2} mm of polyethylene are left below the dishes: check it."
            )),
            Underside::Unclear {
                reach_mm,
                plate_mm,
                ledges_mm,
            } => remarks.push(format!(
                "  The body reaches {reach_mm:.1} mm below its dishes, as with a tray or stem, and does not show where the \
                 polyethylene ends: write {}.",
                heights_to_write(*plate_mm, ledges_mm)
            )),
        }
        remarks
    }
}

/// Recognises an insert that forms one body with its tray, whose shape is not that of an insert: the tray is cut off
/// for every orientation in turn, until the remaining body is an insert in that orientation.
pub(super) fn recognised_alone(mesh: &TriangleMesh) -> Option<Recognition> {
    Orientation::all().find_map(|lies| {
        let rotation: Mat3 = lies.rotation();
        let placed = mesh.clone().mapped(|vertex| rotation * vertex);
        let alone = Alone::of(checks_of(Body::Insert).check(placed).ok()?).ok()?;
        if !alone.is_part() {
            return None;
        }
        let lies_so = Body::Insert.recognise(&alone.shell.mesh)?.nearest() == Orientation::ISB;
        let back = || {
            alone
                .shell
                .mesh
                .mapped(|vertex| rotation.transpose() * vertex)
        };
        lies_so
            .then(back)
            .and_then(|mesh| Body::Insert.recognise(&mesh))
    })
}
