//! A mechanism as a table: its joints, the regions of its surface, and the columns of a cycle.

use std::fmt;

use serde::{Deserialize, Serialize};

use super::{Channel, JointDescription, JointIndex, JointKind};
use crate::contact::{ContactResult, MAX_REGIONS};

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
    /// The row at `percent` of the cycle, where the joints are at `positions` and the contact has landed.
    pub(super) fn new(percent: f64, positions: [f64; 6], landing: &ContactResult) -> Self {
        let (mut region_force_n, mut contact_area_mm2) = ([0.0; MAX_REGIONS], 0.0);
        for node in &landing.touched {
            region_force_n[usize::from(node.region)] -= node.force_n.y;
            contact_area_mm2 += node.covered_mm2;
        }
        Self {
            percent,
            positions,
            axial_force_n: region_force_n.iter().sum(),
            contact_area_mm2,
            peak_pressure_mpa: landing.peak_pressure_mpa,
            region_force_n,
        }
    }
}

/// Positions of all joints, in the unit of files: translations first.
#[derive(Clone, Debug, PartialEq)]
pub struct Readings {
    values: Vec<(JointDescription, f64)>,
}

impl Readings {
    /// The positions (mm and rad, in the order of the chain) of a mechanism's joints.
    pub fn new(mechanism: &Mechanism, positions: &[f64; 6]) -> Self {
        let in_files = mechanism.in_files.iter();
        let mut values: Vec<_> = in_files
            .map(|&index| (*mechanism.joint(index), index.of(positions)))
            .collect();
        values.sort_by_key(|(joint, _)| joint.kind() == JointKind::Rotation);
        Self { values }
    }
}

impl fmt::Display for Readings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, (joint, position)) in self.values.iter().enumerate() {
            let between = if i == 0 { "" } else { ", " };
            let (symbol, decimals, kind) = (joint.symbol, joint.decimals, joint.kind());
            let value = kind.in_files(*position);
            write!(f, "{between}{symbol} {value:.decimals$} {}", kind.unit())?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::knee::KNEE;

    #[test]
    fn readings_of_a_knee_tell_shifts_then_turns() {
        let positions = [0.1, -0.2, 1.0, -2.5, 0.25, 1.0];
        assert_eq!(
            Readings::new(&KNEE, &positions).to_string(),
            "AP -2.500 mm, ML 1.000 mm, IS 0.250 mm, IE -11.459 deg, VV 5.730 deg, flexion 57.30 deg"
        );
    }
}
