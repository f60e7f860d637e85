//! Where joints stand, as a message tells it.

use std::fmt;

use super::{JointDescription, JointKind, Mechanism};

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
