//! A case of a hip drafted from the files of head and cup.

use std::ops::RangeInclusive;
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

/// Largest radius of heads, cups and discs on the market, mm.
const MAX_RADIUS_MM: f64 = 32.0;
/// Root mean square distance from its sphere above which a body is not round, mm: a fifth of the usual clearance.
const MAX_RMS_MM: f64 = 0.02;
/// Usual radial clearances of polyethylene cups, mm.
const CLEARANCES_MM: RangeInclusive<f64> = 0.02..=0.4;

impl Drafted {
    /// Drafts the case of a hip from the triangles of its head and its cup, to be kept in `folder`: units, radii, and the
    /// direction in which the cup opens follow from the shapes.
    ///
    /// # Errors
    /// A file that cannot be read, a head without a ball, a cup without a socket, and a cup that is smaller than its head.
    pub fn hip(preset: Preset, [head, cup]: [&Path; 2], folder: &Path) -> Result<Self, DraftError> {
        let Some((min_mm, inclination)) = of_joint(preset) else {
            let message = "--head and --cup are a ball and its socket, of a hip or a disc; the machine tests another joint";
            return Err(BuildError::mesh(head, &["file"], message).into());
        };
        let (ball, socket) = ball_and_socket([head, cup], &(min_mm..=MAX_RADIUS_MM))?;
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

/// Returns the ball and the socket of two files, with radii on the market.
fn ball_and_socket<'a>(
    [head, cup]: [&'a Path; 2],
    radii_mm: &RangeInclusive<f64>,
) -> Result<(Round<'a>, Round<'a>), BuildError> {
    // Heads have a whole diameter in mm, and sockets the radius of their head.
    let to_whole = |radius_mm: f64| (2.0 * radius_mm - (2.0 * radius_mm).round()).abs();
    let ball = Round::from(head, Roundness::Convex, radii_mm, to_whole)?;
    let head_mm = ball.as_ref().map_or(0.0, Round::radius_mm);
    let to_head = |radius_mm: f64| (radius_mm - head_mm).abs();
    let socket = Round::from(cup, Roundness::Concave, radii_mm, to_head)?;
    match (ball, socket) {
        (Some(ball), Some(socket)) => Ok((ball, socket)),
        (_, None) if Round::from(head, Roundness::Concave, radii_mm, to_head)?.is_some() => {
            let message = "this body has a spherical socket, and the other has none; exchange --head and --cup";
            Err(BuildError::mesh(head, &["file"], message))
        }
        (None, _) => Err(not_round(head, "ball", "head")),
        (_, None) => Err(not_round(cup, "socket", "cup")),
    }
}

/// Returns the smallest radius on the market, mm, and the line of the inclination of a cup that differs from the usual one; none
/// if the machine tests no ball and socket.
fn of_joint(preset: Preset) -> Option<(f64, &'static str)> {
    match preset.machine().keys.tests {
        TestedJoint::Hip => Some((10.0, "")),
        // The discs of the presets lie across the load.
        TestedJoint::Disc => Some((5.0, "inclination_deg = 0.0\n")),
        _ => None,
    }
}

/// A body with the sphere in it, in the unit of its file.
struct Round<'a> {
    file: &'a Path,
    sphere: FittedSphere,
    unit: LengthUnit,
    /// Another unit in which its radius is on the market.
    other_unit: Option<LengthUnit>,
}

impl<'a> Round<'a> {
    /// Returns the body of a file if it has a sphere, in the unit that makes its radius one of `radii_mm`, and of two units the
    /// one with the smaller `oddity` of the radius.
    fn from(
        file: &'a Path,
        roundness: Roundness,
        radii_mm: &RangeInclusive<f64>,
        oddity: impl Fn(f64) -> f64,
    ) -> Result<Option<Self>, BuildError> {
        let mesh: TriangleMesh = parse_surface(file, &surface_bytes(&Disk, file)?)?;
        let Some(sphere) = FittedSphere::new(&mesh, roundness) else {
            return Ok(None);
        };
        let in_mm = |unit: &LengthUnit| sphere.radius_mm * unit.in_mm();
        let all = LengthUnit::ALL.iter().copied();
        let mut units: Vec<LengthUnit> =
            all.filter(|unit| radii_mm.contains(&in_mm(unit))).collect();
        units.sort_by(|one, two| oddity(in_mm(one)).total_cmp(&oddity(in_mm(two))));
        let Some(&unit) = units.first() else {
            let message = format!(
                "the sphere in this body has a radius of {:.4} in the unit of the file, and none of mm, cm, m and in makes it \
                 {} mm to {} mm, as those of this joint are; scale it, or write the case by hand",
                sphere.radius_mm,
                radii_mm.start(),
                radii_mm.end()
            );
            return Err(BuildError::mesh(file, &["length_unit"], message));
        };
        Ok(Some(Self {
            file,
            sphere,
            unit,
            other_unit: units.get(1).copied(),
        }))
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
        let other = self.other_unit.map(|unit| {
            let radius_mm = self.sphere.radius_mm * unit.in_mm();
            format!(
                "  The unit is uncertain: the radius would be {radius_mm:.3} mm with length_unit \"{}\", which is on the market too. \
                 Check it; if that is right, scale both files to mm and draft again.",
                unit.word()
            )
        });
        let mut remarks = vec![
            format!("{body}, derived from the shape of {}:", self.file.display()),
            format!(
                "  {part} of {:.3} mm radius with length_unit \"{}\"; its vertices are {rms_mm:.4} mm from it (rms){doubt}.",
                self.radius_mm(),
                self.unit.word()
            ),
        ];
        remarks.extend(other);
        remarks
    }
}

fn not_round(file: &Path, part: &str, body: &str) -> BuildError {
    let message = format!(
        "this body has no spherical {part}, as the {body} of a hip has; check that it is the {body} and that its triangles \
         face outwards"
    );
    BuildError::mesh(file, &["file"], message)
}
