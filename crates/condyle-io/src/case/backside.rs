//! What holds the backside of a deformable insert on its tray.

use condyle::contact::Backside;

use crate::config::{settings, variants, within};

settings! {
    /// How a backside rests on its tray.
    RestingBackside {
        /// Coulomb coefficient of friction between backside and tray. Assumed: the default is no measured one.
        backside_friction: f64 = 0.2, in within(0.0, 1000.0);
        /// Spacing of the points at which the motion of the backside is told; between them it is interpolated.
        backside_spacing_mm: f64 = 5.0, in within(1.0, 50.0);
    }
}

variants! {
    /// What holds the backside of a deformable insert on its tray.
    BacksideChoice by
    /// What holds the backside of a deformable insert on its tray: a bond, or the tray alone, off which it lifts and along which it slips with friction; some ten times the time, and the implicit integrator alone.
    backside = "bonded" {
        /// It neither lifts nor slips.
        Bonded = "bonded",
        /// It presses and sticks or slips, or lifts.
        Resting(RestingBackside) = "resting",
    }
}

impl BacksideChoice {
    /// What it stands for.
    pub fn backside(&self) -> Backside {
        match self {
            Self::Bonded => Backside::Bonded,
            Self::Resting(resting) => Backside::Resting {
                friction: resting.backside_friction,
                spacing_mm: resting.backside_spacing_mm,
            },
        }
    }

    /// Whether it rests.
    pub(crate) fn is_resting(&self) -> bool {
        matches!(self, Self::Resting(_))
    }
}
