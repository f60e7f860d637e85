//! `condyle sensitivity`, through the front door.

use condyle_results::catalogue;
use serde_json::Value;

use crate::bench::Bench;

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

fn study(bench: &Bench, threads: &str) -> (Value, String) {
    let said = bench.say(&["sensitivity", "case.toml", "--json", "--threads", threads]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let json = serde_json::from_str(&said.out).expect("JSON");
    (json, said.out)
}

#[test]
fn each_assumption_is_changed_alone_and_the_threads_do_not_matter() {
    let bench = Bench::with_case(TINY);
    let (found, text) = study(&bench, "1");
    assert_eq!(text, study(&bench, "4").1);
    let rows = found["changed"].as_array().expect("rows");
    let half = rows
        .iter()
        .find(|row| row["assumption"] == "friction" && row["change"] == "x 0.5")
        .expect("friction is an assumption");
    assert_eq!(half["set"], serde_json::json!(["contact.friction=0.035"]));
    let run = [
        "run",
        "case.toml",
        "--set",
        "contact.friction=0.035",
        "--out",
        "half",
    ];
    assert_eq!(bench.say(&run).code, Some(0));
    assert_eq!(
        half["found"]["mass_loss_mg"],
        bench.summary("half")[&catalogue::MASS_LOSS_MG]
    );
}

#[test]
fn what_a_case_does_not_use_is_said_to_be_without_effect() {
    let said = Bench::with_case(TINY).say(&["sensitivity", "case.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.starts_with("| assumption "), "{}", said.out);
    assert!(said.out.contains("| thickness: +1 mm "), "{}", said.out);
    let text = format!("{TINY}[machine]\npreset = \"stanmore-displacement\"\n");
    let said = Bench::with_case(&text).say(&["sensitivity", "case.toml"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.out.contains("\nWithout effect here: "), "{}", said.out);
    assert!(!said.out.contains("| sign of AP force"), "{}", said.out);
}

#[test]
fn a_case_that_cannot_be_run_is_an_error() {
    let said = Bench::with_case("[contact]\nfriction = 9\n").say(&["sensitivity", "case.toml"]);
    said.assert_refused(2, &["outside its range"]);
}
