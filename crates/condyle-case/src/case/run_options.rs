//! Options of a run: accuracy, limits of the computer, additional output.

use crate::config::{settings, within};

settings! {
    /// Estimates of the accuracy of a run.
    Accuracy {
        /// Estimate discretisation errors after the run, by solving the unworn cycle more coarsely.
        estimate: bool = true;
    }
}

settings! {
    /// Limits on the use of the computer.
    Limits {
        /// Memory that a run may use; a case that needs more is refused before it begins.
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
    pub const BYTES_OF_FIELD_NODE: f64 = 48.0;

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
