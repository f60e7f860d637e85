//! Options of a run: accuracy, limits of the computer, additional output.

use super::table::plain_tables;
use crate::config::{settings, within};

settings! {
    /// What a run tells of its own accuracy.
    Accuracy {
        /// Whether discretisation errors are estimated after the run, by solving the unworn cycle more coarsely.
        estimate: bool = true;
    }
}

settings! {
    /// What a run may take of the computer.
    Limits {
        /// Memory that a run may need; a case that needs more is refused before it begins.
        memory_gb: f64 = Limits::DEFAULT_GB, in within(0.1, 10_000.0);
    }
}

impl Limits {
    /// Memory that a run may need where the case does not say.
    pub(super) const DEFAULT_GB: f64 = 2.0;

    /// Bytes of all that a run knows of a node of an insert, its contact left out: positions now and on the way, and
    /// what a file of it takes while it is written.
    pub const BYTES_OF_INSERT_NODE: f64 = 800.0;

    /// Bytes of a node of the distance field of a femur in triangles, while that is made.
    pub const BYTES_OF_FIELD_NODE: f64 = 48.0;

    /// How many things of so many bytes each the memory has room for.
    pub(super) fn most(&self, bytes_each: f64) -> usize {
        (self.memory_gb * 1e9 / bytes_each) as usize
    }
}

settings! {
    /// What a run writes besides what it always does.
    Output {
        /// Whether the first and the last cycle are written for ParaView, increment by increment: the pressure on the insert, and the femur where it is. About 100 kB an increment and body.
        cycle_frames: bool = false;
    }
}

plain_tables! {
    Accuracy = "accuracy", "What a run tells of its own accuracy.";
    Limits = "limits", "What a run may take of the computer.";
    Output = "output", "What a run writes besides what it always does.";
}
