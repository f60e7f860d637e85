//! What `condyle check` says of a case, and the picture it draws.

use std::fs;

use crate::bench::{Bench, SMALL};

#[test]
fn check_tells_bodies_pose_contact_and_what_a_run_needs() {
    let bench = Bench::with_case(SMALL);
    let said = bench.say(&["check", "case.toml"]);
    let expected = [
        "femur                       generic",
        "insert                      generic",
        "  size AP, SI, ML           46.0 x ",
        "hexahedra, ",
        "worst quality",
        "  thickness over the dishes 9.",
        "settled                     flexion -7.0 deg, VV ",
        "  flexion axis",
        "  contact",
        "a run needs                 about ",
        " MB of 2000 MB",
    ];
    for words in expected {
        assert!(said.out.contains(words), "{words} in\n{}", said.out);
    }
}

#[test]
fn check_gives_the_same_as_json() {
    let bench = Bench::with_case(SMALL);
    let said = bench.say(&["check", "case.toml", "--json"]);
    let json: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    assert_eq!(json["insert"]["size_mm"][0], 46.0);
    assert_eq!(json["at_rest"]["flexion_deg"], -7.0);
    // 5 mm medial of the middle between dishes 46 mm apart: 28 of 46 parts.
    let medial = json["at_rest"]["medial_load_share"].as_f64().unwrap();
    assert!((medial - 28.0 / 46.0).abs() < 0.01, "{medial}");
    assert!(json["femur"]["defects"].as_array().unwrap().is_empty());
    assert!(json["expected"]["memory_mb"].as_f64().unwrap() > 1.0);
}

#[test]
fn check_draws_both_bodies() {
    let bench = Bench::with_case(&format!("title = \"A < B\"\nside = \"left\"\n{SMALL}"));
    let said = bench.say(&["check", "case.toml", "--picture", "bodies.svg"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let svg = fs::read_to_string(bench.path("bodies.svg")).unwrap();
    assert!(svg.contains("A &lt; B") && svg.contains("From the medial side"));
    assert!(svg.len() < 1_000_000, "{}", svg.len());
    let nowhere = bench.say(&["check", "case.toml", "--picture", "no/bodies.svg"]);
    assert_eq!(nowhere.code, Some(2));
    assert!(nowhere.err.contains("no/bodies.svg") && nowhere.err.contains("choose another"));
}

#[test]
fn a_run_that_needs_too_much_memory_is_refused_before_it_begins() {
    let bench = Bench::with_case(SMALL);
    for command in ["check", "run"] {
        let much = ["--set", "increments=100000", "--set", "memory_gb=0.5"];
        let said = bench.say(&[&[command, "case.toml"][..], &much].concat());
        said.assert_refused(2, &["GB of memory", "[limits] memory_gb allows 0.5 GB"]);
    }
    let fine = bench.say(&[
        "check",
        "case.toml",
        "--set",
        "insert.edge_mm=0.1",
        "--set",
        "layers=40",
    ]);
    fine.assert_refused(2, &["the insert would have", "[limits] memory_gb"]);
    assert_eq!(fs::read_dir(bench.path(".")).unwrap().count(), 1);
}
