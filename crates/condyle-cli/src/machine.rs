//! `condyle machine`: lists, prints and checks machines.

use std::path::Path;

use condyle_case::case::{Preset, Rig, RigJoint};

use crate::{
    arguments::Machine,
    output::{self, Done, Failure, Lines},
};

pub fn machine(arguments: &Machine) -> Done {
    match arguments {
        Machine::List => list(),
        Machine::Show { preset } => output::print(preset.text()),
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

fn check(file: &Path) -> Done {
    let rig = Rig::from_file(file).map_err(|problems| Failure::from(&problems))?;
    let mut lines = Lines::default();
    let mut row = |name: &str, value: String| lines.line(format!("{name:<28}{value}"));
    let results = if rig.is_knee_simulator() {
        ", with the results of the knee simulator"
    } else {
        ""
    };
    row("tests", format!("{}{results}", rig.keys.tests.name()));
    row("frequency", format!("{} Hz", rig.keys.frequency_hz));
    for joint in &rig.joints {
        row(&joint.keys.name, described(joint, rig.keys.scale_of(joint)));
    }
    for spring in &rig.springs {
        let (along, about) = (&spring.along, &spring.about);
        let [positive, negative] = spring.stiffness_n_per_mm;
        let described = format!(
            "spring along {along}, {} mm from the axis of {about}, {positive} and {negative} N/mm",
            spring.offset_mm
        );
        row(&spring.name, described);
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

/// Describes kind, axis and drive of a joint, with the range of its waveform times `scale`.
fn described(joint: &RigJoint, scale: f64) -> String {
    let keys = &joint.keys;
    let [x, y, z] = keys.axis;
    let (kind, drive) = (format!("{:?}", keys.kind).to_lowercase(), keys.drive.word());
    let range = match (&joint.waveform, keys.turns_per_cycle) {
        (Some(waveform), _) => {
            // Three decimals; the sum turns -0 into 0.
            let rounded = |end: f64| (1e3 * scale * end).round() / 1e3 + 0.0;
            let [least, most] = waveform.range().map(rounded);
            format!(" {least} to {most} {}", joint.unit())
        }
        (None, Some(turns)) => format!(" {turns} turns a cycle"),
        (None, None) => String::new(),
    };
    format!("{kind} [{x}, {y}, {z}], {drive}{range}")
}
