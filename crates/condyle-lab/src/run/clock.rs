//! Time spent on the solver alone.

use std::time::{Duration, Instant};

/// Time spent on the solver alone.
#[derive(Default)]
pub(crate) struct Clock {
    pub spent: Duration,
}

impl Clock {
    /// The result of some work, whose time counts.
    pub fn time<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = work();
        self.spent += start.elapsed();
        result
    }
}
