//! A pressure law that follows the deformable insert.

use std::fs;

use serde_json::Value;

use crate::bench::{Bench, SMALL};

fn number(value: &Value) -> f64 {
    value.as_f64().expect("a number")
}

#[test]
fn verify_the_table_follows_the_deformable_insert_and_a_run_says_how_well() {
    // By Archard's law the mass depends on force and slip alone, and not on the pressure.
    let bench = Bench::with_case(&format!("{SMALL}[wear]\nlaw = \"archard\"\n"));
    let said = bench.say(&["calibrate", "case.toml", "--out", "fitted", "--json"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let json: Value = serde_json::from_str(&said.out).expect("it prints JSON and nothing else");
    let off = |left: &str, what: &str| number(&json[left]["first_cycle"][what]["mean_percent"]);
    assert!(off("left_before", "peak_pressure") > 20.0, "{json:#}");
    assert!(off("left", "peak_pressure") < 8.0, "{json:#}");
    assert!(off("left", "contact_area") < 8.0, "{json:#}");
    assert!(
        number(&json["left"]["mass_loss_percent"]).abs() < 3.0,
        "{json:#}"
    );
    let motions = &json["left"]["first_cycle_motions"];
    assert!(number(&motions["ap_mm"]) < 0.5, "{json:#}");
    assert!(number(&motions["ie_deg"]) < 0.5, "{json:#}");
    for (name, part) in [
        (
            "pressure_table.csv",
            "overclosure_over_thickness,pressure_mpa\n0.0,0.0\n",
        ),
        ("calibration.md", "# Calibrated pressure law"),
        ("case.toml", "law = \"tabulated-strain\""),
    ] {
        let text = fs::read_to_string(bench.path("fitted").join(name)).unwrap();
        assert!(text.contains(part), "{name}:\n{text}");
    }
    let run = bench.say(&["run", "fitted/case.toml", "--out", "out"]);
    assert_eq!(run.code, Some(0), "{}", run.err);
    let percent = number(&json["peak_error_percent"]);
    let line = run
        .out
        .lines()
        .find(|line| line.starts_with("peak error of the pressure law"));
    let line = line.expect("the run states the error of its law");
    assert!(line.ends_with(&format!("{percent:.1} %")), "{line}");
    let summary: Value =
        serde_json::from_str(&fs::read_to_string(bench.path("out/summary.json")).unwrap()).unwrap();
    assert_eq!(number(&summary["pressure_law_peak_error_percent"]), percent);
}

#[test]
fn a_folder_that_is_there_and_a_case_that_is_none_are_refused() {
    let bench = Bench::with_case(SMALL);
    fs::create_dir(bench.path("there")).unwrap();
    let said = bench.say(&["calibrate", "case.toml", "--out", "there"]);
    assert_eq!(said.code, Some(2));
    assert!(said.err.contains("replace it with --force"), "{}", said.err);
    let said = bench.say(&["calibrate", "none.toml", "--out", "new"]);
    assert_eq!(said.code, Some(2));
    assert!(!bench.path("new").exists());
    let activities = "[femur]\nshape = \"plane\"\n[insert]\nshape = \"pin\"\n[machine]\npreset = \"pin-on-disc\"\n\
                      [[activity]]\nname = \"a\"\nshare = 0.5\n[[activity]]\nname = \"b\"\nshare = 0.5\n";
    bench.write("activities.toml", activities);
    let said = bench.say(&["calibrate", "activities.toml", "--out", "new"]);
    assert_eq!(said.code, Some(2));
    assert!(said.err.contains("fitted to one activity"), "{}", said.err);
    assert!(!bench.path("new").exists());
}

#[test]
fn what_a_killed_calibration_left_does_not_block_the_next() {
    let bench = Bench::with_case(&format!("{SMALL}[wear]\nlaw = \"archard\"\n"));
    fs::create_dir(bench.path("fitted.part")).unwrap();
    bench.write("fitted.part/pressure_table.csv", "half");
    for more in [&[][..], &["--force"]] {
        let said = bench.say(&[&["calibrate", "case.toml", "--out", "fitted"], more].concat());
        assert_eq!(said.code, Some(0), "{}", said.err);
        let table = fs::read_to_string(bench.path("fitted/pressure_table.csv")).unwrap();
        assert!(table.starts_with("overclosure_over_thickness,"), "{table}");
        assert!(!bench.path("fitted.part").exists());
        bench.write("fitted/pressure_table.csv", "old");
    }
}
