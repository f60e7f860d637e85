//! Springs with free play, one stiffness each way, beside the IE axis.

use condyle::{
    Vec3,
    machine::{
        Drive, Spring, Waveform,
        knee::{AP, IE},
    },
};

use crate::{
    Case, Row,
    machine::{Apart, cycle, exact_time, machine},
};

pub(crate) const CASE: Case = Case {
    name: "springs",
    readme: include_str!("README.md"),
    rows,
};

const OFFSET_MM: f64 = 28.0;
const FREE_PLAY_MM: f64 = 2.5;
/// Against posterior motion, each spring, N/mm.
const POSTERIOR: f64 = 16.9;
/// Against anterior motion, each spring, N/mm.
const ANTERIOR: f64 = 3.62;
const TOLERANCE: f64 = 1e-8;

fn rows() -> Vec<Row> {
    let mut rows = vec![under_force(40.0), under_force(-250.0)];
    rows.extend([6f64, 8.0, -12.0].into_iter().flat_map(under_torque));
    for (ap_mm, ie_deg) in [(4.0, 15.0), (-6.0, 4.0), (1.0, -11.0)] {
        rows.extend(under_both(ap_mm, ie_deg));
    }
    rows
}

/// Where the springs hold the insert: AP, mm, and IE, rad.
fn held(ie: Drive, force_n: f64) -> (f64, f64) {
    let spring = |offset_mm| Spring {
        along: AP,
        about: IE,
        offset_mm,
        positive_stiffness: ANTERIOR,
        negative_stiffness: POSTERIOR,
        free_play: FREE_PLAY_MM,
        rest: 0.0,
    };
    let locked = || Drive::Locked(0.0);
    let ap = Drive::Loaded(Waveform::constant(force_n));
    let drives = [locked(), ie, locked(), ap, locked(), locked()];
    let machine = machine(drives, vec![spring(OFFSET_MM), spring(-OFFSET_MM)]);
    let end = cycle(&machine, &mut Apart, Vec3::zeros(), &exact_time(20)).end;
    (AP.of(&end.now.positions), IE.of(&end.now.positions))
}

fn under_force(force_n: f64) -> Row {
    let exact = if force_n > 0.0 {
        FREE_PLAY_MM + force_n / (2.0 * ANTERIOR)
    } else {
        -FREE_PLAY_MM + force_n / (2.0 * POSTERIOR)
    };
    let (ap_mm, _) = held(Drive::Locked(0.0), force_n);
    Row::relative(
        format!("AP under {force_n} N, IE locked"),
        "mm",
        exact,
        ap_mm,
        TOLERANCE,
    )
}

fn torque(torque_nmm: f64) -> Drive {
    Drive::Loaded(Waveform::constant(torque_nmm))
}

/// The torque that turns the insert by `ie_deg`, and what it does.
fn under_torque(ie_deg: f64) -> [Row; 2] {
    let (sine, cosine) = ie_deg.to_radians().abs().sin_cos();
    let force_n = 2.0 * (OFFSET_MM * sine - FREE_PLAY_MM) / (1.0 / ANTERIOR + 1.0 / POSTERIOR);
    let torque_nmm = 2.0 * OFFSET_MM * cosine * force_n * ie_deg.signum();
    let exact_ap_mm = force_n * (1.0 / ANTERIOR - 1.0 / POSTERIOR) / 2.0;
    let (ap_mm, ie_rad) = held(torque(torque_nmm), 0.0);
    let what = format!("under {:.3} N m, AP free", torque_nmm / 1000.0);
    [
        Row::relative(
            format!("IE {what}"),
            "degrees",
            ie_deg,
            ie_rad.to_degrees(),
            TOLERANCE,
        ),
        Row::relative(format!("AP {what}"), "mm", exact_ap_mm, ap_mm, TOLERANCE),
    ]
}

/// The force and torque that hold a pose, and the pose that they lead to.
fn under_both(ap_mm: f64, ie_deg: f64) -> [Row; 2] {
    let (sine, cosine) = ie_deg.to_radians().sin_cos();
    let lateral_n = pull_n(ap_mm + OFFSET_MM * sine);
    let medial_n = pull_n(ap_mm - OFFSET_MM * sine);
    let (force_n, torque_nmm) = (
        lateral_n + medial_n,
        OFFSET_MM * cosine * (lateral_n - medial_n),
    );
    let (ap, ie) = held(torque(torque_nmm), force_n);
    let what = format!("under {force_n:.2} N and {:.3} N m", torque_nmm / 1000.0);
    [
        Row::relative(format!("AP {what}"), "mm", ap_mm, ap, TOLERANCE),
        Row::relative(
            format!("IE {what}"),
            "degrees",
            ie_deg,
            ie.to_degrees(),
            TOLERANCE,
        ),
    ]
}

/// Load that moves a spring's point by `u_mm`.
fn pull_n(u_mm: f64) -> f64 {
    ANTERIOR * (u_mm - FREE_PLAY_MM).max(0.0) + POSTERIOR * (u_mm + FREE_PLAY_MM).min(0.0)
}

#[cfg(test)]
mod tests {
    #[test]
    fn verify_springs() {
        super::CASE.assert_holds();
    }
}
