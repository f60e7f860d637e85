//! `condyle machine`: lists, prints and checks machines.

use std::path::Path;

use condyle_case::case::{Preset, Rig, RigJoint, template};

use crate::{
    arguments::Machine,
    output::{self, Done, Failure, Lines},
};

pub fn machine(arguments: &Machine) -> Done {
    match arguments {
        Machine::List => list(),
        Machine::Show { preset } => output::print(&shown(*preset)),
        Machine::Check { file } => check(file),
    }
}

fn list() -> Done {
    let mut lines = Lines::default();
    for preset in Preset::ALL {
        lines.line(format!("{:<28}{}", preset.word(), preset.about()));
    }
    output::print(lines.text())
}

/// Returns the file of a machine by joints, or the tables of the knee simulator in a case.
fn shown(preset: Preset) -> String {
    if let Some((_, text)) = preset.rig() {
        return text.to_owned();
    }
    let case = template(preset);
    let tables = case
        .split("\n[")
        .filter(|table| table.starts_with("machine"));
    tables.map(|table| format!("[{table}\n")).collect()
}

fn check(file: &Path) -> Done {
    let rig = Rig::from_file(file).map_err(|problems| Failure::from(&problems))?;
    let mut lines = Lines::default();
    let mut row = |name: &str, value: String| lines.line(format!("{name:<28}{value}"));
    row("tests", rig.keys.tests.name().to_owned());
    row("frequency", format!("{} Hz", rig.keys.frequency_hz));
    for joint in &rig.joints {
        row(&joint.keys.name, described(joint));
    }
    for ligament in &rig.ligaments {
        row(
            &ligament.name,
            format!("ligament, {} N", ligament.stiffness_n),
        );
    }
    lines.line(format!("{}: the machine is good", file.display()));
    output::print(lines.text())
}

/// Describes kind, axis and drive of a joint, with the range of its waveform.
fn described(joint: &RigJoint) -> String {
    let keys = &joint.keys;
    let [x, y, z] = keys.axis;
    let (kind, drive) = (format!("{:?}", keys.kind).to_lowercase(), keys.drive.word());
    let range = match (&joint.waveform, keys.turns_per_cycle) {
        (Some(waveform), _) => {
            let values = || waveform.knots().iter().map(|knot| knot.value);
            let least = values().fold(f64::INFINITY, f64::min);
            let most = values().fold(f64::NEG_INFINITY, f64::max);
            format!(" {least} to {most} {}", joint.unit())
        }
        (None, Some(turns)) => format!(" {turns} turns a cycle"),
        (None, None) => String::new(),
    };
    format!("{kind} [{x}, {y}, {z}], {drive}{range}")
}
