//! Activities of the machine, each with its own inputs.

use condyle::machine::{Waveform, knee};

use super::machine::{Freedoms, Machine, Waveforms, report_keys_of_knee};
use super::rig::{Rig, report_keys_of_rig};
use super::waveform::waveform_items;
use crate::config::*;

/// Largest deviation of the sum of shares from 1: thirds are written with a few digits.
const WHOLE: f64 = 1e-3;

settings! {
    /// The keys of an activity except its waveforms; the defaults are those of `[machine]`.
    ActivityKeys {
        /// Its name: small letters, digits and hyphens.
        name: String;
        /// Its share of all cycles; those of all activities add up to 1.
        share: Option<f64> = None, in within(1e-6, 1.0);
        /// Instead of `share`: its cycles in a repeating sequence, such as 17 of walking and 3 of stairs.
        cycles_in_sequence: Option<u64> = None, in within(1.0, 1e9);
        /// Machine file of the activity on a machine by joints, relative to the case file: the joints of `[machine]` with other drives, waveforms and springs; `[machine]` itself if not given. Joints that stand here replace those of the same name.
        file: Option<DataFile> = None;
        /// Cycles a second; if not given, that of its machine file, and without a file that of `[machine]`.
        frequency_hz: Option<f64> = None, in within(0.001, 100.0);
        /// Added to the flexion waveform; that of `[machine]` if not given.
        flexion_offset_deg: Option<f64> = None, in within(-45.0, 45.0);
        /// Factor on the AP force, 1 or -1; that of `[machine]` if not given.
        ap_force_sign: Option<Sign> = None;
        /// Factor on the IE torque, 1 or -1; that of `[machine]` if not given.
        ie_torque_sign: Option<Sign> = None;
    }
}

/// A repeated motion of the machine with its own inputs; in a case without any, `[machine]` has the inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Activity {
    /// Its name, share and numbers.
    pub keys: ActivityKeys,
    /// The waveforms that drive it.
    pub waveforms: Waveforms,
    /// Its machine, if the case has a machine by joints.
    pub rig: Option<Rig>,
}

/// Returns the share of each activity in all cycles; the shares add up to 1.
pub(super) fn shares(activities: &[Activity]) -> Vec<f64> {
    let parts: Vec<f64> = activities.iter().map(Activity::part).collect();
    let sum: f64 = parts.iter().sum();
    parts.iter().map(|part| part / sum).collect()
}

impl Settings for Activity {
    fn items() -> Vec<Item> {
        let mut items = [ActivityKeys::items(), waveform_items(false)].concat();
        let of_rig = Rig::items_beside(&items);
        items.extend(of_rig);
        items
    }

    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        Self::read_on_knee(section, None, log)
    }

    fn read_list(root: &Section<'_>, name: &str, log: &mut Log<'_>) -> Option<Vec<Self>> {
        let sections = root.list(name, log)?;
        if sections.is_empty() {
            return Some(Vec::new());
        }
        // Problems of the machine are reported where the machine is read.
        let mut discarded = Log::new(&log.source, log.base);
        let rig = Machine::rig_in(&root.part("machine"), &mut discarded).flatten();
        let freedoms = Machine::freedoms_in(root, log);
        let all = root.read_list(name, log, |section, log| match &rig {
            Some(rig) => Self::read_on(rig, section, log),
            None => Self::read_on_knee(section, freedoms.as_ref(), log),
        })?;
        check_names(&sections, &all, log);
        check_shares(&sections, &all, log);
        Some(all)
    }

    fn write(&self, out: &mut Writer) {
        self.keys.write(out);
        self.waveforms.write(out);
        if let Some(rig) = &self.rig {
            rig.write(out);
        }
    }
}

impl Activity {
    fn part(&self) -> f64 {
        let cycles = self.keys.cycles_in_sequence.map(|cycles| cycles as f64);
        self.keys.share.or(cycles).unwrap_or_default()
    }

    fn read_on_knee(
        section: &Section<'_>,
        freedoms: Option<&Freedoms>,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        report_keys_of_rig(&["frequency_hz"], section, log);
        section.report_idle(["file"], "a machine by joints", log);
        let keys = ActivityKeys::read(section, log);
        let name = keys.as_ref().map_or("", |keys| keys.name.as_str());
        let waveforms = freedoms.and_then(|freedoms| {
            // Activities do not inherit waveforms from each other.
            let missing = freedoms.channels().map(|channel| channel.name);
            let mut missing = missing
                .filter(|table| section.value(table).is_none())
                .peekable();
            if missing.peek().is_none() {
                return Waveforms::read(section, freedoms, log);
            }
            for table in missing {
                let (what, none) = if table == knee::AXIAL_FORCE.name {
                    ("load", "")
                } else {
                    (table, ", or its `waveform = \"none\"`")
                };
                let fault = Fault::new(
                    format!("the activity \"{name}\" has no {what}"),
                    format!(
                        "write its [activity.{table}]{none}: nothing is taken from another activity"
                    ),
                );
                log.problem(section.span(), fault);
            }
            None
        });
        let (keys, waveforms) = (keys?, waveforms?);
        let presses = |waveform: &Waveform| waveform.knots().iter().any(|knot| knot.value > 0.0);
        if !waveforms.get(&knee::AXIAL_FORCE).is_none_or(presses) {
            let name = &keys.name;
            let message =
                format!("the activity \"{name}\" has no load: its axial force is never above 0 N");
            let fault = Fault::new(message, "give it an axial force above 0 N");
            return log.reject(section.key_span(knee::AXIAL_FORCE.name), fault);
        }
        Some(Self {
            keys,
            waveforms,
            rig: None,
        })
    }

    /// Reads an activity on a machine by joints: its own drives of the same joints, or those of the machine.
    fn read_on(machine: &Rig, section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let mut keys = ActivityKeys::read(section, log)?;
        let file = keys.file.take();
        let base = match &file {
            Some(file) => Rig::in_file(file, section, log)?,
            None => {
                // The factors of the machine multiply those of the activity when both are built.
                let mut own = machine.clone();
                (own.keys.load_scale, own.keys.motion_scale) = (1.0, 1.0);
                own
            }
        };
        let rig = base.changed_by(section, log)?;
        keys.frequency_hz = None;
        if let Some(difference) = rig.difference_from(machine) {
            let key = if file.is_some() { "file" } else { "joints" };
            let name = &keys.name;
            let message = format!(
                "the machine of the activity \"{name}\" is not that of [machine]: {difference}"
            );
            let advice = "give both the same joints in the same order and ligaments of the same names; drives, waveforms and springs may differ";
            return log.reject(section.key_span(key), Fault::new(message, advice));
        }
        let of_knee = ["flexion_offset_deg", "ap_force_sign", "ie_torque_sign"];
        report_keys_of_knee(section, &of_knee, log);
        Some(Self {
            keys,
            waveforms: Waveforms::default(),
            rig: Some(rig),
        })
    }
}

/// Reports names that are not valid in a path, and names that two activities share.
fn check_names(sections: &[Section<'_>], all: &[Activity], log: &mut Log<'_>) {
    for (number, (section, activity)) in sections.iter().zip(all).enumerate() {
        let name = &activity.keys.name;
        let fault = if name.len() > LONGEST_NAME || !is_name(name) {
            let advice = "write 1 to 40 small letters, digits and hyphens, such as \"stairs\"";
            Fault::new(format!("an activity cannot be called \"{name}\""), advice)
        } else if all[..number].iter().any(|other| other.keys.name == *name) {
            let message = format!("two activities are called \"{name}\"");
            Fault::new(message, "give each its own name")
        } else {
            continue;
        };
        log.problem(section.value_span("name"), fault);
    }
}

/// Names become parts of file names.
const LONGEST_NAME: usize = 40;

/// Reports activities without a share or with two, and shares that do not sum up to 1.
fn check_shares(sections: &[Section<'_>], all: &[Activity], log: &mut Log<'_>) {
    let has_cycles = |activity: &Activity| activity.keys.cycles_in_sequence.is_some();
    let by_sequence = all.iter().any(has_cycles);
    let mut complete = true;
    for (section, activity) in sections.iter().zip(all) {
        let name = &activity.keys.name;
        let (message, advice) = match (activity.keys.share, has_cycles(activity)) {
            (None, false) => (
                format!("the activity \"{name}\" has no share of the cycles"),
                "write `share = 0.15`, or in all of them `cycles_in_sequence = 3`",
            ),
            (Some(_), true) => (
                format!("the activity \"{name}\" has both a `share` and `cycles_in_sequence`"),
                "leave one of them out",
            ),
            (Some(_), false) if by_sequence => (
                format!(
                    "the activity \"{name}\" has a `share`, and another has `cycles_in_sequence`"
                ),
                "give all of them the one or the other",
            ),
            _ => continue,
        };
        log.problem(section.value_span("share"), Fault::new(message, advice));
        complete = false;
    }
    let sum: f64 = all.iter().map(Activity::part).sum();
    if let (Some(last), true) = (sections.last(), complete && !by_sequence)
        && (sum - 1.0).abs() > WHOLE
    {
        let fault = Fault::new(
            format!("the shares of the activities add up to {sum:.4} instead of 1"),
            "correct them, or write `cycles_in_sequence`",
        );
        log.problem(last.value_span("share"), fault);
    }
}
