//! A hard ball that digs its own shape into a flat.

use std::f64::consts::{PI, TAU};

use condyle::{evolve::UpdateRecord, geometry::Counterface, machine::knee};

use crate::{
    Case, Row,
    convergence::order_of_errors,
    drives::{to_and_fro, to_and_fro_later},
    law::THICKNESS_MM,
    marched::marched,
    plate::rubbing,
    pressed::block,
    rub_test::{MM_PER_M, Rub, WEAR_FACTOR_MM3_PER_NM},
};

pub(crate) const CASE: Case = Case {
    name: "wearing-ball",
    readme: include_str!("README.md"),
    rows,
};

const RADIUS_MM: f64 = 24.0;
const LOAD_N: f64 = 50.0;
/// Radius of the circle that the ball goes round.
const ORBIT_MM: f64 = 0.02;
/// Height of the cap at the end.
const END_MM: f64 = 0.25;
const UPDATES: usize = 160;

fn rows() -> Vec<Row> {
    let updates = updates();
    let [quarter, end] = [UPDATES / 4, UPDATES].map(|count| &updates[count - 1]);
    let (exact_a, exact_h) = ((2.0 * RADIUS_MM * END_MM).sqrt(), END_MM);
    let power = |of: fn(&UpdateRecord) -> f64| order_of_errors([of(end), of(quarter)], 4.0);
    vec![
        Row::relative("volume", "mm3", volume_mm3(), end.volume_loss_mm3, 5e-3),
        Row::relative(
            "radius of the scar; order: power of N",
            "mm",
            exact_a,
            radius_mm(end),
            0.02,
        )
        .with_order(0.25, power(radius_mm), 0.01),
        Row::relative(
            "depth of the scar; order: power of N",
            "mm",
            exact_h,
            end.max_depth_mm,
            0.03,
        )
        .with_order(0.5, power(|update| update.max_depth_mm), 0.02),
    ]
}

/// Volume of the cap at the end, as a paraboloid.
fn volume_mm3() -> f64 {
    PI * RADIUS_MM * END_MM * END_MM
}

/// Radius of a paraboloid of the volume and depth.
fn radius_mm(update: &UpdateRecord) -> f64 {
    (2.0 * update.volume_loss_mm3 / (PI * update.max_depth_mm)).sqrt()
}

fn updates() -> Vec<UpdateRecord> {
    let (contact, _) = rubbing(0.0, 1.0);
    let per_cycle = WEAR_FACTOR_MM3_PER_NM / MM_PER_M * LOAD_N * TAU * ORBIT_MM;
    let rub = Rub {
        femur: Counterface::sphere(RADIUS_MM),
        insert: block(10.0, THICKNESS_MM, 0.25),
        contact,
        ap: to_and_fro(ORBIT_MM),
        load_n: LOAD_N,
        increments: 20,
        cycles: volume_mm3() / per_cycle,
        updates: UPDATES,
    };
    let mut test = rub.test();
    let machine = &mut test.activities[0].machine;
    machine.joint_mut(knee::ML).drive = to_and_fro_later(ORBIT_MM);
    marched(test).state().updates.clone()
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_wearing_ball() {
        super::CASE.assert_holds();
    }
}
