//! A Saltelli design: tests that differ by one input from a base.

use super::place::Place;
use super::sobol::sobol_places;

/// A base test of a Saltelli design, and what is changed of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in super::super) enum Saltelli {
    /// The base itself.
    A,
    /// The base with one input from the other one.
    Changed(usize),
    /// The other one.
    B,
}

impl Saltelli {
    /// The number of the base of a row, and which of its tests it is.
    pub fn of(row: u64, inputs: usize) -> (u64, Self) {
        let tests = inputs as u64 + 2;
        let which = match (row % tests) as usize {
            0 => Self::A,
            place if place <= inputs => Self::Changed(place - 1),
            _ => Self::B,
        };
        (row / tests, which)
    }

    /// Where that test has the inputs (Saltelli et al. 2010): of two points of Sobol side by side.
    pub fn places(row: u64, inputs: usize, seed: u64) -> Vec<Place> {
        let (base, which) = Self::of(row, inputs);
        let both = sobol_places(base, 2 * inputs, seed);
        let (a, b) = both.split_at(inputs);
        match which {
            Self::A => a.to_vec(),
            Self::B => b.to_vec(),
            Self::Changed(input) => {
                let mut changed = a.to_vec();
                changed[input] = b[input];
                changed
            }
        }
    }
}
