//! A bad case file: said with file, line, caret and advice; exit code 2, and nothing is made.

use crate::bench::Bench;

/// The command refuses `text` at `place`, with these words.
#[track_caller]
fn assert_refused(text: &str, place: &str, words: &[&str]) {
    assert_bench_refused(&Bench::with_case(text), place, words);
}

#[track_caller]
fn assert_bench_refused(bench: &Bench, place: &str, words: &[&str]) {
    for arguments in [
        &["run", "case.toml", "--out", "out"][..],
        &["check", "case.toml"],
    ] {
        let said = bench.say(arguments);
        let mut first: Vec<&str> = words[..1].to_vec();
        first.extend([place, "^"]);
        said.assert_refused(2, &first);
        said.assert_refused(2, words);
        assert_eq!(said.out, "");
    }
    assert!(!bench.path("out").exists());
}

#[test]
fn unknown_key() {
    let words = ["[femur] has no key `radus_mm`", "did you mean `radius_mm`?"];
    let text = "[femur]\nshape = \"sphere\"\nradus_mm = 24.0\n";
    assert_refused(text, "case.toml:3:1", &words);
}

#[test]
fn wrong_type() {
    let words = ["`updates` must be", "this is text in quotes"];
    assert_refused("[march]\nupdates = \"ten\"\n", "case.toml:2:11", &words);
}

#[test]
fn wrong_unit() {
    let words = ["the key is `edge_mm`", "write `edge_mm = 1"];
    assert_refused("[insert]\nedge_cm = 0.1\n", "case.toml:2:1", &words);
    let words = ["`length_unit` cannot be \"feet\"", "\"mm\""];
    let text = "[femur]\nshape = \"mesh\"\nfile = \"case.toml\"\nlength_unit = \"feet\"\n";
    assert_refused(text, "case.toml:4:15", &words);
}

#[test]
fn value_out_of_range() {
    let words = ["outside its range", "it can be 0 to 0.499"];
    assert_refused(
        "[material]\npoissons_ratio = 0.5\n",
        "case.toml:2:18",
        &words,
    );
}

#[test]
fn updates_that_do_not_go_together() {
    let words = ["`update` cannot be \"sometimes\"", "\"fixed\" or \"auto\""];
    assert_refused(
        "[march]\nupdate = \"sometimes\"\n",
        "case.toml:2:10",
        &words,
    );
    let words = ["`updates` belongs to update = \"fixed\"", "remove it"];
    let text = "[march]\nupdate = \"auto\"\nupdates = 5\n";
    assert_refused(text, "case.toml:3:1", &words);
    let words = ["belongs to update = \"auto\"", "write `update = \"auto\"`"];
    let text = "[march]\ndepth_tolerance_fraction = 0.1\n";
    assert_refused(text, "case.toml:2:1", &words);
    let words = ["is 0, outside its range", "it can be 1e-5 to 0.5"];
    let text = "[march]\nupdate = \"auto\"\ndepth_tolerance_fraction = 0\n";
    assert_refused(text, "case.toml:3:28", &words);
    let words = ["`estimate` must be true or false", "text in quotes"];
    assert_refused("[accuracy]\nestimate = \"no\"\n", "case.toml:2:12", &words);
}

#[test]
fn missing_file() {
    let words = ["there is no file", "nowhere.stl", "correct the path"];
    let text = "[insert]\nshape = \"mesh\"\nfile = \"nowhere.stl\"\n";
    assert_refused(text, "case.toml:3:8", &words);
}

#[test]
fn missing_case_file() {
    let bench = Bench::new();
    let said = bench.say(&["run", "case.toml", "--out", "out"]);
    said.assert_refused(2, &["the file case.toml cannot be read"]);
    assert!(!bench.path("out").exists());
}

#[test]
fn knots_with_a_gap_or_a_nan() {
    let knots =
        |points: &str, more: &str| format!("[machine.flexion]\n{more}knots_deg = [\n{points}]\n");
    let words = ["gap from 20 % to 90 %", "add points, at most"];
    let samples = "[0, 0], [10, 1], [20, 2],\n[90, 1], [100, 0],\n";
    let text = knots(samples, "interpolation = \"spline\"\n");
    assert_refused(&text, "case.toml:4:", &words);
    let words = ["is not a finite number", "correct or remove it"];
    let text = knots("[0, 0],\n[50, nan],\n[100, 0],\n", "");
    assert_refused(&text, "case.toml:4:", &words);
}

#[test]
fn csv_with_a_gap_or_a_nan() {
    let text = "[machine.axial_force]\nfile = \"wave.csv\"\n";
    let bench = Bench::with_case(text);
    let row = |percent: u32| format!("{percent},500\n");
    let with_gap: String = (0..=100)
        .step_by(5)
        .filter(|percent| !(30..60).contains(percent))
        .map(row)
        .collect();
    bench.write("wave.csv", &format!("percent,axial_force_n\n{with_gap}"));
    let words = ["gap from 25 % to 60 %", "add points, at most"];
    assert_bench_refused(&bench, "wave.csv:7:1", &words);
    let rows: String = (0..=100).step_by(5).map(row).collect();
    let with_nan = rows.replace("10,500", "10,NaN");
    bench.write("wave.csv", &format!("percent,axial_force_n\n{with_nan}"));
    let words = ["`NaN` in column `axial_force_n`", "write a number there"];
    assert_bench_refused(&bench, "wave.csv:4:4", &words);
}

#[test]
fn every_problem_is_said_at_once() {
    let bench = Bench::with_case("[march]\nupdates = 0\ncycels = 5\n[material]\ndensity = 1\n");
    let said = bench.say(&["run", "case.toml"]);
    let words = [
        "updates",
        "case.toml:2",
        "cycels",
        "case.toml:3",
        "density",
        "case.toml:5",
    ];
    said.assert_refused(2, &words);
}

#[test]
fn of_very_many_problems_the_rest_is_counted() {
    let keys: String = (0..20_000)
        .map(|key| format!("wrong_{key} = 1\n"))
        .collect();
    let said = Bench::with_case(&format!("[march]\n{keys}")).say(&["check", "case.toml"]);
    said.assert_refused(2, &["`wrong_0`", "and 19980 more problems"]);
    assert!(said.err.lines().count() < 200, "{}", said.err);
}

#[test]
fn control_characters_are_shown_as_escapes() {
    let said = |text: &str| Bench::with_case(text).say(&["check", "case.toml"]);
    let key = said("[contact]\n\"\\u001b[31mfriction\" = 0.07\n");
    key.assert_refused(2, &["`\\u{1b}[31mfriction`"]);
    let value = said("[contact.foundation]\nlaw = \"\\u0007linear\"\n");
    value.assert_refused(2, &["\\u{7}linear"]);
    let bench = Bench::with_case("");
    let name = bench.say(&["check", "no\u{1b}[31m.toml"]);
    name.assert_refused(2, &["no\\u{1b}[31m.toml"]);
    for said in [key, value, name] {
        assert!(!said.err.contains(['\u{1b}', '\u{7}']), "{:?}", said.err);
    }
}

#[test]
fn another_word_for_a_key() {
    let words = ["[contact] has no key `mu`", "did you mean `friction`?"];
    assert_refused("[contact]\nmu = 0.07\n", "case.toml:2:1", &words);
}

#[test]
fn words_the_command_does_not_know() {
    let bench = Bench::new();
    for arguments in [
        &["walk"][..],
        &["run"],
        &["run", "case.toml", "--threads", "0"],
        &["new", "case.toml", "--preset", "leeds"],
    ] {
        assert_eq!(bench.say(arguments).code, Some(2), "{arguments:?}");
    }
}
