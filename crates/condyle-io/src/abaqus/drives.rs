//! What every freedom does in a step, and the keywords for it.

use std::io::{self, Write};

use condyle::machine::{Drive, FREEDOMS, Freedom};

use super::model::Model;
use super::names;
use super::waves::wave;
use crate::mesh::InpWriter;

/// What one freedom does in a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Command {
    /// Nothing leads or pushes it.
    Free,
    /// Led to `by` times an amplitude from where the file begins, mm or rad.
    Lead { by: f64, along: &'static str },
    /// Pushed by `by` times an amplitude, N or N mm.
    Push { by: f64, along: &'static str },
}

/// What all six do, in the order of [`FREEDOMS`].
pub(super) type Commands = [Command; 6];

const STAY: Command = Command::Lead {
    by: 0.0,
    along: names::HOLD,
};

/// Settling, as condyle settles: axial force alone, AP free, IE held, the rest as it is driven.
pub(super) fn settle(model: &Model<'_>) -> Commands {
    FREEDOMS.map(
        |freedom| match (freedom, &model.test.machine().row(freedom).drive) {
            (Freedom::AnteroPosterior, _) => Command::Free,
            (Freedom::InternalExternal, _) => STAY,
            (Freedom::InferoSuperior | Freedom::Flexion, Drive::Loaded(load)) => Command::Push {
                by: load.at(0.0).0,
                along: names::LOADING,
            },
            (_, Drive::Loaded(_)) => Command::Free,
            _ => STAY,
        },
    )
}

/// From where it settled to where the cycle begins; none where that is the same.
pub(super) fn start(model: &Model<'_>) -> Option<Commands> {
    let begin = |freedom: Freedom| match &model.test.machine().row(freedom).drive {
        Drive::Loaded(load) if freedom == Freedom::InferoSuperior => Command::Push {
            by: load.at(0.0).0,
            along: names::HOLD,
        },
        Drive::Loaded(load) if load.at(0.0).0 == 0.0 => Command::Free,
        Drive::Loaded(load) => Command::Push {
            by: load.at(0.0).0,
            along: names::RAMP,
        },
        Drive::Locked(_) | Drive::Prescribed(_) => lead(way(model, freedom), names::RAMP),
    };
    let commands = FREEDOMS.map(begin);
    let ramps = |command: &Command| matches!(command, Command::Lead { along, .. } | Command::Push { along, .. } if *along == names::RAMP);
    commands.iter().any(ramps).then_some(commands)
}

/// One gait cycle.
pub(super) fn gait(model: &Model<'_>) -> Commands {
    FREEDOMS.map(|freedom| {
        let named = wave(model, freedom).map(|(name, _)| name);
        match (&model.test.machine().row(freedom).drive, named) {
            (Drive::Prescribed(_), Some(along)) => Command::Lead { by: 1.0, along },
            (Drive::Loaded(_), Some(along)) => Command::Push { by: 1.0, along },
            (Drive::Loaded(_), None) => Command::Free,
            (Drive::Locked(_) | Drive::Prescribed(_), _) => lead(way(model, freedom), names::HOLD),
        }
    })
}

/// How far the beginning of the cycle lies from the pose in which the file begins.
fn way(model: &Model<'_>, freedom: Freedom) -> f64 {
    const NONE: f64 = 1e-12;
    let j = freedom as usize;
    let way = model.cycle_start[j] - model.placing.positions[j];
    if way.abs() < NONE { 0.0 } else { way }
}

fn lead(by: f64, along: &'static str) -> Command {
    if by == 0.0 {
        return STAY;
    }
    Command::Lead { by, along }
}

/// Writes commands as boundary conditions and loads that replace all those before.
pub(super) fn write<W: Write>(commands: &Commands, inp: &mut InpWriter<W>) -> io::Result<()> {
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
    for (freedom, command) in FREEDOMS.into_iter().zip(commands) {
        if let (STAY, Place::Node { set, dof }) = (*command, place(freedom)) {
            inp.line(&format!("{set}, {dof}, {dof}"))?;
        }
    }
    for (freedom, &command) in FREEDOMS.into_iter().zip(commands) {
        drive(place(freedom), command, inp)?;
    }
    Ok(())
}

/// Where a freedom is in the file.
enum Place {
    /// A degree of freedom of a reference node.
    Node { set: &'static str, dof: u8 },
    /// The free rotation of the hinge.
    Hinge,
}

fn place(freedom: Freedom) -> Place {
    let (set, dof) = match freedom {
        Freedom::VarusValgus => return Place::Hinge,
        Freedom::InternalExternal => (names::CARRIAGE, 5),
        Freedom::MedioLateral => (names::CARRIAGE, 3),
        Freedom::AnteroPosterior => (names::CARRIAGE, 1),
        Freedom::InferoSuperior => (names::FEMUR_REF, 2),
        Freedom::Flexion => (names::FEMUR_REF, 6),
    };
    Place::Node { set, dof }
}

fn drive<W: Write>(place: Place, command: Command, inp: &mut InpWriter<W>) -> io::Result<()> {
    let (keyword, by) = match (&place, command) {
        (_, Command::Free) | (Place::Node { .. }, STAY) => return Ok(()),
        (Place::Node { .. }, Command::Lead { by, along }) => (
            format!("*BOUNDARY, OP=NEW, AMPLITUDE={along}, TYPE=DISPLACEMENT"),
            by,
        ),
        (Place::Node { .. }, Command::Push { by, along }) => {
            (format!("*CLOAD, OP=NEW, AMPLITUDE={along}"), by)
        }
        (Place::Hinge, Command::Lead { by, along }) => (
            format!("*CONNECTOR MOTION, OP=NEW, AMPLITUDE={along}, TYPE=DISPLACEMENT"),
            by,
        ),
        (Place::Hinge, Command::Push { by, along }) => {
            (format!("*CONNECTOR LOAD, OP=NEW, AMPLITUDE={along}"), by)
        }
    };
    inp.keyword(&keyword)?;
    inp.line(&match (place, command) {
        (Place::Node { set, dof }, Command::Lead { .. }) => format!("{set}, {dof}, {dof}, {by:?}"),
        (Place::Node { set, dof }, _) => format!("{set}, {dof}, {by:?}"),
        (Place::Hinge, _) => format!("{}, 4, {by:?}", names::HINGE),
    })
}
