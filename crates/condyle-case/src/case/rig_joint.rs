//! A joint of a machine file: its axis, drive, waveform and spring.

use condyle::Vec3;
use condyle::machine::{
    Axis, Channel, ChannelUnit, Drive, JointDescription, JointIndex, JointKind, Loading, MovedBody,
    Settling, Spring, Waveform, knee,
};
use condyle::parameter::unit_of;

use super::drive::DriveWord;
use super::waveform;
use crate::config::*;

words! {
    JointKind {
        Rotation = "rotation",
        Translation = "translation",
    }

    MovedBody {
        Counterface = "counterface",
        Insert = "bearing",
    }

    Settling {
        Driven = "driven",
        Free = "free",
        HeldAtZero = "held",
        DrivenWithoutLoad = "driven-without-load",
    }
}

choice! {
    /// Level from which the height of a point of an axis is measured.
    PointLevel {
        /// The origin of the bearing frame.
        Origin = "origin",
        /// The lowest point of the bearing surface.
        LowestPoint = "lowest-point",
    }
}

settings! {
    /// The keys of a joint of a machine file, besides its waveform in `[joints.load]` or `[joints.motion]`.
    RigJointKeys {
        /// Its name: small letters, digits and hyphens.
        name: String;
        /// Heading in reports; the name if not given.
        title: Option<String> = None;
        /// Positive direction in words.
        positive: Option<String> = None;
        /// Motion: a rotation or a translation.
        kind: JointKind;
        /// Direction of its axis in the bearing frame: the load acts along y, and the counterface lies above the bearing. z points laterally, and for a disc to the right.
        axis: [f64; 3], in within(-1.0, 1.0);
        /// Body that it moves, which determines the sign.
        moves: MovedBody = MovedBody::Counterface;
        /// Point of a rotation's axis, in the bearing frame with all joints before it at zero; those joints carry it along. The centre of the counterface if not given.
        point_mm: Option<[f64; 3]> = None, in within(-1000.0, 1000.0);
        /// Level from which the height of `point_mm`, its second number, is measured; the origin if not given.
        point_from: Option<PointLevel> = None;
        /// Its drive.
        drive: DriveWord = DriveWord::Locked;
        /// Position of a locked rotation.
        locked_at_deg: Option<f64> = None, in within(-360.0, 360.0);
        /// Position of a locked translation.
        locked_at_mm: Option<f64> = None, in within(-1000.0, 1000.0);
        /// Whole turns of a prescribed rotation in a cycle, in place of a waveform.
        turns_per_cycle: Option<f64> = None, in within(-100.0, 100.0);
        /// Mass that a translation moves; 5 kg if not given.
        inertia_kg: Option<f64> = None, in within(0.0, 1000.0);
        /// Moment of inertia that a rotation moves; 0.01 kg m2 if not given.
        inertia_kg_m2: Option<f64> = None, in within(0.0, 100.0);
        /// Viscous damping of a translation; 0.3 N s/mm if not given.
        damping_n_s_per_mm: Option<f64> = None, in within(0.0, 1000.0);
        /// Viscous damping of a rotation; 0.2 N m s/rad if not given.
        damping_nm_s_per_rad: Option<f64> = None, in within(0.0, 1000.0);
        /// A spring of a loaded translation: stiffness against positive and against negative motion. It does not act while the machine settles.
        spring_n_per_mm: Option<[f64; 2]> = None, in within(0.0, 10_000.0);
        /// A spring of a loaded rotation: stiffness against positive and against negative motion.
        spring_nm_per_deg: Option<[f64; 2]> = None, in within(0.0, 1000.0);
        /// Motion each way before the spring of a translation engages; none if not given.
        free_play_mm: Option<f64> = None, in within(0.0, 100.0);
        /// Motion each way before the spring of a rotation engages; none if not given.
        free_play_deg: Option<f64> = None, in within(0.0, 180.0);
        /// Position of a translation where its spring is without force; zero if not given.
        spring_rest_mm: Option<f64> = None, in within(-100.0, 100.0);
        /// Position of a rotation where its spring is without force; zero if not given.
        spring_rest_deg: Option<f64> = None, in within(-180.0, 180.0);
        /// State while the machine settles at the start of the cycle, before the first cycle.
        settling: Settling = Settling::Driven;
        /// True for a translation that reads zero where the machine has settled; true for loaded ones if not given.
        zeroed: Option<bool> = None;
    }
}

impl RigJointKeys {
    /// Returns the keys that do not apply to its kind of motion.
    fn keys_of_other_kind(&self) -> &'static [&'static str] {
        match self.kind {
            JointKind::Rotation => &[
                "locked_at_mm",
                "inertia_kg",
                "damping_n_s_per_mm",
                "spring_n_per_mm",
                "free_play_mm",
                "spring_rest_mm",
            ],
            JointKind::Translation => &[
                "locked_at_deg",
                "inertia_kg_m2",
                "damping_nm_s_per_rad",
                "turns_per_cycle",
                "point_mm",
                "point_from",
                "spring_nm_per_deg",
                "free_play_deg",
                "spring_rest_deg",
            ],
        }
    }

    /// Returns the key of its spring's stiffness.
    fn spring_key(&self) -> &'static str {
        match self.kind {
            JointKind::Rotation => "spring_nm_per_deg",
            JointKind::Translation => "spring_n_per_mm",
        }
    }

    /// Returns what is wrong with the keys of a joint, each with the key at fault.
    fn faults(&self, section: &Section<'_>) -> Vec<(&'static str, Fault)> {
        let mut faults = Vec::new();
        let (name, drive) = (&self.name, self.drive.word());
        let mut add =
            |key, message: String, advice: &str| faults.push((key, Fault::new(message, advice)));
        if !is_name(name) {
            let message = format!("a joint cannot be called \"{name}\"");
            add("name", message, "use small letters, digits and hyphens");
        }
        if self.axis == [0.0; 3] {
            let message = format!("the axis of the joint \"{name}\" has no direction");
            add("axis", message, "give it a length, such as [0, 1, 0]");
        }
        let channel = channel_of(self.kind, self.drive);
        for table in ["load", "motion"] {
            let is_given = section.value(table).is_some();
            if is_given && channel.is_none_or(|channel| channel.name != table) {
                let message =
                    format!("the joint \"{name}\" is {drive}, and has a waveform of {table}");
                add(table, message, "remove one of them: a joint has one drive");
            }
        }
        for key in self
            .keys_of_other_kind()
            .iter()
            .filter(|key| section.value(key).is_some())
        {
            let kind = self.kind.text().unwrap_or_default();
            let message = format!("`{key}` does not fit the {kind} \"{name}\"");
            add(key, message, "remove it, or change `kind`");
        }
        let spring = self.spring_key();
        if section.value(spring).is_some() && self.drive != DriveWord::Loaded {
            let message = format!("the joint \"{name}\" is {drive}: its spring has no effect");
            add(spring, message, "remove it, or write drive = \"loaded\"");
        }
        let is_prescribed = self.drive == DriveWord::Prescribed;
        if self
            .turns_per_cycle
            .is_some_and(|turns| turns.fract() != 0.0 || !is_prescribed)
        {
            let message = format!("the joint \"{name}\" does not repeat after a cycle");
            add(
                "turns_per_cycle",
                message,
                "use whole turns and drive = \"prescribed\"",
            );
        }
        faults.extend(self.faults_of_unused_keys(section));
        faults
    }

    /// Returns the keys that have no effect, each with the reason.
    fn faults_of_unused_keys(&self, section: &Section<'_>) -> Vec<(&'static str, Fault)> {
        let is_given = |key: &str| section.value(key).is_some();
        let is_locked = self.drive == DriveWord::Locked;
        let (has_spring, has_point) = (is_given(self.spring_key()), self.point_mm.is_some());
        let (lock, spring) = ("or write drive = \"locked\"", "or give the joint a spring");
        let unused = [
            ("locked_at_deg", is_locked, lock),
            ("locked_at_mm", is_locked, lock),
            ("free_play_deg", has_spring, spring),
            ("free_play_mm", has_spring, spring),
            ("spring_rest_deg", has_spring, spring),
            ("spring_rest_mm", has_spring, spring),
            ("point_from", has_point, "or give `point_mm`"),
        ];
        let unused = unused.into_iter();
        let of_other_kind = self.keys_of_other_kind();
        let unused = unused.filter(|(key, has_effect, _)| {
            is_given(key) && !has_effect && !of_other_kind.contains(key)
        });
        let faults = unused.map(|(key, _, advice)| {
            let message = format!("`{key}` has no effect on the joint \"{}\"", self.name);
            (key, Fault::new(message, format!("remove it, {advice}")))
        });
        faults.chain(self.fault_of_zero()).collect()
    }

    /// Returns the fault of a joint that cannot read zero where the machine has settled: zero would be its reading there and the
    /// value of its drive, and both cannot hold.
    fn fault_of_zero(&self) -> Option<(&'static str, Fault)> {
        if self.zeroed != Some(true) {
            return None;
        }
        let is_free = matches!(self.settling, Settling::Free | Settling::HeldAtZero);
        let why = match self.kind {
            JointKind::Rotation => "only translations can",
            JointKind::Translation if is_free || self.drive == DriveWord::Loaded => return None,
            JointKind::Translation => "its drive holds it; settling = \"free\" releases it",
        };
        let (name, advice) = (&self.name, "remove `zeroed`");
        let message =
            format!("the joint \"{name}\" cannot read zero where the machine has settled: {why}");
        Some(("zeroed", Fault::new(message, advice)))
    }
}

const fn channel(name: &'static str, unit: ChannelUnit, most: f64) -> Channel {
    Channel {
        name,
        about: "Waveform of the joint, in the direction of its axis.",
        unit,
        sign: 1.0,
        least: -most,
        most,
    }
}

static FORCE: Channel = channel("load", ChannelUnit::Newton, 20_000.0);
static TORQUE: Channel = channel("load", ChannelUnit::NewtonMetre, 500.0);
static TRANSLATION: Channel = channel("motion", ChannelUnit::Millimetre, 1000.0);
static ROTATION: Channel = channel("motion", ChannelUnit::Degree, 360.0);

fn channel_of(kind: JointKind, drive: DriveWord) -> Option<&'static Channel> {
    match (drive, kind) {
        (DriveWord::Locked, _) => None,
        (DriveWord::Loaded, JointKind::Translation) => Some(&FORCE),
        (DriveWord::Loaded, JointKind::Rotation) => Some(&TORQUE),
        (DriveWord::Prescribed, JointKind::Translation) => Some(&TRANSLATION),
        (DriveWord::Prescribed, JointKind::Rotation) => Some(&ROTATION),
    }
}

/// The joints that a machine may have.
const MAX_JOINTS: usize = 6;

/// A joint of a machine from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct RigJoint {
    /// Its keys.
    pub keys: RigJointKeys,
    /// Its waveform of load or motion, in the unit of files.
    pub waveform: Option<Waveform>,
}

impl Settings for RigJoint {
    fn items() -> Vec<Item> {
        let mut items = RigJointKeys::items();
        for channels in [[&FORCE, &TORQUE], [&TRANSLATION, &ROTATION]] {
            items.push(Item::Table(waveform::table(&channels, false)));
        }
        items
    }

    /// Reads the joints of a machine; each has its own name.
    fn read_list(above: &Section<'_>, name: &str, log: &mut Log<'_>) -> Option<Vec<Self>> {
        let sections = above.list(name, log)?;
        if sections.len() > MAX_JOINTS {
            let count = sections.len();
            let message =
                format!("a machine has at most {MAX_JOINTS} joints, and this one has {count}");
            let fault = Fault::new(message, "two bodies have six freedoms");
            return log.reject(above.key_span(name), fault);
        }
        let joints = above.read_list(name, log, Self::read)?;
        above.check_names_differ(name, log)?;
        Some(joints)
    }

    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let mut keys = RigJointKeys::read(section, log)?;
        // A direction from CAD has round-off, but the axis that presses is along y exactly.
        let largest = keys
            .axis
            .iter()
            .fold(0.0_f64, |most, part| most.max(part.abs()));
        for part in &mut keys.axis {
            if part.abs() < AXIS_ROUND_OFF * largest {
                *part = 0.0;
            }
        }
        let channel = channel_of(keys.kind, keys.drive);
        let mut faults = keys.faults(section);
        let waveform = match channel {
            Some(channel) if section.value(channel.name).is_some() => {
                Some(waveform::read(channel, section, log)?)
            }
            _ => None,
        };
        let is_prescribed = keys.drive == DriveWord::Prescribed;
        if is_prescribed && waveform.is_some() == keys.turns_per_cycle.is_some() {
            let message = format!(
                "the prescribed joint \"{}\" needs one of [joints.motion] and `turns_per_cycle`",
                keys.name
            );
            faults.push(("drive", Fault::new(message, "")));
        }
        let is_sound = faults.is_empty();
        for (key, fault) in faults {
            log.problem(section.key_span(key), fault);
        }
        is_sound.then_some(Self { keys, waveform })
    }

    fn write(&self, out: &mut Writer) {
        self.keys.write(out);
        if let (Some(channel), Some(waveform)) =
            (channel_of(self.keys.kind, self.keys.drive), &self.waveform)
        {
            out.table(channel.name, |out| waveform::write(channel, waveform, out));
        }
    }
}

/// Components of an axis smaller than this part of the largest are round-off.
const AXIS_ROUND_OFF: f64 = 1e-6;

impl RigJoint {
    pub(super) fn name(&self) -> &str {
        &self.keys.name
    }

    /// Returns whether this translation along y presses the bodies together at any time.
    pub(super) fn presses(&self) -> bool {
        let upwards = match self.keys.moves {
            MovedBody::Counterface => self.keys.axis[1],
            MovedBody::Insert => -self.keys.axis[1],
        };
        let mut loads = self.waveform.iter().flat_map(Waveform::knots);
        loads.any(|knot| knot.value * upwards < 0.0)
    }

    /// Returns the unit of its waveform.
    pub fn unit(&self) -> &'static str {
        let channel = channel_of(self.keys.kind, self.keys.drive);
        let suffix = channel.map(|channel| format!("_{}", channel.unit.suffix()));
        suffix
            .and_then(|suffix| unit_of(&suffix))
            .unwrap_or_default()
    }

    pub(super) fn axis(&self) -> Axis {
        let direction = Vec3::from(self.keys.axis).normalize().into();
        match (self.keys.kind, self.keys.point_mm) {
            (JointKind::Translation, _) => Axis::Along(direction),
            (JointKind::Rotation, Some(_)) => Axis::About(direction),
            (JointKind::Rotation, None) => Axis::AboutCounterface(direction),
        }
    }

    /// Returns whether the joint moves as another, whatever drives both.
    pub(super) fn moves_as(&self, other: &Self) -> bool {
        let (own, others) = (&self.keys, &other.keys);
        own.kind == others.kind
            && own.axis == others.axis
            && own.moves == others.moves
            && own.point_mm == others.point_mm
            && own.point_from == others.point_from
            && own.settling == others.settling
            // The first activity sets the zero of all, whatever drives a joint in the others.
            && own.zeroed.is_none_or(|zeroed| zeroed == other.is_zeroed())
    }

    pub(super) fn is_zeroed(&self) -> bool {
        let is_free =
            self.keys.kind == JointKind::Translation && self.keys.drive == DriveWord::Loaded;
        self.keys.zeroed.unwrap_or(is_free)
    }

    /// Returns the spring of this joint, if it has one, in mm, rad, N and N mm.
    pub(super) fn spring(&self, index: JointIndex) -> Option<Spring> {
        let keys = &self.keys;
        let unit = keys.kind.file_unit_in_solver();
        let (given, free_play, rest) = match keys.kind {
            // N/mm as they are; N m/deg are 1000 N mm for each degree.
            JointKind::Translation => {
                (keys.spring_n_per_mm, keys.free_play_mm, keys.spring_rest_mm)
            }
            JointKind::Rotation => (
                keys.spring_nm_per_deg
                    .map(|both| both.map(|one| 1e3 * one / unit)),
                keys.free_play_deg,
                keys.spring_rest_deg,
            ),
        };
        given.map(|[positive_stiffness, negative_stiffness]| Spring {
            along: index,
            about: index,
            offset_mm: 0.0,
            positive_stiffness,
            negative_stiffness,
            free_play: free_play.unwrap_or(0.0) * unit,
            rest: rest.unwrap_or(0.0) * unit,
        })
    }

    /// Returns the drive in mm, rad, N or N mm, with its waveform times `scale`.
    pub(super) fn driven(&self, scale: f64) -> Drive {
        let keys = &self.keys;
        let channel = channel_of(keys.kind, keys.drive);
        let waveform = || {
            let factor = channel.map_or(1.0, Channel::factor) * scale;
            let given = self.waveform.clone();
            given.map_or(Waveform::constant(0.0), |waveform| waveform.scaled(factor))
        };
        match (keys.drive, keys.turns_per_cycle) {
            (DriveWord::Locked, _) => {
                let at = keys.locked_at_deg.or(keys.locked_at_mm).unwrap_or(0.0);
                Drive::Locked(at * keys.kind.file_unit_in_solver())
            }
            (DriveWord::Prescribed, Some(turns)) => {
                Drive::Prescribed(Waveform::turning(0.0, turns * std::f64::consts::TAU))
            }
            (DriveWord::Prescribed, None) => Drive::Prescribed(waveform()),
            (DriveWord::Loaded, _) if matches!(self.axis(), Axis::Along([0.0, _, 0.0])) => {
                Drive::Loaded(waveform::cut_off_at_zero(waveform()))
            }
            (DriveWord::Loaded, _) => Drive::Loaded(waveform()),
        }
    }

    /// Returns mass and damping in tonne and N s/mm, or moment of inertia and damping in tonne mm2 and N mm s/rad.
    pub(super) fn inertia_and_damping(&self) -> (f64, f64) {
        let keys = &self.keys;
        // Files state SI units; the library computes in t, mm and s, and 1 kg m2 is 1e3 t mm2.
        match keys.kind {
            JointKind::Rotation => (
                (keys.inertia_kg_m2).map_or(knee::MOMENT_OF_INERTIA_TONNE_MM2, |own| 1e3 * own),
                (keys.damping_nm_s_per_rad).map_or(knee::DAMPING_NMM_S_PER_RAD, |own| 1e3 * own),
            ),
            JointKind::Translation => (
                keys.inertia_kg.map_or(knee::MASS_TONNE, |mass| 1e-3 * mass),
                keys.damping_n_s_per_mm.unwrap_or(knee::DAMPING_N_S_PER_MM),
            ),
        }
    }

    /// Returns a point of its axis in the insert frame, for a bearing that is lowest at `low_point_mm`.
    pub(super) fn axis_point_mm(&self, low_point_mm: Vec3) -> Vec3 {
        let level_mm = match self.keys.point_from {
            None | Some(PointLevel::Origin) => 0.0,
            Some(PointLevel::LowestPoint) => low_point_mm.y,
        };
        let point_mm = self.keys.point_mm.unwrap_or_default();
        Vec3::from(point_mm) + Vec3::new(0.0, level_mm, 0.0)
    }

    /// Returns whether it has the name and the motion of `joint`, whatever drives it.
    pub(super) fn is_as(&self, joint: &JointDescription) -> bool {
        let keys = &self.keys;
        // Only loads make the zero of a joint matter: one that is locked or prescribed fits unless its key states otherwise.
        let is_zeroed = keys.zeroed.unwrap_or(keys.kind == JointKind::Translation);
        let own = (
            self.name(),
            self.axis(),
            keys.moves,
            keys.settling,
            is_zeroed,
        );
        own == (
            joint.name,
            joint.axis,
            joint.moves,
            joint.settling,
            joint.is_zeroed,
        )
    }

    pub(super) fn description(&self) -> JointDescription {
        let keys = &self.keys;
        let is_rotation = keys.kind == JointKind::Rotation;
        let leaked = |text: &str| -> &'static str { Box::leak(text.to_owned().into_boxed_str()) };
        let name = leaked(&keys.name);
        let given = |text: &Option<String>, default| text.as_deref().map_or(default, leaked);
        let (motion, load): (&Channel, &Channel) = match keys.kind {
            JointKind::Rotation => (&ROTATION, &TORQUE),
            JointKind::Translation => (&TRANSLATION, &FORCE),
        };
        let (inertia, damping) = self.inertia_and_damping();
        JointDescription {
            name,
            column: leaked(&format!(
                "{}_{}",
                keys.name.replace('-', "_"),
                keys.kind.unit()
            )),
            symbol: name,
            long_name: name,
            title: given(&keys.title, name),
            positive: given(&keys.positive, "along the axis"),
            decimals: if is_rotation { 2 } else { 3 },
            least_span: if is_rotation { 1.0 } else { 0.1 },
            axis: self.axis(),
            moves: keys.moves,
            settling: keys.settling,
            is_zeroed: self.is_zeroed(),
            inertia,
            damping,
            motion: Some(motion),
            load: Loading::By(load),
        }
    }
}
