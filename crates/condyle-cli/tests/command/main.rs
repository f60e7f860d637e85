//! The command, through its front door.

mod bad_bodies;
mod bad_case;
mod bench;
mod contract;
mod converge;
mod determinism;
mod folders;
mod interrupt;
mod left_knee;
mod physics;
mod shapes;
mod words;
