//! The simulator: its numbers, its six freedoms and what drives them.

use condyle::machine::Waveform;

use super::channel::Channel;
use super::drive_reason::DriveReason;
use super::machine_keys::{
    DriveWord, MachineSettings, Preset, Rotation, Springs, Start, Translation,
};
use super::waveform;
use crate::keyed::{KeyReason, Log, Section, Settings, names, read_table};

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

/// The six freedoms; the drive of each is given.
#[derive(Clone, Debug, PartialEq)]
pub struct Freedoms {
    /// Antero-posterior translation of the insert.
    pub ap: Translation,
    /// Internal-external rotation of the insert.
    pub ie: Rotation,
    /// Medio-lateral translation of the insert.
    pub ml: Translation,
    /// Varus-valgus rotation of the insert.
    pub vv: Rotation,
    /// Infero-superior translation of the femur.
    pub is: Translation,
    /// Flexion of the femur.
    pub flexion: Rotation,
}

/// The waveforms of a machine, each in the unit of its key.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Waveforms {
    given: [Option<Waveform>; 6],
}

impl Waveforms {
    /// The waveform of `channel`, if the machine uses it.
    pub fn get(&self, channel: Channel) -> Option<&Waveform> {
        self.given[channel as usize].as_ref()
    }
}

/// Names of the freedoms, in the order they are written.
pub(super) const FREEDOMS: [&str; 6] = ["ap", "ie", "ml", "vv", "is", "flexion"];

/// What a freedom can be, and the waveform each drive needs.
pub(super) struct Drives {
    pub freedom: &'static str,
    pub prescribed: Option<Channel>,
    pub loaded: Option<Channel>,
    pub can_be_loaded: bool,
}

/// The drives of each freedom, in the order of [`FREEDOMS`].
pub(super) const DRIVES: [Drives; 6] = [
    drives("ap", Some(Channel::ApMotion), Some(Channel::ApForce), true),
    drives("ie", Some(Channel::IeMotion), Some(Channel::IeTorque), true),
    drives("ml", None, None, true),
    drives("vv", None, None, true),
    drives("is", None, Some(Channel::AxialForce), true),
    drives("flexion", Some(Channel::Flexion), None, false),
];

const fn drives(
    freedom: &'static str,
    prescribed: Option<Channel>,
    loaded: Option<Channel>,
    can_be_loaded: bool,
) -> Drives {
    Drives {
        freedom,
        prescribed,
        loaded,
        can_be_loaded,
    }
}

impl Drives {
    fn allow(&self, drive: DriveWord) -> bool {
        match drive {
            DriveWord::Locked => true,
            DriveWord::Prescribed => self.prescribed.is_some(),
            DriveWord::Loaded => self.can_be_loaded,
        }
    }

    fn words(&self) -> &'static str {
        match (self.prescribed.is_some(), self.can_be_loaded) {
            (true, true) => "\"locked\", \"prescribed\" or \"loaded\"",
            (true, false) => "\"locked\" or \"prescribed\"",
            (false, _) => "\"locked\" or \"loaded\"",
        }
    }

    /// The waveform that `drive` needs.
    pub(super) fn channel(&self, drive: DriveWord) -> Option<Channel> {
        match drive {
            DriveWord::Locked => None,
            DriveWord::Prescribed => self.prescribed,
            DriveWord::Loaded => self.loaded,
        }
    }
}

/// What moves each freedom of a preset, in the order of [`FREEDOMS`].
fn preset_drives(preset: Preset) -> [DriveWord; 6] {
    use DriveWord::{Loaded, Prescribed};
    match preset {
        Preset::StanmoreForce => [Loaded, Loaded, Loaded, Loaded, Loaded, Prescribed],
        Preset::StanmoreDisplacement => {
            [Prescribed, Prescribed, Loaded, Loaded, Loaded, Prescribed]
        }
    }
}

impl Freedoms {
    fn read(machine: &Section<'_>, preset: Preset, log: &mut Log<'_>) -> Option<Self> {
        let section = machine.table("freedoms", log);
        section.check_keys(&FREEDOMS, log);
        let (ap, ie) = (
            read_table(&section, "ap", log),
            read_table(&section, "ie", log),
        );
        let (ml, vv) = (
            read_table(&section, "ml", log),
            read_table(&section, "vv", log),
        );
        let (is, flexion) = (
            read_table(&section, "is", log),
            read_table(&section, "flexion", log),
        );
        let (ap, ie, ml) = (ap?, ie?, ml?);
        let mut freedoms = Self {
            ap,
            ie,
            ml,
            vv: vv?,
            is: is?,
            flexion: flexion?,
        };
        for (drive, default) in freedoms.drives_mut().into_iter().zip(preset_drives(preset)) {
            drive.get_or_insert(default);
        }
        freedoms.check(&section, log);
        Some(freedoms)
    }

    fn drives_mut(&mut self) -> [&mut Option<DriveWord>; 6] {
        [
            &mut self.ap.drive,
            &mut self.ie.drive,
            &mut self.ml.drive,
            &mut self.vv.drive,
            &mut self.is.drive,
            &mut self.flexion.drive,
        ]
    }

    /// What moves each freedom, in the order ap, ie, ml, vv, is, flexion.
    pub fn drives(&self) -> [DriveWord; 6] {
        [
            self.ap.drive,
            self.ie.drive,
            self.ml.drive,
            self.vv.drive,
            self.is.drive,
            self.flexion.drive,
        ]
        .map(|drive| drive.unwrap_or(DriveWord::Locked))
    }

    fn locked_at(&self) -> [f64; 6] {
        [
            self.ap.locked_at_mm,
            self.ie.locked_at_deg,
            self.ml.locked_at_mm,
            self.vv.locked_at_deg,
            self.is.locked_at_mm,
            self.flexion.locked_at_deg,
        ]
    }

    /// Reports drives that a freedom cannot have, and places to lock one that is not locked.
    fn check(&self, section: &Section<'_>, log: &mut Log<'_>) {
        for ((can, drive), at) in DRIVES.iter().zip(self.drives()).zip(self.locked_at()) {
            let row = section.table(can.freedom, log);
            if !can.allow(drive) {
                let (freedom, drive, drives) = (can.freedom, drive.word(), can.words());
                let reason = DriveReason::NoSuchDrive {
                    freedom,
                    drive,
                    drives,
                };
                log.problem(row.value_span("drive"), reason);
            }
            if drive != DriveWord::Locked && at != 0.0 {
                let key = ["locked_at_mm", "locked_at_deg"]
                    .into_iter()
                    .find(|key| row.value(key).is_some())
                    .unwrap_or_default();
                let needs = "`drive = \"locked\"`".to_owned();
                let reason = KeyReason::Idle {
                    key: key.to_owned(),
                    needs,
                };
                log.problem(row.key_span(key), reason);
            }
        }
    }
}

impl Waveforms {
    fn read(machine: &Section<'_>, drives: &[DriveWord; 6], log: &mut Log<'_>) -> Option<Self> {
        let mut given: [Option<Waveform>; 6] = Default::default();
        let mut complete = true;
        for (can, &drive) in DRIVES.iter().zip(drives) {
            for channel in [can.prescribed, can.loaded].into_iter().flatten() {
                if can.channel(drive) == Some(channel) {
                    let waveform = waveform::read(channel, machine, log);
                    complete &= waveform.is_some();
                    given[channel as usize] = waveform;
                } else {
                    check_absent(machine, can, drive, channel, log);
                }
            }
        }
        complete.then_some(Self { given })
    }
}

/// Reports a waveform for a freedom that is driven otherwise.
fn check_absent(
    machine: &Section<'_>,
    can: &Drives,
    drive: DriveWord,
    channel: Channel,
    log: &mut Log<'_>,
) {
    if machine.value(channel.name()).is_none() {
        return;
    }
    let wanted = match can.prescribed == Some(channel) {
        true => DriveWord::Prescribed,
        false => DriveWord::Loaded,
    };
    let reason = DriveReason::UnusedWaveform {
        section: format!("machine.{}", channel.name()),
        freedom: can.freedom,
        drive: drive.word(),
        wanted: wanted.word(),
    };
    log.problem(machine.key_span(channel.name()), reason);
}

impl Machine {
    pub(super) fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let known: Vec<&str> = names(&MachineSettings::keys())
            .chain(names(&Start::keys()))
            .chain(["springs", "freedoms"])
            .chain(Channel::ALL.map(Channel::name))
            .collect();
        section.check_keys(&known, log);
        let settings = MachineSettings::read(section, log);
        let springs = read_table(section, "springs", log);
        let preset = Start::read(section, log)?.preset;
        let freedoms = Freedoms::read(section, preset, log)?;
        let waveforms = Waveforms::read(section, &freedoms.drives(), log);
        Some(Self {
            preset,
            settings: settings?,
            springs: springs?,
            freedoms,
            waveforms: waveforms?,
        })
    }
}
