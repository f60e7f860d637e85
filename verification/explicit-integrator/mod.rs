//! The implicit integrator against central differences.

use condyle::machine::{Integration, JointKind, knee::KNEE};

use crate::{
    Case, Row,
    convergence::order_of_errors,
    default_case::{DefaultCase, Solved},
};

pub(crate) const CASE: Case = Case {
    name: "explicit-integrator",
    readme: include_str!("README.md"),
    rows,
};

/// Places in the cycle at which the two are compared.
const PLACES: usize = 200;
/// What the two may differ by, mm and degrees.
const NEAR: f64 = 0.02;
/// The default 200 increments follow the quick motions of heel strike this coarsely.
const NEAR_BY_DEFAULT: f64 = 0.35;
/// Explicit steps asked for where inertia is added, s.
const LONG_STEP_S: f64 = 6e-6;
/// What the inertia added for them may change, mm and degrees.
const NEAR_WITH_INERTIA: f64 = 0.5;

/// Largest differences of two cycles, mm and degrees.
#[derive(Clone, Copy)]
struct Apart {
    mm: f64,
    deg: f64,
}

fn rows() -> Vec<Row> {
    let case = DefaultCase::new();
    let explicit = |least_step_s| case.solved(PLACES, Integration::Explicit { least_step_s });
    let exact = explicit(0.0);
    let from_implicit = |increments| apart(&exact, &case.solved(increments, Integration::Implicit));
    let [coarse, middle, fine] = [200, 1600, 3200].map(from_implicit);
    let heavy = explicit(LONG_STEP_S);
    let added = 100.0 * heavy.counters.added_inertia;
    let heavy_steps = format!("explicit steps of 6 us with up to {added:.0} % more inertia");
    let [mm, deg] = held(fine, "3200 increments", NEAR);
    let mut rows = Vec::new();
    rows.extend(held(coarse, "200 increments", NEAR_BY_DEFAULT));
    rows.extend(held(middle, "1600 increments", NEAR));
    rows.push(mm.with_order(2.0, order_of_errors([middle.mm, fine.mm], 2.0), 0.3));
    rows.push(deg.with_order(2.0, order_of_errors([middle.deg, fine.deg], 2.0), 0.3));
    rows.extend(held(apart(&exact, &heavy), &heavy_steps, NEAR_WITH_INERTIA));
    rows
}

fn held(apart: Apart, how: &str, tolerance: f64) -> [Row; 2] {
    [
        Row::absolute(
            format!("largest difference of AP, ML and IS, {how}"),
            "mm",
            0.0,
            apart.mm,
            tolerance,
        ),
        Row::absolute(
            format!("largest difference of IE and VV, {how}"),
            "degrees",
            0.0,
            apart.deg,
            tolerance,
        ),
    ]
}

/// Largest differences over the whole cycle.
fn apart(one: &Solved, other: &Solved) -> Apart {
    let every = |solved: &Solved| solved.rows.len() / PLACES;
    let at = |solved: &Solved, place: usize| solved.rows[(place + 1) * every(solved) - 1];
    let mut apart = Apart { mm: 0.0, deg: 0.0 };
    for place in 0..PLACES {
        let (one, other) = (at(one, place), at(other, place));
        for (j, joint) in KNEE.joints.iter().enumerate() {
            let here = (one.positions[j] - other.positions[j]).abs();
            match joint.kind() {
                JointKind::Rotation => apart.deg = apart.deg.max(here.to_degrees()),
                JointKind::Translation => apart.mm = apart.mm.max(here),
            }
        }
    }
    apart
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_implicit_against_explicit() {
        super::CASE.assert_holds();
    }
}
