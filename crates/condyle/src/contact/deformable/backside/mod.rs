//! A backside that rests on its tray: each place of it presses and sticks there or slips, or lifts.
//!
//! Its flat part rests (`floor`). Where it moves is told at points (`tray_points`) of a `grid`, whose motions give stiffness and compliance as those of a solid with
//! moved supports (`tray`). Under the loads on the surface it comes to rest by Signorini's and Coulomb's conditions
//! (`rest`). How it gets there from increment to increment is `insert`; what stays is `memory`, and what a cycle came to
//! `cycle`.

mod cycle;
mod floor;
mod grid;
mod insert;
mod memory;
mod rest;
#[cfg(test)]
mod tests;
mod tray;
mod tray_points;

pub(super) use floor::Floor;
pub(super) use insert::RestingInsert;
pub(super) use memory::{BACKSIDE_CYCLE_FIELD, BACKSIDE_FIELD, BacksideMemory};
pub(super) use rest::rest;
pub(super) use tray::Tray;
