//! Cases with known answers that condyle is held against.
//!
//! Every case has a folder beside this one: a README that says what is exact, and a function that
//! returns rows of exact and computed values. To add one: its folder, its module and its line in
//! [`CASES`], then `cargo run --release -p condyle-verification -- --page`.

mod ball;
mod case;
mod convergence;
mod number;
mod page;
mod pressed;
mod row;

#[path = "../sphere-on-foundation/mod.rs"]
mod sphere_on_foundation;

pub use case::Case;
pub use page::{page, table};
pub use row::{Order, Row};

/// Every case, in the order of the page.
pub const CASES: &[Case] = &[sphere_on_foundation::CASE];
