//! What a run writes besides what it always does.

use crate::config::settings;

settings! {
    /// What a run writes besides what it always does.
    Output {
        /// Whether the first and the last cycle are written for ParaView, increment by increment: the pressure on the insert, and the femur where it is. About 100 kB an increment and body.
        cycle_frames: bool = false;
    }
}
