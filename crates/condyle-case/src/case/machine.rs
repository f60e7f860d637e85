//! The simulator: its own keys, its six freedoms, and the waveforms that drive them.

use std::sync::OnceLock;

use condyle::machine::knee::{self, KNEE};
use condyle::machine::{Channel, JointDescription, JointIndex, JointKind, Waveform};

use toml::de::DeTable;

use super::drive::DriveWord;
use super::ligament::Ligament;
use super::rig::{Rig, report_keys_of_rig};
use super::waveform::{self, waveform_items};
use crate::config::*;

choice! {
    /// A simulator to start from.
    Preset {
        /// AP and IE free under force and torque, restrained by springs.
        StanmoreForce = "stanmore-force",
        /// AP and IE moved along waveforms.
        StanmoreDisplacement = "stanmore-displacement",
        /// Hip: three rotations of the head, load fixed to the cup.
        Iso142421Like = "iso-14242-1-like",
        /// Hip: head on a block of 23 degrees that orbits.
        Iso142423Like = "iso-14242-3-like",
        /// Hip: as iso-14242-1-like, with a spring that moves head and cup apart in swing, onto the rim.
        Iso142424Like = "iso-14242-4-like",
        /// Lumbar disc: flexion, bending and rotation, a quarter of a cycle apart.
        Iso181921LumbarLike = "iso-18192-1-lumbar-like",
        /// Cervical disc: as the lumbar one, with larger motions and smaller loads.
        Iso181921CervicalLike = "iso-18192-1-cervical-like",
        /// Ankle: flexion prescribed, AP force and torque restrained by the bearing.
        Iso22622Like = "iso-22622-like",
        /// Ankle: as iso-22622-like, with AP motion and rotation prescribed.
        Iso22622DisplacementLike = "iso-22622-displacement-like",
        /// Pin on a disc along a circle.
        PinOnDisc = "pin-on-disc",
    }

    /// Meaning of a stated spring stiffness.
    StiffnessOf {
        /// Both springs of the pair together: each has half.
        Pair = "pair",
        /// Each spring of the pair.
        Each = "each",
    }
}

settings! {
    /// The simulator's own keys.
    MachineSettings {
        /// The simulator to start from: it determines which freedoms are loaded and which are prescribed.
        preset: Preset = Preset::StanmoreForce;
        /// Machine file in place of a preset, relative to the case file; [its keys](machines.md) may also stand here, where a joint replaces that of the same name.
        file: Option<DataFile> = None;
        /// Cycles a second.
        frequency_hz: f64 = 1.1, in within(0.001, 100.0);
        /// Factor on every load and torque, also of activities.
        load_scale: f64 = 1.0, in within(0.01, 100.0);
        /// Added to the flexion waveform: -7 sets the femur 7 degrees towards hyperextension.
        flexion_offset_deg: f64 = -7.0, in within(-45.0, 45.0);
        /// Factor on the AP force, 1 or -1: laboratories disagree on its direction.
        ap_force_sign: Sign = Sign(1.0);
        /// Factor on the IE torque, 1 or -1: laboratories disagree on its direction.
        ie_torque_sign: Sign = Sign(1.0);
        /// Distance of the varus-valgus axis medial of the load axis.
        vv_axis_medial_mm: f64 = 5.0, in within(-50.0, 50.0);
        /// Distance of the varus-valgus axis below the dish's lowest point.
        vv_axis_below_mm: f64 = 20.0, in within(-100.0, 200.0);
        /// Distance of the axis of IE rotation anterior of the insert's origin.
        ie_axis_anterior_mm: f64 = 0.0, in within(-50.0, 50.0);
    }

    /// The pair of springs that represents the ligaments.
    Springs {
        /// Stiffness against posterior motion of the insert.
        posterior_n_per_mm: f64 = 33.8, in within(0.0, 10_000.0);
        /// Stiffness against anterior motion of the insert.
        anterior_n_per_mm: f64 = 7.24, in within(0.0, 10_000.0);
        /// Springs to which the stiffnesses apply: the pair or each one, which Knight 2007 does not state.
        stiffness_of: StiffnessOf = StiffnessOf::Pair;
        /// Motion each way before the springs engage.
        free_play_mm: f64 = 2.5, in within(0.0, 50.0);
        /// Distance of each spring to the side of the IE axis.
        lateral_offset_mm: f64 = 28.0, in within(0.0, 100.0);
    }
}

// No source gives the inertia and damping of a freedom: the book explains the defaults.
settings! {
    /// Keys of a freedom along a line, beside its drive.
    TranslationKeys {
        /// Position at which it is held when locked.
        locked_at_mm: f64 = 0.0, in within(-100.0, 100.0);
        /// Mass that moves with it.
        inertia_kg: f64 = 1e3 * knee::MASS_TONNE, in within(0.0, 1000.0);
        /// Viscous damping.
        damping_n_s_per_mm: f64 = knee::DAMPING_N_S_PER_MM, in within(0.0, 1000.0);
    }

    /// Keys of a freedom about an axis, beside its drive. Files state SI units: 1 t mm2 is 1e-3 kg m2.
    RotationKeys {
        /// Position at which it is held when locked.
        locked_at_deg: f64 = 0.0, in within(-180.0, 180.0);
        /// Moment of inertia that moves with it.
        inertia_kg_m2: f64 = 1e-3 * knee::MOMENT_OF_INERTIA_TONNE_MM2, in within(0.0, 100.0);
        /// Viscous damping.
        damping_nm_s_per_rad: f64 = 1e-3 * knee::DAMPING_NMM_S_PER_RAD, in within(0.0, 1000.0);
    }
}

/// The simulator.
#[derive(Clone, Debug, PartialEq)]
pub struct Machine {
    /// Its own keys.
    pub settings: MachineSettings,
    /// The pair of springs.
    pub springs: Springs,
    /// The six freedoms.
    pub freedoms: Freedoms,
    /// The waveforms that drive the freedoms.
    pub waveforms: Waveforms,
    /// The ligaments of the knee simulator.
    pub ligaments: Vec<Ligament>,
    /// A machine by joints, in place of the knee simulator that all other fields describe.
    pub rig: Option<Rig>,
}

/// The settings of a freedom.
#[derive(Clone, Debug, PartialEq)]
pub struct Freedom {
    /// Its drive.
    pub drive: DriveWord,
    /// Its position when locked, inertia and damping.
    pub keys: FreedomKeys,
}

/// The keys of a freedom of either kind.
#[derive(Clone, Debug, PartialEq)]
#[expect(missing_docs, reason = "the kinds of joints")]
pub enum FreedomKeys {
    Translation(TranslationKeys),
    Rotation(RotationKeys),
}

/// The six freedoms, one per joint, each with its drive.
#[derive(Clone, Debug, PartialEq)]
pub struct Freedoms {
    rows: [Freedom; 6],
}

/// The waveforms of a machine, each in the unit of its key.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Waveforms {
    given: Vec<(&'static Channel, Waveform)>,
}

impl Preset {
    /// Returns the text of its machine file.
    pub fn text(self) -> &'static str {
        match self {
            Self::StanmoreForce => include_str!("../../machines/stanmore-force.toml"),
            Self::StanmoreDisplacement => include_str!("../../machines/stanmore-displacement.toml"),
            Self::Iso142421Like => include_str!("../../machines/iso-14242-1-like.toml"),
            Self::Iso142423Like => include_str!("../../machines/iso-14242-3-like.toml"),
            Self::Iso142424Like => include_str!("../../machines/iso-14242-4-like.toml"),
            Self::Iso181921LumbarLike => {
                include_str!("../../machines/iso-18192-1-lumbar-like.toml")
            }
            Self::Iso181921CervicalLike => {
                include_str!("../../machines/iso-18192-1-cervical-like.toml")
            }
            Self::Iso22622Like => include_str!("../../machines/iso-22622-like.toml"),
            Self::Iso22622DisplacementLike => {
                include_str!("../../machines/iso-22622-displacement-like.toml")
            }
            Self::PinOnDisc => include_str!("../../machines/pin-on-disc.toml"),
        }
    }

    /// Returns the machine of its file, which is read once.
    pub(super) fn machine(self) -> &'static Rig {
        static READ: [OnceLock<Rig>; Preset::ALL.len()] =
            [const { OnceLock::new() }; Preset::ALL.len()];
        let name = || format!("machines/{}.toml", self.word());
        READ[self as usize].get_or_init(|| Rig::shipped(&name(), self.text()))
    }

    /// Returns the drive of a freedom for which the case gives none.
    fn drive(self, freedom: &str) -> DriveWord {
        let mut joints = self.machine().joints.iter();
        let joint = joints.find(|joint| joint.keys.name == freedom);
        joint.map_or(DriveWord::Loaded, |joint| joint.keys.drive)
    }
}

impl Freedom {
    pub(super) fn drive_key() -> Key {
        let about = "Its drive; that of the preset if not given.";
        Key::optional("drive", about, DriveWord::kind())
    }

    fn read(
        joint: &JointDescription,
        preset: Preset,
        section: &Section<'_>,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        let drive: Option<Option<DriveWord>> = section.setting(&Self::drive_key(), Some(None), log);
        let keys = FreedomKeys::read(joint.kind(), section, log)?;
        let drive = drive?.unwrap_or(preset.drive(joint.name));
        if !drive.fits(joint) {
            let (freedom, word) = (joint.name, drive.word());
            let fault = Fault::new(
                format!("the {freedom} freedom cannot be {word}: a case has no waveform for that"),
                format!("it can be {}", quoted_list(&DriveWord::words_for(joint))),
            );
            log.problem(section.value_span("drive"), fault);
        }
        let (key, locked_at) = match &keys {
            FreedomKeys::Translation(keys) => ("locked_at_mm", keys.locked_at_mm),
            FreedomKeys::Rotation(keys) => ("locked_at_deg", keys.locked_at_deg),
        };
        if drive != DriveWord::Locked && locked_at != 0.0 {
            log.problem(section.key_span(key), idle(key, "`drive = \"locked\"`"));
        }
        Some(Self { drive, keys })
    }

    fn write(&self, out: &mut Writer) {
        self.drive.write(&Self::drive_key(), out);
        match &self.keys {
            FreedomKeys::Translation(keys) => keys.write(out),
            FreedomKeys::Rotation(keys) => keys.write(out),
        }
    }

    fn item(joint: &'static JointDescription) -> Item {
        let drive = Key {
            kind: Kind::Word(DriveWord::words_for(joint)),
            ..Self::drive_key()
        };
        let items = [vec![Item::Key(drive)], FreedomKeys::items(joint.kind())].concat();
        let about = format!("{}: + is {}.", joint.title, joint.positive);
        Item::Table(TableItem::new(joint.name, &about, items))
    }
}

impl FreedomKeys {
    pub(super) fn items(kind: JointKind) -> Vec<Item> {
        match kind {
            JointKind::Translation => TranslationKeys::items(),
            JointKind::Rotation => RotationKeys::items(),
        }
    }

    fn read(kind: JointKind, section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        Some(match kind {
            JointKind::Translation => Self::Translation(TranslationKeys::read(section, log)?),
            JointKind::Rotation => Self::Rotation(RotationKeys::read(section, log)?),
        })
    }
}

impl Freedoms {
    fn read(machine: &Section<'_>, preset: Preset, log: &mut Log<'_>) -> Option<Self> {
        let section = machine.table("freedoms", log);
        let read = KNEE.joints.each_ref().map(|joint| {
            let section = section.table(joint.name, log);
            Freedom::read(joint, preset, &section, log)
        });
        let rows: Vec<Freedom> = read.into_iter().collect::<Option<_>>()?;
        let rows = rows.try_into().ok()?;
        Some(Self { rows })
    }

    /// Returns the settings of one freedom.
    pub fn get(&self, joint: JointIndex) -> &Freedom {
        &self.rows[joint.place()]
    }

    pub(super) fn channels(&self) -> impl Iterator<Item = &'static Channel> {
        self.in_files()
            .filter_map(|(joint, freedom)| freedom.drive.channel(joint))
    }

    /// Returns every freedom with its joint, in the order they are written.
    fn in_files(&self) -> impl Iterator<Item = (&'static JointDescription, &Freedom)> {
        joints_in_files()
            .zip(KNEE.in_files.iter().copied())
            .map(|(joint, index)| (joint, self.get(index)))
    }

    fn item() -> Item {
        let items = joints_in_files().map(Freedom::item).collect();
        Item::Table(TableItem::new("freedoms", "The six freedoms.", items))
    }
}

pub(super) fn joints_in_files() -> impl Iterator<Item = &'static JointDescription> {
    KNEE.in_files.iter().map(|&index| KNEE.joint(index))
}

impl Waveforms {
    /// Returns the waveform of `channel`, if the machine uses it.
    pub fn get(&self, channel: &Channel) -> Option<&Waveform> {
        let mut given = self.given.iter();
        given.find_map(|(of, waveform)| (*of == channel).then_some(waveform))
    }

    /// Reads the waveforms that `freedoms` need from their tables in `machine`; reports any other waveform.
    pub(super) fn read(
        machine: &Section<'_>,
        freedoms: &Freedoms,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        let mut given = Vec::new();
        let mut complete = true;
        for (joint, freedom) in freedoms.in_files() {
            for channel in [joint.motion, joint.load_channel()].into_iter().flatten() {
                if freedom.drive.channel(joint) == Some(channel) {
                    let waveform = waveform::read(channel, machine, log);
                    complete &= waveform.is_some();
                    given.extend(waveform.map(|waveform| (channel, waveform)));
                } else if machine.value(channel.name).is_some() {
                    let wanted = if joint.motion == Some(channel) {
                        DriveWord::Prescribed
                    } else {
                        DriveWord::Loaded
                    };
                    let table = format!("[{}.{}]", machine.path, channel.name);
                    let (name, drive, wanted) = (joint.name, freedom.drive.word(), wanted.word());
                    let fault = Fault::new(
                        format!(
                            "{table} is given, but the {name} freedom is {drive}; these contradict each other"
                        ),
                        format!("remove {table}, or make the freedom `drive = \"{wanted}\"`"),
                    );
                    log.problem(machine.key_span(channel.name), fault);
                }
            }
        }
        complete.then_some(Self { given })
    }

    pub(super) fn write(&self, out: &mut Writer) {
        for channel in KNEE.channels {
            if let Some(waveform) = self.get(channel) {
                out.table(channel.name, |out| waveform::write(channel, waveform, out));
            }
        }
    }
}

impl Machine {
    /// Returns the freedoms of the machine of a case, ignoring all other problems of the machine.
    pub(super) fn freedoms_in(root: &Section<'_>, log: &Log<'_>) -> Option<Freedoms> {
        let mut discarded = Log::new(&log.source, log.base);
        let section = root.part("machine");
        let preset = MachineSettings::read(&section, &mut discarded)?.preset;
        Freedoms::read(&section, preset, &mut discarded)
    }

    fn read_with(
        section: &Section<'_>,
        waveforms: impl FnOnce(&Section<'_>, &Freedoms, &mut Log<'_>) -> Option<Waveforms>,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        let settings = MachineSettings::read(section, log);
        let springs = Springs::read_in(section, "springs", log);
        let ligaments = Ligament::read_list(section, "ligaments", log);
        let settings = settings?;
        let freedoms = Freedoms::read(section, settings.preset, log)?;
        let waveforms = waveforms(section, &freedoms, log);
        Some(Self {
            settings,
            springs: springs?,
            freedoms,
            waveforms: waveforms?,
            ligaments: ligaments?,
            rig: None,
        })
    }

    /// Returns the machine by joints that `section` describes, if it describes one; the outer `None` if it has problems.
    pub(super) fn rig_in(section: &Section<'_>, log: &mut Log<'_>) -> Option<Option<Rig>> {
        let mut discarded = Log::new(&log.source, log.base);
        let settings = MachineSettings::read(section, &mut discarded);
        let (preset, file) = settings.map_or((None, None), |settings| {
            let machine = settings.preset.machine();
            // A case of a knee simulator has keys of its own, which change the machine when it is built.
            let is_of_file = !machine.is_knee_simulator();
            (is_of_file.then(|| machine.clone()), settings.file)
        });
        let rig = Rig::read_from(section, preset, file.as_ref(), log)?;
        if rig.is_some() {
            let own = MachineSettings::keys();
            let shared = ["preset", "file", "frequency_hz", "load_scale"];
            let own = own.iter().map(|key| key.name);
            let own = own.filter(|key| !shared.contains(key));
            let of_knee: Vec<&str> = own.chain(["springs", "freedoms"]).collect();
            report_keys_of_knee(section, &of_knee, log);
        }
        Some(rig)
    }
}

/// Reports the waveforms of the knee simulator, and those of `keys`, that `section` of a machine by joints gives.
pub(super) fn report_keys_of_knee(section: &Section<'_>, keys: &[&'static str], log: &mut Log<'_>) {
    let channels = KNEE.channels.iter().map(|channel| channel.name);
    let needs = "a knee simulator, such as preset = \"stanmore-force\"";
    section.report_idle(keys.iter().copied().chain(channels), needs, log);
}

impl Settings for Machine {
    fn items() -> Vec<Item> {
        let mut items = MachineSettings::items();
        items.push(Springs::item(
            "springs",
            "The pair of springs that represents the ligaments.",
        ));
        items.push(Freedoms::item());
        items.extend(waveform_items(true));
        let of_rig = Rig::items_beside(&items);
        items.extend(of_rig);
        items
    }

    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        Self::read_with(section, Waveforms::read, log)
    }

    /// Reads the machine of a case; if the case has activities, they have the waveforms.
    fn read_in(root: &Section<'_>, name: &'static str, log: &mut Log<'_>) -> Option<Self> {
        let section = root.table(name, log);
        if let Some(rig) = Self::rig_in(&section, log)? {
            // Without keys the simulator of knees has its defaults, and no problems.
            let (none, mut discarded) = (DeTable::new(), Log::new(&log.source, log.base));
            let unused = Self::read(&Section::root(&none), &mut discarded)?;
            return Some(Self {
                rig: Some(rig),
                ..unused
            });
        }
        let mut own: Vec<&str> = names(&MachineSettings::keys()).collect();
        own.push("ligaments");
        report_keys_of_rig(&own, &section, log);
        if root.tables("activity").is_empty() {
            return Self::read(&section, log);
        }
        for channel in KNEE.channels {
            let table = channel.name;
            if section.value(table).is_some() {
                let fault = Fault::new(
                    format!(
                        "[machine.{table}] is given, but the inputs of the machine are those of each [[activity]]"
                    ),
                    format!("move it into the activities, as [activity.{table}]"),
                );
                log.problem(section.key_span(table), fault);
            }
        }
        Self::read_with(&section, |_, _, _| Some(Waveforms::default()), log)
    }

    fn write(&self, out: &mut Writer) {
        if let Some(rig) = &self.rig {
            return rig.write(out);
        }
        self.settings.write(out);
        self.springs.write_in("springs", out);
        self.waveforms.write(out);
        for (joint, freedom) in self.freedoms.in_files() {
            out.table(&format!("freedoms.{}", joint.name), |out| {
                freedom.write(out);
            });
        }
        self.ligaments.write_in("ligaments", out);
    }
}
