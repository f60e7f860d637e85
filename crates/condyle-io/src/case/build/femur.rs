//! The femoral component as the contact sees it.

use std::path::Path;

use condyle::Vec3;
use condyle::geometry::{
    CheckedShell, Cylinder, FemoralSurface, GenericFemur, GenericFemurShape, SmoothField,
    TriangleMesh,
};
use serde::{Deserialize, Serialize};

use super::super::femur::{Femur, MeshFemur};
use super::super::heading::Side;
use super::error::{BuildError, BuildWarning};
use super::lie::check_lie;
use super::meshes::{Faces, Placing, parsed_shell, shell, warn};
use super::wrong_axes::Body;
use crate::cache::{Keep, kept};
use crate::keyed::DataFile;
use crate::mesh::surface_bytes;

/// A femoral surface, the axis it flexes about and where that starts over the insert.
pub(super) struct BuiltFemur {
    pub surface: FemoralSurface,
    /// (x, y) in the femoral frame.
    pub flexion_axis_mm: (f64, f64),
    /// (x, z) of the flexion axis in the insert frame.
    pub start_mm: (f64, f64),
}

/// How the one-time work on a mesh is done.
#[derive(Clone, Copy)]
pub(super) struct Preparing<'a> {
    pub threads: usize,
    pub keep: &'a dyn Keep,
}

impl Femur {
    /// The femur, which starts the cycle flexed by `flexion_rad`.
    pub(super) fn build(
        &self,
        side: Side,
        flexion_rad: f64,
        preparing: Preparing<'_>,
        warnings: &mut Vec<BuildWarning>,
    ) -> Result<BuiltFemur, BuildError> {
        let start = |start: Option<[f64; 2]>| start.map(|start| on_the_right(start, side));
        Ok(match self {
            Self::Generic(femur) => {
                let shape = GenericFemurShape {
                    distal_radius_mm: femur.distal_radius_mm,
                    posterior_radius_mm: femur.posterior_radius_mm,
                    transition_deg: femur.transition_deg,
                    coronal_radius_mm: femur.coronal_radius_mm,
                    spacing_mm: femur.spacing_mm,
                };
                BuiltFemur {
                    surface: FemoralSurface::Generic(GenericFemur::new(shape)),
                    flexion_axis_mm: (0.0, 0.0),
                    start_mm: start(femur.start_mm).unwrap_or(over_the_dish(&shape, flexion_rad)),
                }
            }
            Self::Sphere(femur) => BuiltFemur {
                surface: FemoralSurface::sphere(femur.radius_mm),
                flexion_axis_mm: (0.0, 0.0),
                start_mm: start(femur.start_mm).unwrap_or((0.0, 0.0)),
            },
            Self::Cylinder(femur) => BuiltFemur {
                surface: FemoralSurface::Cylinder(Cylinder {
                    radius_mm: femur.radius_mm,
                }),
                flexion_axis_mm: (0.0, 0.0),
                start_mm: start(femur.start_mm).unwrap_or((0.0, 0.0)),
            },
            Self::Mesh(femur) => from_mesh(femur, side, flexion_rad, preparing, warnings)?,
        })
    }
}

impl MeshFemur {
    /// Its triangles as a checked shell in the femoral frame of a right knee, mm.
    pub(crate) fn triangles(&self, side: Side) -> Result<TriangleMesh, BuildError> {
        let placing = Placing::new(self.length_unit, &self.axes, side)?;
        Ok(shell(&self.file, &placing, Faces::Down, &mut Vec::new())?.mesh)
    }
}

/// A place [x, z] of the insert frame, mirrored with a left knee.
fn on_the_right([x, z]: [f64; 2], side: Side) -> (f64, f64) {
    match side {
        Side::Right => (x, z),
        Side::Left => (x, -z),
    }
}

/// Where the frame must be for the centre of the distal arc to stand over x = 0.
///
/// That centre lies (distal - posterior radius) from the origin, opposite to the transition.
fn over_the_dish(shape: &GenericFemurShape, flexion_rad: f64) -> (f64, f64) {
    let to_centre_mm = shape.distal_radius_mm - shape.posterior_radius_mm;
    let anterior_rad = shape.transition_deg.to_radians() - flexion_rad;
    (-to_centre_mm * anterior_rad.sin(), 0.0)
}

fn from_mesh(
    femur: &MeshFemur,
    side: Side,
    flexion_rad: f64,
    preparing: Preparing<'_>,
    warnings: &mut Vec<BuildWarning>,
) -> Result<BuiltFemur, BuildError> {
    let placing = Placing::new(femur.length_unit, &femur.axes, side)?;
    let PreparedFemur { shell, field } = prepared(&femur.file, &placing, preparing)?;
    warn(&femur.file, &shell, warnings);
    check_lie(Body::Femur, &femur.file, &shell.mesh, &placing, warnings)?;
    let flexion_axis_mm = match femur.flexion_axis_mm {
        Some([x, y]) => (x, y),
        None => shell.mesh.posterior_arc_centre_mm(),
    };
    let (x, z) = on_the_right(femur.start_mm.unwrap_or_default(), side);
    Ok(BuiltFemur {
        surface: FemoralSurface::Mesh(field),
        flexion_axis_mm,
        start_mm: (x + axis_ahead_mm(flexion_axis_mm, flexion_rad), z),
    })
}

/// The one-time work on a mesh femur.
#[derive(Serialize, Deserialize)]
struct PreparedFemur {
    shell: CheckedShell,
    field: SmoothField,
}

/// The shell in a file and its field, computed or kept from a run before.
fn prepared(
    file: &DataFile,
    placing: &Placing,
    preparing: Preparing<'_>,
) -> Result<PreparedFemur, BuildError> {
    let path = file.path();
    let bytes = surface_bytes(file.files(), path)?;
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    let inputs = [ending.as_encoded_bytes(), &placing.bytes(), &bytes];
    kept(preparing.keep, "femur", &inputs, || {
        let shell = parsed_shell(path, &bytes, placing, Faces::Down)?;
        check_node_count(path, &shell.mesh)?;
        let field = SmoothField::new(&shell.mesh, preparing.threads);
        Ok(PreparedFemur { shell, field })
    })
}

/// Nodes of a field that take 2 GB while it is made.
const MOST_NODES: usize = 50_000_000;

fn check_node_count(file: &Path, mesh: &TriangleMesh) -> Result<(), BuildError> {
    let nodes = SmoothField::node_count(mesh);
    if nodes <= MOST_NODES {
        return Ok(());
    }
    let (file, most) = (file.to_path_buf(), MOST_NODES);
    Err(BuildError::TooManyNodes { file, nodes, most })
}

/// How far anterior of the frame's origin the flexion axis lies in the insert frame.
fn axis_ahead_mm(flexion_axis_mm: (f64, f64), flexion_rad: f64) -> f64 {
    let axis = Vec3::new(flexion_axis_mm.0, flexion_axis_mm.1, 0.0);
    let (sine, cosine) = flexion_rad.sin_cos();
    axis.x * cosine - axis.y * sine
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_extended_generic_femur_starts_with_its_distal_centre_over_the_dish() {
        let (x, z) = over_the_dish(&GenericFemurShape::default(), -7f64.to_radians());
        // The centre, 16 mm out at 20 degrees, leans 7 degrees further forward.
        assert!((x + 16.0 * 27f64.to_radians().sin()).abs() < 1e-12);
        assert_eq!(z, 0.0);
    }

    #[test]
    fn verify_axis_turns_with_the_femur() {
        let quarter = std::f64::consts::FRAC_PI_2;
        assert!((axis_ahead_mm((3.0, 5.0), 0.0) - 3.0).abs() < 1e-12);
        assert!((axis_ahead_mm((3.0, 5.0), quarter) + 5.0).abs() < 1e-12);
    }

    #[test]
    fn a_left_start_is_mirrored() {
        assert_eq!(on_the_right([1.0, 2.0], Side::Left), (1.0, -2.0));
    }
}
