//! A mechanism as a table: its joints, the regions of its surface, and the columns of a cycle.

use serde::{Deserialize, Serialize};

use super::{Channel, JointDescription, JointIndex, JointKind};
use crate::contact::{ContactResult, MAX_REGIONS};

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

/// The description of six joints between insert and femur, of the regions and of the columns of results.
///
/// The joints stand in the order of the chain: the first carries the insert itself, the last the femur. A
/// joint about an axis that is fixed in the insert frame stands before every joint that is zeroed where the
/// machine settles, so that the axis stays where it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Mechanism {
    /// The joints, from the insert to the femur.
    pub joints: [JointDescription; 6],
    /// The joints in the order in which files list them.
    pub in_files: [JointIndex; 6],
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
        let mut joints: Vec<_> = self.in_files.to_vec();
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
