//! A mechanism as a table: its joints with the waveforms that can drive them, the regions of its surface, and the
//! columns of a cycle.

use serde::{Deserialize, Serialize};

use crate::contact::{ContactResult, MAX_REGIONS};

/// The kind of motion of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// It rotates: rad and N mm in the solver, degrees in files.
    Rotation,
    /// It translates: mm and N everywhere.
    Translation,
}

impl JointKind {
    /// Returns the unit of positions in files, which ends their names.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::Rotation => "deg",
            Self::Translation => "mm",
        }
    }

    /// Returns the unit of files in the solver's unit, rad or mm.
    pub const fn file_unit_in_solver(self) -> f64 {
        match self {
            Self::Rotation => 1f64.to_radians(),
            Self::Translation => 1.0,
        }
    }

    /// Converts a position of the solver, rad or mm, to the unit of files.
    pub const fn in_files(self, position: f64) -> f64 {
        match self {
            Self::Rotation => position.to_degrees(),
            Self::Translation => position,
        }
    }
}

/// The place of a joint in its chain.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct JointIndex(usize);

impl JointIndex {
    /// The six places, from the insert to the counterface.
    pub const ALL: [Self; 6] = [Self(0), Self(1), Self(2), Self(3), Self(4), Self(5)];

    /// Returns the place as a number, from 0 at the insert.
    pub const fn place(self) -> usize {
        self.0
    }

    /// Returns the value of this joint from one value per joint.
    pub const fn of(self, values: &[f64; 6]) -> f64 {
        values[self.0]
    }
}

/// The unit of a waveform's values in files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ChannelUnit {
    /// N.
    Newton,
    /// N m.
    NewtonMetre,
    /// mm.
    Millimetre,
    /// Degrees.
    Degree,
}

impl ChannelUnit {
    /// Returns the ending of names with this unit, such as the `n` of `knots_n`.
    pub const fn suffix(self) -> &'static str {
        match self {
            Self::Newton => "n",
            Self::NewtonMetre => "nm",
            Self::Millimetre => JointKind::Translation.unit(),
            Self::Degree => JointKind::Rotation.unit(),
        }
    }
}

/// A waveform that moves or loads a joint, as it stands in files.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Channel {
    /// Name in files, such as `ap_force`.
    pub name: &'static str,
    /// Description with the positive direction.
    pub about: &'static str,
    /// Unit of the values.
    pub unit: ChannelUnit,
    /// 1 if positive values act in the joint's positive direction, -1 otherwise.
    pub sign: f64,
    /// Smallest permitted value.
    pub least: f64,
    /// Largest permitted value.
    pub most: f64,
}

impl Channel {
    /// Returns the factor from a value in a file to the joint's load or motion: sign and unit.
    pub const fn factor(&self) -> f64 {
        let unit_in_solver = match self.unit {
            ChannelUnit::Newton => 1.0,
            ChannelUnit::NewtonMetre => 1e3,
            ChannelUnit::Millimetre => JointKind::Translation.file_unit_in_solver(),
            ChannelUnit::Degree => JointKind::Rotation.file_unit_in_solver(),
        };
        self.sign * unit_in_solver
    }
}

/// The line that a joint moves along or about, as a unit vector in the insert frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Axis {
    /// Along a direction.
    Along([f64; 3]),
    /// About a direction, through the point of the insert frame that the machine sets in
    /// [`Joint::axis_point_mm`](super::Joint).
    About([f64; 3]),
    /// About a direction, through the counterface's own axis point; the joints nearer to the insert carry it.
    AboutCounterface([f64; 3]),
}

/// The body that a joint moves. A joint of the insert moves the counterface the opposite way relative to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MovedBody {
    /// The insert.
    Insert,
    /// The counterface.
    Counterface,
}

/// The state of a joint while the machine settles under the load at the start of the cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Settling {
    /// Free and without load, whatever drives it in the cycle.
    Free,
    /// Held at zero.
    HeldAtZero,
    /// Driven as at the start of the cycle, by motion or load.
    Driven,
    /// Driven as at the start of the cycle, but free and without load if a load drives it.
    DrivenWithoutLoad,
}

/// The permission of a joint to be free under a load, and the waveform of that load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Loading {
    /// It cannot be free.
    None,
    /// It can be free, always without load.
    Free,
    /// It can be free under a waveform.
    By(&'static Channel),
}

/// A joint of a mechanism: its names, its axis, how it settles, and the waveforms that can drive it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointDescription {
    /// Name in files, such as `ap`.
    pub name: &'static str,
    /// Column in files of motions: the name and the unit.
    pub column: &'static str,
    /// Short name in messages.
    pub symbol: &'static str,
    /// Long name in messages, such as `AnteroPosterior`.
    pub long_name: &'static str,
    /// Heading on pages.
    pub title: &'static str,
    /// Positive direction in words.
    pub positive: &'static str,
    /// Decimals of its position in messages, in the unit of files.
    pub decimals: usize,
    /// Smallest range of a plotted curve, in the unit of files: smaller motions are not enlarged.
    pub least_span: f64,
    /// Axis of the motion.
    pub axis: Axis,
    /// Body that it moves, which fixes the sign.
    pub moves: MovedBody,
    /// State while the machine settles.
    pub settling: Settling,
    /// True if it reads zero where the machine has settled.
    pub is_zeroed: bool,
    /// Default mass in tonne, or moment of inertia in tonne mm2.
    pub inertia: f64,
    /// Default viscous damping, N s/mm or N mm s/rad.
    pub damping: f64,
    /// Waveform that can prescribe its motion.
    pub motion: Option<&'static Channel>,
    /// Waveform that can load it.
    pub load: Loading,
}

impl JointDescription {
    /// Returns the kind of motion, which follows from the axis.
    pub const fn kind(&self) -> JointKind {
        match self.axis {
            Axis::Along(_) => JointKind::Translation,
            Axis::About(_) | Axis::AboutCounterface(_) => JointKind::Rotation,
        }
    }

    /// Returns the waveform that can load it, if there is one.
    pub const fn load_channel(&self) -> Option<&'static Channel> {
        match self.load {
            Loading::By(channel) => Some(channel),
            Loading::None | Loading::Free => None,
        }
    }

    /// Returns whether it can be free.
    pub const fn can_be_free(&self) -> bool {
        !matches!(self.load, Loading::None)
    }

    /// Returns whether it stands at zero once the machine has settled.
    pub fn settles_at_zero(&self) -> bool {
        self.is_zeroed || self.settling == Settling::HeldAtZero
    }
}

/// A region of the articulating surface whose load is reported separately.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Name, such as `medial`.
    pub name: &'static str,
    /// Label in pictures.
    pub label: &'static str,
    /// Column of its part of the axial force.
    pub column: &'static str,
    /// Heading of that part on pages.
    pub title: &'static str,
}

/// The quantity in a column of a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CycleQuantity {
    /// Position of a joint, in the unit of files.
    Position(JointIndex),
    /// Load that presses the bodies together, N.
    AxialForce,
    /// Area in contact, mm2.
    ContactArea,
    /// Highest pressure anywhere, MPa.
    PeakPressure,
    /// Part of the axial force on a region, by the region's number, N.
    RegionForce(usize),
}

/// A joint of the body whose replacement a machine tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TestedJoint {
    /// Knee.
    #[default]
    Knee,
    /// A hip.
    Hip,
    /// An intervertebral disc.
    Disc,
    /// An ankle.
    Ankle,
    /// None: specimens of material, such as pins on a disc.
    Specimen,
}

impl TestedJoint {
    /// Every joint.
    pub const ALL: [Self; 5] = [
        Self::Knee,
        Self::Hip,
        Self::Disc,
        Self::Ankle,
        Self::Specimen,
    ];

    /// Returns the name, such as `hip`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Knee => "knee",
            Self::Hip => "hip",
            Self::Disc => "disc",
            Self::Ankle => "ankle",
            Self::Specimen => "specimen",
        }
    }

    /// Returns the names of the counterface and of the bearing, such as `head` and `cup`.
    pub const fn bodies(self) -> [&'static str; 2] {
        match self {
            Self::Knee => ["femur", "insert"],
            Self::Hip => ["head", "cup"],
            Self::Disc => ["ball", "socket"],
            Self::Ankle => ["talus", "insert"],
            Self::Specimen => ["counterface", "specimen"],
        }
    }
}

/// The description of six joints between insert and counterface, of the regions and of the columns of results.
///
/// The joints stand in the order of the chain: the first carries the insert itself, the last the counterface. A
/// joint about an axis that is fixed in the insert frame stands before every joint that is zeroed where the
/// machine settles, so that the axis stays where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// The joint of the body whose replacement it tests.
    pub tests: TestedJoint,
    /// The joints, from the insert to the counterface.
    pub joints: [JointDescription; 6],
    /// The joints in the order in which files list them.
    pub in_files: &'static [JointIndex],
    /// The waveforms that the joints take, in the order in which files list them.
    pub channels: &'static [&'static Channel],
    /// The columns of a cycle, in the order of files.
    pub columns: &'static [CycleQuantity],
    /// The regions of the surface, in the order of their numbers; at most
    /// [`MAX_REGIONS`](crate::contact::MAX_REGIONS).
    pub regions: &'static [Region],
}

impl Mechanism {
    /// Returns the description of a joint.
    pub const fn joint(&self, index: JointIndex) -> &JointDescription {
        &self.joints[index.place()]
    }

    /// Returns the joint called `name`, if there is one.
    pub fn named(&self, name: &str) -> Option<JointIndex> {
        let is_it = |&index: &JointIndex| self.joint(index).name == name;
        JointIndex::ALL.into_iter().find(is_it)
    }

    /// Returns the waveform called `name`, if a joint takes one.
    pub fn channel(&self, name: &str) -> Option<&'static Channel> {
        let mut channels = self.channels.iter().copied();
        channels.find(|channel| channel.name == name)
    }

    /// Returns the name of a column of a cycle, which ends in the unit.
    pub const fn column(&self, quantity: CycleQuantity) -> &'static str {
        match quantity {
            CycleQuantity::Position(index) => self.joint(index).column,
            CycleQuantity::AxialForce => "axial_force_n",
            CycleQuantity::ContactArea => "contact_area_mm2",
            CycleQuantity::PeakPressure => "peak_pressure_mpa",
            CycleQuantity::RegionForce(region) => self.regions[region].column,
        }
    }

    /// Returns the names of all columns of a cycle.
    ///
    /// # Panics
    /// If the number of columns is not `N`.
    pub const fn column_names<const N: usize>(&self) -> [&'static str; N] {
        assert!(self.columns.len() == N, "as many names as columns");
        let mut names = [""; N];
        let mut i = 0;
        while i < N {
            names[i] = self.column(self.columns[i]);
            i += 1;
        }
        names
    }

    /// Returns the value of a quantity in a row, in the unit of its column.
    pub fn value(&self, quantity: CycleQuantity, row: &CycleRow) -> f64 {
        match quantity {
            CycleQuantity::Position(index) => {
                let kind = self.joint(index).kind();
                kind.in_files(index.of(&row.positions))
            }
            CycleQuantity::AxialForce => row.axial_force_n,
            CycleQuantity::ContactArea => row.contact_area_mm2,
            CycleQuantity::PeakPressure => row.peak_pressure_mpa,
            CycleQuantity::RegionForce(region) => row.region_force_n[region],
        }
    }

    /// Formats positions, mm and rad, in the unit of files: translations first.
    pub fn readings(&self, positions: &[f64; 6]) -> String {
        let mut joints = self.in_files.to_vec();
        joints.sort_by_key(|&index| self.joint(index).kind() == JointKind::Rotation);
        let reading = |index: JointIndex| {
            let joint = self.joint(index);
            let (kind, decimals) = (joint.kind(), joint.decimals);
            let value = kind.in_files(index.of(positions));
            format!("{} {value:.decimals$} {}", joint.symbol, kind.unit())
        };
        joints
            .into_iter()
            .map(reading)
            .collect::<Vec<_>>()
            .join(", ")
    }
}

/// The machine at the end of an increment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CycleRow {
    /// Place in the cycle, %.
    pub percent: f64,
    /// Positions, mm or rad, in the order of the chain.
    pub positions: [f64; 6],
    /// Load pressing the bodies together along y, as the contact carries it, N.
    pub axial_force_n: f64,
    /// Area in contact, mm2.
    pub contact_area_mm2: f64,
    /// Highest pressure anywhere, at a node or between nodes, MPa.
    pub peak_pressure_mpa: f64,
    /// Part of the axial force on every region of the surface, N, in the order of the mechanism's regions.
    pub region_force_n: [f64; MAX_REGIONS],
}

impl CycleRow {
    /// Creates the row at `percent` of the cycle with the joints at `positions`.
    pub(super) fn new(percent: f64, positions: [f64; 6], contact: &ContactResult) -> Self {
        let (mut region_force_n, mut contact_area_mm2) = ([0.0; MAX_REGIONS], 0.0);
        for node in &contact.touched {
            // The insert is pressed down along y.
            region_force_n[usize::from(node.region)] -= node.force_n.y;
            contact_area_mm2 += node.covered_mm2;
        }
        Self {
            percent,
            positions,
            axial_force_n: region_force_n.iter().sum(),
            contact_area_mm2,
            peak_pressure_mpa: contact.peak_pressure_mpa,
            region_force_n,
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::machine::knee::KNEE;

    #[test]
    fn readings_of_a_knee_list_translations_then_rotations() {
        let positions = [0.1, -0.2, 1.0, -2.5, 0.25, 1.0];
        assert_eq!(
            KNEE.readings(&positions),
            "AP -2.500 mm, ML 1.000 mm, IS 0.250 mm, IE -11.459 deg, VV 5.730 deg, flexion 57.30 deg"
        );
    }
}
