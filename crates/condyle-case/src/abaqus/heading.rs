//! What the file is, and what differs from condyle's model.

use std::io::{self, Write};

use condyle::machine::{JointIndex, knee};

use super::model::Model;
use crate::case::Side;
use condyle_mesh::formats::InpWriter;

const SIGNS: &str = "\nUNITS mm, N, s, tonne, MPa, rad.
FRAME x anterior, y superior, z to the right, which is lateral: a right knee.
SIGNS of motions: AP + anterior, ML + lateral, IE + internal (about +y), VV + varus (about +x), all four
of the insert; IS + superior and flexion + flexion (about +z), both of the femur. Loads have the sign of
the motion they push.";

const DIFFERS: &str = "\nWHAT DIFFERS FROM CONDYLE'S MODEL
- The faces of both bodies are flat here; condyle holds smooth surfaces against each other. Under a
  light load that shows: the shipped generic implant carries 214 N rather than 206 N in the pose where
  the file begins.
- Contact is enforced by Abaqus's surface-to-surface or penalty method; condyle integrates the pressure
  over the share of surface around every node, cut where the overlap ends.
- Friction sticks elastically over a short slip (Standard) or by a penalty (Explicit); condyle's is
  mu p v / sqrt(v^2 + v0^2) with the case's speed v0. While condyle settles there is no friction.
- The springs are there while it settles, but slack within their free play; condyle settles without.
- The insert's elements have a density: their mass comes on top of the machine's own, which is much larger.
- Time is integrated by Abaqus's scheme with its own increments, condyle's by backward differences.
- One cycle from rest; condyle repeats it until it ends where it began. No wear.";

pub(super) fn write<W: Write>(model: &Model<'_>, inp: &mut InpWriter<W>) -> io::Result<()> {
    let title = model.case.heading.title.replace(['\n', '\r'], " ");
    inp.heading(&title)?;
    inp.comment(&format!(
        "Written by condyle {} for {}, with {}.",
        env!("CARGO_PKG_VERSION"),
        if model.options.explicit {
            "Abaqus/Explicit (run it in double precision)"
        } else {
            "Abaqus/Standard"
        },
        if model.options.deformable {
            "an elastic insert"
        } else {
            "a rigid insert under a softened contact, condyle's own model"
        }
    ))?;
    if model.case.heading.side == Side::Left {
        inp.comment("The case is a left knee: this is its mirror image.")?;
    }
    inp.comment(SIGNS)?;
    inp.comment(&pose(model))?;
    inp.comment(DIFFERS)?;
    inp.comment(deformable_differs(model))
}

fn deformable_differs(model: &Model<'_>) -> &'static str {
    if model.options.deformable {
        "- The insert is linear elastic and its contact hard: neighbouring points of the surface feel each\n\
         \u{20} other. condyle's is an elastic layer under each point alone."
    } else {
        "- The pressure law uses one thickness for the whole insert, condyle the local one."
    }
}

/// Where both bodies stand when the file begins.
fn pose(model: &Model<'_>) -> String {
    let at = |joint: JointIndex| joint.of(&model.placing.positions);
    let is_mm = at(knee::IS);
    let deepest = model
        .placing
        .gaps_mm(model.test)
        .into_iter()
        .fold(f64::INFINITY, f64::min);
    format!(
        "\nPOSE. The bodies stand where condyle finds them settled under the axial force at 0 % of the cycle:\n\
         flexion {:.4} deg, VV {:.6} deg, IE 0, and AP = ML = 0 by definition; IS is {is_mm:.5} mm from there.\n\
         Smallest gap {deepest:.5} mm (negative is overlap).",
        at(knee::FLEXION).to_degrees(),
        at(knee::VV).to_degrees(),
    )
}
