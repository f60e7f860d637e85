//! Paths with closed forms, for the tests of the laws: a node of 2 mm2 that all presses.

use super::{MeanCycle, WearLaw};
use crate::contact::{CycleHistory, Moment, Record};

/// Pressure, MPa, and slip, mm.
pub(super) type Step = (f64, [f64; 2]);

/// Area of the node's share, mm2.
const AREA_MM2: f64 = 2.0;

/// The history of a node that goes this way.
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

/// What `law` wears in a cycle of that path, mm.
pub(super) fn depth_mm(law: &dyn WearLaw, path: &[Step]) -> f64 {
    let history = history(path);
    law.wear(&MeanCycle::new(&[(1.0, &history)], 0, AREA_MM2))
        .depth_mm
}

/// What of it, 0 to 1, is outside of what the law was fitted to.
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
        let angle = std::f64::consts::TAU * part as f64 / PARTS as f64;
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
