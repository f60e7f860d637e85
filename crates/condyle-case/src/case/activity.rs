//! Activities of the machine, each with inputs of its own.

use std::ops::Range;

use condyle::machine::Waveform;

use super::machine::{Freedoms, Machine, Sign, Waveforms};
use super::machine_reason::ActivityReason;
use super::waveform::{CaseChannel, waveform_items};
use crate::config::{Item, Log, Section, Settings, TableItem, Writer, settings, within};

/// Shares whose sum is so near to 1 are whole: thirds are written with a few digits.
const WHOLE: f64 = 1e-3;

settings! {
    /// The keys of an activity except its waveforms; the defaults are those of `[machine]`.
    ActivityKeys {
        /// Its name: small letters, digits and hyphens.
        name: String;
        /// Its share of all cycles; those of all activities sum up to 1.
        share: Option<f64> = None, in within(1e-6, 1.0);
        /// Instead of `share`: its cycles in a sequence that repeats, such as 17 of walking and 3 of stairs.
        cycles_in_sequence: Option<u64> = None, in within(1.0, 1e9);
        /// Cycles a second; that of `[machine]` if not given.
        frequency_hz: Option<f64> = None, in within(0.001, 100.0);
        /// Added to the flexion waveform; that of `[machine]` if not given.
        flexion_offset_deg: Option<f64> = None, in within(-45.0, 45.0);
        /// 1 or -1 times the AP force; that of `[machine]` if not given.
        ap_force_sign: Option<Sign> = None;
        /// 1 or -1 times the IE torque; that of `[machine]` if not given.
        ie_torque_sign: Option<Sign> = None;
    }
}

/// A repeated motion of the machine with inputs of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Activity {
    /// Its name, share and numbers.
    pub keys: ActivityKeys,
    /// The waveforms that drive it.
    pub waveforms: Waveforms,
}

/// The activities of a case, in the order they are written; none where `[machine]` has the inputs of the only
/// one.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Activities {
    all: Vec<Activity>,
}

const ACTIVITIES: &str = "
One table for each thing that the machine does, each with every waveform that its freedoms need as \
`[activity.axial_force]`, `[activity.flexion]` and so on, with the keys of the waveforms above; `[machine]` then has \
none. [Activities and creep](activities-and-creep.md) shows how.
";

impl Activities {
    /// Returns every activity.
    pub fn iter(&self) -> impl Iterator<Item = &Activity> {
        self.all.iter()
    }

    /// Returns true if `[machine]` has the inputs.
    pub fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    /// The share of all cycles that each has; they sum up to 1.
    pub(super) fn shares(&self) -> Vec<f64> {
        let parts: Vec<f64> = self.all.iter().map(Activity::part).collect();
        let sum: f64 = parts.iter().sum();
        parts.iter().map(|part| part / sum).collect()
    }
}

impl Settings for Activities {
    fn items() -> Vec<Item> {
        [ActivityKeys::items(), waveform_items(false)].concat()
    }

    fn item(name: &'static str, about: &str) -> Item {
        Item::Table(TableItem {
            is_list: true,
            note: ACTIVITIES.to_owned(),
            ..TableItem::new(name, about, Self::items())
        })
    }

    /// Reads the only activity of `section`.
    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let all = vec![Activity::read(section, None, log)?];
        Some(Self { all })
    }

    fn read_in(root: &Section<'_>, name: &'static str, log: &mut Log<'_>) -> Option<Self> {
        let sections = root.list(name, log)?;
        let freedoms = Machine::freedoms_in(root, log);
        let read = |section| Activity::read(section, freedoms.as_ref(), log);
        let all: Vec<Option<Activity>> = sections.iter().map(read).collect();
        let all: Vec<Activity> = all.into_iter().collect::<Option<_>>()?;
        check_names(&sections, &all, log);
        check_shares(&sections, &all, log);
        Some(Self { all })
    }

    fn write(&self, out: &mut Writer) {
        for activity in &self.all {
            activity.keys.write(out);
            activity.waveforms.write(out);
        }
    }

    fn write_in(&self, name: &str, out: &mut Writer) {
        for activity in &self.all {
            out.table_of_list(name, |out| {
                activity.keys.write(out);
                activity.waveforms.write(out);
            });
        }
    }
}

impl Activity {
    /// Its share, or its cycles in the sequence.
    fn part(&self) -> f64 {
        let cycles = self.keys.cycles_in_sequence.map(|cycles| cycles as f64);
        self.keys.share.or(cycles).unwrap_or_default()
    }

    fn read(section: &Section<'_>, freedoms: Option<&Freedoms>, log: &mut Log<'_>) -> Option<Self> {
        let keys = ActivityKeys::read(section, log);
        let name = keys.as_ref().map_or("", |keys| keys.name.as_str());
        let waveforms = freedoms.and_then(|freedoms| {
            check_inputs(section, name, freedoms, log)?;
            Waveforms::read(section, freedoms, log)
        });
        let read = Self {
            keys: keys?,
            waveforms: waveforms?,
        };
        read.check_load(section, log)?;
        Some(read)
    }

    fn check_load(&self, section: &Section<'_>, log: &mut Log<'_>) -> Option<()> {
        let load = CaseChannel::load();
        let presses = |waveform: &Waveform| waveform.knots().iter().any(|knot| knot.value > 0.0);
        if self.waveforms.get(load).is_none_or(presses) {
            return Some(());
        }
        let name = self.keys.name.clone();
        log.problem(
            section.key_span(load.name()),
            ActivityReason::NoLoad { name },
        );
        None
    }
}

/// Reports every waveform that an activity lacks: none is taken from another activity in silence.
fn check_inputs(
    section: &Section<'_>,
    name: &str,
    freedoms: &Freedoms,
    log: &mut Log<'_>,
) -> Option<()> {
    let needed: Vec<CaseChannel> = freedoms.channels().collect();
    let lacking = needed
        .into_iter()
        .filter(|channel| section.value(channel.name()).is_none());
    let mut complete = Some(());
    for channel in lacking {
        let reason = ActivityReason::LacksInput {
            name: name.to_owned(),
            table: channel.name(),
            is_load: channel == CaseChannel::load(),
        };
        log.problem(section.span(), reason);
        complete = None;
    }
    complete
}

/// Reports names that are no words of a path, or that two activities have.
fn check_names(sections: &[Section<'_>], all: &[Activity], log: &mut Log<'_>) {
    for (number, (section, activity)) in sections.iter().zip(all).enumerate() {
        let name = &activity.keys.name;
        let is_word = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
        let place = section.value_span("name");
        if name.is_empty() || name.len() > LONGEST_NAME || !name.chars().all(is_word) {
            let name = name.clone();
            log.problem(place, ActivityReason::Name { name });
        } else if all[..number].iter().any(|other| other.keys.name == *name) {
            let name = name.clone();
            log.problem(place, ActivityReason::SameName { name });
        }
    }
}

/// Names become parts of file names.
const LONGEST_NAME: usize = 40;

/// Reports activities that do not say how many of the cycles they are, and shares that are not all of them.
fn check_shares(sections: &[Section<'_>], all: &[Activity], log: &mut Log<'_>) {
    let mut said = true;
    let by_sequence = all
        .iter()
        .any(|activity| activity.keys.cycles_in_sequence.is_some());
    for (section, activity) in sections.iter().zip(all) {
        let ActivityKeys {
            share,
            cycles_in_sequence,
            name,
            ..
        } = &activity.keys;
        let name = name.clone();
        let place = place_of_share(section);
        match (share, cycles_in_sequence) {
            (None, None) => log.problem(section.span(), ActivityReason::NoShare { name }),
            (Some(_), Some(_)) => log.problem(place, ActivityReason::TwoShares { name }),
            (Some(_), None) if by_sequence => log.problem(place, ActivityReason::Mixed { name }),
            _ => continue,
        }
        said = false;
    }
    let sum: f64 = all.iter().map(Activity::part).sum();
    if let (Some(last), true) = (sections.last(), said && !by_sequence)
        && (sum - 1.0).abs() > WHOLE
    {
        log.problem(place_of_share(last), ActivityReason::Sum { sum });
    }
}

fn place_of_share(section: &Section<'_>) -> Range<usize> {
    section.value_span("share")
}
