//! What the command says, and where.

use condyle_results::catalogue;
use std::fs;

use condyle_results::Summary;

use crate::bench::{Bench, SMALL};

#[test]
fn json_is_all_there_is_on_standard_output() {
    let bench = Bench::with_case(SMALL);
    let said = bench.say(&["run", "case.toml", "--out", "out", "--json"]);
    let summary: Summary = serde_json::from_str(&said.out).expect("it is one JSON value");
    assert_eq!(summary, bench.summary("out"));
    let again = bench.say(&["run", "case.toml", "--out", "out", "--json", "--resume"]);
    assert_eq!(again.out, said.out);
}

#[test]
fn progress_is_a_plain_line_an_update_where_there_is_no_terminal() {
    let bench = Bench::with_case(SMALL);
    let said = bench.run_into("out");
    let lines: Vec<&str> = said.err.lines().collect();
    assert_eq!(lines.len(), 3, "{}", said.err);
    assert!(lines[0].starts_with("1666667 cycles: ") && lines[2].starts_with("5000000 cycles: "));
    assert!(
        lines
            .iter()
            .all(|line| line.contains(" mg worn, ") && line.is_ascii())
    );
    assert!(!said.err.contains('\r') && !said.err.contains('\x1b'));
}

#[test]
fn the_table_at_the_end_is_short_and_has_units() {
    let bench = Bench::with_case(SMALL);
    let said = bench.run_into("out");
    // Doubts, notes and the table of laws are indented or named.
    let is_aside = |line: &str| {
        ["doubtful: ", "note: ", "   "]
            .iter()
            .any(|start| line.starts_with(start))
    };
    assert!(
        said.out.lines().filter(|line| !is_aside(line)).count() < 20,
        "{}",
        said.out
    );
    let summary = bench.summary("out");
    let expected = [
        format!("{:.2} mg", summary[&catalogue::MASS_LOSS_MG]),
        format!("{:.4} mm", summary[&catalogue::MAX_DEPTH_MM]),
        "cycles                      5000000".to_owned(),
        format!("{}, ", summary[&catalogue::NEWTON_ITERATIONS]),
        format!(
            "{:.0} a cycle",
            summary[&catalogue::CONTACT_EVALUATIONS_PER_CYCLE]
        ),
        "results in out; open out/report.html".to_owned(),
    ];
    for words in expected {
        assert!(said.out.contains(&words), "{words} in\n{}", said.out);
    }
}

#[test]
fn check_says_that_a_case_is_good_and_makes_nothing() {
    let bench = Bench::with_case(SMALL);
    let said = bench.say(&["check", "case.toml"]);
    assert_eq!((said.code, said.err.as_str()), (Some(0), ""));
    let (rows, last) = said.out.trim_end().rsplit_once('\n').unwrap();
    assert_eq!(last, "case.toml: the case is good");
    assert!(rows.lines().all(|row| row.len() < 90), "{rows}");
    let printed = bench.say(&["check", "case.toml", "--print"]).out;
    assert!(printed.contains("edge_mm = 2.5") && printed.contains("friction = 0.07"));
    assert_eq!(fs::read_dir(bench.path(".")).unwrap().count(), 1);
    bench.write("case.toml", &printed);
    assert_eq!(bench.say(&["check", "case.toml", "--print"]).out, printed);
}

#[test]
fn new_writes_a_case_that_runs() {
    for preset in ["stanmore-force", "stanmore-displacement"] {
        let bench = Bench::new();
        let said = bench.say(&["new", "case.toml", "--preset", preset]);
        assert_eq!(said.code, Some(0), "{}", said.err);
        assert!(said.out.contains("condyle run case.toml"));
        let text = fs::read_to_string(bench.path("case.toml")).unwrap();
        assert!(text.contains(&format!("preset = \"{preset}\"")));
        let schema = text.lines().next().unwrap().strip_prefix("#:schema ");
        let schema = fs::read_to_string(bench.path(schema.unwrap())).unwrap();
        assert_eq!(schema, bench.say(&["schema"]).out);
        let short = text
            .replace("edge_mm = 1.05", "edge_mm = 2.5")
            .replace("updates = 10", "updates = 1")
            .replace("increments = 200", "increments = 40");
        bench.write("case.toml", &short);
        bench.run_into("out");
        assert_eq!(bench.summary("out")[&catalogue::UPDATES], 1.0);
        assert!(bench.summary("out")[&catalogue::HEXAHEDRA] < 2600.0);
    }
}

#[test]
fn new_never_writes_over_a_file() {
    let bench = Bench::with_case("mine");
    let said = bench.say(&["new", "case.toml"]);
    said.assert_refused(2, &["case.toml", "choose another name"]);
    assert_eq!(fs::read_to_string(bench.path("case.toml")).unwrap(), "mine");
    let said = bench.say(&["new", "no/such/folder/case.toml"]);
    said.assert_refused(2, &["no/such/folder/case.toml"]);
}

#[test]
fn report_writes_the_page_again_and_the_pictures() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    let page = fs::read(bench.path("out/report.html")).unwrap();
    fs::remove_file(bench.path("out/report.html")).unwrap();
    let said = bench.say(&["report", "out"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert_eq!(fs::read(bench.path("out/report.html")).unwrap(), page);
    let said = bench.say(&["report", "out", "--pictures"]);
    for name in ["wear_map.svg", "wear.svg", "kinematics.svg"] {
        assert!(said.out.contains(name), "{}", said.out);
        let picture = fs::read_to_string(bench.path("out").join(name)).unwrap();
        assert!(
            picture.starts_with("<svg") || picture.starts_with("<?xml"),
            "{name}"
        );
    }
}

#[test]
fn report_of_no_results_is_refused() {
    let bench = Bench::new();
    bench.say(&["report", "out"]).assert_refused(2, &["out"]);
    fs::create_dir(bench.path("out")).unwrap();
    bench.say(&["report", "out"]).assert_refused(2, &["out"]);
    assert_eq!(fs::read_dir(bench.path("out")).unwrap().count(), 0);
}
