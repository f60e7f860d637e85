//! A case drafted from two mesh files: unit, axes, side, origin and start are concluded from the shapes.

use std::mem;
use std::path::{Path, PathBuf};

use condyle::anatomy::{
    Likeness, Orientation, Recognition, Sureness, Upright, flange_lead_mm, start_over_the_dishes_mm,
};
use condyle::geometry::{FittedArc, GenericInsertShape, TriangleMesh, Underside};
use condyle::{Mat3, Vec3};
use condyle_mesh::files::Disk;
use condyle_mesh::formats::{parse_surface, surface_bytes};
use condyle_mesh::repair::{CheckedMesh, RepairError};
use thiserror::Error;

use super::build::{
    Body, BuildError, MAX_ACROSS_MM, WrittenRotation, advice, checked, checks_of, cut_at,
    heights_to_write, longest_mm, middle_of_mesh, rounded_up, usual_unit,
};
use super::contents::Case;
use super::frame::{Axes, LengthUnit, Side};
use super::machine::Preset;
use crate::config::{Problems, quoted};

/// Distance along x from the dishes' middle beyond which an origin is not that of a machine, mm.
const MAX_ALONG_MM: f64 = 20.0;
/// Largest `start_mm` of a case.
const MAX_START_MM: f64 = 100.0;

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
    /// A preset for another joint than the knee; a file that cannot be read, does not form a shell, or does not have the size of a
    /// part of a knee.
    pub fn new(
        preset: Preset,
        side: Option<Side>,
        [femur, insert]: [&Path; 2],
        folder: &Path,
    ) -> Result<Self, DraftError> {
        let machine = format!("[machine]\npreset = \"{}\"\n", preset.word());
        let machine_alone = Case::parse(&machine, "machine", Path::new(""))?;
        if !machine_alone.tests_knee() {
            return Err(DraftError::OtherJoint);
        }
        let femur = Concluded::from(Body::Femur, femur)?;
        let insert = Concluded::from(Body::Insert, insert)?;
        refuse_others(&femur, &insert)?;
        let (mut femur, mut insert) = (femur.upright()?, insert.upright()?);
        // A femur gets the frame of its insert if it may lie in it, and an insert on the bone that of its femur.
        if let (Some(of_femur), Some(of_insert)) = (&femur.upright, &insert.upright) {
            let of_insert = of_insert.clone().on_bone_of(of_femur, &insert.mesh);
            femur.upright = Some(of_femur.clone().in_frame_of(&of_insert, &femur.mesh));
            insert.upright = Some(of_insert);
        }
        let femur_lies = femur.lies(&insert.best());
        let insert_lies = insert.lies(&[femur_lies.rotation()]);
        let (mut femur_shell, whole) = (femur.shell(&femur_lies)?, insert.shell(&insert_lies)?);
        let mut alone =
            Alone::of(whole).map_err(|error| BuildError::shell(&insert.file, &error))?;
        let mut of_insert = insert.remarks(&insert_lies, &alone.shell);
        let mut insert_keys = insert.keys(&insert_lies);
        of_insert.extend(alone.remarks());
        insert_keys += &alone.keys();
        of_insert.extend(alone.centre(&mut insert_keys));
        let (side, of_side) = with_reason(side, &femur_shell.mesh);
        let mut of_femur = femur.remarks(&femur_lies, &femur_shell);
        let flexion_rad = machine_alone.start_flexion_rad();
        let start = |femur: &CheckedMesh| {
            let start = start_over_the_dishes_mm(&femur.mesh, &alone.shell.mesh, flexion_rad);
            start.unwrap_or_default()
        };
        let mut femur_keys = femur.keys(&femur_lies);
        let (mut x, mut z) = start(&femur_shell);
        if x.abs().max(z.abs()) > MAX_START_MM {
            of_femur.push(centre_femur(&mut femur_shell.mesh, &mut femur_keys));
            (x, z) = start(&femur_shell);
        }
        of_femur.push(of_side);
        // Adding 0 makes -0 positive.
        let [x, z] = [x, z].map(|value| (10.0 * value).round() / 10.0 + 0.0);
        let keys = format!(
            "title = \"Untitled\"\nside = \"{}\"\n{femur_keys}start_mm = [{x:?}, {z:?}]\n{insert_keys}{machine}",
            side.word()
        );
        let text = Case::parse(&keys, "draft", folder)?.as_draft_in(folder);
        Ok(Self::with_remarks(text, of_femur, of_insert))
    }

    /// Writes remarks above the tables of both bodies.
    pub(super) fn with_remarks(
        mut text: String,
        of_femur: Vec<String>,
        of_insert: Vec<String>,
    ) -> Self {
        for (table, remarks) in [("[femur]\n", &of_femur), ("[insert]\n", &of_insert)] {
            let lines: String = remarks.iter().map(|line| format!("# {line}\n")).collect();
            text = text.replacen(&format!("\n{table}"), &format!("\n{lines}{table}"), 1);
        }
        let remarks = [of_femur, of_insert].concat();
        Self { text, remarks }
    }
}

/// Refuses meshes of other bodies than those of a whole knee.
fn refuse_others(femur: &Concluded<'_>, insert: &Concluded<'_>) -> Result<(), DraftError> {
    let [of_femur, of_insert] = [femur, insert].map(|body| Likeness::of(&body.mesh));
    if (of_femur, of_insert) == (Some(Likeness::Insert), Some(Likeness::Femur)) {
        let [femur, insert] = [femur, insert].map(|body| body.written.to_path_buf());
        return Err(DraftError::Exchanged { femur, insert });
    }
    for (body, likeness) in [(femur, of_femur), (insert, of_insert)] {
        // One body alone may be misjudged if its shape is unusual; only spheres are recognised in any unit.
        let is_other = |one: &Likeness| match one {
            Likeness::Femur | Likeness::Insert => false,
            Likeness::Head(_) | Likeness::Cup => true,
            Likeness::Tray | Likeness::OneCompartment => {
                usual_unit(longest_mm(&body.mesh)).is_some()
            }
        };
        let other = likeness.filter(is_other);
        if let Some((other, advice)) = other.and_then(|one| Some((one, advice(body.body, one)?))) {
            let message = format!("this {} is {other}; {advice}", body.body);
            return Err(BuildError::mesh(&body.file, &["file"], message).into());
        }
    }
    Ok(())
}

/// Moves the origin of a femur to its flexion axis, half-way between its sides; returns the remark.
fn centre_femur(femur: &mut TriangleMesh, keys: &mut String) -> String {
    let (x, y) = FittedArc::posterior(femur).centre_mm;
    let (low, high) = femur.bounds();
    // A tenth of a millimetre is enough for an origin; adding zero turns -0 into 0.
    let [x, y, z] = [x, y, f64::midpoint(low.z, high.z)].map(|at| (10.0 * at).round() / 10.0 + 0.0);
    *keys += &format!("origin_mm = [{x:?}, {y:?}, {z:?}]\n");
    let origin = Vec3::new(x, y, z);
    *femur = mem::take(femur).mapped(|vertex| vertex - origin);
    format!(
        "  origin_mm on its flexion axis, since the origin of the file is {:.0} mm from there.",
        origin.norm()
    )
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
            "likely a {} knee, since the flange of the trochlea on that side extends {lead_mm:.1} mm further",
            shown.word()
        ),
        None => "not visible from the shape, since both sides are alike".to_owned(),
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
    /// In the unit of the file until it is concluded, then in mm.
    mesh: TriangleMesh,
    unit: LengthUnit,
    upright: Option<Upright>,
}

impl<'a> Concluded<'a> {
    fn from(body: Body, written: &'a Path) -> Result<Self, BuildError> {
        let file = std::path::absolute(written).unwrap_or_else(|_| written.to_path_buf());
        let mesh = parse_surface(&file, &surface_bytes(&Disk, &file)?)?;
        let unit = LengthUnit::Millimetre;
        let usual = usual_unit(longest_mm(&mesh)).map(|(unit, _)| unit);
        Ok(Self {
            body,
            file,
            written,
            mesh: match usual {
                Some(unit) => mesh.mapped(|vertex| vertex * unit.in_mm()),
                None => mesh,
            },
            unit: usual.unwrap_or(unit),
            upright: None,
        })
    }

    /// Finds the frame along which it lies.
    fn upright(self) -> Result<Self, BuildError> {
        let (body, size) = (self.body, longest_mm(&self.mesh));
        if usual_unit(size).is_none() {
            let message = format!(
                "this {body} is {size:.4} long in the unit of the file, and none of mm, cm, m and in makes it 40 mm to 120 mm \
                 long, as that of a whole knee is; scale it, or write the case by hand"
            );
            return Err(BuildError::mesh(&self.file, &["length_unit"], message));
        }
        let upright = match body {
            Body::Femur => Upright::of_femur(&self.mesh),
            Body::Insert => Upright::of_insert(&self.mesh)
                .or_else(|| recognised_alone(&self.mesh).map(Upright::square)),
        };
        Ok(Self { upright, ..self })
    }

    /// Returns the rotations from the file that agree with its shape, best first.
    fn best(&self) -> Vec<Mat3> {
        let rotations = |upright: &Upright| {
            let turn = upright.rotation();
            let best = upright.recognition.best();
            best.map(|best| best.rotation() * turn).collect()
        };
        self.upright.as_ref().map_or_else(Vec::new, rotations)
    }

    /// Returns its rotation from the file: that of the other body if its own shape permits it, since the files of one
    /// implant mostly share their axes.
    fn lies(&self, of_other: &[Mat3]) -> WrittenRotation {
        let square = Orientation::ISB.rotation();
        let Some(upright) = &self.upright else {
            return WrittenRotation::of(of_other.first().unwrap_or(&square));
        };
        let best = self.best();
        // Written angles are rounded; orientations differ by a quarter turn.
        let is_of_other = |one: &&Mat3| of_other.iter().any(|other| (*one - other).amax() < 0.01);
        let turn = upright.rotation();
        let nearest = upright.recognition.nearest_after(&turn).rotation() * turn;
        WrittenRotation::of(best.iter().find(is_of_other).unwrap_or(&nearest))
    }

    /// Returns the mesh, repaired and checked as in a run.
    fn shell(&self, lies: &WrittenRotation) -> Result<CheckedMesh, BuildError> {
        let rotation = lies.rotation();
        let placed = self.mesh.clone().mapped(|vertex| rotation * vertex);
        checked(
            &self.file,
            (&placed, &Vec3::clone),
            &placed,
            checks_of(self.body, None),
        )
    }

    fn keys(&self, lies: &WrittenRotation) -> String {
        let file = quoted(&self.file.display().to_string());
        let (table, unit, lines) = (self.body.table(), self.unit.word(), lies.lines());
        format!("[{table}]\nshape = \"mesh\"\nfile = {file}\nlength_unit = \"{unit}\"\n{lines}")
    }

    fn remarks(&self, lies: &WrittenRotation, shell: &CheckedMesh) -> Vec<String> {
        let (low, high) = shell.mesh.bounds();
        let size = high - low;
        let mut remarks = vec![
            format!(
                "{}, derived from the shape of {}:",
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
        if let Some(angles) = lies.rotation_deg {
            remarks.push(rotated(angles));
        }
        if let Some(upright) = &self.upright {
            remarks.extend(upright.slope.map(|up| sloped(&(lies.rotation() * up))));
        }
        if self.body == Body::Femur {
            if self
                .upright
                .as_ref()
                .is_some_and(|upright| upright.is_flexion_open)
            {
                let flexion = "  flexion cannot be determined, since other rotations about the medio-lateral axis fit better, but \
                               not certainly: check it in the picture.";
                remarks.push(flexion.to_owned());
            }
            let start = "  start_mm: the lowest points of the condyles over those of the dishes.";
            remarks.push(start.to_owned());
        } else if !shell.closed {
            let thickness =
                "  The surface is open and thickness_mm is assumed: write that of the insert.";
            remarks.push(thickness.to_owned());
        }
        remarks
    }

    fn how_sure(&self, lies: &WrittenRotation) -> String {
        let Some(Upright { recognition, .. }) = &self.upright else {
            return "cannot be derived, since the shape is not that of a whole knee: check them"
                .to_owned();
        };
        match recognition.sureness() {
            Some(Sureness::Certain) => "certain".to_owned(),
            Some(Sureness::Likely) => {
                "likely, since only one feature of the shape distinguishes back from front: check them"
                    .to_owned()
            }
            None => {
                let others = self
                    .best()
                    .into_iter()
                    .map(|one| WrittenRotation::of(&one).axes);
                let others = others.filter(|other| *other != lies.axes);
                let others: Vec<String> =
                    others.map(|other| format!("{:?}", other.words())).collect();
                format!(
                    "uncertain, since {} fits about as well: check them",
                    others.join(" or ")
                )
            }
        }
    }
}

/// Describes a rotation about the fixed axes z, x, y by its angle and axis.
fn rotated(angles_deg: [f64; 3]) -> String {
    let rotation = WrittenRotation {
        axes: Axes::ISB,
        rotation_deg: Some(angles_deg),
    };
    // The rotation turns the file back: its transpose is how the file lies.
    let turn = rotation.rotation().transpose();
    let cosine = f64::midpoint(turn.trace(), -1.0);
    let [x, y, z] = [(2, 1), (0, 2), (1, 0)].map(|(i, j)| turn[(i, j)] - turn[(j, i)]);
    let axis = Vec3::new(x, y, z).normalize();
    format!(
        "  rotation_deg: the file lies rotated by {:.1} degrees about the axis ({:.2}, {:.2}, {:.2}), anterior, superior and \
         right; check it in the picture.",
        cosine.clamp(-1.0, 1.0).acos().to_degrees(),
        axis.x,
        axis.y,
        axis.z
    )
}

/// Describes the slope of an insert whose superior direction is `up`.
fn sloped(up: &Vec3) -> String {
    let slope_deg = (-up.x).atan2(up.y).to_degrees();
    let side = if slope_deg > 0.0 {
        "posterior"
    } else {
        "anterior"
    };
    format!(
        "  It has {:.1} degrees of {side} slope, which are kept, since the femur lies along the axes: check it in the \
         picture.",
        slope_deg.abs()
    )
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

    fn keys(&self) -> String {
        let mut keys = String::new();
        if !self.shell.closed {
            let thickness_mm = GenericInsertShape::default().thickness_mm;
            keys += &format!("thickness_mm = {thickness_mm:?}\n");
        }
        if let Underside::Ledge { height_mm, .. } = &self.underside {
            keys += &format!("clip_below_mm = {:?}\n", rounded_up(*height_mm));
        }
        keys
    }

    /// Moves the origin between the dishes, if it is far from there; returns the remark.
    fn centre(&mut self, keys: &mut String) -> Option<String> {
        let middle = middle_of_mesh(&self.shell.mesh);
        // The lowest place of flat dishes along x is uncertain: only a distant one indicates another origin.
        if middle.z.abs() <= MAX_ACROSS_MM && middle.x.abs() <= MAX_ALONG_MM {
            return None;
        }
        self.shell.mesh = mem::take(&mut self.shell.mesh).mapped(|vertex| vertex - middle);
        *keys += "origin = \"centre\"\n";
        Some(format!(
            "  origin \"centre\", since the origin of the file is {:.0} mm from the middle of the dishes.",
            middle.norm()
        ))
    }

    fn remarks(&self) -> Vec<String> {
        let mut remarks = Vec::new();
        let parts = self.shell.left_out.len();
        if parts > 0 {
            remarks.push(format!(
                "  The file has {parts} more parts, below or next to the insert: they are removed."
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
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Debug, Error)]
pub enum DraftError {
    /// A file that cannot be read or used.
    #[error(transparent)]
    Mesh(#[from] BuildError),
    /// Femur and insert in each other's place.
    #[error(
        "{} is an insert and {} a femoral component: exchange them",
        femur.display(),
        insert.display()
    )]
    Exchanged { femur: PathBuf, insert: PathBuf },
    /// A machine for another joint than the knee.
    #[error(
        "unit, axes and start of a femur and an insert are derived for knees only\n\nFor a hip give --head and --cup. For another joint \
         write the case without files, and in its [femur] and [insert] shape = \"mesh\", file, length_unit and axes"
    )]
    OtherJoint,
    /// The draft is not a valid case.
    #[error(transparent)]
    Case(#[from] Problems),
}
