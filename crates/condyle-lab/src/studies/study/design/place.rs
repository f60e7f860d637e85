//! Where a test has an input.

/// Where a test has an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) enum Place {
    /// As the case has it.
    AsItIs,
    /// Where this share of its distribution lies below.
    Share(f64),
    /// This part of the way from its low end to its high one.
    Along(f64),
}
