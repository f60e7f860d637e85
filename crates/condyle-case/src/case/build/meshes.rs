//! Triangles of a file as a checked shell in the frame of a right knee, mm.

use std::path::Path;

use condyle::geometry::TriangleMesh;
use condyle::{Mat3, Vec3};
use condyle_mesh::repair::{CheckedMesh, Checks, Parts, Touching};

use super::super::frame::Axes;
use super::super::frame::LengthUnit;
use super::super::frame::Side;
#[cfg(feature = "file-system")]
use super::error::Body;
use super::error::{BuildError, BuildWarning, MeshFault, MeshRemark};
use super::size::check_triangles;
use super::size::stray_piece;
use crate::config::DataFile;
use condyle_mesh::formats::{parse_surface, surface_bytes};

/// Map from the unit and axes of a file to mm, x anterior, y superior, z to the right of a right knee.
pub(super) struct Placing {
    pub unit: LengthUnit,
    axes: Mat3,
    linear: Mat3,
    /// A left knee is mirrored, and its faces are turned round.
    pub mirrors: bool,
}

impl Placing {
    pub(super) fn new(unit: LengthUnit, axes: &Axes, side: Side) -> Result<Self, BuildError> {
        let axes = axes.rotation(side)?;
        let mirrors = side == Side::Left;
        let linear = mirror(mirrors) * (axes * unit.in_mm());
        Ok(Self {
            unit,
            axes,
            linear,
            mirrors,
        })
    }

    /// Returns the axes of a file whose body must be turned by `turn` after this placing.
    pub(super) fn axes_turned(&self, turn: &Mat3) -> Axes {
        let mirror = mirror(self.mirrors);
        Axes::of(&(mirror * turn * mirror * self.axes))
    }

    pub(super) fn bytes(&self) -> Vec<u8> {
        self.linear
            .iter()
            .flat_map(|entry| entry.to_le_bytes())
            .collect()
    }

    pub(super) fn point(&self, point: &Vec3) -> Vec3 {
        self.linear * point
    }

    fn mesh(&self, mesh: TriangleMesh) -> TriangleMesh {
        let mut placed = mesh.mapped(|vertex| self.point(vertex));
        if self.mirrors {
            turn_round(&mut placed);
        }
        placed
    }
}

fn mirror(mirrors: bool) -> Mat3 {
    Mat3::from_diagonal(&Vec3::new(1.0, 1.0, if mirrors { -1.0 } else { 1.0 }))
}

fn turn_round(mesh: &mut TriangleMesh) {
    mesh.triangles
        .iter_mut()
        .for_each(|triangle| triangle.swap(1, 2));
}

/// Expected orientation of a surface, and the checks of it.
#[derive(Clone, Copy)]
pub(super) struct ShellOf {
    /// Direction that an open surface must face on the whole.
    faces: Faces,
    checks: Checks,
}

impl ShellOf {
    pub(super) const FEMUR: Self = Self {
        faces: Faces::Down,
        checks: Checks {
            touching: Touching::FromBelowAndBehind,
            parts: Parts::All,
            clip_below_mm: None,
        },
    };

    pub(super) fn insert(clip_below_mm: Option<f64>) -> Self {
        Self {
            faces: Faces::Up,
            checks: Checks {
                touching: Touching::FromAbove,
                parts: Parts::SeenFromAbove,
                clip_below_mm,
            },
        }
    }
}

#[cfg(feature = "file-system")]
pub(in crate::case) fn checks_of(body: Body) -> Checks {
    match body {
        Body::Femur => ShellOf::FEMUR.checks,
        Body::Insert => ShellOf::insert(None).checks,
    }
}

pub(in crate::case) fn checks_of_insert(clip_below_mm: Option<f64>) -> Checks {
    ShellOf::insert(clip_below_mm).checks
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Faces {
    Up,
    Down,
}

/// Reads a surface, checks it and turns it to face out; adds a warning for each repair.
pub(super) fn shell(
    file: &DataFile,
    placing: &Placing,
    of: ShellOf,
    warnings: &mut Vec<BuildWarning>,
) -> Result<CheckedMesh, BuildError> {
    let bytes = surface_bytes(file.files(), file.path())?;
    let shell = parsed_shell(file.path(), &bytes, placing, of)?;
    warn(file, &shell, warnings);
    Ok(shell)
}

/// As [`shell`], from the bytes of the file and without warnings.
pub(super) fn parsed_shell(
    file: &Path,
    bytes: &[u8],
    placing: &Placing,
    of: ShellOf,
) -> Result<CheckedMesh, BuildError> {
    let mesh = placing.mesh(parse_surface(file, bytes)?);
    check_triangles(file, &mesh, placing.unit)?;
    check_clip(file, &mesh, of.checks.clip_below_mm)?;
    let mut shell = of
        .checks
        .check(mesh)
        .map_err(|error| BuildError::mesh(file, MeshFault::Shell(error)))?;
    if !shell.closed && faces(&shell.mesh) != of.faces {
        turn_round(&mut shell.mesh);
        shell.turned_round = true;
    }
    Ok(shell)
}

fn check_clip(
    file: &Path,
    mesh: &TriangleMesh,
    clip_below_mm: Option<f64>,
) -> Result<(), BuildError> {
    let (low, high) = mesh.bounds();
    match clip_below_mm {
        Some(height_mm) if height_mm <= low.y || height_mm >= high.y => {
            let fault = MeshFault::ClipMisses {
                height_mm,
                low_mm: low.y,
                high_mm: high.y,
            };
            Err(BuildError::mesh(file, fault))
        }
        _ => Ok(()),
    }
}

/// Adds a warning for each repair of a file, and for each suspicious property.
pub(super) fn warn(file: &DataFile, shell: &CheckedMesh, warnings: &mut Vec<BuildWarning>) {
    let counted =
        |count: usize, remark: fn(usize) -> MeshRemark| (count > 0).then(|| remark(count));
    let parts = &shell.left_out;
    let defects = &shell.defects;
    let remarks = [
        stray_piece(&shell.mesh).map(MeshRemark::StrayPiece),
        (!parts.is_empty()).then(|| MeshRemark::LeftOut(parts.clone())),
        shell.turned_round.then_some(MeshRemark::TurnedRound),
        counted(shell.made_consistent, MeshRemark::MadeConsistent),
        counted(shell.wrinkles, MeshRemark::Wrinkles),
        counted(shell.removed_degenerate, MeshRemark::RemovedDegenerate),
        (!defects.is_empty()).then(|| MeshRemark::Defects(defects.clone())),
    ];
    let remarks = remarks.into_iter().flatten();
    warnings.extend(remarks.map(|remark| BuildWarning::mesh(file, remark)));
}

/// Returns the direction that most of the surface faces, by its area seen from above.
fn faces(mesh: &TriangleMesh) -> Faces {
    let upward = |triangle: usize| {
        let [a, b, c] = mesh.corners(triangle);
        (b - a).cross(&(c - a)).y
    };
    let sum: f64 = (0..mesh.triangles.len()).map(upward).sum();
    if sum > 0.0 { Faces::Up } else { Faces::Down }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_a_left_knee_becomes_its_mirror_image() {
        let placing = Placing::new(LengthUnit::Metre, &Axes::ISB, Side::Left).unwrap();
        let placed = placing.point(&Vec3::new(0.001, 0.002, 0.003));
        assert!((placed - Vec3::new(1.0, 2.0, -3.0)).norm() < 1e-12);
        let mesh = TriangleMesh {
            vertices: vec![Vec3::zeros(), Vec3::x(), Vec3::z()],
            triangles: vec![[0, 2, 1]],
        };
        assert!(faces(&mesh) == Faces::Up && faces(&placing.mesh(mesh)) == Faces::Up);
    }
}
