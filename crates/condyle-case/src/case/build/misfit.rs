//! Bodies of another kind or orientation than the case states: the likely causes of a case that does not start.

use condyle::Mat3;
use condyle::anatomy::{Likeness, Upright};
use condyle::geometry::TriangleMesh;
use condyle_mesh::formats::read_surface;

use super::error::Body;
use super::placing::{Placing, WrittenRotation};
use crate::case::contents::Case;
use crate::case::femur::FemurShape;
use crate::case::insert::InsertShape;
use crate::config::DataFile;

/// Ratio of the widths of femur and insert, and its inverse, beyond which they are not of one implant; neighbouring
/// sizes of real ones are within it.
const MAX_WIDTH_RATIO: f64 = 1.25;

/// Angle to its axes beyond which a body is reported, degrees: what a shape shows is known to about a degree.
const MAX_OFF_DEG: f64 = 5.0;

/// A body that does not fit, with the keys at fault.
pub(in crate::case) struct Misfit {
    pub body: Body,
    pub keys: &'static [&'static str],
    pub text: String,
}

/// A mesh of a case in the frame of a right knee, mm.
struct Placed<'a> {
    body: Body,
    file: &'a DataFile,
    placing: Placing,
    mesh: TriangleMesh,
}

impl Case {
    /// Examines what the meshes of this case resemble, how they lie, and whether their sizes belong together.
    ///
    /// It takes some tenths of a second: runs that start need it not.
    pub fn misfit_remarks(&self) -> Vec<String> {
        self.misfits()
            .into_iter()
            .map(|misfit| misfit.text)
            .collect()
    }

    pub(in crate::case) fn misfits(&self) -> Vec<Misfit> {
        if !self.tests_knee() {
            return Vec::new();
        }
        let (femur, insert) = (self.placed_femur(), self.placed_insert());
        let both = femur.as_ref().zip(insert.as_ref());
        let of_sizes = both.and_then(|(femur, insert)| of_sizes(femur, insert));
        let bodies = femur.iter().chain(&insert);
        bodies.filter_map(Placed::misfit).chain(of_sizes).collect()
    }

    fn placed_femur(&self) -> Option<Placed<'_>> {
        let FemurShape::Mesh(femur) = &self.femur.shape else {
            return None;
        };
        let placing = Placing::new(&femur.frame, femur.origin_mm, self.side_in_frame());
        Placed::read(Body::Femur, &femur.file, placing.ok()?)
    }

    fn placed_insert(&self) -> Option<Placed<'_>> {
        match &self.insert.shape {
            InsertShape::Mesh(insert) => {
                let placing = Placing::new(&insert.frame, None, self.side_in_frame()).ok()?;
                Placed::read(Body::Insert, &insert.file, placing)
            }
            InsertShape::Hexahedra(insert) => {
                let (file, placing) = self.placed_hexahedra(insert).ok()?;
                Some(Placed {
                    body: Body::Insert,
                    file: &insert.file,
                    placing,
                    mesh: file.mesh_of_boundary(),
                })
            }
            _ => None,
        }
    }
}

impl<'a> Placed<'a> {
    fn read(body: Body, file: &'a DataFile, placing: Placing) -> Option<Self> {
        Some(Self {
            body,
            file,
            mesh: placing.mesh(read_surface(file.files(), file.path()).ok()?),
            placing,
        })
    }

    fn misfit(&self) -> Option<Misfit> {
        let (body, name) = (self.body, self.file.name());
        let likeness = Likeness::of(&self.mesh)?;
        if let Some(advice) = advice(body, likeness) {
            return Some(Misfit {
                body,
                keys: &["file"],
                text: format!("{name}: this {body} is {likeness}; {advice}"),
            });
        }
        // The shape of a femur shows its flexion to about 10 degrees only; an insert on the bone has a slope.
        let (upright, off_deg) = match body {
            Body::Femur => Upright::of_femur(&self.mesh).map(|one| (one.clone(), one.lean_deg())),
            Body::Insert => Upright::of_insert(&self.mesh)
                .filter(|one| !one.only_slopes())
                .map(|one| (one.clone(), one.off_square_deg())),
        }?;
        if off_deg < MAX_OFF_DEG {
            return None;
        }
        let turn = upright.turn?;
        let orientation = upright.recognition.nearest_after(&turn).rotation();
        let total: Mat3 = self.placing.rotation_turned(&(orientation * turn));
        let lines = WrittenRotation::of(&total).lines();
        let text = format!(
            "{name}: this {body} lies {:.0} degrees off its axes; write {}, as its shape indicates",
            off_deg,
            lines.trim_end().replace('\n', " and ")
        );
        Some(Misfit {
            body,
            keys: &["rotation_deg", "axes", "file"],
            text,
        })
    }

    fn width_mm(&self) -> f64 {
        let (low, high) = self.mesh.bounds();
        high.z - low.z
    }
}

/// Returns what to do with a body that resembles something else than its table says; none if it does not.
pub(in crate::case) fn advice(body: Body, likeness: Likeness) -> Option<&'static str> {
    match (body, likeness) {
        (Body::Femur, Likeness::Femur | Likeness::OneCompartment)
        | (Body::Insert, Likeness::Insert) => None,
        (_, Likeness::Femur | Likeness::Insert) => Some("exchange femur and insert"),
        (_, Likeness::Head(_) | Likeness::Cup) => Some(
            "draft a hip from the files of both: condyle new hip.toml --head HEAD --cup CUP; or by dimensions: condyle new \
             hip.toml --joint hip",
        ),
        (_, Likeness::Tray) => Some("give the polyethylene that lies on it"),
        (_, Likeness::OneCompartment) => Some(
            "condyle tests whole knees, and a femur on one compartment alone would tip over; give the inserts and the condyles of \
             both sides",
        ),
    }
}

/// Compares the widths of both bodies.
fn of_sizes(femur: &Placed<'_>, insert: &Placed<'_>) -> Option<Misfit> {
    let (of_femur, of_insert) = (femur.width_mm(), insert.width_mm());
    let ratio = of_femur / of_insert;
    let text = format!(
        "{}: this femur is {of_femur:.1} mm wide and the insert {of_insert:.1} mm, unlike those of one implant; check both files \
         and their length_unit",
        femur.file.name()
    );
    (ratio.max(1.0 / ratio) > MAX_WIDTH_RATIO).then_some(Misfit {
        body: Body::Femur,
        keys: &["length_unit", "file"],
        text,
    })
}
