//! The femur of a case pressed on its deformable insert at one place of the first cycle.

use std::io::{self, Write};
use std::ops::ControlFlow;

use condyle::contact::Bodies;
use condyle::evolve::{March, MarchError, PlacementError};
use condyle::geometry::TriangleMesh;
use condyle::machine::CycleRow;
use condyle::spatial::Pose;
use condyle_fem::Hardening;
use thiserror::Error;

use super::pressed::Pressed;
use crate::case::{BuildError, BuildWarning, Case, FEMUR_TRIANGLES, Side};

/// A case with a deformable insert, and its first solved cycle on the unworn insert.
pub struct PressedCase<'a> {
    case: &'a Case,
    hardening: Option<Hardening>,
    triangles: TriangleMesh,
    unworn: March,
    cycle: Vec<(CycleRow, Pose)>,
    /// Repairs of the meshes and other remarks of the build.
    pub warnings: Vec<BuildWarning>,
}

impl<'a> PressedCase<'a> {
    /// Builds the case and solves its first cycle; `threads` share the work on a mesh.
    ///
    /// # Errors
    /// A foundation, a resting backside, kinematic hardening, a case that does not build, bodies that do not settle, or a
    /// cycle that cannot be solved.
    pub fn new(case: &'a Case, threads: usize) -> Result<Self, ExportError> {
        let Some(model) = case.contact.deformable() else {
            return Err(ExportError::Unsupported {
                supported: "a femur pressed on a deformable insert",
                found: "an elastic foundation".to_owned(),
                remedy: "[contact] model = \"deformable\"",
            });
        };
        if model.backside.is_resting() {
            return Err(ExportError::Unsupported {
                supported: "an insert that is bonded to its tray",
                found: "backside = \"resting\"".to_owned(),
                remedy: "[contact.deformable] backside = \"bonded\"",
            });
        }
        let hardening = model.plasticity.hardening();
        let modulus_mpa = hardening.as_ref().map_or(0.0, Hardening::kinematic_modulus);
        if modulus_mpa != 0.0 {
            return Err(ExportError::Unsupported {
                supported: "isotropic hardening only",
                found: format!("kinematic_modulus_mpa = {modulus_mpa}"),
                remedy: "kinematic_modulus_mpa = 0",
            });
        }
        let built = case.build(threads)?;
        let unworn = March::start(built.test)?;
        let mut march = March::resume(unworn.test().clone(), unworn.state().clone());
        if let Err(error) = march.update(&mut |_| ControlFlow::Continue(())) {
            return Err(ExportError::Cycle(Box::new(error)));
        }
        let cycle = march.last_cycle().map_or_else(Vec::new, |cycle| {
            let rows = cycle.rows.iter().enumerate();
            rows.map(|(increment, row)| (*row, cycle.pose(increment)))
                .collect()
        });
        Ok(Self {
            case,
            hardening,
            triangles: case.femur_triangles(unworn.test(), FEMUR_TRIANGLES)?,
            cycle,
            unworn,
            warnings: built.warnings,
        })
    }

    /// Returns the test with the unworn insert.
    pub fn unworn(&self) -> &March {
        &self.unworn
    }

    /// Returns the increment that ends nearest to `percent` of the cycle, and the femur's pose at its end in the insert frame.
    ///
    /// # Errors
    /// If nothing touches there.
    pub fn at(&self, percent: f64) -> Result<(CycleRow, Pose), ExportError> {
        let off = |row: &CycleRow| (row.percent - percent).abs();
        let nearest = |one: &&(CycleRow, Pose), other: &&(CycleRow, Pose)| {
            off(&one.0).total_cmp(&off(&other.0))
        };
        let found = self.cycle.iter().min_by(nearest).copied();
        let touching = found.filter(|(row, _)| row.contact_area_mm2 > 0.0);
        touching.ok_or(ExportError::Apart { percent })
    }

    /// Writes the femur pressed on the insert at its pose at `percent` of the cycle.
    ///
    /// # Errors
    /// If nothing touches there, or the file cannot be written.
    pub fn write(&self, percent: f64, out: &mut impl Write) -> Result<(), ExportError> {
        let (row, pose) = self.at(percent)?;
        let (case, insert) = (self.case, self.unworn.insert());
        let pressed = Pressed {
            title: &case.heading.title.replace(['\n', '\r'], " "),
            note: &note(case, &row),
            bodies: Bodies {
                counterface: self.unworn.counterface(),
                insert,
                surface: &insert.surface(),
            },
            triangles: &self.triangles,
            elastic: case.material.elastic(),
            hardening: self.hardening.as_ref(),
            pose,
            slide: None,
        };
        let written = pressed.write(out);
        written.map_err(|source| ExportError::Write { source })
    }
}

fn note(case: &Case, row: &CycleRow) -> String {
    let mirrored = if case.side_in_frame() == Side::Left {
        "\nThis is the mirror image of the case, with z reversed."
    } else {
        ""
    };
    format!(
        "Written by condyle {} for CalculiX (and Abaqus): the femur pressed on the unworn insert, without friction,\n\
         to where it is at {} % of the first cycle of {:?}. condyle's contact carries {:.3} N down there, touches\n\
         on {:.2} mm2 and presses with {:.3} MPa at most, including friction and earlier yield.{mirrored}",
        env!("CARGO_PKG_VERSION"),
        row.percent,
        case.heading.title,
        row.axial_force_n,
        row.contact_area_mm2,
        row.peak_pressure_mpa,
    )
}

/// A case that cannot be exported.
#[expect(missing_docs, reason = "the messages describe the variants and fields")]
#[derive(Debug, Error)]
pub enum ExportError {
    /// The case does not build.
    #[error(transparent)]
    Build(#[from] BuildError),
    /// The femur cannot be placed on the insert.
    #[error(transparent)]
    Placement(#[from] PlacementError),
    #[error("the export supports {supported}, but this case has {found}; write {remedy}")]
    Unsupported {
        supported: &'static str,
        found: String,
        remedy: &'static str,
    },
    #[error("the bodies are not in contact at {percent} % of the cycle; choose another percentage")]
    Apart { percent: f64 },
    /// The first cycle could not be solved.
    #[error(transparent)]
    Cycle(Box<MarchError>),
    #[error("the exported file cannot be written: {source}; check the disk and the folder")]
    Write { source: io::Error },
}
