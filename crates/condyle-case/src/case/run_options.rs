//! Options of a run: cycles, updates of the worn shape, steps in time, accuracy, limits and additional output.

use condyle::machine::TimeSettings;

use crate::config::*;

settings! {
    /// The march over the life of the insert.
    March {
        /// Cycles of the whole test.
        cycles: u64 = 5_000_000, in within(1.0, 1e10);
        /// Schedule of the updates of the worn shape.
        [flat] update: Update;
    }

    /// Updates of the worn shape, evenly over the cycles.
    FixedUpdates {
        /// Updates of the worn shape, evenly over the cycles; if the insert creeps, the first comes after a tenth of such an interval.
        updates: u64 = 10, in within(1.0, 10_000.0);
    }

    /// Updates of the worn shape as a tolerance on depth requires them.
    AutoUpdates {
        /// Error of the maximum depth that one interval may add, as a fraction of the depth expected at the end. Later intervals remove most of it.
        depth_tolerance_fraction: f64 = 0.05, in within(1e-5, 0.5);
    }
}

variants! {
    /// Schedule of the updates of the worn shape.
    Update by
    /// Schedule of the updates of the worn shape: evenly over the cycles, or as a tolerance on depth requires.
    update = "fixed" {
        /// A given number, evenly over the cycles.
        Fixed(FixedUpdates) = "fixed",
        /// As few as a tolerance on the maximum depth allows.
        Auto(AutoUpdates) = "auto",
    }
}

choice! {
    /// Integration in time.
    IntegratorWord {
        /// Backward differences and Newton's method.
        Implicit = "implicit",
        /// Central differences, as a cross-check.
        Explicit = "explicit",
    }
}

settings! {
    /// Steps and tolerances in time.
    Time {
        /// Increments in a gait cycle.
        increments: u64 = TimeSettings::default().increments as u64, in within(20.0, 100_000.0);
        /// An implicit increment is halved until its estimated error is below this value, with rotations on a lever of 10 mm; 0 disables this.
        increment_error_mm: f64 = TimeSettings::default().increment_error_mm, in within(0.0, 10.0);
        /// Largest residual force of a converged increment.
        force_tolerance_n: f64 = TimeSettings::default().force_tolerance_n, in within(1e-9, 10.0);
        /// Largest number of cycles until the motion is periodic.
        most_cycles_to_repeat: u64 = TimeSettings::default().most_cycles_to_repeat as u64, in within(1.0, 1000.0);
        /// Largest difference of a translation between two cycles of a periodic motion.
        repeat_tolerance_mm: f64 = TimeSettings::default().repeat_tolerance_mm, in within(1e-9, 10.0);
        /// Largest difference of a rotation between two cycles of a periodic motion.
        repeat_tolerance_deg: f64 = TimeSettings::default().repeat_tolerance_rad.to_degrees(), in within(1e-9, 10.0);
        /// Integration of an increment: implicit in one step, or explicit in many short ones.
        integrator: IntegratorWord = IntegratorWord::Implicit;
        /// For the explicit integrator: inertia is added where a stable step would be shorter than this; 0 adds none.
        explicit_step_s: f64 = 0.0, in within(0.0, 1e-3);
    }
}

settings! {
    /// Estimates of the accuracy of a run.
    Accuracy {
        /// Estimate discretisation errors after the run.
        estimate: bool = true;
    }
}

settings! {
    /// Limits on the use of the computer.
    Limits {
        /// Memory that a run may use; a case that needs more is rejected before the start.
        memory_gb: f64 = Limits::DEFAULT_GB, in within(0.1, 10_000.0);
    }
}

impl Limits {
    /// Default of `memory_gb`.
    pub(super) const DEFAULT_GB: f64 = 2.0;

    /// Bytes that a run needs per node of an insert, without its contact: positions, histories, and the file while it is
    /// written.
    pub const BYTES_OF_INSERT_NODE: f64 = 800.0;

    /// Bytes of a node of the distance field of a femur in triangles, while that is made.
    pub const BYTES_OF_FIELD_NODE: f64 = 52.0;

    /// Returns the number of items of `bytes_each` bytes that fit into the memory.
    pub(super) fn most(&self, bytes_each: f64) -> usize {
        (self.memory_gb * 1e9 / bytes_each) as usize
    }
}

settings! {
    /// Additional output of a run.
    Output {
        /// Write the first and the last cycle for ParaView, increment by increment: the pressure on the insert, and the femur at its pose. About 100 kB per increment and body.
        cycle_frames: bool = false;
    }
}
