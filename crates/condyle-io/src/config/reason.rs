//! Why something in a file cannot be used.

use std::error::Error;

/// Why something in a file cannot be used, as data: `Display` says what is wrong.
///
/// Every part of a file has reasons of its own, each an enum with fields or a struct.
pub trait Reason: Error + Send + Sync + 'static {
    /// What to do about it, where there is more to say than what is wrong.
    fn advice(&self) -> Option<String>;
}
