//! Paths with closed forms, and every law on them: a node of 2 mm2 that is loaded as a whole.

use std::f64::consts::TAU;

use super::{MeanCycle, WEAR_LAWS, WearLaw, WearLawKind};
use crate::contact::{CycleHistory, Moment, Record};

/// Pressure, MPa, and slip, mm.
pub(super) type Step = (f64, [f64; 2]);

/// Area of the node's share, mm2.
const AREA_MM2: f64 = 2.0;

/// The history of a node on this path.
pub(super) fn history(path: &[Step]) -> CycleHistory {
    let mut history = CycleHistory::default();
    let record = |&(pressure_mpa, slip_mm): &Step| Record {
        node: 0,
        pressed_mm2: AREA_MM2 as f32,
        moment: Moment {
            pressure_mpa,
            slip_mm,
        },
    };
    let instants: Vec<_> = path
        .iter()
        .map(|step| history.record([record(step)].into_iter()))
        .collect();
    history.sort(1, &instants);
    history
}

/// The wear by `law` in a cycle of that path, mm.
pub(super) fn depth_mm(law: &dyn WearLaw, path: &[Step]) -> f64 {
    let history = history(path);
    law.wear(&MeanCycle::new(&[(1.0, &history)], 0, AREA_MM2))
        .depth_mm
}

/// The part of it, 0 to 1, outside the range to which the law was fitted.
pub(super) fn outside(law: &dyn WearLaw, path: &[Step]) -> Option<f64> {
    let history = history(path);
    law.wear(&MeanCycle::new(&[(1.0, &history)], 0, AREA_MM2))
        .part_outside
}

/// There and back, in all as long as `slip_mm`.
pub(super) fn straight(pressure_mpa: f64, slip_mm: [f64; 2]) -> Vec<Step> {
    let half = slip_mm.map(|part| 0.5 * part);
    vec![(pressure_mpa, half), (pressure_mpa, half.map(|part| -part))]
}

/// Once round a rectangle.
pub(super) fn rectangle(pressure_mpa: f64, [width_mm, depth_mm]: [f64; 2]) -> Vec<Step> {
    let sides = [
        [width_mm, 0.0],
        [0.0, depth_mm],
        [-width_mm, 0.0],
        [0.0, -depth_mm],
    ];
    sides.map(|side| (pressure_mpa, side)).to_vec()
}

/// Once round a circle of that circumference.
pub(super) fn circle(pressure_mpa: f64, round_mm: f64) -> Vec<Step> {
    const PARTS: usize = 720;
    let step = |part| {
        let angle = TAU * part as f64 / PARTS as f64;
        let (sine, cosine) = angle.sin_cos();
        let along_mm = round_mm / PARTS as f64;
        (pressure_mpa, [along_mm * cosine, along_mm * sine])
    };
    (0..PARTS).map(step).collect()
}

/// The same path turned by `degrees`.
pub(super) fn turned(path: &[Step], degrees: f64) -> Vec<Step> {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    let turn = |&(pressure_mpa, [x, z]): &Step| {
        (pressure_mpa, [cosine * x - sine * z, sine * x + cosine * z])
    };
    path.iter().map(turn).collect()
}

/// Panics unless both agree to a part in a hundred million.
pub(super) fn assert_near(found: f64, exact: f64) {
    let error = (found - exact).abs();
    assert!(error <= 1e-8 * exact.abs(), "{found:e} for {exact:e}");
}

/// A path under one pressure, its cross-shear ratio and its length.
struct Known {
    path: Vec<Step>,
    cross_shear: f64,
    slid_mm: f64,
}

/// Straight, round, square, long and figure-of-eight.
fn known(pressure_mpa: f64) -> [Known; 5] {
    let of = |path: Vec<Step>, cross_shear, slid_mm| Known {
        path,
        cross_shear,
        slid_mm,
    };
    let (eight_cross_shear, eight_mm) = eight_by_quadrature();
    [
        of(straight(pressure_mpa, [20.0, 0.0]), 0.0, 20.0),
        of(circle(pressure_mpa, 20.0), 0.5, 20.0),
        of(rectangle(pressure_mpa, [5.0, 5.0]), 0.5, 20.0),
        of(rectangle(pressure_mpa, [9.0, 1.0]), 0.1, 20.0),
        of(eight(pressure_mpa), eight_cross_shear, eight_mm),
    ]
}

/// Gerono's figure of eight, x = 3 sin t, z = 3 sin t cos t, in many chords.
fn eight(pressure_mpa: f64) -> Vec<Step> {
    const CHORDS: usize = 40_000;
    let place = |chord: usize| {
        let t = TAU * chord as f64 / CHORDS as f64;
        [3.0 * t.sin(), 3.0 * t.sin() * t.cos()]
    };
    let step = |chord| {
        let ([x0, z0], [x1, z1]) = (place(chord), place(chord + 1));
        (pressure_mpa, [x1 - x0, z1 - z0])
    };
    (0..CHORDS).map(step).collect()
}

/// Its cross-shear ratio and length, by Simpson's rule on the velocity 3 (cos t, cos 2t): the two axes are those of
/// its symmetry.
fn eight_by_quadrature() -> (f64, f64) {
    const PARTS: usize = 4000;
    let (mut along, mut across) = (0.0, 0.0);
    for part in 0..PARTS {
        let t = TAU * part as f64 / PARTS as f64;
        // Simpson's weights on a closed path; the velocity is never 0.
        let weight = [2.0, 4.0][part % 2] / 3.0 * TAU / PARTS as f64;
        let (x, z) = (3.0 * t.cos(), 3.0 * (2.0 * t).cos());
        along += weight * x * x / x.hypot(z);
        across += weight * z * z / x.hypot(z);
    }
    (along.min(across) / (along + across), along + across)
}

/// The wear by a law with default constants, mm; none for a law whose closed form is with its own tests.
fn exact_mm(law: &WearLawKind, pressure_mpa: f64, known: &Known) -> Option<f64> {
    let (cs, slid_mm) = (known.cross_shear, known.slid_mm);
    // N m on each square millimetre.
    let work = pressure_mpa * slid_mm / 1000.0;
    Some(match law.word {
        "archard" => 2.64e-7 * work,
        "kang" => (-13.1 - 0.29 * pressure_mpa.min(10.0)).exp() * cs.max(0.01).powf(0.19) * work,
        "contact-area" if cs < 0.04 => (32.0 * cs + 0.3) * 1e-9 * slid_mm,
        "contact-area" => (1.9 * cs + 1.6) * 1e-9 * slid_mm,
        "unified" => 2.0 * 1.63e-6 * cs * work,
        "directional" => 2.0 * 1.63e-6 / 7.4 * (1.0 - cs + 6.4 * cs) * work,
        _ => return None,
    })
}

#[test]
fn verify_every_law_on_every_path_however_it_lies() {
    for law in WEAR_LAWS {
        let own = law.with_defaults().law;
        for pressure_mpa in [0.5, 5.0, 25.0] {
            for (number, known) in known(pressure_mpa).iter().enumerate() {
                for degrees in [0.0, 33.0, 120.0, -77.7] {
                    let found = depth_mm(own.as_ref(), &turned(&known.path, degrees));
                    let Some(exact) = exact_mm(law, pressure_mpa, known) else {
                        continue;
                    };
                    let error = (found - exact).abs();
                    let word = law.word;
                    assert!(
                        error <= 1e-6 * exact + 1e-22,
                        "{word} on path {number}: {found:e} for {exact:e}"
                    );
                }
            }
        }
    }
}

#[test]
fn verify_a_law_scaled_wears_so_many_times_as_much() {
    for law in WEAR_LAWS {
        for known in &known(3.0)[1..] {
            let once = depth_mm(law.with_defaults().law.as_ref(), &known.path);
            for times in [0.2, 1.0, 3.5] {
                let scaled = law.law(&(law.scaled)(&law.defaults(), times));
                assert_near(depth_mm(scaled.as_ref(), &known.path), times * once);
            }
        }
    }
}
