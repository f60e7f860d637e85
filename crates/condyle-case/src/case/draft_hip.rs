//! A case of a hip drafted from the files of head and cup.

use std::path::Path;

use condyle::geometry::TriangleMesh;
use condyle::machine::TestedJoint;
use condyle_mesh::files::Disk;
use condyle_mesh::formats::{parse_surface, surface_bytes};
use condyle_mesh::{FittedSphere, Roundness};

use super::build::BuildError;
use super::contents::Case;
use super::draft::{DraftError, Drafted};
use super::frame::LengthUnit;
use super::machine::Preset;
use crate::config::quoted;

/// Radii of heads and cups on the market, mm. In inches they overlap with those in centimetres from 25.4 to 32 mm: such a
/// file is read as one in centimetres.
const RADII_MM: std::ops::RangeInclusive<f64> = 10.0..=32.0;
/// Root mean square distance from its sphere above which a body is not round, mm: a fifth of the usual clearance.
const MAX_RMS_MM: f64 = 0.02;
/// Usual radial clearances of polyethylene cups, mm.
const CLEARANCES_MM: std::ops::RangeInclusive<f64> = 0.02..=0.4;

impl Drafted {
    /// Drafts the case of a hip from the triangles of its head and its cup, to be kept in `folder`: units, radii, and the
    /// direction in which the cup opens follow from the shapes.
    ///
    /// # Errors
    /// A file that cannot be read, a head without a ball, a cup without a socket, and a cup that is smaller than its head.
    pub fn hip(preset: Preset, [head, cup]: [&Path; 2], folder: &Path) -> Result<Self, DraftError> {
        let Some(inclination) = inclination(preset) else {
            let message = "--head and --cup are a ball and its socket, of a hip or a disc; the machine tests another joint";
            return Err(BuildError::mesh(head, &["file"], message).into());
        };
        let ball = Round::from(head, Roundness::Convex)?;
        let (ball, socket) = match (ball, Round::from(cup, Roundness::Concave)?) {
            (Some(ball), Some(socket)) => (ball, socket),
            (_, None) if Round::from(head, Roundness::Concave)?.is_some() => {
                let message = "this body has a spherical socket, and the other has none; exchange --head and --cup";
                return Err(BuildError::mesh(head, &["file"], message).into());
            }
            (None, _) => return Err(not_round(head, "ball", "head").into()),
            (_, None) => return Err(not_round(cup, "socket", "cup").into()),
        };
        let clearance_mm = socket.radius_mm() - ball.radius_mm();
        if clearance_mm <= 0.0 {
            let message = format!(
                "the socket of radius {:.3} mm is not larger than the head of {:.3} mm; check both files and their units",
                socket.radius_mm(),
                ball.radius_mm()
            );
            return Err(BuildError::mesh(cup, &["file"], message).into());
        }
        let mut of_head = ball.remarks("head", "a ball");
        let mut of_cup = socket.remarks("cup", "a socket");
        let [x, y, z]: [f64; 3] = socket.sphere.opens_along.into();
        of_head.push(
            "  The case describes the head as a ball of this radius. To test the head of the file itself, write \
             shape = \"mesh\", file and axes in [femur]."
                .to_owned(),
        );
        of_cup.push(format!(
            "  It opens along ({x:.3}, {y:.3}, {z:.3}) of the file. inclination_deg is that of the preset: check it."
        ));
        // As printed: an export rounds a clearance of 0.4 mm to more than that.
        let unusual = if CLEARANCES_MM.contains(&((clearance_mm * 1e3).round() / 1e3)) {
            ""
        } else {
            ", which is unusual: check the files"
        };
        of_cup.push(format!(
            "  The radial clearance is {clearance_mm:.3} mm{unusual}."
        ));
        let file = quoted(
            &std::path::absolute(cup)
                .unwrap_or_else(|_| cup.to_path_buf())
                .display()
                .to_string(),
        );
        let keys = format!(
            "title = \"Untitled\"\n[femur]\nshape = \"sphere\"\nradius_mm = {:.4}\n[insert]\nshape = \"cup-mesh\"\nfile = {file}\n\
             length_unit = \"{}\"\n{inclination}[machine]\npreset = \"{}\"\n",
            ball.radius_mm(),
            socket.unit.word(),
            preset.word()
        );
        let text = Case::parse(&keys, "draft", folder)?.as_draft_in(folder);
        Ok(Self::with_remarks(text, of_head, of_cup))
    }
}

/// Returns the line of the inclination of a cup that differs from the usual one; none if the machine tests no ball and socket.
fn inclination(preset: Preset) -> Option<&'static str> {
    match preset.machine().keys.tests {
        TestedJoint::Hip => Some(""),
        // The discs of the presets lie across the load.
        TestedJoint::Disc => Some("inclination_deg = 0.0\n"),
        _ => None,
    }
}

/// A body with the sphere in it, in the unit of its file.
struct Round<'a> {
    file: &'a Path,
    sphere: FittedSphere,
    unit: LengthUnit,
}

impl<'a> Round<'a> {
    /// Returns the body of a file if it has a sphere of the size of a hip.
    fn from(file: &'a Path, roundness: Roundness) -> Result<Option<Self>, BuildError> {
        let mesh: TriangleMesh = parse_surface(file, &surface_bytes(&Disk, file)?)?;
        let Some(sphere) = FittedSphere::new(&mesh, roundness) else {
            return Ok(None);
        };
        let is_usual = |unit: &LengthUnit| RADII_MM.contains(&(sphere.radius_mm * unit.in_mm()));
        let Some(unit) = LengthUnit::ALL.iter().copied().find(is_usual) else {
            let message = format!(
                "the sphere in this body has a radius of {:.4} in the unit of the file, and none of mm, cm, m and in makes it \
                 10 mm to 32 mm, as that of a hip is; scale it, or write the case by hand",
                sphere.radius_mm
            );
            return Err(BuildError::mesh(file, &["length_unit"], message));
        };
        Ok(Some(Self { file, sphere, unit }))
    }

    fn radius_mm(&self) -> f64 {
        self.sphere.radius_mm * self.unit.in_mm()
    }

    fn remarks(&self, body: &str, part: &str) -> Vec<String> {
        let rms_mm = self.sphere.rms_mm * self.unit.in_mm();
        let doubt = if rms_mm > MAX_RMS_MM {
            ": it is not round, or a scan; check it"
        } else {
            ""
        };
        vec![
            format!("{body}, derived from the shape of {}:", self.file.display()),
            format!(
                "  {part} of {:.3} mm radius with length_unit \"{}\"; its vertices are {rms_mm:.4} mm from it (rms){doubt}.",
                self.radius_mm(),
                self.unit.word()
            ),
        ]
    }
}

fn not_round(file: &Path, part: &str, body: &str) -> BuildError {
    let message = format!(
        "this body has no spherical {part}, as the {body} of a hip has; check that it is the {body} and that its triangles \
         face outwards"
    );
    BuildError::mesh(file, &["file"], message)
}
