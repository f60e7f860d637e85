//! A mechanism as one table: its joints, the regions of its surface, and what files tell of a cycle.

use super::{Channel, CycleRow, JointDescription, JointIndex};

/// A region of the articulating surface that loads are told apart by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Its name: `medial`.
    pub name: &'static str,
    /// What a picture calls it.
    pub label: &'static str,
    /// The column of its part of the axial force.
    pub column: &'static str,
    /// What a page calls that part.
    pub title: &'static str,
}

/// What a column of a cycle holds.
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

/// Six joints between insert and femur, as a description that everything else is looked up in.
///
/// The joints stand in the order of the chain: the first carries the insert itself, the last the femur. A
/// joint about an axis that is fixed in the insert frame stands before every joint that is zeroed where the
/// machine settles, so that the axis stays where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// The joints, from the insert to the femur.
    pub joints: [JointDescription; 6],
    /// The same in the order in which files list them.
    pub in_files: [JointIndex; 6],
    /// The waveforms that the joints take, in the order in which files list them.
    pub channels: &'static [&'static Channel],
    /// What the columns of a cycle are, in the order of files.
    pub columns: &'static [CycleQuantity],
    /// The regions of the surface, in the order of their numbers; at most
    /// [`MAX_REGIONS`](crate::contact::MAX_REGIONS).
    pub regions: &'static [Region],
}

impl Mechanism {
    /// The description of a joint.
    pub const fn joint(&self, index: JointIndex) -> &JointDescription {
        &self.joints[index.place()]
    }

    /// The joint called `name`, if there is one.
    pub fn named(&self, name: &str) -> Option<JointIndex> {
        let is_it = |&index: &JointIndex| self.joint(index).name == name;
        JointIndex::ALL.into_iter().find(is_it)
    }

    /// The waveform called `name`, if a joint takes one.
    pub fn channel(&self, name: &str) -> Option<&'static Channel> {
        let mut channels = self.channels.iter().copied();
        channels.find(|channel| channel.name == name)
    }

    /// The name of a column of a cycle, which ends in the unit.
    pub const fn column(&self, quantity: CycleQuantity) -> &'static str {
        match quantity {
            CycleQuantity::Position(index) => self.joint(index).column,
            CycleQuantity::AxialForce => "axial_force_n",
            CycleQuantity::ContactArea => "contact_area_mm2",
            CycleQuantity::PeakPressure => "peak_pressure_mpa",
            CycleQuantity::RegionForce(region) => self.regions[region].column,
        }
    }

    /// The names of all columns of a cycle, as many as there are.
    ///
    /// # Panics
    /// Where there are not `N`.
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

    /// The value of a quantity in a row, in the unit of its column.
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
}
