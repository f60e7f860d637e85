//! Increments that are halved where their own error is estimated too large.

use std::{ops::ControlFlow, path::Path};

use condyle::{
    contact::ContactMemory,
    evolve::March,
    machine::{Chain, Cycle, Simulator, TimeSettings, knee::AP},
};
use condyle_case::case::Case;

/// One repeating cycle of the default case.
fn cycle(march: &March, increments: usize, increment_error_mm: f64) -> Cycle {
    let test = march.test();
    let time = TimeSettings {
        increments,
        increment_error_mm,
        ..test.time
    };
    let chain = Chain::new(test.machine(), march.state().zero_mm, test.flexion_axis_mm);
    let surface = march.insert().surface();
    let bodies = march.bodies(&surface);
    let mut contact = test.contact.contact(bodies, ContactMemory::default());
    let mut simulator = Simulator::new(test.machine(), &chain, contact.as_mut(), &time);
    let start = &march.state().activities[0].machine;
    let solved = simulator.cycle(start, &mut |_| ControlFlow::Continue(()));
    let solved = solved.expect("the default case is solved");
    solved.continue_value().expect("nobody stops it")
}

/// Root mean square difference of AP, mm, over the places of the coarser cycle.
fn apart_mm(coarse: &Cycle, fine: &Cycle) -> f64 {
    let each = fine.rows.len() / coarse.rows.len();
    let finer = fine.rows.iter().skip(each - 1).step_by(each);
    let squares = coarse.rows.iter().zip(finer);
    let sum: f64 = squares
        .map(|(a, b)| (AP.of(&a.positions) - AP.of(&b.positions)).powi(2))
        .sum();
    (sum / coarse.rows.len() as f64).sqrt()
}

#[test]
fn verify_halved_increments_are_nearer_to_the_truth() {
    let case = Path::new(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../../cases/knight-2007.toml"
    ));
    let test = Case::read(case).unwrap().build(1).unwrap().test;
    let march = March::start(test).unwrap();
    let truth = cycle(&march, 3200, 0.0);
    let errors =
        [0.0, 0.01, 0.001].map(|at_most_mm| apart_mm(&cycle(&march, 100, at_most_mm), &truth));
    assert!(
        errors[1] < 0.5 * errors[0] && errors[2] < 0.5 * errors[1],
        "{errors:?}"
    );
}

/// Returns the mass that walking and a chair rise, which starts at 83 degrees of flexion, cost by an integrator, mg.
fn mass_of_walk_and_chair_mg(integrator: &str) -> f64 {
    let [walk, chair] = [("paper-like", "iso-like"), ("chair-like", "chair-like")].map(|(load, motion)| {
        format!(
            "[[activity]]\nname = \"{motion}\"\nshare = 0.5\naxial_force.waveform = \"{load}\"\n\
             flexion.waveform = \"{motion}\"\nap_force.waveform = \"{motion}\"\nie_torque.waveform = \"{motion}\"\n"
        )
    });
    let text = format!(
        "[insert]\nsagittal_radius_mm = 65.1\ncoronal_radius_mm = 59.8\nedge_mm = 3.0\nlayers = 1\n\
         [contact]\nslip_tolerance_mm_per_s = 0.3\n[march]\ncycles = 1000000\nupdates = 1\n\
         [time]\nincrements = 400\nintegrator = \"{integrator}\"\n{walk}{chair}"
    );
    let case = Case::parse(&text, "case", ".".as_ref()).expect("a good case");
    let mut march = March::start(case.build(1).expect("it builds").test).expect("it settles");
    march.run().expect("it is solved");
    march.state().updates[0].mass_loss_mg
}

#[test]
fn verify_activities_that_start_flexed_by_explicit_and_by_implicit_steps() {
    let [implicit, explicit] = ["implicit", "explicit"].map(mass_of_walk_and_chair_mg);
    let apart = (explicit / implicit - 1.0).abs();
    assert!(apart < 0.01, "{implicit} and {explicit} mg");
}
