//! What a number may be.

use std::fmt;

/// The least and the most that a number may be, both allowed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// Least.
    pub least: f64,
    /// Most.
    pub most: f64,
}

/// Limits from `least` to `most`, both allowed.
pub(crate) const fn within(least: f64, most: f64) -> Limits {
    Limits { least, most }
}

impl Limits {
    /// Whether `value` lies inside; NaN does not.
    pub fn allow(&self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }
}

impl fmt::Display for Limits {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} to {}", plain(self.least), plain(self.most))
    }
}

/// A number as a person would write it.
pub(crate) fn plain(value: f64) -> String {
    if value != 0.0 && !(1e-3..1e9).contains(&value.abs()) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_allow_their_ends_and_no_nan() {
        let limits = within(0.0, 0.499);
        assert!(limits.allow(0.0) && limits.allow(0.499));
        assert!(!limits.allow(0.5) && !limits.allow(f64::NAN));
        assert_eq!(limits.to_string(), "0 to 0.499");
    }
}
