//! Differences of the size of rounding stay as small, whatever the model.

use std::ops::ControlFlow;

use condyle::evolve::March;
use condyle_case::case::Case;

/// A change of Young's modulus of 463 MPa: ten times the rounding of a number.
const RELATIVE_CHANGE: f64 = 1e-12;
/// The largest relative change of a mass that it may cause.
const MOST: f64 = 1e-6;

/// The keys that select each model.
const MODELS: [(&str, &str); 7] = [
    ("rigid", ""),
    ("rigid, creep", "[creep]\nlaw = \"lee-pienkowski\"\n"),
    ("deformable", "[contact]\nmodel = \"deformable\"\n"),
    (
        "deformable, creep",
        "[contact]\nmodel = \"deformable\"\n[creep]\nlaw = \"lee-pienkowski\"\n",
    ),
    (
        "plastic",
        "[contact]\nmodel = \"deformable\"\n[contact.deformable]\nplasticity = \"j2\"\n",
    ),
    (
        "plastic, creep",
        "[contact]\nmodel = \"deformable\"\n[contact.deformable]\nplasticity = \"j2\"\n\
         [creep]\nlaw = \"lee-pienkowski\"\n",
    ),
    (
        "resting",
        "[contact]\nmodel = \"deformable\"\n[contact.deformable]\nbackside = \"resting\"\n",
    ),
];

/// Designs: distal, posterior and coronal radius of the femur, sagittal and coronal radius and thickness of the insert, mm.
const DESIGNS: [[f64; 6]; 3] = [
    [33.1, 20.9, 22.7, 64.3, 47.9, 9.1],
    [38.2, 18.7, 31.3, 71.9, 58.1, 7.7],
    [29.3, 22.9, 26.9, 52.7, 43.1, 11.3],
];

/// Returns the mass lost after every update, mg.
fn masses_mg(model: &str, design: [f64; 6], youngs_modulus_mpa: f64) -> Vec<f64> {
    let [distal, posterior, coronal, sagittal, dish, thickness] = design;
    let text = format!(
        "[femur]\ndistal_radius_mm = {distal:?}\nposterior_radius_mm = {posterior:?}\ncoronal_radius_mm = {coronal:?}\n\
         [insert]\nsagittal_radius_mm = {sagittal:?}\ncoronal_radius_mm = {dish:?}\nthickness_mm = {thickness:?}\n\
         edge_mm = 3.0\nlayers = 1\n[material]\nyoungs_modulus_mpa = {youngs_modulus_mpa:?}\n\
         [march]\nupdates = 4\n[time]\nincrements = 40\n{model}"
    );
    let case = Case::parse(&text, "case", ".".as_ref()).expect("a good case");
    let built = case.build(1).expect("it builds");
    let mut march = March::start(built.test).expect("it settles");
    while !march.is_done() {
        let updated = march.update(&mut |_| ControlFlow::Continue(()));
        let _ = updated.expect("it is solved");
    }
    let updates = march.state().updates.iter();
    updates.map(|update| update.mass_loss_mg).collect()
}

#[test]
fn a_change_of_rounding_changes_no_mass() {
    for (name, model) in MODELS {
        for (number, design) in DESIGNS.into_iter().enumerate() {
            let [one, other] = [463.0, 463.0 * (1.0 + RELATIVE_CHANGE)]
                .map(|youngs_modulus_mpa| masses_mg(model, design, youngs_modulus_mpa));
            for (one, other) in one.into_iter().zip(other) {
                let change = (other / one - 1.0).abs();
                assert!(change < MOST, "{name}, design {number}: {one} {other}");
            }
        }
    }
}
