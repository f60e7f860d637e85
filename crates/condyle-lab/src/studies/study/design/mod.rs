//! Which tests are done: every test by its number alone, whatever was done before.

mod correlated;
mod factorial;
mod latin;
mod morris;
mod permutation;
mod sobol;
mod sobol_directions;

pub(super) use correlated::Correlated;
pub(super) use factorial::{factorial_places, one_at_a_time_places};
pub(super) use latin::latin_places;
pub(super) use morris::{Walk, morris_places};
pub(super) use sobol::{MOST_AXES, sobol_places};

/// Where a test has an input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// As the case has it.
    AsItIs,
    /// Where this share of its distribution lies below.
    Share(f64),
    /// This part of the way from its low end to its high one.
    Along(f64),
}

/// A base test of a Saltelli design, and what is changed of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Saltelli {
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
