//! What every joint does in a step, and the keywords for it.

use std::io::{self, Write};

use condyle::machine::{
    Axis, Drive, Joint, JointDescription, JointIndex, JointKind, MovedBody, Settling,
};

use super::model::Model;
use super::names;
use super::waves::{load_name, motion_name, wave};
use condyle_mesh::formats::InpWriter;

/// The amplitude that a command follows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Along {
    /// One of the file's own.
    Given(&'static str),
    /// The one of the joint's waveform.
    Waveform,
}

const HOLD: Along = Along::Given(names::HOLD);
const RAMP: Along = Along::Given(names::RAMP);
const LOADING: Along = Along::Given(names::LOADING);

/// What one joint does in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Command {
    /// Nothing leads or pushes it.
    Free,
    /// Led to `by` times an amplitude from where the file begins, mm or rad.
    Lead { by: f64, along: Along },
    /// Pushed by `by` times an amplitude, N or N mm.
    Push { by: f64, along: Along },
}

/// What all six do, in the order of the chain.
pub(super) type Commands = [Command; 6];

const STAY: Command = Command::Lead {
    by: 0.0,
    along: HOLD,
};

/// Settling, as condyle settles.
pub(super) fn settle(model: &Model<'_>) -> Commands {
    let joints = model.test.machine().joints.each_ref();
    joints.map(|joint| match (joint.description.settling, &joint.drive) {
        (Settling::Free, _) => Command::Free,
        (Settling::HeldAtZero, _) => STAY,
        (Settling::Driven, Drive::Loaded(load)) => Command::Push {
            by: load.at(0.0).0,
            along: LOADING,
        },
        (Settling::DrivenWithoutLoad, Drive::Loaded(_)) => Command::Free,
        (_, Drive::Locked(_) | Drive::Prescribed(_)) => STAY,
    })
}

/// From where it settled to where the cycle begins; none where that is the same.
pub(super) fn start(model: &Model<'_>) -> Option<Commands> {
    let begin = |index: JointIndex| {
        let joint = model.test.machine().joint(index);
        match &joint.drive {
            Drive::Loaded(load) => pushed_to_start(joint, load.at(0.0).0),
            Drive::Locked(_) | Drive::Prescribed(_) => lead(way(model, index), RAMP),
        }
    };
    let commands = JointIndex::ALL.map(begin);
    let ramps = |command: &Command| matches!(command, Command::Lead { along, .. } | Command::Push { along, .. } if *along == RAMP);
    commands.iter().any(ramps).then_some(commands)
}

/// A joint that `load` pushes at the start of the cycle: all the time, if it did so while settling.
fn pushed_to_start(joint: &Joint, load: f64) -> Command {
    if joint.description.settling == Settling::Driven {
        Command::Push {
            by: load,
            along: HOLD,
        }
    } else if load == 0.0 {
        Command::Free
    } else {
        Command::Push {
            by: load,
            along: RAMP,
        }
    }
}

/// One gait cycle.
pub(super) fn gait(model: &Model<'_>) -> Commands {
    JointIndex::ALL.map(|index| {
        let (by, along) = (1.0, Along::Waveform);
        let has_wave = wave(model, index).is_some();
        match &model.test.machine().joint(index).drive {
            Drive::Prescribed(_) => Command::Lead { by, along },
            Drive::Loaded(_) if has_wave => Command::Push { by, along },
            Drive::Loaded(_) => Command::Free,
            Drive::Locked(_) => lead(way(model, index), HOLD),
        }
    })
}

/// How far the beginning of the cycle lies from the pose in which the file begins.
fn way(model: &Model<'_>, index: JointIndex) -> f64 {
    const NONE: f64 = 1e-12;
    let way = index.of(&model.cycle_start) - index.of(&model.placing.positions);
    if way.abs() < NONE { 0.0 } else { way }
}

fn lead(by: f64, along: Along) -> Command {
    if by == 0.0 {
        return STAY;
    }
    Command::Lead { by, along }
}

/// Writes commands as boundary conditions and loads that replace all those before.
pub(super) fn write<W: Write>(
    model: &Model<'_>,
    commands: &Commands,
    inp: &mut InpWriter<W>,
) -> io::Result<()> {
    inp.keyword("*BOUNDARY, OP=NEW")?;
    for (set, first, last) in [
        (names::FEMUR_REF, 1, 1),
        (names::FEMUR_REF, 3, 5),
        (names::CARRIAGE, 2, 2),
        (names::CARRIAGE, 4, 4),
        (names::CARRIAGE, 6, 6),
    ] {
        inp.line(&format!("{set}, {first}, {last}"))?;
    }
    for (index, command) in JointIndex::ALL.into_iter().zip(commands) {
        if let (STAY, JointInFile::Node { set, dof }) = (*command, place(model, index)) {
            inp.line(&format!("{set}, {dof}, {dof}"))?;
        }
    }
    for (index, &command) in JointIndex::ALL.into_iter().zip(commands) {
        let joint = model.test.machine().joint(index).description;
        drive(joint, &place(model, index), command, inp)?;
    }
    Ok(())
}

/// Where a joint is in the file.
enum JointInFile {
    /// A degree of freedom of a reference node.
    Node { set: &'static str, dof: usize },
    /// The free rotation of the hinge.
    Hinge,
}

/// The joint that carries the insert is the hinge; the others are degrees of freedom of the carriage or the
/// femur, 1 to 3 along x, y and z and 4 to 6 about them.
fn place(model: &Model<'_>, index: JointIndex) -> JointInFile {
    let joint = model.test.machine().joint(index).description;
    if index.place() == 0 {
        return JointInFile::Hinge;
    }
    let (Axis::Along(direction) | Axis::About(direction) | Axis::AboutFemur(direction)) =
        joint.axis;
    let along = direction.iter().position(|&part| part != 0.0).unwrap_or(0) + 1;
    let dof = match joint.kind() {
        JointKind::Translation => along,
        JointKind::Rotation => along + 3,
    };
    let set = match joint.moves {
        MovedBody::Insert => names::CARRIAGE,
        MovedBody::Femur => names::FEMUR_REF,
    };
    JointInFile::Node { set, dof }
}

fn drive<W: Write>(
    joint: &JointDescription,
    place: &JointInFile,
    command: Command,
    inp: &mut InpWriter<W>,
) -> io::Result<()> {
    match (command, place) {
        (Command::Free, _) | (STAY, JointInFile::Node { .. }) => Ok(()),
        (Command::Lead { by, along }, _) => {
            let amplitude = along.name(|| motion_name(joint));
            lead_place(place, by, &amplitude, inp)
        }
        (Command::Push { by, along }, _) => {
            let amplitude = along.name(|| load_name(joint));
            push_place(place, by, &amplitude, inp)
        }
    }
}

impl Along {
    /// The name of the amplitude; `waveform` says that of the joint's waveform.
    fn name(self, waveform: impl FnOnce() -> String) -> String {
        match self {
            Self::Given(name) => name.to_owned(),
            Self::Waveform => waveform(),
        }
    }
}

fn lead_place<W: Write>(
    place: &JointInFile,
    by: f64,
    amplitude: &str,
    inp: &mut InpWriter<W>,
) -> io::Result<()> {
    let how = format!("OP=NEW, AMPLITUDE={amplitude}, TYPE=DISPLACEMENT");
    match place {
        JointInFile::Node { set, dof } => {
            inp.keyword(&format!("*BOUNDARY, {how}"))?;
            inp.line(&format!("{set}, {dof}, {dof}, {by:?}"))
        }
        JointInFile::Hinge => {
            inp.keyword(&format!("*CONNECTOR MOTION, {how}"))?;
            inp.line(&format!("{}, 4, {by:?}", names::HINGE))
        }
    }
}

fn push_place<W: Write>(
    place: &JointInFile,
    by: f64,
    amplitude: &str,
    inp: &mut InpWriter<W>,
) -> io::Result<()> {
    let how = format!("OP=NEW, AMPLITUDE={amplitude}");
    match place {
        JointInFile::Node { set, dof } => {
            inp.keyword(&format!("*CLOAD, {how}"))?;
            inp.line(&format!("{set}, {dof}, {by:?}"))
        }
        JointInFile::Hinge => {
            inp.keyword(&format!("*CONNECTOR LOAD, {how}"))?;
            inp.line(&format!("{}, 4, {by:?}", names::HINGE))
        }
    }
}
