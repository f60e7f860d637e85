//! Pressure law and friction.

use condyle::contact::PressureTable;

use crate::keyed::{Key, Log, Section, Settings, Variants, Writer, settings, variants, within};

settings! {
    /// Contact besides the pressure law.
    Friction {
        /// Coulomb coefficient of friction.
        friction: f64 = 0.07, in within(0.0, 2.0);
        /// Sliding speed at which friction is nearly full: smaller is truer and slower.
        slip_tolerance_mm_per_s: f64 = 0.3, in within(1e-6, 1000.0);
    }
}

variants! {
    /// Pressure against overclosure; the modulus comes from the material.
    PressureLawChoice by
    /// Form of pressure against overclosure.
    law = "linear" {
        /// p = K d / h.
        Linear = "linear",
        /// p = -K ln(1 - d / h).
        Logarithmic = "logarithmic",
        /// Points of pressure against overclosure.
        Tabulated(PressureTable) = "tabulated",
    }
}

/// Pressure law and friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Pressure against overclosure.
    pub law: PressureLawChoice,
    /// Friction.
    pub friction: Friction,
}

impl Contact {
    /// The key that chooses the law, and those that `[contact]` has whatever the law.
    pub(super) fn keys() -> Vec<Key> {
        [vec![PressureLawChoice::choices().by], Friction::keys()].concat()
    }

    pub(super) fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let law = PressureLawChoice::read(section, &Friction::keys(), log);
        let friction = Friction::read(section, log);
        Some(Self {
            law: law?,
            friction: friction?,
        })
    }

    pub(super) fn write(&self, out: &mut Writer) {
        self.law.write(out);
        self.friction.write(out);
    }
}
