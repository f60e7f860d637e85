//! Names of cycles in captions.

use crate::number::cycles;

/// Names of the first and last cycle for captions.
pub(super) fn cycle_caption(first: f64, last: f64) -> (String, String) {
    let named = |count: f64| match count {
        0.0 => String::from("unworn"),
        count => format!("after {} cycles", cycles(count)),
    };
    (named(first), named(last))
}
