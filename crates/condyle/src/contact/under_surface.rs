//! What is below the surface of an insert that is a solid: stress, and what has yielded.

use serde::{Deserialize, Serialize};

/// Plastic strain that accumulates at a place in a cycle below which the place counts as shaken down: the flow of an
/// increment is found to some 3e-6.
const SHAKEN_DOWN: f64 = 1e-5;

/// What is below the surface of an insert that is a solid.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct UnderSurface {
    /// Of every element its equivalent stress of von Mises, the mean of the stress over the element, MPa.
    pub von_mises_mpa: Vec<f64>,
    /// Of every element the largest shear stress of the same mean, MPa.
    pub max_shear_mpa: Vec<f64>,
    /// What has yielded, if the insert does.
    pub plastic: Option<PlasticUnderSurface>,
    /// What the backside did in the last cycles, if it rests on its tray.
    pub backside: Option<BacksideAtRest>,
}

/// What a backside that rests on its tray did at most in the last cycle of any activity.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct BacksideAtRest {
    /// Farthest that a place of it lifts off the tray, mm.
    pub lift_mm: f64,
    /// Largest part of it that lifts at once.
    pub lifted_part: f64,
    /// Longest way that a place of it slips along the tray while it presses, there and back, mm.
    pub slip_mm: f64,
    /// Largest force along the tray that the lock carries, N.
    pub lock_force_n: f64,
    /// Largest moment about the vertical axis that the lock carries, N mm.
    pub lock_moment_nmm: f64,
}

/// What of an insert has yielded.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PlasticUnderSurface {
    /// Of every node of the surface how far it has given way for good along the inward normal, mm.
    pub permanent_set_mm: Vec<f64>,
    /// Of every element the largest accumulated plastic strain at its Gauss points.
    pub plastic_strain: Vec<f64>,
    /// What every element does in a cycle that repeats itself.
    pub regime: Vec<Regime>,
}

/// What a place of an insert does in a cycle that repeats itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Regime {
    /// It has never yielded.
    #[default]
    Elastic,
    /// It has, and does so no more.
    ShakenDown,
    /// It yields in every cycle: its strain grows, or goes to and fro.
    Ratcheting,
}

impl Regime {
    /// That of a place that has yielded, by what accumulates in a cycle.
    pub fn of_flow(plastic_strain: f64) -> Self {
        if plastic_strain > SHAKEN_DOWN {
            Self::Ratcheting
        } else {
            Self::ShakenDown
        }
    }

    /// The number of it in files: 0 elastic, 1 shaken down, 2 ratcheting.
    pub fn number(self) -> u8 {
        self as u8
    }
}
