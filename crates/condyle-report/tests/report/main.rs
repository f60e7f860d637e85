//! From a made-up results folder to its page and pictures.

mod bad_input;
mod fixture;
mod moving;
mod page;
mod pictures;
