//! The march over the life of the insert.

use crate::config::{Key, Log, Section, Settings, Variants, Writer, settings, variants, within};

settings! {
    /// The whole test.
    WholeTest {
        /// Gait cycles in all.
        cycles: u64 = 5_000_000, in within(1.0, 1e10);
    }

    /// Updates of the worn shape, evenly over the cycles.
    FixedUpdates {
        /// How often the worn shape is brought up to date, evenly over the cycles; where the insert creeps, first after a tenth of such an interval.
        updates: u64 = 10, in within(1.0, 10_000.0);
    }

    /// Updates of the worn shape as the depth asks for them.
    AutoUpdates {
        /// Error of the maximum depth that one interval may make, as a fraction of the depth expected at the end; it mostly wears away in those that follow.
        depth_tolerance_fraction: f64 = 0.05, in within(1e-5, 0.5);
    }
}

variants! {
    /// When the worn shape is brought up to date.
    Update by
    /// How often the worn shape is brought up to date: evenly, or as a tolerance on depth asks for.
    update = "fixed" {
        /// So many times, evenly over the cycles.
        Fixed(FixedUpdates) = "fixed",
        /// As seldom as a tolerance on the maximum depth allows.
        Auto(AutoUpdates) = "auto",
    }
}

/// The march over the life of the insert.
#[derive(Clone, Debug, PartialEq)]
pub struct March {
    /// Gait cycles in all.
    pub cycles: u64,
    /// When the worn shape is brought up to date.
    pub update: Update,
}

impl March {
    /// The keys that `[march]` has whatever the update, and the one that chooses it.
    pub(super) fn keys() -> Vec<Key> {
        [WholeTest::keys(), vec![Update::choices().by]].concat()
    }

    pub(super) fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let update = Update::read(section, &WholeTest::keys(), log);
        let test = WholeTest::read(section, log);
        Some(Self {
            cycles: test?.cycles,
            update: update?,
        })
    }

    pub(super) fn write(&self, out: &mut Writer) {
        let cycles = self.cycles;
        WholeTest { cycles }.write(out);
        self.update.write(out);
    }
}
