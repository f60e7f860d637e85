//! Which tests are done: every test by its number alone, whatever was done before.

mod correlated;
mod factorial;
mod latin;
mod morris;
mod permutation;
mod place;
mod saltelli;
mod sobol;
mod sobol_directions;

pub(super) use correlated::Correlated;
pub(super) use factorial::{factorial_places, one_at_a_time_places};
pub(super) use latin::latin_places;
pub(super) use morris::{Walk, morris_places};
pub(super) use place::Place;
pub(super) use saltelli::Saltelli;
pub(super) use sobol::{MAX_AXES, sobol_places};
