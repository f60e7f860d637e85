//! How the joints move at an instant.

use serde::{Deserialize, Serialize};

/// Positions, rates and accelerations of the six joints, mm and rad and s, in the order of the chain.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Kinematics {
    /// Positions, mm or rad.
    pub positions: [f64; 6],
    /// Rates, mm/s or rad/s.
    pub rates: [f64; 6],
    /// Accelerations, mm/s2 or rad/s2.
    pub accelerations: [f64; 6],
}

impl Kinematics {
    /// Joints that stand still.
    pub fn at_rest(positions: [f64; 6]) -> Self {
        Self {
            positions,
            rates: [0.0; 6],
            accelerations: [0.0; 6],
        }
    }
}
