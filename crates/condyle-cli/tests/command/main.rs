//! The command, through its front door.

mod bad_bodies;
mod bad_case;
mod bench;
mod cache;
mod calibrate;
mod changes;
mod compare_kinematics;
mod compare_surface;
mod compare_wear;
mod contract;
mod converge;
mod determinism;
mod folders;
mod interrupt;
mod left_knee;
mod measured;
mod new_from_meshes;
mod output;
mod physics;
mod places;
mod plausibility;
mod preview;
mod sensitivity;
mod shapes;
mod slip_paths;
mod words;
