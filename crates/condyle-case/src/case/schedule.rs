//! Cycles of the test, updates of the worn shape, and steps in time.

use condyle::machine::{Integration, TimeSettings};

use super::table::{Context, Table, WearLaws, WriteWaveform, plain_tables};
use crate::config::{
    Key, Log, Page, Section, Settings, TableSchema, Variants, Writer, choice, settings, variants,
    within,
};

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

choice! {
    /// How time is integrated.
    IntegratorWord {
        /// Backward differences and Newton's method.
        Implicit = "implicit",
        /// Central differences, as a cross-check.
        Explicit = "explicit",
    }
}

impl IntegratorWord {
    /// The word for a way to step through an increment.
    fn of(integration: Integration) -> Self {
        match integration {
            Integration::Implicit => Self::Implicit,
            Integration::Explicit { .. } => Self::Explicit,
        }
    }
}

settings! {
    /// Steps and tolerances in time.
    Time {
        /// Increments in a gait cycle.
        increments: u64 = TimeSettings::default().increments as u64, in within(20.0, 100_000.0);
        /// An implicit increment is halved until its own error is estimated below this; rotations on a lever of 10 mm. 0 never halves for that.
        increment_error_mm: f64 = TimeSettings::default().increment_error_mm, in within(0.0, 10.0);
        /// Largest residual force of a converged increment.
        force_tolerance_n: f64 = TimeSettings::default().force_tolerance_n, in within(1e-9, 10.0);
        /// Cycles to run at most until one repeats the one before.
        most_cycles_to_repeat: u64 = TimeSettings::default().most_cycles_to_repeat as u64, in within(1.0, 1000.0);
        /// Largest difference of a translation between two cycles that repeat.
        repeat_tolerance_mm: f64 = TimeSettings::default().repeat_tolerance_mm, in within(1e-9, 10.0);
        /// Largest difference of a rotation between two cycles that repeat.
        repeat_tolerance_deg: f64 = TimeSettings::default().repeat_tolerance_rad.to_degrees(), in within(1e-9, 10.0);
        /// How an increment is stepped through: implicit in one step, or explicit in many short ones.
        integrator: IntegratorWord = IntegratorWord::of(TimeSettings::default().integration);
        /// Explicit: inertia is added wherever a stable step would be shorter than this; 0 adds none.
        explicit_step_s: f64 = 0.0, in within(0.0, 1e-3);
    }
}

impl Table for March {
    const NAME: &'static str = "march";

    fn read_in(root: &Section<'_>, _: &Context, log: &mut Log<'_>) -> Option<Self> {
        Self::read(&root.table(Self::NAME, log), log)
    }

    fn write_in(&self, _: WriteWaveform, out: &mut Writer) {
        out.table(Self::NAME);
        self.write(out);
    }

    fn add_to_schema(case: TableSchema, _: WearLaws) -> TableSchema {
        let table = TableSchema::new("The march over the life of the insert.")
            .with_keys(&Self::keys())
            .with_choices(&Update::choices());
        case.with_table(Self::NAME, table)
    }

    fn add_to_page(page: &mut Page, _: WearLaws) {
        page.chosen("`[march]`", &Self::keys(), &Update::choices());
    }
}

plain_tables! {
    Time = "time", "Steps and tolerances in time.";
}
