//! The rules of the house: who may know whom, and what is written where.

mod arrows;
mod circles;
mod functions;
mod modules;
mod pages;
mod repository;
mod source;
mod words;
