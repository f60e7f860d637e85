//! Cases with known solutions.
//!
//! Every case has a folder next to this one: a README that describes the exact solution, and a function that
//! returns rows of exact and computed values. To add one: its folder, its module and its line in
//! [`CASES`], then `cargo run --release -p condyle-verification -- --page`.

#[cfg(test)]
mod assertions;
mod ball;
#[cfg(doctest)]
mod book;
mod case;
mod convergence;
mod default_case;
mod drives;
mod foundation_rows;
#[path = "../../crates/condyle/src/contact/deformable/plastic/tests/initial_stress.rs"]
mod initial_stress;
mod law;
mod machine;
mod marched;
mod number;
mod observed;
mod page;
mod plate;
mod pressed;
mod quadrature;
mod round_solids;
mod row;
mod rub_test;

#[path = "../archard-ball-on-flat/mod.rs"]
mod archard_ball_on_flat;
#[path = "../archard-pin-on-plate/mod.rs"]
mod archard_pin_on_plate;
#[path = "../bonded-layer/mod.rs"]
mod bonded_layer;
#[path = "../cylinder-on-foundation/mod.rs"]
mod cylinder_on_foundation;
#[path = "../elastic-solids/mod.rs"]
mod elastic_solids;
#[path = "../energy-balance/mod.rs"]
mod energy_balance;
#[path = "../explicit-integrator/mod.rs"]
mod explicit_integrator;
#[path = "../friction-block/mod.rs"]
mod friction_block;
#[path = "../invariances/mod.rs"]
mod invariances;
#[path = "../off-centre-load/mod.rs"]
mod off_centre_load;
#[path = "../opensim-contact/mod.rs"]
mod opensim_contact;
#[path = "../plastic-solids/mod.rs"]
mod plastic_solids;
#[path = "../refinement/mod.rs"]
mod refinement;
#[path = "../sphere-on-foundation/mod.rs"]
mod sphere_on_foundation;
#[path = "../springs/mod.rs"]
mod springs;
#[path = "../wearing-ball/mod.rs"]
mod wearing_ball;

pub use case::Case;
pub use page::{page, table};
pub use row::{Order, Row};

/// Every case, in the order of the page.
pub const CASES: &[Case] = &[
    sphere_on_foundation::CASE,
    cylinder_on_foundation::CASE,
    off_centre_load::CASE,
    springs::CASE,
    friction_block::CASE,
    elastic_solids::CASE,
    bonded_layer::CASE,
    plastic_solids::CASE,
    archard_pin_on_plate::CASE,
    archard_ball_on_flat::CASE,
    wearing_ball::CASE,
    invariances::CASE,
    refinement::CASE,
    opensim_contact::CASE,
    explicit_integrator::CASE,
    energy_balance::CASE,
];
