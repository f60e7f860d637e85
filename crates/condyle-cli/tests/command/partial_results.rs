//! The report of a results folder that is incomplete, damaged, or of another version.

use std::fs;

use crate::bench::{Bench, SMALL};

/// Every file of a run that its report reads, and a heading that is not there without it.
const FILES: [&str; 12] = [
    "summary.json",
    "wear.csv",
    "kinematics.csv",
    "slip_paths.csv",
    "case.toml",
    "insert_0000.vtu",
    "insert_0002.vtu",
    "insert_0003.vtu",
    "femur.vtu",
    "femur_pose.csv",
    "cycle_first_pressure.csv",
    "cycle_last_pressure.csv",
];

/// Asserts that the page names a file as not shown whole, and has what is of all the others.
#[track_caller]
fn says(bench: &Bench, name: &str, how: &str) {
    let said = bench.say(&["report", "out"]);
    assert_eq!(said.code, Some(0), "{name} {how}: {}", said.err);
    let page = fs::read_to_string(bench.path("out/report.html")).expect("the page is there");
    let before = page.split("<h2>").next().unwrap_or_default();
    let is_last_mesh = name == "insert_0003.vtu";
    let is_named = before.contains(name) || (is_last_mesh && before.contains("insert_*.vtu"));
    assert!(is_named, "{name} {how}: the page does not name it");
    let headings = [
        ("Wear on the surface", "insert_0003.vtu"),
        ("Wear over the test", "wear.csv"),
        ("Motion and load in a", "kinematics.csv"),
        ("All numbers", "summary.json"),
        ("The case file with every default", "case.toml"),
    ];
    for (heading, of) in headings {
        // Without its last mesh a run shows the one before.
        let is_shown = page.contains(heading);
        assert!(
            is_shown || of == name,
            "{name} {how}: {heading} is not shown"
        );
    }
}

#[test]
fn a_folder_without_one_file_or_with_one_cut_short_is_shown_and_the_page_says_so() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    for name in FILES {
        let path = bench.path("out").join(name);
        let whole = fs::read(&path).expect("the run wrote it");
        fs::remove_file(&path).expect("can be removed");
        // The report takes what a run keeps there for a part of it.
        says(&bench, name, "removed");
        for part in [0, whole.len() / 3, whole.len() - 1] {
            fs::write(&path, &whole[..part]).expect("can be written");
            if name != "case.toml" || part != 0 {
                says_or_is_whole(&bench, name, part, whole.len());
            }
        }
        fs::write(&path, &whole).expect("can be written");
    }
    let said = bench.say(&["report", "out"]);
    assert!(said.code == Some(0) && said.err.is_empty(), "{}", said.err);
}

/// A file without its last line end may still be whole.
#[track_caller]
fn says_or_is_whole(bench: &Bench, name: &str, part: usize, whole: usize) {
    let is_whole_without = name == "summary.json" && part + 1 == whole;
    if !is_whole_without {
        says(bench, name, &format!("cut to {part} bytes"));
    }
}

#[test]
fn a_run_of_another_version_or_cut_at_a_line_is_told_of() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    let page = |name: &str, change: fn(&str) -> String| {
        let path = bench.path("out").join(name);
        let whole = fs::read_to_string(&path).expect("the run wrote it");
        fs::write(&path, change(&whole)).expect("can be written");
        assert_eq!(bench.say(&["report", "out"]).code, Some(0));
        fs::write(&path, whole).expect("can be written");
        fs::read_to_string(bench.path("out/report.html")).expect("the page is there")
    };
    let version = format!("\"version\": \"{}\"", env!("CARGO_PKG_VERSION"));
    let summary = fs::read_to_string(bench.path("out/summary.json")).expect("is there");
    assert!(summary.contains(&version));
    let older = page("summary.json", |text| {
        text.replace(env!("CARGO_PKG_VERSION"), "0.0.9")
    });
    assert!(older.contains("The run is from condyle 0.0.9"));
    fn without_last_line(text: &str) -> String {
        let end = text.trim_end().rfind('\n').map_or(0, |end| end + 1);
        text[..end].to_owned()
    }
    let wear = page("wear.csv", without_last_line);
    assert!(wear.contains("states 3 updates, and wear.csv has 2"));
    let kinematics = page("kinematics.csv", without_last_line);
    assert!(kinematics.contains("has a cycle of 49"));
}

#[test]
fn a_folder_of_which_nothing_can_be_read_is_refused_with_the_reasons() {
    let bench = Bench::new();
    fs::create_dir(bench.path("out")).expect("can be made");
    bench.write("out/summary.json", "{");
    bench.write("out/wear.csv", "cycles,mass_loss_mg\n1");
    let said = bench.say(&["report", "out"]);
    said.assert_refused(
        2,
        &[
            "Nothing in the folder",
            "summary.json",
            "wear.csv",
            "cut short",
        ],
    );
}
