//! What leads and pushes the freedoms, over time.

use std::io::{self, Write};

use condyle::machine::{Drive, FREEDOMS, Freedom, Waveform};

use super::model::Model;
use super::names;
use super::step_times::{SETTLE_S, START_S};
use crate::mesh::InpWriter;

/// Points of a table at least.
const POINTS: usize = 400;

pub(super) fn write<W: Write>(model: &Model<'_>, inp: &mut InpWriter<W>) -> io::Result<()> {
    inp.comment(
        "\nAMPLITUDES in the time of their step, s. Motions, mm and rad, count from the pose in which the\n\
         file begins; loads, N and N mm, have the sign of the motion they push: the axial force, a\n\
         compression, pushes the femur down and is negative.",
    )?;
    inp.amplitude(names::HOLD, &[(0.0, 1.0), (model.cycle_s(), 1.0)])?;
    smooth_step(inp, names::RAMP, START_S)?;
    if model.options.explicit {
        smooth_step(inp, names::LOADING, SETTLE_S)?;
    } else {
        inp.amplitude(names::LOADING, &[(0.0, 1.0), (SETTLE_S, 1.0)])?;
    }
    for freedom in FREEDOMS {
        if let Some((name, table)) = wave(model, freedom) {
            inp.amplitude(name, &table)?;
        }
    }
    Ok(())
}

/// From 0 to 1 in `seconds`, without a jolt at either end.
fn smooth_step<W: Write>(inp: &mut InpWriter<W>, name: &str, seconds: f64) -> io::Result<()> {
    inp.keyword(&format!("*AMPLITUDE, NAME={name}, DEFINITION=SMOOTH STEP"))?;
    inp.reals(&[0.0, 0.0, seconds, 1.0])
}

/// Name and table of what drives a freedom; none where it is locked or nothing pushes it.
pub(super) fn wave(model: &Model<'_>, freedom: Freedom) -> Option<(&'static str, Vec<(f64, f64)>)> {
    let from = model.placing.positions[freedom as usize];
    match &model.test.machine.row(freedom).drive {
        Drive::Locked(_) => None,
        Drive::Prescribed(motion) => Some((motion_name(freedom), sampled(model, motion, from))),
        Drive::Loaded(load) => {
            let table = sampled(model, load, 0.0);
            let pushes = table.iter().any(|&(_, value)| value != 0.0);
            pushes.then_some((load_name(freedom), table))
        }
    }
}

/// A waveform less `from` over one cycle.
fn sampled(model: &Model<'_>, waveform: &Waveform, from: f64) -> Vec<(f64, f64)> {
    let points = POINTS.max(model.test.time.increments);
    let at = |i: usize| {
        let phase = i as f64 / points as f64;
        (phase * model.cycle_s(), waveform.at(phase).0 - from)
    };
    (0..=points).map(at).collect()
}

fn motion_name(freedom: Freedom) -> &'static str {
    match freedom {
        Freedom::VarusValgus => "VV-MOTION",
        Freedom::InternalExternal => "IE-MOTION",
        Freedom::MedioLateral => "ML-MOTION",
        Freedom::AnteroPosterior => "AP-MOTION",
        Freedom::InferoSuperior => "IS-MOTION",
        Freedom::Flexion => "FLEXION",
    }
}

fn load_name(freedom: Freedom) -> &'static str {
    match freedom {
        Freedom::VarusValgus => "VV-TORQUE",
        Freedom::InternalExternal => "IE-TORQUE",
        Freedom::MedioLateral => "ML-FORCE",
        Freedom::AnteroPosterior => "AP-FORCE",
        Freedom::InferoSuperior => "AXIAL-FORCE",
        Freedom::Flexion => "FLEXION-TORQUE",
    }
}
