//! A case drafted from two mesh files: unit, axes and start are concluded from the shapes.

use std::path::{Path, PathBuf};

use condyle::Mat3;
use condyle::anatomy::{
    Orientation, Recognition, Sureness, flange_lead_mm, start_over_the_dishes_mm,
};
use condyle::geometry::{CheckedShell, GenericInsertShape, ShellError, TriangleMesh, Underside};
use thiserror::Error;

use super::axes::Axes;
use super::build::{
    Body, MOST_ACROSS_MM, checks_of, checks_of_insert, heights_to_write, longest_mm,
    middle_of_mesh, rounded_up, usual_unit,
};
use super::contents::Case;
use super::heading::Side;
use super::machine_keys::Preset;
use super::mesh_file::LengthUnit;
use crate::files::Disk;
use crate::keyed::{Problems, quoted};
use crate::mesh::{MeshFileError, parse_surface, surface_bytes};

/// What a case is drafted from.
#[derive(Clone, Copy, Debug)]
pub struct Draft<'a> {
    /// Which simulator.
    pub preset: Preset,
    /// Which knee; none to tell it from the femur.
    pub side: Option<Side>,
    /// Mesh of the femoral component.
    pub femur: &'a Path,
    /// Mesh of the insert, closed or an open articulating surface.
    pub insert: &'a Path,
}

/// A case drafted from meshes.
#[derive(Clone, Debug)]
pub struct Drafted {
    /// The case file, with what was concluded and how sure it is as remarks.
    pub text: String,
    /// What was concluded, one thing a line.
    pub remarks: Vec<String>,
}

/// Why no case can be drafted from two files.
#[derive(Debug, Error)]
pub enum DraftError {
    /// A file that cannot be read.
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
    /// A body that no unit makes as large as a knee's.
    #[error(
        "{}: this {body} is {size:.4} long in the unit of the file, and none of mm, cm, m and in makes it \
         40 mm to 120 mm long, as that of a whole knee is; scale it, or write the case by hand",
        file.display()
    )]
    NoUnit {
        /// The file.
        file: PathBuf,
        /// Which body.
        body: Body,
        /// Its longest extent, in the unit of the file.
        size: f64,
    },
    /// The draft is no case.
    #[error(transparent)]
    Case(#[from] Problems),
}

impl Draft<'_> {
    /// The case, to be kept in `folder`.
    ///
    /// # Errors
    /// A file that cannot be read, is no shell, or by its size no part of a knee.
    pub fn drafted(&self, folder: &Path) -> Result<Drafted, DraftError> {
        let femur = Concluded::from(Body::Femur, self.femur)?;
        let insert = Concluded::from(Body::Insert, self.insert)?;
        let femur_lies = femur.orientation(&insert.best());
        let insert_lies = insert.orientation(&[femur_lies]);
        let (femur_shell, whole) = (femur.shell(&femur_lies)?, insert.shell(&insert_lies)?);
        let mut alone = Alone::of(whole).map_err(|source| insert.refused(source))?;
        let origin = ConcludedOrigin::centred(&mut alone.shell.mesh);
        let of_insert = [origin.key, &thickness(&alone.shell), &alone.key()].concat();
        let bodies = [
            keys_of("femur", &femur, &femur_lies),
            keys_of("insert", &insert, &insert_lies) + &of_insert,
        ];
        let start_mm = self.start_mm(&femur_shell.mesh, &alone.shell.mesh);
        let side = ConcludedSide::of(&femur_shell.mesh, self.side);
        let keys = self.keys(side.side, &bodies, start_mm);
        let case = Case::parse(&keys, "draft", folder)?;
        let of_insert = [insert.remarks(&insert_lies, &alone.shell), alone.remarks()];
        let remarks = [
            with(femur.remarks(&femur_lies, &femur_shell), Some(side.remark)),
            with(of_insert.concat(), origin.remark),
        ];
        let text = case.as_draft_in(folder);
        Ok(Drafted {
            text: with_remarks(text, &remarks),
            remarks: remarks.concat(),
        })
    }

    fn keys(&self, side: Side, [femur, insert]: &[String; 2], (x, z): (f64, f64)) -> String {
        let (side, preset) = (side.word(), self.preset.word());
        format!(
            "title = \"Untitled\"\nside = \"{side}\"\n{femur}start_mm = [{x:.1}, {z:.1}]\n{insert}[machine]\npreset = \"{preset}\"\n"
        )
    }

    /// Where the femoral frame starts, in the frame of the knee that it is.
    fn start_mm(&self, femur: &TriangleMesh, insert: &TriangleMesh) -> (f64, f64) {
        let machine = format!("[machine]\npreset = \"{}\"\n", self.preset.word());
        let case = Case::parse(&machine, "machine", Path::new(""));
        let flexion_rad = case.map_or(0.0, |case| case.start_flexion_rad());
        start_over_the_dishes_mm(femur, insert, flexion_rad).unwrap_or_default()
    }
}

/// The keys of a table of the case that were concluded.
fn keys_of(table: &str, body: &Concluded<'_>, lies: &Orientation) -> String {
    let file = quoted(&body.file.display().to_string());
    let [x, y, z] = Axes::of(&lies.rotation()).words();
    let unit = body.unit.word();
    format!(
        "[{table}]\nshape = \"mesh\"\nfile = {file}\nlength_unit = \"{unit}\"\naxes = [\"{x}\", \"{y}\", \"{z}\"]\n"
    )
}

fn with(mut remarks: Vec<String>, remark: Option<String>) -> Vec<String> {
    remarks.extend(remark);
    remarks
}

/// An origin so far in front of the dishes' middle, or behind it, is not that of a machine, mm.
const FAR_ALONG_MM: f64 = 20.0;

/// Where the origin of an insert frame is.
struct ConcludedOrigin {
    key: &'static str,
    remark: Option<String>,
}

impl ConcludedOrigin {
    /// That of the file, unless the dishes lie off it; then between them, where the insert is moved to.
    fn centred(insert: &mut TriangleMesh) -> Self {
        let middle = middle_of_mesh(insert);
        // Flat dishes are lowest at no certain place along: only what is far off is taken for another origin.
        let is_far = middle.z.abs() > MOST_ACROSS_MM || middle.x.abs() > FAR_ALONG_MM;
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

/// Which knee a case is of, and where that comes from.
struct ConcludedSide {
    side: Side,
    remark: String,
}

impl ConcludedSide {
    /// Of a femur that lies x anterior, y superior, z right, of which the user may have said the side.
    fn of(femur: &TriangleMesh, said: Option<Side>) -> Self {
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

/// The thickness of an open insert, which has none of its own.
fn thickness(insert: &CheckedShell) -> String {
    if insert.closed {
        return String::new();
    }
    let thickness_mm = GenericInsertShape::default().thickness_mm;
    format!("thickness_mm = {thickness_mm:?}\n")
}

/// An insert without the tray that its file may hold too.
struct Alone {
    shell: CheckedShell,
    underside: Underside,
}

impl Alone {
    fn of(whole: CheckedShell) -> Result<Self, ShellError> {
        let underside = if whole.closed {
            Underside::of(&whole.mesh)
        } else {
            Underside::Whole
        };
        let shell = match &underside {
            Underside::Ledge { height_mm, .. } => {
                let left_out = whole.left_out;
                let checks = checks_of_insert(Some(rounded_up(*height_mm)));
                let cut = checks.check(whole.mesh)?;
                CheckedShell { left_out, ..cut }
            }
            _ => whole,
        };
        Ok(Self { shell, underside })
    }

    /// The height at which it is cut.
    fn key(&self) -> String {
        match &self.underside {
            Underside::Ledge { height_mm, .. } => {
                format!("clip_below_mm = {:?}\n", rounded_up(*height_mm))
            }
            _ => String::new(),
        }
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

/// Recognises an insert in one with its tray, which is none by its shape: it is cut off as it would be in every
/// orientation, until one shows an insert that lies so.
fn recognised_alone(mesh: &TriangleMesh) -> Option<Recognition> {
    Orientation::all().find_map(|lies| {
        let rotation: Mat3 = lies.rotation();
        let placed = mesh.clone().mapped(|vertex| rotation * vertex);
        let alone = Alone::of(checks_of(Body::Insert).check(placed).ok()?).ok()?;
        let is_cut = matches!(alone.underside, Underside::Ledge { .. });
        if !is_cut && alone.shell.left_out.is_empty() {
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

/// A body of the draft, and what its shape tells.
struct Concluded<'a> {
    body: Body,
    file: PathBuf,
    written: &'a Path,
    mesh: TriangleMesh,
    unit: LengthUnit,
    recognition: Option<Recognition>,
}

impl<'a> Concluded<'a> {
    fn from(body: Body, written: &'a Path) -> Result<Self, DraftError> {
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

    /// The orientations that its shape leaves, best first.
    fn best(&self) -> Vec<Orientation> {
        self.recognition
            .iter()
            .flat_map(Recognition::best)
            .collect()
    }

    /// How it lies: as the other body may lie, where its own shape leaves that, since files of one
    /// implant mostly share their axes.
    fn orientation(&self, of_other: &[Orientation]) -> Orientation {
        let Some(recognition) = &self.recognition else {
            return of_other.first().copied().unwrap_or(Orientation::ISB);
        };
        let shared = recognition.best().find(|best| of_other.contains(best));
        shared.unwrap_or_else(|| recognition.nearest())
    }

    /// Its triangles in mm, x anterior, y superior, z right.
    fn placed(&self, lies: &Orientation) -> TriangleMesh {
        let rotation: Mat3 = lies.rotation();
        self.mesh.clone().mapped(|vertex| rotation * vertex)
    }

    /// The same, mended and checked as a run does it.
    fn shell(&self, lies: &Orientation) -> Result<CheckedShell, DraftError> {
        checks_of(self.body)
            .check(self.placed(lies))
            .map_err(|source| self.refused(source))
    }

    fn refused(&self, source: ShellError) -> DraftError {
        DraftError::Shell {
            file: self.file.clone(),
            source,
        }
    }

    fn remarks(&self, lies: &Orientation, shell: &CheckedShell) -> Vec<String> {
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

/// The case with remarks above the tables of its bodies.
fn with_remarks(text: String, [femur, insert]: &[Vec<String>; 2]) -> String {
    let above = |table: &str, remarks: &[String]| {
        let lines: String = remarks.iter().map(|line| format!("# {line}\n")).collect();
        (format!("\n[{table}]\n"), format!("\n{lines}[{table}]\n"))
    };
    [above("femur", femur), above("insert", insert)]
        .into_iter()
        .fold(text, |text, (table, remarked)| {
            text.replacen(&table, &remarked, 1)
        })
}
