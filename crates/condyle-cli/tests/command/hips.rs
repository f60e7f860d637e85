//! Hips from the files of head and cup.

use condyle_mesh::{TriangleMesh, Vec3, formats::write_stl};
use condyle_results::catalogue;

use crate::bench::Bench;

/// Coarse facets around a body.
const AROUND: u32 = 36;

/// Returns points of a circle about the origin, by the angle from straight down, in steps of six degrees.
fn arc(radius: f64, from_deg: f64, to_deg: f64) -> impl Iterator<Item = (f64, f64)> {
    let steps = ((to_deg - from_deg).abs() / 6.0).round();
    (0..=steps as u32).map(move |n| {
        let angle = (from_deg + (to_deg - from_deg) * f64::from(n) / steps).to_radians();
        (radius * angle.sin(), -radius * angle.cos())
    })
}

fn cup() -> TriangleMesh {
    let profile: Vec<(f64, f64)> = arc(22.1, 1e-6, 90.0).chain(arc(14.1, 90.0, 1e-6)).collect();
    TriangleMesh::revolved(&profile, AROUND)
}

/// Returns a liner with a cylinder and a flat bottom outside, and a chamfer along its rim.
fn liner() -> TriangleMesh {
    let outside = [
        (1e-6, -21.5),
        (12.0, -21.5),
        (22.1, -14.0),
        (22.1, 0.0),
        (15.0, 0.0),
    ];
    let profile: Vec<(f64, f64)> = outside.into_iter().chain(arc(14.1, 88.0, 1e-6)).collect();
    TriangleMesh::revolved(&profile, AROUND)
}

/// Returns a ball with a bore for its neck.
fn head() -> TriangleMesh {
    let bore = [(6.0, 11.9), (5.0, 2.0), (1e-6, 2.0)];
    let profile: Vec<(f64, f64)> = arc(14.0, 1e-6, 150.0).chain(bore).collect();
    TriangleMesh::revolved(&profile, AROUND)
}

/// Writes a body in metres, turned and far from its origin.
fn write(bench: &Bench, name: &str, body: TriangleMesh) {
    let turn = condyle::Mat3::from_columns(&[
        Vec3::new(0.36, 0.48, -0.8),
        Vec3::new(-0.8, 0.6, 0.0),
        Vec3::new(0.48, 0.64, 0.6),
    ]);
    let shift = Vec3::new(120.0, -40.0, 900.0);
    let body = body.mapped(|vertex| (turn * vertex + shift) / 1000.0);
    let mut stl = Vec::new();
    write_stl(&mut stl, &body).unwrap();
    std::fs::write(bench.path(name), stl).unwrap();
}

fn mass_mg(bench: &Bench, case: &str, out: &str) -> f64 {
    let said = bench.say(&["run", case, "--out", out]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    bench.summary(out)[&catalogue::MASS_LOSS_MG]
}

#[test]
fn a_coarse_turned_pair_in_metres_wears_as_the_hip_by_dimensions() {
    let bench = Bench::new();
    for (name, body) in [
        ("head.stl", head()),
        ("cup.stl", cup()),
        ("liner.stl", liner()),
    ] {
        write(&bench, name, body);
    }
    bench.say(&["new", "plain.toml", "--joint", "hip"]);
    let plain = std::fs::read_to_string(bench.path("plain.toml")).unwrap();
    assert!(plain.contains("shape = \"cup\""));
    let exact_mg = mass_mg(&bench, "plain.toml", "plain");
    for (case, cup, tolerance) in [
        ("cup.toml", "cup.stl", 1e-3),
        ("liner.toml", "liner.stl", 0.015),
    ] {
        let said = bench.say(&["new", case, "--head", "head.stl", "--cup", cup]);
        assert!(
            said.err
                .contains("a socket of 14.100 mm radius with length_unit \"m\""),
            "{}",
            said.err
        );
        assert!(
            said.err.contains("radial clearance is 0.100 mm"),
            "{}",
            said.err
        );
        let mg = mass_mg(&bench, case, case.trim_end_matches(".toml"));
        assert!(
            (mg / exact_mg - 1.0).abs() < tolerance,
            "{cup}: {mg} {exact_mg}"
        );
    }
}

#[test]
fn bodies_that_are_no_hip_are_refused_with_the_reason() {
    let bench = Bench::new();
    let large = head().mapped(|vertex| vertex * 1.01);
    let block = TriangleMesh::block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0));
    let bodies = [
        ("head.stl", head()),
        ("cup.stl", cup()),
        ("large.stl", large),
        ("block.stl", block),
    ];
    for (name, body) in bodies {
        write(&bench, name, body);
    }
    for (head, cup, why) in [
        ("cup.stl", "head.stl", "exchange --head and --cup"),
        ("large.stl", "cup.stl", "is not larger than the head"),
        ("block.stl", "cup.stl", "no spherical ball"),
        ("head.stl", "block.stl", "no spherical socket"),
    ] {
        let said = bench.say(&["new", "hip.toml", "--head", head, "--cup", cup]);
        said.assert_refused(2, &[why]);
        assert!(!bench.path("hip.toml").exists());
    }
    bench.say(&["new", "hip.toml", "--head", "head.stl", "--cup", "cup.stl"]);
    let said = bench.say(&[
        "run",
        "hip.toml",
        "--set",
        "femur.radius_mm=14.2",
        "--out",
        "out",
    ]);
    said.assert_refused(2, &["not larger than its head"]);
}

#[test]
fn a_hip_is_described_in_its_own_words() {
    let bench = Bench::with_case(
        "[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n[insert]\nshape = \"cup\"\nedge_mm = 2.5\nlayers = 2\n\
         [machine]\npreset = \"iso-14242-1-like\"\n[march]\nupdates = 1\n[accuracy]\nestimate = false\n\
         [[activity]]\nname = \"walking\"\ncycles_in_sequence = 9\n\
         [[activity]]\nname = \"strolling\"\ncycles_in_sequence = 1\nfrequency_hz = 0.5\n",
    );
    let said = bench.say(&["check", "case.toml"]).out;
    let words = ["head ", "cup "].map(|word| said.lines().any(|line| line.starts_with(word)));
    assert!(words == [true; 2] && !said.contains("dish"), "{said}");
    let ran = bench.run_into("hip").out;
    assert!(ran.contains("measured on hip simulators"), "{ran}");
    let summary = bench.summary("hip");
    assert_eq!(summary.joint.name(), "hip");
    assert_eq!(summary.motions[0].title, "Lateral motion");
    let page = std::fs::read_to_string(bench.path("hip/report.html")).expect("a report is written");
    assert!(page.contains("cycles the cup has lost") && page.contains("+ head lateral"));
    assert!(page.contains("Deepest: <tspan") && !page.contains("Deepest medial"));
    assert!(page.contains("Wear by activity") && !page.contains("AP range"));
}
