//! What leads and pushes the freedoms, over time.

use std::io::{self, Write};

use condyle::machine::{Drive, JointDescription, JointIndex, JointKind, Waveform};

use super::model::Model;
use super::names;
use super::step_times::{SETTLE_S, START_S};
use condyle_mesh::formats::InpWriter;

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
    for joint in JointIndex::ALL {
        if let Some((name, table)) = wave(model, joint) {
            inp.amplitude(&name, &table)?;
        }
    }
    Ok(())
}

/// From 0 to 1 in `seconds`, without a jolt at either end.
fn smooth_step<W: Write>(inp: &mut InpWriter<W>, name: &str, seconds: f64) -> io::Result<()> {
    inp.keyword(&format!("*AMPLITUDE, NAME={name}, DEFINITION=SMOOTH STEP"))?;
    inp.reals(&[0.0, 0.0, seconds, 1.0])
}

/// Name and table of what drives a joint; none where it is locked or nothing pushes it.
pub(super) fn wave(model: &Model<'_>, index: JointIndex) -> Option<(String, Vec<(f64, f64)>)> {
    let from = index.of(&model.placing.positions);
    let joint = model.test.machine().joint(index);
    match &joint.drive {
        Drive::Locked(_) => None,
        Drive::Prescribed(motion) => {
            let name = motion_name(joint.description);
            Some((name, sampled(model, motion, from)))
        }
        Drive::Loaded(load) => {
            let table = sampled(model, load, 0.0);
            let pushes = table.iter().any(|&(_, value)| value != 0.0);
            pushes.then_some((load_name(joint.description), table))
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

/// The amplitude of a prescribed motion: after its waveform, or else after its joint.
pub(super) fn motion_name(joint: &JointDescription) -> String {
    let channel = joint.motion.map(|channel| channel.name);
    let name = channel.map_or_else(|| format!("{}-motion", joint.name), str::to_owned);
    in_capitals(&name)
}

/// The amplitude of a load: after its waveform, or else after its joint.
pub(super) fn load_name(joint: &JointDescription) -> String {
    let load = match joint.kind() {
        JointKind::Rotation => "torque",
        JointKind::Translation => "force",
    };
    let channel = joint.load_channel().map(|channel| channel.name);
    let name = channel.map_or_else(|| format!("{}-{load}", joint.name), str::to_owned);
    in_capitals(&name)
}

fn in_capitals(name: &str) -> String {
    name.replace('_', "-").to_uppercase()
}
