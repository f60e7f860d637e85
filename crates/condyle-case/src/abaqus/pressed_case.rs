//! The femur of a case pressed on its deformable insert, where its first cycle is at a place.

use std::io::Write;
use std::ops::ControlFlow;

use condyle::contact::Bodies;
use condyle::evolve::March;
use condyle::geometry::TriangleMesh;
use condyle::machine::CycleRow;
use condyle::spatial::Pose;
use condyle_fem::Hardening;

use super::error::ExportError;
use super::pressed::Pressed;
use crate::case::{BuildWarning, Case, ContactModelWord, FEMUR_TRIANGLES, Side};

/// A case with a deformable insert, and its first solved cycle on the unworn insert.
pub struct PressedCase<'a> {
    case: &'a Case,
    hardening: Option<Hardening>,
    triangles: TriangleMesh,
    unworn: March,
    cycle: Vec<(CycleRow, Pose)>,
    /// What was put right in the meshes on the way.
    pub warnings: Vec<BuildWarning>,
}

impl<'a> PressedCase<'a> {
    /// Builds the case and solves its first cycle; `threads` share the work on a mesh.
    ///
    /// # Errors
    /// A foundation, a backside that rests, kinematic hardening, a case that does not build, bodies that do not settle, or a cycle that is
    /// not solved.
    pub fn new(case: &'a Case, threads: usize) -> Result<Self, ExportError> {
        if case.contact.model == ContactModelWord::Foundation {
            return Err(ExportError::Foundation);
        }
        if case.contact.backside.is_resting() {
            return Err(ExportError::Resting);
        }
        let hardening = case.contact.plasticity.hardening();
        let modulus_mpa = hardening.as_ref().map_or(0.0, Hardening::kinematic_modulus);
        if modulus_mpa != 0.0 {
            return Err(ExportError::KinematicHardening { modulus_mpa });
        }
        let built = case.build(threads)?;
        let unworn = March::start(built.test)?;
        Ok(Self {
            case,
            hardening,
            triangles: case.femur_triangles(unworn.test(), FEMUR_TRIANGLES)?,
            cycle: first_cycle(&unworn)?,
            unworn,
            warnings: built.warnings,
        })
    }

    /// The test, its insert unworn.
    pub fn unworn(&self) -> &March {
        &self.unworn
    }

    /// The increment that ends nearest to `percent` of the cycle, and where the femur is then in the insert frame.
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

    /// Writes the bodies alone, the femur pressed to where it is at `percent` of the cycle, for CalculiX and Abaqus.
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
                femur: self.unworn.femur(),
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

fn first_cycle(unworn: &March) -> Result<Vec<(CycleRow, Pose)>, ExportError> {
    let mut march = March::resume(unworn.test().clone(), unworn.state().clone());
    match march.update(&mut |_| ControlFlow::Continue(())) {
        Ok(ControlFlow::Continue(_) | ControlFlow::Break(())) => {}
        Err(error) => return Err(ExportError::Cycle(Box::new(error))),
    }
    let cycle = march.last_cycle();
    Ok(cycle.map_or_else(Vec::new, |cycle| {
        let rows = cycle.rows.iter().enumerate();
        rows.map(|(increment, row)| (*row, cycle.pose(increment)))
            .collect()
    }))
}

fn note(case: &Case, row: &CycleRow) -> String {
    let mirrored = if case.heading.side == Side::Left {
        "\nThe case is a left knee: this is its mirror image."
    } else {
        ""
    };
    format!(
        "Written by condyle {} for CalculiX (and Abaqus): the femur pressed on the unworn insert, without friction,\n\
         to where it is at {} % of the first cycle of {:?}. condyle's contact carries {:.3} N down there, touches\n\
         on {:.2} mm2 and presses with {:.3} MPa at most, friction and what has yielded before included.{mirrored}",
        env!("CARGO_PKG_VERSION"),
        row.percent,
        case.heading.title,
        row.axial_force_n,
        row.contact_area_mm2,
        row.peak_pressure_mpa,
    )
}
