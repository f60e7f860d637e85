//! Machines by joints at the command: their list, their files, their reports.

use crate::bench::{Bench, SMALL};

const ORBITAL: &str = "[femur]\nshape = \"sphere\"\nradius_mm = 14.0\n\
                       [insert]\nshape = \"cup\"\nedge_mm = 2.5\nlayers = 2\n\
                       [machine]\npreset = \"iso-14242-3-like\"\n\
                       [march]\nupdates = 24\n[time]\nincrements = 50\n[accuracy]\nestimate = false\n";

#[test]
fn the_report_of_a_hip_has_a_curve_of_every_joint() {
    let bench = Bench::with_case(ORBITAL);
    bench.run_into("out");
    let report = std::fs::read_to_string(bench.path("out/report.html")).unwrap();
    for joint in [
        "lateral_mm",
        "anterior_mm",
        "penetration_mm",
        "orbit_deg",
        "tilt_deg",
        "counter_deg",
    ] {
        assert!(report.contains(&format!("id=\"k-{joint}")), "{joint}");
    }
    assert!(!report.contains("insert anterior"));
}

#[test]
fn machines_are_listed_shown_and_checked() {
    let bench = Bench::new();
    let listed = bench.say(&["machine", "list"]).out;
    let presets: Vec<&str> = listed
        .lines()
        .filter_map(|line| line.split(' ').next())
        .collect();
    assert!(presets.contains(&"stanmore-force") && presets.contains(&"iso-22622-like"));
    for preset in presets {
        let shown = bench.say(&["machine", "show", preset]).out;
        bench.write("rig.toml", &shown);
        let checked = bench.say(&["machine", "check", "rig.toml"]).out;
        assert!(
            checked.contains("the machine is good"),
            "{preset}: {checked}"
        );
    }
}

/// Returns the lines of a file of results without those of computing time and inputs.
fn computed(bench: &Bench, file: &str) -> Vec<String> {
    let bytes = std::fs::read(bench.path(file)).unwrap();
    let text = String::from_utf8_lossy(&bytes);
    let lines = text.lines().map(str::to_owned);
    lines
        .filter(|line| !line.contains("wall_s") && !line.contains("inputs_blake3"))
        .collect()
}

#[test]
fn a_shown_knee_simulator_has_the_results_of_its_preset() {
    for preset in ["stanmore-force", "stanmore-displacement"] {
        let bench = Bench::new();
        bench.write("rig.toml", &bench.say(&["machine", "show", preset]).out);
        for (out, machine) in [
            ("by-file", "file = \"rig.toml\"".to_owned()),
            ("by-word", format!("preset = {preset:?}")),
        ] {
            bench.write("case.toml", &format!("{SMALL}[machine]\n{machine}\n"));
            bench.run_into(out);
        }
        let files = [
            "wear.csv",
            "kinematics.csv",
            "insert_0001.vtu",
            "summary.json",
        ];
        for file in files {
            let [by_file, by_word] =
                ["by-file", "by-word"].map(|out| computed(&bench, &format!("{out}/{file}")));
            assert_eq!(by_file, by_word, "{preset}: {file}");
        }
        let summary = computed(&bench, "by-file/summary.json").concat();
        assert!(summary.contains("\"ap_range_mm\"") && summary.contains("medial"));
    }
}

#[test]
fn a_machine_that_cannot_press_is_refused_with_its_line() {
    let bench = Bench::new();
    let shown = bench.say(&["machine", "show", "iso-14242-1-like"]).out;
    bench.write(
        "rig.toml",
        &shown.replace(
            "axis = [0, -1, 0]\ndrive = \"loaded\"",
            "axis = [1, 0, 0]\ndrive = \"loaded\"",
        ),
    );
    let said = bench.say(&["machine", "check", "rig.toml"]);
    said.assert_refused(2, &["one joint that presses", "rig.toml:"]);
}
