//! The rules of the house: who may know whom, and what is written where.

mod arrows;
mod modules;
mod pages;
mod repository;
mod words;
