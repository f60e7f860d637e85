//! Each call of the program, as the page makes it.

use std::{
    fs,
    path::Path,
    process::{Command, Output},
};

use condyle_case::case::Case;
use condyle_report::{Results, scene::Scene};
use serde_json::Value;

const CASE: &str = "\
[insert]
edge_mm = 3.0
layers = 1
[march]
updates = 3
[time]
increments = 40
";

fn called(folder: &Path, words: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_condyle-web"));
    let ran = program.args(words).current_dir(folder).output();
    ran.expect("the program starts")
}

/// The messages on standard output, one JSON value per line.
fn messages(output: &Output) -> Vec<Value> {
    let text = String::from_utf8(output.stdout.clone()).expect("it is text");
    let lines = text.lines();
    lines
        .map(|line| serde_json::from_str(line).expect("a line is JSON"))
        .collect()
}

fn folder_with(case: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fs::write(folder.path().join("case.toml"), case).expect("it can be written");
    folder
}

#[test]
fn what_the_page_shows_and_saves_is_the_results_folder_of_one_run() {
    let folder = folder_with(CASE);
    let ran = called(folder.path(), &["run", "case.toml", "results", "scene"]);
    assert!(ran.status.success(), "{ran:?}");
    let reached = messages(&ran);
    let updates = reached
        .iter()
        .filter_map(|line| line["reached"]["updates"].as_u64());
    assert_eq!(updates.collect::<Vec<_>>(), [0, 1, 2, 3]);
    assert_eq!(reached.last(), Some(&Value::from("estimating")));
    let out = folder.path().join("results");
    let summary = fs::read(out.join("summary.json")).expect("it was written");
    assert!(!out.join("report.html").exists());

    let reported = called(folder.path(), &["report", "results"]);
    assert!(reported.status.success(), "{reported:?}");
    assert!(out.join("report.html").exists());
    let results = Results::read(&out).expect("it is whole");
    let scene = Scene::read(&out, &results);
    assert_eq!(scene.missing, Vec::<String>::new());
    let shown = fs::read(folder.path().join("scene")).expect("it was written");
    assert!(shown == scene.to_bytes(), "the scenes differ");
    let after = fs::read(out.join("summary.json")).expect("it is there");
    assert!(after == summary, "the report has another run");
}

#[test]
fn a_wrong_case_fails_with_the_message_of_the_command() {
    const WRONG: &str = "[contact]\nfrictoin = 0.04\n";
    let folder = folder_with(WRONG);
    for words in [
        &["preview", "case.toml", "results"][..],
        &["run", "case.toml", "results", "scene"],
    ] {
        let output = called(folder.path(), words);
        assert_eq!(output.status.code(), Some(2));
        let failed = &messages(&output)[0]["failed"];
        let problems = Case::parse(WRONG, "case.toml", folder.path()).expect_err("it is wrong");
        assert_eq!(failed["message"], problems.to_string());
        let problem = &failed["problems"][0];
        assert_eq!(
            (&problem["line"], &problem["column"]),
            (&2.into(), &1.into())
        );
        assert_eq!(problem["advice"], "did you mean `friction`?");
    }
    assert!(!folder.path().join("results").exists());
}

#[test]
fn files_that_are_not_meshes_give_no_case() {
    let folder = folder_with("");
    for name in ["femur.stl", "insert.stl"] {
        fs::write(folder.path().join(name), "solid x\nnonsense").expect("it can be written");
    }
    let output = called(
        folder.path(),
        &["draft", "drafted.toml", "femur.stl", "insert.stl"],
    );
    assert_eq!(output.status.code(), Some(2));
    let message = messages(&output)[0]["failed"]["message"].to_string();
    assert!(message.contains("femur.stl:2"), "{message}");
    assert!(!folder.path().join("drafted.toml").exists());
}

#[test]
fn a_preview_is_near_the_run_and_estimates_no_errors() {
    let folder = folder_with("[insert]\nedge_mm = 2.0\nlayers = 1\n");
    let summary = |words: &[&str]| -> Value {
        let ran = called(folder.path(), words);
        assert!(ran.status.success(), "{ran:?}");
        let text = fs::read(folder.path().join("out/summary.json"));
        serde_json::from_slice(&text.expect("it was written")).expect("it is JSON")
    };
    let run = summary(&["run", "case.toml", "out", "scene"]);
    let preview = summary(&["preview", "case.toml", "out"]);
    assert!(preview["error"].is_null() && run["error"].is_object());
    assert!(preview["contact_evaluations"].as_f64() < run["contact_evaluations"].as_f64());
    for name in ["mass_loss_mg", "max_depth_mm", "peak_pressure_mpa"] {
        let [run, preview] = [&run, &preview].map(|of| of[name].as_f64().expect("it is a number"));
        assert!(
            (preview / run - 1.0).abs() < 0.1,
            "{name}: {preview}, not {run}"
        );
    }
}

#[test]
fn what_is_no_call_is_refused() {
    let folder = folder_with(CASE);
    assert_eq!(called(folder.path(), &["nonsense"]).status.code(), Some(2));
}
