//! One of several parts of a study, each on a machine of its own.

use std::{fmt, str::FromStr};

/// Every `of`-th test, from one of the first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    number: u64,
    of: u64,
}

impl Shard {
    /// The whole study.
    pub const WHOLE: Self = Self { number: 1, of: 1 };

    /// Whether it is the whole study.
    pub fn is_whole(&self) -> bool {
        self.of == 1
    }

    /// Whether a row is one of its tests.
    pub fn has(&self, row: u64) -> bool {
        row % self.of == self.number - 1
    }

    /// How many of so many tests are its own.
    pub fn count(&self, tests: u64) -> u64 {
        (tests + self.of - self.number) / self.of
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(written: &str) -> Result<Self, String> {
        let parts = written.split_once('/');
        let numbers = parts.and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
        match numbers {
            Some((number, of)) if 1 <= number && number <= of => Ok(Self { number, of }),
            _ => Err(format!(
                "`{written}` is no shard; write the second of four as 2/4"
            )),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_test_belongs_to_one_shard() {
        let shards: Vec<Shard> = ["1/3", "2/3", "3/3"]
            .iter()
            .map(|shard| shard.parse().unwrap())
            .collect();
        for row in 0..10 {
            assert_eq!(shards.iter().filter(|shard| shard.has(row)).count(), 1);
        }
        let counts: Vec<u64> = shards.iter().map(|shard| shard.count(10)).collect();
        assert_eq!(counts, [4, 3, 3]);
        for wrong in ["", "0/3", "4/3", "1", "a/b", "1/0"] {
            assert!(wrong.parse::<Shard>().unwrap_err().contains("2/4"));
        }
    }
}
