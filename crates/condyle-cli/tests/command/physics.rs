//! Closed forms through the front door: a ball or two condyles on a flat insert.

use condyle_results::catalogue;
use std::f64::consts::PI;

use crate::bench::Bench;

const KW_MM3_PER_NM: f64 = 2.64e-7;
const CYCLES: f64 = 1e6;
const RADIUS_MM: f64 = 24.0;
const LOAD_N: f64 = 500.0;

/// A ball under a constant load, its AP and flexion moved as given, all else held.
fn ball(ap: &str, flexion: &str) -> Bench {
    Bench::with_case(
        &format!(
            "\
[femur]
shape = \"sphere\"
radius_mm = {RADIUS_MM:?}
[insert]
shape = \"flat\"
edge_mm = 1.5
layers = 2
[machine]
preset = \"stanmore-displacement\"
flexion_offset_deg = 0.0
[machine.axial_force]
knots_n = [[0, {LOAD_N:?}]]
[machine.flexion]
knots_deg = [{flexion}]
[machine.ap_motion]
knots_mm = [{ap}]
[machine.ie_motion]
waveform = \"none\"
[machine.freedoms.ml]
drive = \"locked\"
[machine.freedoms.vv]
drive = \"locked\"
[wear]
wear_factor_mm3_per_nm = {KW_MM3_PER_NM:?}
[march]
cycles = {CYCLES:?}
updates = 2
[time]
increments = 60
"
        )
        .replace("cycles = 1000000.0", "cycles = 1_000_000"),
    )
}

/// Volume after a run, over Kw F S for a path of `path_mm` a cycle.
#[track_caller]
fn volume_over_archard(bench: &Bench, path_mm: f64) -> f64 {
    bench.run_into("out");
    let archard_mm3 = KW_MM3_PER_NM * LOAD_N * path_mm / 1000.0 * CYCLES;
    bench.summary("out")[&catalogue::VOLUME_LOSS_MM3] / archard_mm3
}

#[test]
fn verify_volume_of_a_sliding_ball_is_kw_f_s() {
    let sliding = ball("[0, -5], [50, 5]", "[0, 0]");
    let ratio = volume_over_archard(&sliding, 20.0);
    assert!((ratio - 1.0).abs() < 5e-3, "{ratio}");
    let summary = sliding.summary("out");
    assert!(
        (summary[&catalogue::VOLUME_LOSS_MESH_MM3] / summary[&catalogue::VOLUME_LOSS_MM3] - 1.0)
            .abs()
            < 0.01
    );
    assert!((summary[&catalogue::AP_RANGE_MM] - 10.0).abs() < 1e-6);
}

#[test]
fn verify_volume_of_a_ball_spinning_in_place_is_kw_f_s() {
    let spinning = ball("[0, 0]", "[0, 0], [50, 30]");
    let path_mm = 2.0 * 30f64.to_radians() * RADIUS_MM;
    let ratio = volume_over_archard(&spinning, path_mm);
    // The surface that touches lies nearer to the axis than the radius, by what it is pressed in.
    assert!((0.985..1.001).contains(&ratio), "{ratio}");
}

#[test]
fn verify_a_rolling_ball_does_not_slide_and_so_does_not_wear() {
    let half_mm = 15f64.to_radians() * RADIUS_MM;
    let rolling = ball(
        &format!("[0, {:?}], [50, {half_mm:?}]", -half_mm),
        "[0, -15], [50, 15]",
    );
    let ratio = volume_over_archard(&rolling, 4.0 * half_mm);
    assert!(ratio < 0.015, "{ratio}");
    let dragging = ball(
        &format!("[0, {half_mm:?}], [50, {:?}]", -half_mm),
        "[0, -15], [50, 15]",
    );
    let ratio = volume_over_archard(&dragging, 4.0 * half_mm);
    assert!((ratio - 2.0).abs() < 0.02, "{ratio}");
}

#[test]
fn verify_contact_of_a_ball_on_the_foundation() {
    let coarse = ball("[0, 0]", "[0, 0]");
    let text = std::fs::read_to_string(coarse.path("case.toml")).unwrap();
    let bench = Bench::with_case(&text.replace("edge_mm = 1.5", "edge_mm = 0.6"));
    bench.run_into("out");
    let table = bench.table("out", "kinematics.csv");
    let (e, v, h) = (463.0, 0.46, 9.0);
    let stiffness = (1.0 - v) * e / ((1.0 + v) * (1.0 - 2.0 * v)) / h;
    let deep_mm = (LOAD_N / (PI * stiffness * RADIUS_MM)).sqrt();
    let (area, peak) = (table["contact_area_mm2"][0], table["peak_pressure_mpa"][0]);
    assert!(
        (area / (2.0 * PI * RADIUS_MM * deep_mm) - 1.0).abs() < 0.01,
        "{area}"
    );
    assert!((peak / (stiffness * deep_mm) - 1.0).abs() < 0.02, "{peak}");
    assert!((table["axial_force_n"][0] - LOAD_N).abs() < 0.02);
}

/// Without lateral strain a pin is a bar: its grid has nodes with three faces, whose load must be a uniform pressure too.
#[test]
fn verify_the_pressure_at_the_end_of_a_pin_without_poissons_ratio_is_uniform() {
    let bench = Bench::with_case(
        "\
[femur]
shape = \"plane\"
[insert]
shape = \"pin\"
radius_mm = 4.5
thickness_mm = 10.0
layers = 2
edge_mm = 1.0
[material]
poissons_ratio = 0.0
[contact]
friction = 0.0
model = \"deformable\"
[machine]
preset = \"pin-on-disc\"
[march]
updates = 1
[accuracy]
estimate = false
",
    );
    bench.run_into("out");
    let table = bench.table("out", "kinematics.csv");
    let mean_mpa = table["axial_force_n"][0] / (PI * 4.5 * 4.5);
    let peak_mpa = table["peak_pressure_mpa"][0];
    assert!(
        (peak_mpa / mean_mpa - 1.0).abs() < 1e-6,
        "{peak_mpa} of {mean_mpa}"
    );
}

/// Condyles on a flat insert under a constant load without friction, everything still.
fn standing(medial_mm: f64, more: &str) -> Bench {
    Bench::with_case(&format!(
        "\
{more}
[insert]
shape = \"flat\"
edge_mm = 1.5
layers = 2
[contact]
friction = 0.0
[machine]
flexion_offset_deg = 0.0
frequency_hz = 0.1
vv_axis_medial_mm = {medial_mm:?}
[machine.axial_force]
knots_n = [[0, 1000]]
[machine.flexion]
waveform = \"none\"
[machine.freedoms.ap]
drive = \"locked\"
[machine.freedoms.ie]
drive = \"locked\"
[machine.freedoms.ml]
drive = \"locked\"
[march]
cycles = 1000
updates = 1
[time]
increments = 40
"
    ))
}

#[test]
fn verify_load_off_the_middle_splits_by_its_levers() {
    for (medial_mm, side) in [
        (5.0, "right"),
        (5.0, "left"),
        (0.0, "right"),
        (-8.0, "right"),
    ] {
        let bench = standing(medial_mm, &format!("side = \"{side}\""));
        bench.run_into("out");
        let (share, expected) = (
            bench.summary("out")[&catalogue::MEDIAL_LOAD_SHARE],
            (23.0 + medial_mm) / 46.0,
        );
        assert!(
            (share - expected).abs() < 5e-3 * expected,
            "{side} {medial_mm}: {share}"
        );
    }
}

/// A ball on a flat insert without friction, slowly pushed and turned; springs of the paper.
fn sprung(freedom: &str, load: &str, held: &str) -> Bench {
    Bench::with_case(&format!(
        "\
[femur]
shape = \"sphere\"
[insert]
shape = \"flat\"
edge_mm = 2.0
layers = 2
[contact]
friction = 0.0
[machine]
flexion_offset_deg = 0.0
frequency_hz = 0.01
[machine.axial_force]
knots_n = [[0, 500]]
[machine.flexion]
waveform = \"none\"
[machine.{freedom}]
{load}
[machine.freedoms.{held}]
drive = \"locked\"
[machine.freedoms.ml]
drive = \"locked\"
[machine.freedoms.vv]
drive = \"locked\"
[march]
cycles = 1000
updates = 1
[time]
increments = 200
"
    ))
}

/// The value of a column of the last cycle at a place in it.
fn at_percent(bench: &Bench, column: &str, percent: f64) -> f64 {
    let table = bench.table("out", "kinematics.csv");
    let row = table["percent"]
        .iter()
        .rposition(|at| (at - percent).abs() < 1e-9);
    table[column][row.expect("there is such an increment")]
}

#[test]
fn verify_ap_response_of_springs_with_free_play() {
    // Held at the peaks for a while, so that the damper has come to rest.
    let load = "knots_n = [[0, 0], [15, 100], [35, 100], [65, -200], [85, -200]]";
    let bench = sprung("ap_force", load, "ie");
    bench.run_into("out");
    for (percent, expected) in [(35.0, 2.5 + 100.0 / 7.24), (85.0, -2.5 - 200.0 / 33.8)] {
        let ap = at_percent(&bench, "ap_mm", percent);
        assert!((ap / expected - 1.0).abs() < 2e-3, "{ap} {expected}");
    }
}

#[test]
fn verify_ie_response_of_springs_with_free_play() {
    let load = "knots_nm = [[0, 0], [15, 4], [35, 4], [65, -3], [85, -3]]";
    let bench = sprung("ie_torque", load, "ap");
    bench.run_into("out");
    // One spring of each pair is drawn forwards, the other back: T = a (ka + kp)/2 (a sin - play) cos.
    let torque_nm = |angle_deg: f64| {
        let (sine, cosine) = angle_deg.to_radians().sin_cos();
        let stretched = 28.0 * sine.abs() - 2.5;
        28.0 * (33.8 + 7.24) / 2.0 * stretched * cosine * sine.signum() / 1000.0
    };
    for (percent, expected) in [(35.0, 4.0), (85.0, -3.0)] {
        let angle = at_percent(&bench, "ie_deg", percent);
        let torque = torque_nm(angle);
        assert!((torque / expected - 1.0).abs() < 5e-3, "{angle} {torque}");
    }
}
