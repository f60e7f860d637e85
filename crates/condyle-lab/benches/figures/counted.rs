//! The work whose instructions are counted, each in a function that is not inlined, so that its name
//! is found in what callgrind writes.

use std::hint::black_box;

use condyle::contact::ContactModel;
use condyle_case::case::Case;

use crate::{
    cases::{self, REAL, SMALL},
    gait::{Asked, Gait, SECOND, Updates},
};

/// The counted pieces of work: the name of each in the budgets, and its function here.
pub const COUNTED: [(&str, &str); 3] = [
    ("contact_evaluation", "counted_contact_evaluations"),
    ("increment", "counted_increments"),
    ("whole_test", "counted_whole_test"),
];

/// Does the work on a case, and prints how many of each thing it did.
pub fn run(name: &str) {
    let case = cases::read(name).expect("looked for by who asks");
    // The femur's preparation would take callgrind a minute, and is no part of the march.
    if name != REAL {
        counted_whole_test(&case);
        println!("whole_test 1");
    }
    if SMALL.iter().any(|(small, _)| *small == name) {
        return;
    }
    let updates = Updates::of(&case, SECOND + 1, |_| ());
    let (gait, asked) = (updates.gait(SECOND), updates.asked(SECOND));
    let contact = || gait.contact_after(updates.cache(SECOND));
    counted_contact_evaluations(contact().as_mut(), asked);
    println!("contact_evaluation {}", asked.len());
    let increments = counted_increments(&gait, contact().as_mut());
    println!("increment {increments}");
}

/// Wrench and tangent, as the cycle of the second update asks for them.
#[inline(never)]
fn counted_contact_evaluations(contact: &mut dyn ContactModel, asked: &[Asked]) {
    for asked in asked {
        contact.begin_increment(asked.increment);
        contact.respond(&asked.motion);
        black_box(contact.tangent());
    }
}

/// The cycle of the second update.
#[inline(never)]
fn counted_increments(gait: &Gait<'_>, contact: &mut dyn ContactModel) -> usize {
    black_box(gait.solve(contact))
}

/// From the parsed case to the last update.
#[inline(never)]
fn counted_whole_test(case: &Case) {
    black_box(cases::marched(cases::built(case)));
}
