//! A case drafted from two mesh files: unit, axes, side, origin and start are concluded from the shapes.

use std::path::{Path, PathBuf};

use condyle::anatomy::{
    Orientation, Recognition, Sureness, flange_lead_mm, start_over_the_dishes_mm,
};
use condyle::geometry::{GenericInsertShape, TriangleMesh, Underside};
use condyle_mesh::files::Disk;
use condyle_mesh::formats::{parse_surface, surface_bytes};
use condyle_mesh::repair::{CheckedMesh, RepairError};
use thiserror::Error;

use super::build::{
    Body, BuildError, MAX_ACROSS_MM, checks_of, cut_at, heights_to_write, longest_mm,
    middle_of_mesh, rounded_up, usual_unit,
};
use super::contents::Case;
use super::frame::{Axes, LengthUnit, Side};
use super::machine::Preset;
use crate::config::{Problems, quoted};

/// Distance along x from the dishes' middle beyond which an origin is not that of a machine, mm.
const MAX_ALONG_MM: f64 = 20.0;

/// A case drafted from meshes.
#[derive(Clone, Debug)]
pub struct Drafted {
    /// The case file, with the conclusions and their certainty as remarks.
    pub text: String,
    /// The conclusions, one per line.
    pub remarks: Vec<String>,
}

impl Drafted {
    /// Drafts the case of two meshes, to be kept in `folder`; the insert may be closed or an open articulating surface.
    /// Without a side, the shape of the femur determines it.
    ///
    /// # Errors
    /// A file that cannot be read, does not form a shell, or does not have the size of a part of a knee.
    pub fn new(
        preset: Preset,
        side: Option<Side>,
        [femur, insert]: [&Path; 2],
        folder: &Path,
    ) -> Result<Self, DraftError> {
        let femur = Concluded::from(Body::Femur, femur)?;
        let insert = Concluded::from(Body::Insert, insert)?;
        let femur_lies = femur.orientation(&insert.best());
        let insert_lies = insert.orientation(&[femur_lies]);
        let (femur_shell, whole) = (femur.shell(&femur_lies)?, insert.shell(&insert_lies)?);
        let mut alone =
            Alone::of(whole).map_err(|error| BuildError::shell(&insert.file, &error))?;
        let mut of_insert = insert.remarks(&insert_lies, &alone.shell);
        let mut insert_keys = insert.keys(&insert_lies);
        of_insert.extend(alone.remarks());
        if !alone.shell.closed {
            let thickness_mm = GenericInsertShape::default().thickness_mm;
            insert_keys += &format!("thickness_mm = {thickness_mm:?}\n");
        }
        if let Underside::Ledge { height_mm, .. } = &alone.underside {
            insert_keys += &format!("clip_below_mm = {:?}\n", rounded_up(*height_mm));
        }
        let middle = middle_of_mesh(&alone.shell.mesh);
        // The lowest place of flat dishes along x is uncertain: only a distant one indicates another origin.
        if middle.z.abs() > MAX_ACROSS_MM || middle.x.abs() > MAX_ALONG_MM {
            alone.shell.mesh = alone.shell.mesh.mapped(|vertex| vertex - middle);
            insert_keys += "origin = \"centre\"\n";
            of_insert.push(format!(
                "  origin \"centre\", since the file has its own {:.0} mm from the middle of the dishes.",
                middle.norm()
            ));
        }
        let (side, of_side) = with_reason(side, &femur_shell.mesh);
        let mut of_femur = femur.remarks(&femur_lies, &femur_shell);
        of_femur.push(of_side);
        let machine = format!("[machine]\npreset = \"{}\"\n", preset.word());
        let flexion_rad = Case::parse(&machine, "machine", Path::new(""))?.start_flexion_rad();
        let start = start_over_the_dishes_mm(&femur_shell.mesh, &alone.shell.mesh, flexion_rad);
        let (x, z) = start.unwrap_or_default();
        let keys = format!(
            "title = \"Untitled\"\nside = \"{}\"\n{}start_mm = [{x:.1}, {z:.1}]\n{insert_keys}{machine}",
            side.word(),
            femur.keys(&femur_lies)
        );
        let mut text = Case::parse(&keys, "draft", folder)?.as_draft_in(folder);
        for (table, remarks) in [("[femur]\n", &of_femur), ("[insert]\n", &of_insert)] {
            let lines: String = remarks.iter().map(|line| format!("# {line}\n")).collect();
            text = text.replacen(&format!("\n{table}"), &format!("\n{lines}{table}"), 1);
        }
        let remarks = [of_femur, of_insert].concat();
        Ok(Self { text, remarks })
    }
}

/// Returns the side of the knee of a femur with x anterior, y superior, z right, and the reason for it.
fn with_reason(given: Option<Side>, femur: &TriangleMesh) -> (Side, String) {
    let shown = flange_lead_mm(femur).map(|lead| {
        let side = if lead > 0.0 { Side::Right } else { Side::Left };
        (side, lead.abs())
    });
    let side = given.or(shown.map(|(side, _)| side)).unwrap_or(Side::Right);
    let of_shape = match shown {
        Some((shown, lead_mm)) => format!(
            "likely a {} knee, since one flange of the trochlea stands out by {lead_mm:.1} mm there",
            shown.word()
        ),
        None => "the shape does not show it, since both sides of it are alike".to_owned(),
    };
    let why = match given {
        Some(_) => "as given",
        None if shown.is_some() => "check it",
        None => "assumed: check it",
    };
    let remark = format!("  side \"{}\", {why}; {of_shape}.", side.word());
    (side, remark)
}

/// A body of the draft, with the conclusions from its shape.
struct Concluded<'a> {
    body: Body,
    file: PathBuf,
    written: &'a Path,
    mesh: TriangleMesh,
    unit: LengthUnit,
    recognition: Option<Recognition>,
}

impl<'a> Concluded<'a> {
    fn from(body: Body, written: &'a Path) -> Result<Self, BuildError> {
        let file = std::path::absolute(written).unwrap_or_else(|_| written.to_path_buf());
        let mesh = parse_surface(&file, &surface_bytes(&Disk, &file)?)?;
        let size = longest_mm(&mesh);
        let Some((unit, _)) = usual_unit(size) else {
            let message = format!(
                "this {body} is {size:.4} long in the unit of the file, and none of mm, cm, m and in makes it 40 mm to 120 mm \
                 long, as that of a whole knee is; scale it, or write the case by hand"
            );
            return Err(BuildError::mesh(&file, &["length_unit"], message));
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
    fn best(&self) -> Vec<Orientation> {
        self.recognition
            .iter()
            .flat_map(Recognition::best)
            .collect()
    }

    /// Returns its orientation: that of the other body if its own shape permits it, since the files of one implant
    /// mostly share their axes.
    fn orientation(&self, of_other: &[Orientation]) -> Orientation {
        let Some(recognition) = &self.recognition else {
            return of_other.first().copied().unwrap_or(Orientation::ISB);
        };
        // Both files of one implant mostly have the same axes.
        let shared = recognition.best().find(|best| of_other.contains(best));
        shared.unwrap_or_else(|| recognition.nearest())
    }

    /// Returns the mesh, repaired and checked as in a run.
    fn shell(&self, lies: &Orientation) -> Result<CheckedMesh, BuildError> {
        let rotation = lies.rotation();
        let placed = self.mesh.clone().mapped(|vertex| rotation * vertex);
        checks_of(self.body, None)
            .check(placed)
            .map_err(|error| BuildError::shell(&self.file, &error))
    }

    fn keys(&self, lies: &Orientation) -> String {
        let file = quoted(&self.file.display().to_string());
        let [x, y, z] = Axes::of(&lies.rotation()).words();
        let (table, unit) = (self.body.table(), self.unit.word());
        format!(
            "[{table}]\nshape = \"mesh\"\nfile = {file}\nlength_unit = \"{unit}\"\naxes = [\"{x}\", \"{y}\", \"{z}\"]\n"
        )
    }

    fn remarks(&self, lies: &Orientation, shell: &CheckedMesh) -> Vec<String> {
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
            return "cannot be concluded, since the shape is not that of a whole knee: check them"
                .to_owned();
        };
        match recognition.sureness() {
            Some(Sureness::Certain) => "for certain".to_owned(),
            Some(Sureness::Likely) => {
                "likely, since only one sign of the shape distinguishes back from front: check them"
                    .to_owned()
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
struct Alone {
    shell: CheckedMesh,
    underside: Underside,
}

impl Alone {
    fn of(whole: CheckedMesh) -> Result<Self, RepairError> {
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

    fn remarks(&self) -> Vec<String> {
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
fn recognised_alone(mesh: &TriangleMesh) -> Option<Recognition> {
    Orientation::all().find_map(|lies| {
        let rotation = lies.rotation();
        let placed = mesh.clone().mapped(|vertex| rotation * vertex);
        let alone = Alone::of(checks_of(Body::Insert, None).check(placed).ok()?).ok()?;
        let is_part = matches!(alone.underside, Underside::Ledge { .. });
        if !is_part && alone.shell.left_out.is_empty() {
            return None;
        }
        if Body::Insert.recognise(&alone.shell.mesh)?.nearest() != Orientation::ISB {
            return None;
        }
        let back = rotation.transpose();
        Body::Insert.recognise(&alone.shell.mesh.mapped(|vertex| back * vertex))
    })
}

/// A draft that cannot be made.
#[derive(Debug, Error)]
pub enum DraftError {
    /// A file that cannot be read or used.
    #[error(transparent)]
    Mesh(#[from] BuildError),
    /// The draft is not a valid case.
    #[error(transparent)]
    Case(#[from] Problems),
}
