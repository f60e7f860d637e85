//! The steps: settle, go to where the cycle begins if that is elsewhere, one gait cycle.

use std::io::{self, Write};

use super::drives::{self, Commands};
use super::model::Model;
use super::step_times::{SETTLE_S, START_S};
use super::{names, output};
use condyle_mesh::formats::{AnalysisStep, Application, InpWriter, Procedure};

/// Smallest increment that Abaqus may cut down to, s.
const MIN_S: f64 = 1e-9;

pub(super) fn write<W: Write>(model: &Model<'_>, inp: &mut InpWriter<W>) -> io::Result<()> {
    inp.comment(output::comment(model))?;
    inp.comment(settle_comment(model))?;
    let settle = drives::settle(model);
    step(
        model,
        "SETTLE",
        SETTLE_S,
        Application::QuasiStatic,
        &settle,
        inp,
    )?;
    if let Some(start) = drives::start(model) {
        inp.comment("\nSTEP START: from where it settled to where the gait cycle begins.")?;
        step(
            model,
            "START",
            START_S,
            Application::QuasiStatic,
            &start,
            inp,
        )?;
    }
    inp.comment(&format!(
        "\nSTEP GAIT: one gait cycle at {} Hz. condyle repeats the cycle until it ends where it began.",
        model.test.machine().frequency_hz
    ))?;
    let gait = drives::gait(model);
    let application = Application::ModerateDissipation;
    step(model, "GAIT", model.cycle_s(), application, &gait, inp)
}

fn settle_comment(model: &Model<'_>) -> &'static str {
    if model.options.explicit {
        "\nSTEP SETTLE: axial force of the cycle's start alone, AP free, IE held. The femur begins lifted\n\
         until nothing touches, since Abaqus/Explicit would push bodies apart that overlap at the start."
    } else {
        "\nSTEP SETTLE: axial force of the cycle's start alone, AP free, IE held. It begins where condyle\n\
         is in balance: what moves here is the difference between the two contacts."
    }
}

fn step<W: Write>(
    model: &Model<'_>,
    name: &str,
    period_s: f64,
    application: Application,
    commands: &Commands,
    inp: &mut InpWriter<W>,
) -> io::Result<()> {
    let increment_s = model.increment_s();
    let procedure = if model.options.explicit {
        Procedure::Explicit
    } else {
        Procedure::Implicit {
            application,
            first_s: increment_s / 10.0,
            least_s: MIN_S,
            most_s: increment_s,
        }
    };
    inp.begin_step(&AnalysisStep {
        name,
        period_s,
        procedure,
    })?;
    if model.options.explicit && name == "SETTLE" {
        inp.explicit_contact_pair(names::BEARING, names::FEMUR_SURFACE, names::ARTICULATING)?;
    }
    drives::write(model, commands, inp)?;
    output::write(model, period_s, inp)?;
    inp.end_step()
}
