//! The simulator: its numbers, its six freedoms and what drives them.

use condyle::machine::{JointDescription, JointIndex, JointKind, Waveform, knee::KNEE};

use super::activity_reason::ActivityReason;
use super::channel::CaseChannel;
use super::drive_reason::DriveReason;
use super::machine_keys::{
    DriveWord, MachineSettings, Preset, Rotation, Springs, Start, Translation,
};
use super::waveform;
use crate::config::{Key, KeyReason, Log, Section, Settings, names, quoted_list, read_table};

/// The simulator.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    /// The simulator it starts from.
    pub preset: Preset,
    /// Its numbers.
    pub settings: MachineSettings,
    /// The pair of springs.
    pub springs: Springs,
    /// The six freedoms.
    pub freedoms: Freedoms,
    /// The waveforms that drive them, and no others.
    pub waveforms: Waveforms,
}

/// The keys of a freedom.
#[derive(Clone, Debug, PartialEq)]
pub enum Freedom {
    /// One that translates.
    Translation(Translation),
    /// One that rotates.
    Rotation(Rotation),
}

/// The six freedoms, one a joint; the drive of each is given.
#[derive(Clone, Debug, PartialEq)]
pub struct Freedoms {
    /// In the order of the chain.
    rows: [Freedom; 6],
}

/// The waveforms of a machine, each in the unit of its key.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Waveforms {
    given: Vec<(CaseChannel, Waveform)>,
}

impl Waveforms {
    /// The waveform of `channel`, if the machine uses it.
    pub fn get(&self, channel: CaseChannel) -> Option<&Waveform> {
        let mut given = self.given.iter();
        given.find_map(|(of, waveform)| (*of == channel).then_some(waveform))
    }
}

/// What moves each freedom of a preset.
fn preset_drives(preset: Preset) -> [(&'static str, DriveWord); 6] {
    use DriveWord::{Loaded, Prescribed};
    match preset {
        Preset::StanmoreForce => [
            ("ap", Loaded),
            ("ie", Loaded),
            ("ml", Loaded),
            ("vv", Loaded),
            ("is", Loaded),
            ("flexion", Prescribed),
        ],
        Preset::StanmoreDisplacement => [
            ("ap", Prescribed),
            ("ie", Prescribed),
            ("ml", Loaded),
            ("vv", Loaded),
            ("is", Loaded),
            ("flexion", Prescribed),
        ],
    }
}

/// What moves a freedom where the case does not say.
fn preset_drive(preset: Preset, freedom: &str) -> Option<DriveWord> {
    let mut drives = preset_drives(preset).into_iter();
    drives.find_map(|(name, drive)| (name == freedom).then_some(drive))
}

/// Whether a drive moves a joint.
fn allows(joint: &JointDescription, drive: DriveWord) -> bool {
    match drive {
        DriveWord::Locked => true,
        DriveWord::Prescribed => joint.motion.is_some(),
        DriveWord::Loaded => joint.can_be_free(),
    }
}

/// The drives that a joint can have.
fn drive_words(joint: &JointDescription) -> Vec<&'static str> {
    let drives = DriveWord::ALL.iter().copied();
    drives
        .filter(|drive| allows(joint, *drive))
        .map(DriveWord::word)
        .collect()
}

/// The waveform that a drive of a joint needs.
pub(super) fn channel_of(joint: &JointDescription, drive: DriveWord) -> Option<CaseChannel> {
    let channel = match drive {
        DriveWord::Locked => None,
        DriveWord::Prescribed => joint.motion,
        DriveWord::Loaded => joint.load_channel(),
    };
    channel.map(CaseChannel::of)
}

impl Freedom {
    fn read(joint: &JointDescription, section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        match joint.kind() {
            JointKind::Translation => read_table(section, joint.name, log).map(Self::Translation),
            JointKind::Rotation => read_table(section, joint.name, log).map(Self::Rotation),
        }
    }

    /// The keys that the freedom of `joint` has.
    pub(super) fn keys(joint: &JointDescription) -> Vec<Key> {
        let keys = match joint.kind() {
            JointKind::Translation => Translation::keys(),
            JointKind::Rotation => Rotation::keys(),
        };
        let narrowed = |key: Key| match key.name {
            "drive" => key.of_words(drive_words(joint)),
            _ => key,
        };
        keys.into_iter().map(narrowed).collect()
    }

    /// What moves it.
    pub fn drive(&self) -> DriveWord {
        let drive = match self {
            Self::Translation(keys) => keys.drive,
            Self::Rotation(keys) => keys.drive,
        };
        drive.unwrap_or(DriveWord::Locked)
    }

    fn drive_unless_given(&mut self, drive: Option<DriveWord>) {
        let given = match self {
            Self::Translation(keys) => &mut keys.drive,
            Self::Rotation(keys) => &mut keys.drive,
        };
        *given = given.or(drive);
    }

    /// The key that says where it is held when locked.
    fn locked_at_key(&self) -> &'static str {
        match self {
            Self::Translation(_) => "locked_at_mm",
            Self::Rotation(_) => "locked_at_deg",
        }
    }

    /// Where it is held when locked, in the unit of files.
    pub(super) fn locked_at(&self) -> f64 {
        match self {
            Self::Translation(keys) => keys.locked_at_mm,
            Self::Rotation(keys) => keys.locked_at_deg,
        }
    }

    /// Reports a drive that it cannot have, and a place to lock it where it is not locked.
    fn check(&self, joint: &JointDescription, section: &Section<'_>, log: &mut Log<'_>) {
        let (row, drive) = (section.table(joint.name, log), self.drive());
        if !allows(joint, drive) {
            let reason = DriveReason::NoSuchDrive {
                freedom: joint.name,
                drive: drive.word(),
                drives: quoted_list(&drive_words(joint)),
            };
            log.problem(row.value_span("drive"), reason);
        }
        if drive != DriveWord::Locked && self.locked_at() != 0.0 {
            let key = self.locked_at_key();
            let reason = KeyReason::Idle {
                key: key.to_owned(),
                needs: "`drive = \"locked\"`".to_owned(),
            };
            log.problem(row.key_span(key), reason);
        }
    }
}

impl Freedoms {
    fn read(machine: &Section<'_>, preset: Preset, log: &mut Log<'_>) -> Option<Self> {
        let section = machine.table("freedoms", log);
        let known = KNEE.in_files.map(|index| KNEE.joint(index).name);
        section.check_keys(&known, log);
        let read = KNEE.joints.each_ref();
        let read = read.map(|joint| Freedom::read(joint, &section, log));
        let rows: Vec<Freedom> = read.into_iter().collect::<Option<_>>()?;
        let mut rows: [Freedom; 6] = rows.try_into().ok()?;
        for (joint, row) in KNEE.joints.iter().zip(&mut rows) {
            row.drive_unless_given(preset_drive(preset, joint.name));
            row.check(joint, &section, log);
        }
        Some(Self { rows })
    }

    /// The keys of one freedom.
    pub fn get(&self, joint: JointIndex) -> &Freedom {
        &self.rows[joint.place()]
    }

    /// The waveforms that they need.
    pub(super) fn channels(&self) -> impl Iterator<Item = CaseChannel> {
        let channel = |(joint, freedom): (_, &Freedom)| channel_of(joint, freedom.drive());
        self.in_files().filter_map(channel)
    }

    /// Every freedom with its joint, in the order they are written.
    pub(super) fn in_files(&self) -> impl Iterator<Item = (&'static JointDescription, &Freedom)> {
        let joints = KNEE.in_files.into_iter();
        joints.map(|index| (KNEE.joint(index), self.get(index)))
    }
}

impl Waveforms {
    /// Reads those that freedoms so driven need from their tables in `machine`.
    pub(super) fn read(
        machine: &Section<'_>,
        freedoms: &Freedoms,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        let mut given = Vec::new();
        let mut complete = true;
        for (joint, freedom) in freedoms.in_files() {
            let channels = [joint.motion, joint.load_channel()].into_iter().flatten();
            for channel in channels.map(CaseChannel::of) {
                if channel_of(joint, freedom.drive()) == Some(channel) {
                    let waveform = waveform::read(channel, machine, log);
                    complete &= waveform.is_some();
                    given.extend(waveform.map(|waveform| (channel, waveform)));
                } else {
                    check_absent(machine, joint, freedom.drive(), channel, log);
                }
            }
        }
        complete.then_some(Self { given })
    }
}

/// Reports a waveform for a freedom that is driven otherwise.
fn check_absent(
    machine: &Section<'_>,
    joint: &JointDescription,
    drive: DriveWord,
    channel: CaseChannel,
    log: &mut Log<'_>,
) {
    if machine.value(channel.name()).is_none() {
        return;
    }
    let wanted = if joint.motion.map(CaseChannel::of) == Some(channel) {
        DriveWord::Prescribed
    } else {
        DriveWord::Loaded
    };
    let reason = DriveReason::UnusedWaveform {
        section: format!("{}.{}", machine.path(), channel.name()),
        freedom: joint.name,
        drive: drive.word(),
        wanted: wanted.word(),
    };
    log.problem(machine.key_span(channel.name()), reason);
}

/// Reports waveforms of the machine, which has those of its activities.
fn check_without_waveforms(machine: &Section<'_>, log: &mut Log<'_>) {
    for channel in CaseChannel::all() {
        if machine.value(channel.name()).is_some() {
            let table = channel.name();
            log.problem(machine.key_span(table), ActivityReason::OfMachine { table });
        }
    }
}

impl Machine {
    /// Reads `[machine]`, whose waveforms are elsewhere where the case has activities.
    pub(super) fn read(
        section: &Section<'_>,
        has_activities: bool,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        let known: Vec<&str> = names(&MachineSettings::keys())
            .chain(names(&Start::keys()))
            .chain(["springs", "freedoms"])
            .chain(CaseChannel::all().map(CaseChannel::name))
            .collect();
        section.check_keys(&known, log);
        let settings = MachineSettings::read(section, log);
        let springs = read_table(section, "springs", log);
        let preset = Start::read(section, log)?.preset;
        let freedoms = Freedoms::read(section, preset, log)?;
        let waveforms = if has_activities {
            check_without_waveforms(section, log);
            Some(Waveforms::default())
        } else {
            Waveforms::read(section, &freedoms, log)
        };
        Some(Self {
            preset,
            settings: settings?,
            springs: springs?,
            freedoms,
            waveforms: waveforms?,
        })
    }
}
