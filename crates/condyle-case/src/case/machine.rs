//! The simulator: its numbers, its six freedoms and what drives them.

use condyle::machine::knee::{self, KNEE};
use condyle::machine::{JointDescription, JointIndex, JointKind, Waveform};
use condyle::parameter::unit_of;
use toml::Spanned;
use toml::de::DeValue;

use super::machine_reason::{ActivityReason, DriveReason};
use super::table::{Context, Table, WearLaws, WriteWaveform};
use super::waveform::CaseChannel;
use super::waveform::{DEFAULT_WAVEFORM, InterpolationWord, list_waveforms, with_waveforms};
use super::waveform_points;
use crate::config::{
    Key, KeyReason, Kind, Log, Page, Section, Setting, Settings, TableSchema, Writer, choice,
    names, number, quoted_list, read_table, settings, within, wrong_type,
};

choice! {
    /// A simulator to start from.
    Preset {
        /// AP and IE free under force and torque, restrained by springs.
        StanmoreForce = "stanmore-force",
        /// AP and IE moved along waveforms.
        StanmoreDisplacement = "stanmore-displacement",
    }

    /// What a stated spring stiffness belongs to.
    StiffnessOf {
        /// Both springs of the pair together: each has half.
        Pair = "pair",
        /// Each spring of the pair.
        Each = "each",
    }

    /// What moves a freedom.
    DriveWord {
        /// Held at a position.
        Locked = "locked",
        /// Moved along a waveform of position.
        Prescribed = "prescribed",
        /// Free under a waveform of load, or under none.
        Loaded = "loaded",
    }
}

settings! {
    /// The simulator that a machine starts from.
    Start {
        /// The simulator it starts from: which freedoms are free and which are moved.
        preset: Preset = Preset::StanmoreForce;
    }

    /// The simulator's numbers.
    MachineSettings {
        /// Gait cycles a second.
        frequency_hz: f64 = 1.1, in within(0.001, 100.0);
        /// Added to the flexion waveform: -7 sets the femur 7 degrees towards hyperextension.
        flexion_offset_deg: f64 = -7.0, in within(-45.0, 45.0);
        /// 1 or -1 times the AP force: laboratories dispute its direction.
        ap_force_sign: Sign = Sign::Plus;
        /// 1 or -1 times the IE torque: laboratories dispute its direction.
        ie_torque_sign: Sign = Sign::Plus;
        /// How far medial of the load axis the varus-valgus axis lies.
        vv_axis_medial_mm: f64 = 5.0, in within(-50.0, 50.0);
        /// How far below the dish's lowest point the varus-valgus axis lies.
        vv_axis_below_mm: f64 = 20.0, in within(-100.0, 200.0);
        /// How far anterior of the insert's origin the axis of IE rotation lies.
        ie_axis_anterior_mm: f64 = 0.0, in within(-50.0, 50.0);
    }

    /// The pair of springs that stands for the ligaments.
    Springs {
        /// Stiffness against posterior motion of the insert.
        posterior_n_per_mm: f64 = 33.8, in within(0.0, 10_000.0);
        /// Stiffness against anterior motion of the insert.
        anterior_n_per_mm: f64 = 7.24, in within(0.0, 10_000.0);
        /// Whether the stiffnesses are those of the pair or of each spring: the paper does not say.
        stiffness_of: StiffnessOf = StiffnessOf::Pair;
        /// Motion each way before they engage.
        free_play_mm: f64 = 2.5, in within(0.0, 50.0);
        /// How far each spring lies to the side of the IE axis.
        lateral_offset_mm: f64 = 28.0, in within(0.0, 100.0);
    }

    /// A freedom that translates. No source gives inertia and damping: the book says why they are so.
    Translation {
        /// What moves it; by the preset if not given.
        drive: Option<DriveWord> = None;
        /// Where it is held when locked.
        locked_at_mm: f64 = 0.0, in within(-100.0, 100.0);
        /// Mass that moves with it.
        inertia_kg: f64 = 1e3 * knee::MASS_TONNE, in within(0.0, 1000.0);
        /// Viscous damping.
        damping_n_s_per_mm: f64 = knee::DAMPING_N_S_PER_MM, in within(0.0, 1000.0);
    }

    /// A freedom that rotates. No source gives inertia and damping: the book says why they are so.
    Rotation {
        /// What moves it; by the preset if not given.
        drive: Option<DriveWord> = None;
        /// Where it is held when locked.
        locked_at_deg: f64 = 0.0, in within(-180.0, 180.0);
        /// Moment of inertia that moves with it.
        inertia_kg_m2: f64 = 1e-3 * knee::MOMENT_OF_INERTIA_TONNE_MM2, in within(0.0, 100.0);
        /// Viscous damping.
        damping_nm_s_per_rad: f64 = 1e-3 * knee::DAMPING_NMM_S_PER_RAD, in within(0.0, 1000.0);
    }
}

/// 1 or -1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sign {
    /// 1: as the waveform says.
    Plus,
    /// -1: turned round.
    Minus,
}

impl Sign {
    /// 1.0 or -1.0.
    pub fn factor(self) -> f64 {
        match self {
            Self::Plus => 1.0,
            Self::Minus => -1.0,
        }
    }
}

impl Setting for Sign {
    fn kind() -> Kind {
        Kind::Sign
    }

    fn read(value: &Spanned<DeValue<'_>>, key: &Key, log: &mut Log<'_>) -> Option<Self> {
        match number(value.get_ref()) {
            Some(1.0) => Some(Self::Plus),
            Some(-1.0) => Some(Self::Minus),
            _ => {
                wrong_type(value, key, log);
                None
            }
        }
    }

    fn text(&self) -> Option<String> {
        Some(format!("{:.0}", self.factor()))
    }
}

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
                    let waveform = waveform_points::read(channel, machine, log);
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
    /// The freedoms of the machine of a case, whatever else is wrong with it.
    pub(super) fn freedoms_in(root: &Section<'_>, log: &Log<'_>) -> Option<Freedoms> {
        let mut unheard = log.unheard();
        let section = root.part(Self::NAME);
        let preset = Start::read(&section, &mut unheard)?.preset;
        Freedoms::read(&section, preset, &mut unheard)
    }

    /// Reads `[machine]`, whose waveforms are elsewhere where the case has activities.
    fn read(section: &Section<'_>, has_activities: bool, log: &mut Log<'_>) -> Option<Self> {
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

impl Machine {
    /// Writes `[machine]` and the tables inside it.
    fn write(&self, write_waveform: WriteWaveform, out: &mut Writer) {
        out.table("machine");
        let preset = self.preset;
        Start { preset }.write(out);
        self.settings.write(out);
        out.table("machine.springs");
        self.springs.write(out);
        self.waveforms.write("machine.", write_waveform, out);
        self.write_freedoms(out);
    }

    fn write_freedoms(&self, out: &mut Writer) {
        for (joint, freedom) in self.freedoms.in_files() {
            out.table(&format!("machine.freedoms.{}", joint.name));
            match freedom {
                Freedom::Translation(keys) => keys.write(out),
                Freedom::Rotation(keys) => keys.write(out),
            }
        }
    }
}

impl Waveforms {
    /// Writes a table a waveform, each with `above` before its name.
    pub(super) fn write(&self, above: &str, write_waveform: WriteWaveform, out: &mut Writer) {
        for channel in CaseChannel::all() {
            if let Some(waveform) = self.get(channel) {
                let table = format!("{above}{}", channel.name());
                write_waveform(out, &table, channel, waveform);
            }
        }
    }
}

/// The points of a waveform as its table.
pub(super) fn write_knots(
    out: &mut Writer,
    table: &str,
    channel: CaseChannel,
    waveform: &Waveform,
) {
    let interpolation = InterpolationWord::of(waveform.interpolation()).word();
    out.table(table);
    out.comment(channel.about());
    out.line(
        &format!("interpolation = {interpolation:?}"),
        "From point to point.",
    );
    let unit = unit_of(channel.knots_key()).unwrap_or_default();
    out.comment(&format!("[percent of the cycle, {unit}]"));
    let knots = waveform.knots().iter();
    let pairs: Vec<(f64, f64)> = knots.map(|knot| (knot.percent, knot.value)).collect();
    out.pairs(channel.knots_key(), &pairs);
}

/// The table of a waveform by its name.
pub(super) fn write_name(out: &mut Writer, table: &str, channel: CaseChannel, _: &Waveform) {
    out.table(table);
    out.comment(channel.about());
    out.line(
        &format!("waveform = {DEFAULT_WAVEFORM:?}"),
        "Or file and column, or knots.",
    );
}

impl Table for Machine {
    const NAME: &'static str = "machine";

    fn read_in(root: &Section<'_>, _: &Context, log: &mut Log<'_>) -> Option<Self> {
        let has_activities = root.value("activity").is_some();
        Self::read(&root.table(Self::NAME, log), has_activities, log)
    }

    fn write_in(&self, waveforms: WriteWaveform, out: &mut Writer) {
        self.write(waveforms, out);
    }

    fn add_to_schema(case: TableSchema, _: WearLaws) -> TableSchema {
        let keys = [Start::keys(), MachineSettings::keys()].concat();
        let springs = TableSchema::new("The pair of springs that stands for the ligaments.");
        let joints = KNEE.in_files.into_iter().map(|index| KNEE.joint(index));
        let freedoms = joints.fold(TableSchema::new("The six freedoms."), |freedoms, joint| {
            let about = format!("{}: + is {}.", joint.title, joint.positive);
            freedoms.with_table(
                joint.name,
                TableSchema::new(&about).with_keys(&Freedom::keys(joint)),
            )
        });
        let machine = TableSchema::new("The simulator.")
            .with_keys(&keys)
            .with_table("springs", springs.with_keys(&Springs::keys()))
            .with_table("freedoms", freedoms);
        case.with_table(Self::NAME, with_waveforms(machine))
    }

    fn add_to_page(page: &mut Page, _: WearLaws) {
        let keys = [Start::keys(), MachineSettings::keys()].concat();
        page.section("`[machine]`", &keys);
        page.section("`[machine.springs]`", &Springs::keys());
        page.section(&freedoms(JointKind::Translation), &Translation::keys());
        page.section(&freedoms(JointKind::Rotation), &Rotation::keys());
        list_waveforms(page);
    }
}

/// The tables of all freedoms of a kind, such as `[machine.freedoms.ap], .ml and .is`.
fn freedoms(kind: JointKind) -> String {
    let joints = KNEE.in_files.into_iter().map(|index| KNEE.joint(index));
    let names: Vec<&str> = joints
        .filter(|joint| joint.kind() == kind)
        .map(|joint| joint.name)
        .collect();
    let others = names[1..].iter().map(|name| format!(".{name}"));
    let others: Vec<String> = others.collect();
    let first = format!("[machine.freedoms.{}]", names[0]);
    match others.split_last() {
        Some((last, between)) => {
            let listed = [&[first], between].concat().join(", ");
            format!("`{listed} and {last}`")
        }
        None => format!("`{first}`"),
    }
}
