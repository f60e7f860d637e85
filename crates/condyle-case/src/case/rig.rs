//! A machine as a file: joints in order, axes, drives, waveforms and springs; condyle's own machines are such files too.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, LazyLock, Mutex, PoisonError};

use condyle::Vec3;
use condyle::machine::{
    Axis, CycleQuantity, JointDescription, JointIndex, JointKind, Machine, Mechanism, Settling,
    TestedJoint, knee,
};
#[cfg(feature = "file-system")]
use condyle_mesh::files::Disk;
use condyle_mesh::files::{Files, MemoryFiles};
use miette::NamedSource;

use super::drive::DriveWord;
use super::frame::Side;
use super::ligament::Ligament;
use super::rig_joint::{RigJoint, RigJointKeys};
use super::rig_spring::OffsetSpring;
use crate::config::*;

words! {
    TestedJoint {
        Knee = "knee",
        Hip = "hip",
        Disc = "disc",
        Ankle = "ankle",
        Specimen = "specimen",
    }
}

settings! {
    /// The keys of a machine file besides its joints.
    RigKeys {
        /// The joint of the body whose replacement the machine tests: knee, hip, disc, ankle, or specimen for pins and plates.
        tests: TestedJoint;
        /// Cycles a second.
        frequency_hz: f64 = 1.0, in within(0.001, 100.0);
        /// Factor on every load and torque, 1 if not given. Those of a machine file, of the case and of an activity are multiplied.
        load_scale: f64 = 1.0, in within(0.01, 100.0);
        /// Factor on every motion along a waveform, 1 if not given. Those of a machine file, of the case and of an activity are multiplied.
        motion_scale: f64 = 1.0, in within(0.0, 100.0);
        /// Names of all joints from the bearing to the counterface; that of the file if not given.
        order: Option<Names> = None;
    }
}

impl RigKeys {
    /// Returns the factor on the waveform of a joint.
    pub fn scale_of(&self, joint: &RigJoint) -> f64 {
        match joint.keys.drive {
            DriveWord::Loaded => self.load_scale,
            DriveWord::Prescribed => self.motion_scale,
            DriveWord::Locked => 1.0,
        }
    }
}

settings! {
    /// A machine from a file.
    Rig {
        /// Its keys besides those of the joints.
        [flat] keys: RigKeys;
        /// A joint of a machine, from the bearing to the counterface.
        [table] joints: Vec<RigJoint>;
        /// A spring along a translation of a machine, beside the axis of a rotation.
        [table "offset_springs"] springs: Vec<OffsetSpring>;
        /// A ligament between the bodies, on any machine.
        [table] ligaments: Vec<Ligament>;
    }
}

/// Puts every one of `changes` in place of that of the same name in `all`, or after them.
fn replace_by_name<T>(all: &mut Vec<T>, changes: Vec<T>, name: impl Fn(&T) -> &str) {
    for change in changes {
        match all.iter_mut().find(|known| name(known) == name(&change)) {
            Some(known) => *known = change,
            None => all.push(change),
        }
    }
}

/// Reports the keys of a machine by joints that `section` of a knee simulator has, except those in `own`.
pub(super) fn report_keys_of_rig(own: &[&str], section: &Section<'_>, log: &mut Log<'_>) {
    let items = Rig::items();
    let others = items
        .iter()
        .filter_map(Item::name)
        .filter(|key| !own.contains(key));
    section.report_idle(others, "a machine by joints, such as that of a hip", log);
}

impl Rig {
    /// Reads a machine file on the disk; paths in it are relative to its folder.
    ///
    /// # Errors
    /// Every problem of the file.
    #[cfg(feature = "file-system")]
    pub fn from_file(path: &Path) -> Result<Self, Problems> {
        let files: Arc<dyn Files> = Arc::new(Disk);
        let source = read_source(files.as_ref(), path).map_err(Problems::unreadable)?;
        read_document(&source, Base::of(&files, path), |root, log| {
            check(root, &Self::items(), log);
            Self::read(root, log)?.ordered(root, log)
        })
    }

    /// Returns the machine of the `[machine]` table of a case if it is one by joints: that of its file or of `preset` with the
    /// changes of the table, or that of the table; the outer `None` if it has problems.
    pub(super) fn read_from(
        section: &Section<'_>,
        preset: Option<Self>,
        file: Option<&DataFile>,
        log: &mut Log<'_>,
    ) -> Option<Option<Self>> {
        let base = match (file, preset) {
            (Some(file), _) => Self::in_file(file, section, log)?,
            (None, Some(preset)) => preset,
            (None, None) if section.value("joints").is_some() => {
                return Self::read(section, log)?.ordered(section, log).map(Some);
            }
            (None, None) => return Some(None),
        };
        base.changed_by(section, log).map(Some)
    }

    /// Returns the machine of a shipped file, called `name` in messages.
    pub(super) fn shipped(name: &str, text: &str) -> Self {
        let files: Arc<dyn Files> = Arc::new(MemoryFiles::default());
        let source = Arc::new(NamedSource::new(name, text.to_owned()));
        let base = Base::of(&files, Path::new(""));
        match Self::of_text(&source, base) {
            Ok(machine) => machine,
            Err(problems) => unreachable!("shipped machines are read by a test: {problems}"),
        }
    }

    /// Returns the machine of the file that the key `file` of `section` names.
    pub(super) fn in_file(
        file: &DataFile,
        section: &Section<'_>,
        log: &mut Log<'_>,
    ) -> Option<Self> {
        let source = file.source(section, "file", log)?;
        let read = Self::of_text(&source, Base::of(file.shared_files(), file.path()));
        let read = read.map_err(|problems| log.extend(problems)).ok();
        read.map(Self::with_scaled_waveforms)
    }

    /// Returns the machine with its factors in its waveforms, so that those of the case multiply them, and act once on every activity.
    fn with_scaled_waveforms(mut self) -> Self {
        for joint in &mut self.joints {
            let scale = self.keys.scale_of(joint);
            joint.waveform = joint.waveform.take().map(|waveform| waveform.scaled(scale));
        }
        (self.keys.load_scale, self.keys.motion_scale) = (1.0, 1.0);
        self
    }

    /// Returns the machine with the keys of `section`, and with its joints and ligaments in place of those of the same name.
    pub(super) fn changed_by(mut self, section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        for joint in RigJoint::read_list(section, "joints", log)? {
            let name = &joint.keys.name;
            let mut joints = self.joints.iter_mut();
            let Some(known) = joints.find(|known| known.keys.name == *name) else {
                let names: Vec<&str> = self.names().collect();
                let message = format!("the machine has no joint \"{name}\" to replace");
                let advice = format!("its joints are {}", names.join(", "));
                return log.reject(section.key_span("joints"), Fault::new(message, advice));
            };
            *known = joint;
        }
        let springs = OffsetSpring::read_list(section, "offset_springs", log)?;
        replace_by_name(&mut self.springs, springs, |spring| &spring.name);
        let ligaments = Ligament::read_list(section, "ligaments", log)?;
        replace_by_name(&mut self.ligaments, ligaments, |ligament| &ligament.name);
        let keys = &mut self.keys;
        for key in RigKeys::keys() {
            let number = match key.name {
                "tests" => {
                    keys.tests = section.setting(&key, Some(keys.tests), log)?;
                    continue;
                }
                "order" => {
                    keys.order = section.setting(&key, Some(keys.order.take()), log)?;
                    continue;
                }
                "frequency_hz" => &mut keys.frequency_hz,
                "load_scale" => &mut keys.load_scale,
                _ => &mut keys.motion_scale,
            };
            *number = section.setting(&key, Some(*number), log)?;
        }
        self.ordered(section, log)
    }

    /// Returns true if a joint moves along a waveform, which `motion_scale` multiplies; a joint that turns on and on does not.
    pub(super) fn has_motion_curve(&self) -> bool {
        let mut joints = self.joints.iter();
        joints.any(|joint| joint.keys.drive == DriveWord::Prescribed && joint.waveform.is_some())
    }

    fn names(&self) -> impl Iterator<Item = &str> {
        self.joints.iter().map(RigJoint::name)
    }

    fn of_text(source: &Source, base: Base<'_>) -> Result<Self, Problems> {
        read_document(source, base, |root, log| {
            check(root, &Self::items(), log);
            Self::read(root, log)
        })
    }

    /// Returns the machine with its joints in the order of `order`, after checking that they form a chain that presses.
    fn ordered(mut self, section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let mut fault = |key: &str, message: String, advice: &str| {
            log.reject(section.key_span(key), Fault::new(message, advice))
        };
        let names: Vec<&str> = self.names().collect();
        if let Some(Names(order)) = &self.keys.order {
            let (mut wanted, mut present) = (order.clone(), names.clone());
            wanted.sort();
            present.sort_unstable();
            if wanted != present {
                let message = format!("`order` must name every joint once: {}", names.join(", "));
                return fault("order", message, "");
            }
            let place = |joint: &RigJoint| order.iter().position(|name| *name == joint.keys.name);
            self.joints.sort_by_key(place);
        }
        let mut has_zeroed = false;
        for joint in &self.joints {
            if has_zeroed && joint.keys.point_mm.is_some() {
                let message = format!(
                    "the `point_mm` of \"{}\" assumes that the joints before it are at zero, but one of them reads zero only where the machine settles",
                    joint.keys.name
                );
                return fault(
                    "joints",
                    message,
                    "move it nearer to the bearing, before the loaded translations",
                );
            }
            has_zeroed |= joint.is_zeroed();
        }
        if let Some((message, advice)) = self.press_fault() {
            return fault("joints", message, advice);
        }
        let mut springs = self.springs.iter().map(|spring| spring.build(&self.joints));
        if let Some(unattached) = springs.find_map(Result::err) {
            return log.reject(section.key_span("offset_springs"), unattached);
        }
        if let Some((one, other)) = self.same_freedom() {
            let message =
                format!("the loaded joints \"{one}\" and \"{other}\" move along the same line");
            return fault(
                "joints",
                message,
                "lock one of them: their balance is not determined",
            );
        }
        Some(self)
    }

    /// Returns the fault, with advice, of a machine without one joint that presses the bodies together.
    fn press_fault(&self) -> Option<(String, &'static str)> {
        let can_press = |joint: &&RigJoint| {
            let along_y = joint.keys.axis[0] == 0.0 && joint.keys.axis[2] == 0.0;
            joint.keys.kind == JointKind::Translation
                && joint.keys.drive == DriveWord::Loaded
                && along_y
                && joint.waveform.is_some()
        };
        let mut pressing = self.joints.iter().filter(can_press);
        let (Some(press), None) = (pressing.next(), pressing.next()) else {
            let message = "the machine needs one joint that presses the bodies together: a loaded translation along y with \
                           [joints.load]";
            return Some((message.to_owned(), ""));
        };
        let advice = "change the sign of its axis or of its load: the counterface is pressed along [0, -1, 0], the bearing along \
                      [0, 1, 0]";
        (!press.presses()).then(|| {
            let message = format!(
                "the load of \"{}\" never presses the bodies together",
                press.name()
            );
            (message, advice)
        })
    }

    /// Returns two loaded joints of a kind whose axes are parallel; of rotations, only those through the same point.
    fn same_freedom(&self) -> Option<(&str, &str)> {
        /// Sine of the angle below which two axes count as parallel.
        const PARALLEL: f64 = 1e-6;
        let loaded = |joint: &&RigJoint| joint.keys.drive == DriveWord::Loaded;
        let loaded: Vec<&RigJoint> = self.joints.iter().filter(loaded).collect();
        let pairs = loaded.iter().enumerate();
        let mut pairs =
            pairs.flat_map(|(n, one)| loaded[..n].iter().map(move |other| (other, one)));
        let found = pairs.find(|(one, other)| {
            let [a, b] = [one, other].map(|joint| Vec3::from(joint.keys.axis).normalize());
            let is_alike =
                one.keys.kind == other.keys.kind && one.keys.point_mm == other.keys.point_mm;
            is_alike && a.cross(&b).norm() < PARALLEL
        });
        found.map(|(one, other)| (one.name(), other.name()))
    }

    /// Returns the first difference of the motions that this machine and another permit, or of the names of their ligaments,
    /// which are those of one joint; none if activities of one test may run on both.
    pub(super) fn difference_from(&self, other: &Self) -> Option<String> {
        if self.keys.tests != other.keys.tests {
            return Some("it tests another joint of the body".to_owned());
        }
        if self.joints.len() != other.joints.len() {
            let (own, others) = (self.joints.len(), other.joints.len());
            return Some(format!("it has {own} joints in place of {others}"));
        }
        let [own, others] = [self, other].map(|rig| {
            let mut names: Vec<&str> = rig.ligaments.iter().map(|one| one.name.as_str()).collect();
            names.sort_unstable();
            names.join(", ")
        });
        if own != others {
            return Some(format!("its ligaments are ({own}) in place of ({others})"));
        }
        let pairs = self.joints.iter().zip(&other.joints);
        let mut differ = pairs.filter_map(|(joint, other)| {
            let (name, other_name) = (joint.name(), other.name());
            if name != other_name {
                return Some(format!(
                    "it has the joint \"{name}\" in place of \"{other_name}\""
                ));
            }
            let message = || format!("the joint \"{name}\" has another axis, body or zero");
            (!joint.moves_as(other)).then(message)
        });
        differ.next()
    }

    /// Returns the machine in mm, N, s and rad around a bearing that is lowest at `low_point_mm`; ligaments are of a joint of
    /// `side`.
    pub(super) fn build(&self, low_point_mm: Vec3, side: Side) -> Machine {
        let mut machine = Machine::new(self.mechanism());
        let ligaments = self.ligaments.iter();
        machine.ligaments = ligaments.map(|ligament| ligament.build(side)).collect();
        let springs = self.springs.iter().map(|spring| spring.build(&self.joints));
        machine.springs = springs.filter_map(Result::ok).collect();
        for (joint, index) in self.joints.iter().zip(JointIndex::ALL) {
            machine.springs.extend(joint.spring(index));
            let built = machine.joint_mut(index);
            built.drive = joint.driven(self.keys.scale_of(joint));
            (built.inertia, built.damping) = joint.inertia_and_damping();
            built.axis_point_mm = joint.axis_point_mm(low_point_mm);
        }
        machine.frequency_hz = self.keys.frequency_hz;
        machine
    }

    /// Returns whether its joints move as those of the knee simulator: its runs then have the results of knees.
    pub fn is_knee_simulator(&self) -> bool {
        let mut pairs = self.joints.iter().zip(&knee::KNEE.joints);
        self.keys.tests == TestedJoint::Knee
            && self.joints.len() == knee::KNEE.joints.len()
            && pairs.all(|(own, of_knee)| own.is_as(of_knee))
    }

    /// Returns the description of the joints, which lives as long as the process: equal machines share one.
    fn mechanism(&self) -> &'static Mechanism {
        if self.is_knee_simulator() {
            return &knee::KNEE;
        }
        static KNOWN: LazyLock<Mutex<BTreeMap<String, &'static Mechanism>>> =
            LazyLock::new(Mutex::default);
        let joints: Vec<&RigJointKeys> = self.joints.iter().map(|joint| &joint.keys).collect();
        let key = format!("{:?} {joints:?}", self.keys.tests);
        // A panic elsewhere leaves the map whole.
        let mut known = KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        known
            .entry(key)
            .or_insert_with(|| Box::leak(Box::new(self.described())))
    }

    fn described(&self) -> Mechanism {
        let count = self.joints.len();
        let fixed = JointDescription {
            name: "",
            column: "",
            axis: Axis::Along([1.0, 0.0, 0.0]),
            settling: Settling::HeldAtZero,
            is_zeroed: false,
            ..knee::KNEE.joints[0]
        };
        let in_files: &[JointIndex] = &JointIndex::ALL[..count];
        let positions = in_files.iter().map(|&index| CycleQuantity::Position(index));
        let contact = [
            CycleQuantity::AxialForce,
            CycleQuantity::ContactArea,
            CycleQuantity::PeakPressure,
        ];
        let regions = match self.keys.tests {
            TestedJoint::Knee => knee::KNEE.regions,
            _ => &[],
        };
        let forces = (0..regions.len()).map(CycleQuantity::RegionForce);
        let columns: Vec<CycleQuantity> = positions.chain(contact).chain(forces).collect();
        Mechanism {
            tests: self.keys.tests,
            joints: std::array::from_fn(|j| {
                self.joints.get(j).map_or(fixed, RigJoint::description)
            }),
            in_files,
            channels: &[],
            columns: columns.leak(),
            regions,
        }
    }

    /// Returns the entries that a table may have besides `items`: none is required, and those of the same name count once.
    pub(super) fn items_beside(items: &[Item]) -> Vec<Item> {
        let known: Vec<&str> = items.iter().filter_map(Item::name).collect();
        let own = Self::items().into_iter();
        let other = own.filter(|item| !item.name().is_some_and(|name| known.contains(&name)));
        other.map(Item::optional).collect()
    }
}
