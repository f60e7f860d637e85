//! A flat block under a flat plate, with friction.

use std::f64::consts::{PI, TAU};

use condyle::{
    Vec3,
    contact::Bodies,
    machine::{Cycle, Drive, Machine, Waveform, knee::AP},
};

use crate::{
    Case, Row,
    drives::to_and_fro,
    law::THICKNESS_MM,
    machine::{cycle, exact_time, machine},
    plate::{plate, rubbing},
    pressed::{block, contact_of, moving, press},
    quadrature::integral,
};

pub(crate) const CASE: Case = Case {
    name: "friction-block",
    readme: include_str!("README.md"),
    rows,
};

const SIZE_MM: f64 = 20.0;
const FRICTION: f64 = 0.07;
const TOLERANCE_MM_PER_S: f64 = 1.0;
const LOAD_N: f64 = 2000.0;
/// Amplitude of the motion to and fro.
const AMPLITUDE_MM: f64 = 4.0;

fn rows() -> Vec<Row> {
    let mut rows = at_speeds();
    rows.extend([creeping(0.5), creeping(0.9), slipping(1.2), slipping(3.0)]);
    rows.push(working());
    rows
}

/// Friction at a speed, N.
fn friction_n(speed: f64) -> f64 {
    FRICTION * LOAD_N * speed / speed.hypot(TOLERANCE_MM_PER_S)
}

/// Overclosure under the load, mm.
fn overclosure_mm(stiffness: f64) -> f64 {
    LOAD_N / (stiffness * SIZE_MM * SIZE_MM)
}

/// Friction as the contact says, at speeds from deep stick to full slip, 30 degrees off the mesh.
fn at_speeds() -> Vec<Row> {
    let (law, stiffness) = rubbing(FRICTION, TOLERANCE_MM_PER_S);
    let (femur, insert) = (plate(SIZE_MM), block(SIZE_MM, THICKNESS_MM, 1.0));
    let bodies = Bodies {
        counterface: &femur,
        insert: &insert,
        surface: &insert.surface(),
    };
    let mut contact = contact_of(&law, bodies);
    let along = Vec3::new((PI / 6.0).cos(), 0.0, (PI / 6.0).sin());
    let place = Vec3::new(0.0, -overclosure_mm(stiffness), 0.0);
    let mut at = |speed: f64| press(contact.as_mut(), &moving(place, along * speed)).force_n;
    let pressed = Row::relative("load at rest", "N", LOAD_N, -at(0.0).y, 1e-9);
    let speeds = [1e-3, 0.1, 1.0, 10.0];
    let mut rows: Vec<Row> = speeds
        .into_iter()
        .map(|speed| {
            let what = format!("friction at {speed} mm/s");
            let computed = at(speed).dot(&along);
            Row::absolute(what, "N", friction_n(speed), computed, 1e-6)
        })
        .collect();
    let full = at(100.0);
    let across = full.x * along.z - full.z * along.x;
    rows.insert(0, pressed);
    rows.push(Row::relative(
        "mu N, at 100 mm/s",
        "N",
        FRICTION * LOAD_N,
        full.dot(&along),
        1e-4,
    ));
    rows.push(Row::absolute(
        "friction across the slip",
        "N",
        0.0,
        across,
        1e-9,
    ));
    rows
}

/// The block's cycle, pulled or moved along AP under the load.
fn moved(ap: Drive, damping: f64, increments: usize) -> (Cycle, Machine) {
    let (law, stiffness) = rubbing(FRICTION, TOLERANCE_MM_PER_S);
    let (femur, insert) = (plate(60.0), block(SIZE_MM, THICKNESS_MM, 2.0));
    let load = Drive::Loaded(Waveform::constant(-LOAD_N));
    let locked = || Drive::Locked(0.0);
    let drives = [locked(), locked(), locked(), ap, load, locked()];
    let mut machine = machine(drives, Vec::new());
    machine.joint_mut(AP).damping = damping;
    let down = Vec3::new(0.0, -overclosure_mm(stiffness), 0.0);
    let mut time = exact_time(increments);
    time.force_tolerance_n = 1e-7;
    time.most_cycles_to_repeat = 2;
    let bodies = Bodies {
        counterface: &femur,
        insert: &insert,
        surface: &insert.surface(),
    };
    let mut contact = contact_of(&law, bodies);
    (cycle(&machine, contact.as_mut(), down, &time), machine)
}

fn speed_pulled(force_n: f64, damping: f64) -> f64 {
    let pull = Drive::Loaded(Waveform::constant(force_n));
    let (cycle, _) = moved(pull, damping, 100);
    AP.of(&cycle.end.now.rates)
}

fn creeping(part: f64) -> Row {
    let exact = TOLERANCE_MM_PER_S * part / (1.0 - part * part).sqrt();
    let speed = speed_pulled(part * FRICTION * LOAD_N, 0.0);
    Row::relative(
        format!("creep under {part} mu N"),
        "mm/s",
        exact,
        speed,
        1e-6,
    )
}

fn slipping(part: f64) -> Row {
    const DAMPING: f64 = 30.0;
    let force_n = part * FRICTION * LOAD_N;
    let speed = speed_pulled(force_n, DAMPING);
    let held_n = friction_n(speed) + DAMPING * speed;
    Row::relative(
        format!("friction and damper under {part} mu N, at {speed:.2} mm/s"),
        "N",
        force_n,
        held_n,
        1e-6,
    )
}

/// Work of friction over a cycle to and fro, from the histories of the nodes.
fn working() -> Row {
    const INCREMENTS: usize = 800;
    let (cycle, machine) = moved(to_and_fro(AMPLITUDE_MM), 0.0, INCREMENTS);
    let speed = |t: f64| TAU * AMPLITUDE_MM * (TAU * t).sin().abs();
    let exact = 2.0 * integral(0.0, 0.5, |t| friction_n(speed(t)) * speed(t));
    let step_s = 1.0 / (machine.frequency_hz * INCREMENTS as f64);
    let insert = block(SIZE_MM, THICKNESS_MM, 2.0);
    let shares = insert.surface().shares;
    let mut work_nmm = 0.0;
    for (node, share) in shares.iter().enumerate() {
        for moment in cycle.history.moments(node) {
            let slip_mm = moment.slip_mm[0].hypot(moment.slip_mm[1]);
            let part = friction_n(slip_mm / step_s) / LOAD_N;
            work_nmm += part * moment.pressure_mpa * share.area_mm2 * slip_mm;
        }
    }
    Row::relative(
        "work of friction over a cycle",
        "N mm",
        exact,
        work_nmm,
        1e-5,
    )
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_friction_block() {
        super::CASE.assert_holds();
    }
}
