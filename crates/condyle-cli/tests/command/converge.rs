//! `condyle converge`, through the front door.

use condyle_results::catalogue;
use std::fs;
use std::process::{Command, Stdio};
use std::thread::sleep;
use std::time::Duration;

use crate::bench::{Bench, assert_same_bytes, updates_kept};

/// The generic implant on a mesh just fine enough to run: for the command, not for the numbers.
const TINY: &str = "\
[insert]
edge_mm = 4.0
layers = 1
[march]
updates = 1
cycles = 500_000
[time]
increments = 20
";

const OVER: [&str; 5] = ["converge", "case.toml", "--over", "updates=4,1,2", "--out"];

fn over<'a>(out: &'a str, more: &[&'a str]) -> Vec<&'a str> {
    let mut arguments = OVER.to_vec();
    arguments.push(out);
    arguments.extend(more);
    arguments
}

#[test]
fn the_folder_has_a_default() {
    let bench = Bench::with_case(TINY);
    let said = bench.say(&OVER[..4]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(bench.path("results/case-converge/converge.svg").exists());
}

#[test]
fn runs_once_for_each_value_from_coarse_to_fine_whatever_the_threads() {
    let bench = Bench::with_case(TINY);
    let said = bench.say(&over("one", &["--threads", "1"]));
    assert_eq!(said.code, Some(0), "{}", said.err);
    for words in [
        "mass loss",
        "mm3",
        "cycles solved",
        "difference from updates = 4, %",
        "order",
        "extrapolated",
        "results in one; open one/converge.svg",
    ] {
        assert!(said.out.contains(words), "{words} in\n{}", said.out);
    }
    let table = bench.table("one", "converge.csv");
    assert_eq!(table["march.updates"], [1.0, 2.0, 4.0]);
    for (row, updates) in [1, 2, 4].into_iter().enumerate() {
        let summary = bench.summary(&format!("one/updates-{updates}"));
        assert_eq!(summary[&catalogue::UPDATES], f64::from(updates));
        assert_eq!(
            summary[&catalogue::MASS_LOSS_MG],
            table["mass_loss_mg"][row]
        );
        let finest = table["mass_loss_mg"][2];
        let difference = 100.0 * (summary[&catalogue::MASS_LOSS_MG] / finest - 1.0);
        assert_eq!(difference, table["mass_loss_difference_percent"][row]);
    }
    let picture = fs::read_to_string(bench.path("one/converge.svg")).unwrap();
    assert!(picture.starts_with("<svg") && picture.contains("march.updates"));

    let said = bench.say(&over("two", &["--threads", "3", "--json"]));
    let json = fs::read_to_string(bench.path("two/converge.json")).unwrap();
    assert_eq!(said.out, json, "{}", said.err);
    for name in ["converge.csv", "converge.json", "converge.svg"] {
        let [one, two] = ["one", "two"].map(|out| fs::read(bench.path(out).join(name)).unwrap());
        assert!(one == two, "{name}");
    }
    assert_same_bytes(&bench.path("one/updates-2"), &bench.path("two/updates-2"));
}

#[test]
fn a_length_is_finer_where_it_is_smaller() {
    let bench = Bench::with_case(TINY);
    let said = bench.say(&[
        "converge",
        "case.toml",
        "--over",
        "edge_mm=4,6",
        "--out",
        "out",
    ]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert_eq!(
        bench.table("out", "converge.csv")["insert.edge_mm"],
        [6.0, 4.0]
    );
    assert!(said.out.contains("difference from edge_mm = 4, %"));
}

#[test]
fn resume_goes_on_with_what_is_there() {
    let bench = Bench::with_case(TINY);
    assert_eq!(bench.say(&over("whole", &[])).code, Some(0));
    assert_eq!(bench.say(&over("out", &[])).code, Some(0));
    fs::remove_dir_all(bench.path("out/updates-2")).unwrap();
    fs::remove_file(bench.path("out/converge.csv")).unwrap();
    let said = bench.say(&over("out", &["--resume"]));
    assert_eq!(said.code, Some(0), "{}", said.err);
    for name in ["converge.csv", "converge.json"] {
        let [one, two] = ["whole", "out"].map(|out| fs::read(bench.path(out).join(name)).unwrap());
        assert!(one == two, "{name}");
    }
    assert_eq!(updates_kept(&bench.path("out/updates-4")), 4);
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_what_is_done_and_resume_reaches_the_same_numbers() {
    let bench = Bench::with_case(TINY);
    let arguments = ["converge", "case.toml", "--over", "updates=20,25", "--out"];
    let with = |more: &[&'static str]| [&arguments[..], more].concat();
    let mut command = bench.command(&with(&["out", "--threads", "1"]));
    command.stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().expect("it starts");
    let begun = bench.path("out/updates-25/insert_0002.vtu");
    while !begun.exists() && child.try_wait().expect("it can be asked").is_none() {
        sleep(Duration::from_micros(200));
    }
    let id = child.id().to_string();
    let sent = Command::new("kill").args(["-INT", &id]).status();
    assert!(sent.expect("kill is there").success());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(130));
    assert!(String::from_utf8_lossy(&output.stderr).contains("and --resume"));
    assert!(!bench.path("out/updates-20").exists());
    assert!(!bench.path("out/converge.csv").exists());
    for more in [&["out", "--resume"][..], &["whole"]] {
        let said = bench.say(&with(more));
        assert_eq!(said.code, Some(0), "{}", said.err);
    }
    let csv = |out: &str| fs::read(bench.path(out).join("converge.csv")).unwrap();
    assert!(csv("out") == csv("whole"));
}

#[test]
fn a_march_that_finds_its_updates_is_refined_by_its_tolerance() {
    let bench = Bench::with_case(&TINY.replace("updates = 1", "update = \"auto\""));
    let said = bench.say(&["converge", "case.toml", "--out", "out"]);
    let words = ["determines its updates", "depth_tolerance_fraction=0.1,"];
    said.assert_refused(2, &words);
    let by_path = [
        "converge",
        "case.toml",
        "--over",
        "march.updates=1,2",
        "--out",
        "out",
    ];
    bench
        .say(&by_path)
        .assert_refused(2, &["`updates` belongs to update = \"fixed\""]);
    let over = "depth_tolerance_fraction=0.2,0.001";
    let said = bench.say(&["converge", "case.toml", "--over", over, "--out", "out"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let [coarse, fine] = ["0.2", "0.001"].map(|tolerance| {
        updates_kept(
            &bench
                .path("out")
                .join(format!("depth_tolerance_fraction-{tolerance}")),
        )
    });
    assert!(coarse < fine, "{coarse} {fine}");
}

/// The command refuses `over` with these words, and makes nothing.
#[track_caller]
fn assert_refused(over: &str, words: &[&str]) {
    let bench = Bench::with_case(TINY);
    let said = bench.say(&["converge", "case.toml", "--over", over, "--out", "out"]);
    said.assert_refused(2, words);
    assert_eq!(said.out, "");
    assert!(!bench.path("out").exists());
}

#[test]
fn a_key_that_is_none_is_refused() {
    let words = ["no number called `updatse`", "did you mean `updates`?"];
    assert_refused("updatse=1,2", &words);
    let words = [
        "[march] has no key `updatse`",
        "case.toml with march.updatse = 2:9:1",
        "^^^^^^^",
        "did you mean `updates`?",
    ];
    assert_refused("march.updatse=1,2", &words);
    let words = [
        "more than one number named `spacing_mm`",
        "write `femur.spacing_mm` or `insert.spacing_mm`",
    ];
    assert_refused("spacing_mm=40,41", &words);
    assert_refused(
        "contact.foundation.law=1,2",
        &["`law` must be", "this is an integer"],
    );
}

#[test]
fn a_value_that_is_none_is_refused() {
    let words = [
        "`updates` is 0, outside its range",
        "case.toml with march.updates = 0:9:17",
        "^",
        "it can be 1 to 10000",
    ];
    assert_refused("updates=2,0", &words);
    let words = [
        "`increments` must be a whole number",
        "case.toml with time.increments = 40.5:9:19",
    ];
    assert_refused("increments=30,40.5", &words);
    let words = [
        "`ten` is not a valid value of `march.updates`",
        "write a number",
    ];
    assert_refused("updates=1,ten", &words);
}

#[test]
fn fewer_than_two_values_are_refused() {
    let words = [
        "`updates` has one value",
        "write them as `updates=10,20,40`",
    ];
    assert_refused("updates=1", &words);
    assert_refused("updates=", &["`updates` has no value"]);
    assert_refused(
        "updates=2,2.0",
        &["has the value 2 twice", "write each once"],
    );
    for written in ["updates", "=1,2"] {
        assert_refused(written, &["is not a key with values", "`updates=1,2,5,10`"]);
    }
}

#[test]
fn a_folder_that_holds_something_is_refused() {
    let bench = Bench::with_case(TINY);
    fs::create_dir(bench.path("out")).unwrap();
    bench.write("out/mine.txt", "mine");
    let said = bench.say(&over("out", &[]));
    said.assert_refused(2, &["out: the folder is not empty", "--out", "--resume"]);
    assert_eq!(fs::read_dir(bench.path("out")).unwrap().count(), 1);
    bench.write("file", "mine");
    bench.say(&over("file", &[])).assert_refused(2, &["file: "]);
}

#[test]
fn a_case_that_is_wrong_is_shown_as_ever() {
    let bench = Bench::with_case("[march]\ncycels = 5\n");
    let said = bench.say(&over("out", &[]));
    said.assert_refused(2, &["[march] has no key `cycels`", "case.toml:2:1", "^"]);
    let said = bench.say(&["converge", "nowhere.toml", "--out", "out"]);
    said.assert_refused(2, &["the file nowhere.toml cannot be read"]);
}

#[test]
fn physics_that_fails_names_the_value() {
    let bench = Bench::with_case(&TINY.replace("500_000", "2_000_000_000"));
    let said = bench.say(&over("out", &[]));
    said.assert_refused(3, &["in the run with march.updates = 1:", "worn through"]);
    assert!(!bench.path("out/converge.csv").exists());
}

#[test]
fn help_says_how_a_key_is_given() {
    let said = Bench::new().say(&["converge", "--help"]);
    assert_eq!(said.code, Some(0));
    let words = said.out.split_whitespace().collect::<Vec<_>>().join(" ");
    for expected in [
        "Run a case with finer and finer values of one of its numbers",
        "insert.edge_mm=2,1,0.5",
        "[default: updates=1,2,5,10,20,40]",
        "it must be empty",
        "the results do not depend on it",
    ] {
        assert!(words.contains(expected), "{expected} in\n{}", said.out);
    }
}
