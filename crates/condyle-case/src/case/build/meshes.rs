//! Triangles of a file as a shell in the frame of a right knee, mm.

use std::path::{Path, PathBuf};

use condyle::geometry::TriangleMesh;
use condyle::{Mat3, Vec3};
use condyle_mesh::repair::{CheckedMesh, Checks, Parts, Touching};

use super::super::frame::Axes;
use super::super::frame::LengthUnit;
use super::super::frame::Side;
#[cfg(feature = "file-system")]
use super::error::Body;
use super::error::{BuildError, BuildWarning};
use super::size::check_triangles;
use super::size::stray_piece;
use crate::config::DataFile;
use condyle_mesh::formats::{parse_surface, surface_bytes};

/// From the unit and axes of a file to mm, x anterior, y superior, z to the right of a right knee.
pub(super) struct Placing {
    pub unit: LengthUnit,
    axes: Mat3,
    linear: Mat3,
    /// A left knee is mirrored, so that faces must be turned round.
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

    /// The axes of a file whose body, placed so, is yet to be turned.
    pub(super) fn axes_turned(&self, turn: &Mat3) -> Axes {
        let mirror = mirror(self.mirrors);
        Axes::of(&(mirror * turn * mirror * self.axes))
    }

    /// Its bytes, the same for the same placing.
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

/// What makes a right knee of a left one, or changes nothing.
fn mirror(mirrors: bool) -> Mat3 {
    Mat3::from_diagonal(&Vec3::new(1.0, 1.0, if mirrors { -1.0 } else { 1.0 }))
}

/// Lets every triangle face the other way.
fn turn_round(mesh: &mut TriangleMesh) {
    mesh.triangles
        .iter_mut()
        .for_each(|triangle| triangle.swap(1, 2));
}

/// What a surface is to be, and what is done with it before it is checked.
#[derive(Clone, Copy)]
pub(super) struct ShellOf {
    /// Which way an open surface must face on the whole.
    faces: Faces,
    checks: Checks,
}

impl ShellOf {
    /// Of a femur, which faces down.
    pub(super) const FEMUR: Self = Self {
        faces: Faces::Down,
        checks: Checks {
            touching: Touching::FromBelowAndBehind,
            parts: Parts::All,
            clip_below_mm: None,
        },
    };

    /// Of an insert, which faces up, cut away below a height.
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

/// What the shell of a body is checked for, once it lies in the frame of a knee.
#[cfg(feature = "file-system")]
pub(in crate::case) fn checks_of(body: Body) -> Checks {
    match body {
        Body::Femur => ShellOf::FEMUR.checks,
        Body::Insert => ShellOf::insert(None).checks,
    }
}

/// What an insert is checked for that is cut away below a height.
pub(in crate::case) fn checks_of_insert(clip_below_mm: Option<f64>) -> Checks {
    ShellOf::insert(clip_below_mm).checks
}

/// Up or down.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Faces {
    Up,
    Down,
}

/// Reads a surface, checks it and turns it to face out; says what it put right.
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

/// The same from the bytes of the file, without a word of what was put right or looks wrong.
pub(super) fn parsed_shell(
    file: &Path,
    bytes: &[u8],
    placing: &Placing,
    of: ShellOf,
) -> Result<CheckedMesh, BuildError> {
    let mesh = placing.mesh(parse_surface(file, bytes)?);
    check_triangles(file, &mesh, placing.unit)?;
    check_clip(file, &mesh, of.checks.clip_below_mm)?;
    let mut shell = of.checks.check(mesh).map_err(|source| BuildError::Shell {
        file: file.to_path_buf(),
        source,
    })?;
    if !shell.closed && faces(&shell.mesh) != of.faces {
        turn_round(&mut shell.mesh);
        shell.turned_round = true;
    }
    Ok(shell)
}

/// Refuses a height that the mesh does not pass.
fn check_clip(
    file: &Path,
    mesh: &TriangleMesh,
    clip_below_mm: Option<f64>,
) -> Result<(), BuildError> {
    let (low, high) = mesh.bounds();
    match clip_below_mm {
        Some(height_mm) if height_mm <= low.y || height_mm >= high.y => {
            Err(BuildError::ClipMisses {
                file: file.to_path_buf(),
                height_mm,
                low_mm: low.y,
                high_mm: high.y,
            })
        }
        _ => Ok(()),
    }
}

/// Says what was put right in a file, and what looks wrong, by its name alone: results say so too, and name no folder.
pub(super) fn warn(file: &DataFile, shell: &CheckedMesh, warnings: &mut Vec<BuildWarning>) {
    let file = || PathBuf::from(file.name());
    if let Some(piece) = stray_piece(&shell.mesh) {
        let file = file();
        warnings.push(BuildWarning::StrayPiece { file, piece });
    }
    if !shell.left_out.is_empty() {
        let parts = shell.left_out.clone();
        warnings.push(BuildWarning::LeftOut {
            file: file(),
            parts,
        });
    }
    if shell.turned_round {
        warnings.push(BuildWarning::TurnedRound { file: file() });
    }
    if shell.made_consistent > 0 {
        let count = shell.made_consistent;
        warnings.push(BuildWarning::MadeConsistent {
            file: file(),
            count,
        });
    }
    if shell.wrinkles > 0 {
        let count = shell.wrinkles;
        warnings.push(BuildWarning::Wrinkles {
            file: file(),
            count,
        });
    }
    if shell.removed_degenerate > 0 {
        let count = shell.removed_degenerate;
        warnings.push(BuildWarning::RemovedDegenerate {
            file: file(),
            count,
        });
    }
    if !shell.defects.is_empty() {
        let defects = shell.defects.clone();
        warnings.push(BuildWarning::Defects {
            file: file(),
            defects,
        });
    }
}

/// Which way most of the surface's shadow from above faces.
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
