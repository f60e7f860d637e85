//! `condyle new` with two meshes, and its messages about wrong axes and units.

use std::fs;

use crate::bench::Bench;
use crate::shapes::{FLEXED_A_LITTLE, Triangle, block, femur, insert, stl};

/// The triangles in a file of another unit, whose x, y and z point right, anterior and superior.
fn in_cm_right_anterior_superior(triangles: &[Triangle]) -> String {
    let turned = |[x, y, z]: [f64; 3]| [z / 10.0, x / 10.0, y / 10.0];
    let turned: Vec<Triangle> = triangles
        .iter()
        .map(|triangle| triangle.map(turned))
        .collect();
    stl(&turned)
}

fn meshes() -> Bench {
    let bench = Bench::new();
    bench.write("f.stl", &in_cm_right_anterior_superior(&femur()));
    bench.write("i.stl", &in_cm_right_anterior_superior(&insert()));
    bench
}

const NEW: [&str; 6] = ["new", "my.toml", "--femur", "f.stl", "--insert", "i.stl"];

#[test]
fn a_case_of_two_meshes_checks_and_runs_at_one_attempt() {
    let bench = meshes();
    let said = bench.say(&NEW);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.err.contains("length_unit \"cm\""), "{}", said.err);
    let text = fs::read_to_string(bench.path("my.toml")).unwrap();
    assert!(
        text.contains("# femur, concluded from the shape of f.stl:"),
        "{text}"
    );
    assert_eq!(text.matches("length_unit = \"cm\"").count(), 2, "{text}");
    let checked = bench.say(&["check", "my.toml"]);
    assert_eq!(checked.code, Some(0), "{}", checked.err);
    let short = text
        .replace("edge_mm = 1.05", "edge_mm = 2.5")
        .replace("updates = 10", "updates = 1")
        .replace("increments = 200", "increments = 40");
    let machine = short.find("[machine.flexion]").unwrap_or(short.len());
    let rest = short[machine..]
        .find("\n\n")
        .map_or("", |at| &short[machine + at..]);
    bench.write(
        "my.toml",
        &format!("{}{FLEXED_A_LITTLE}{rest}", &short[..machine]),
    );
    let ran = bench.say(&["run", "my.toml", "--out", "out"]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
}

#[test]
fn what_no_case_can_be_made_of_is_refused_and_nothing_written() {
    let bench = meshes();
    bench
        .say(&["new", "my.toml", "--femur", "f.stl"])
        .assert_refused(2, &["--insert"]);
    bench
        .say(&["new", "my.toml", "--side", "left"])
        .assert_refused(2, &["--femur"]);
    bench
        .say(&["new", "my.toml", "--femur", "none.stl", "--insert", "i.stl"])
        .assert_refused(2, &["none.stl"]);
    bench.write("f.stl", &stl(&block([0.0; 3], [0.6, 0.5, 0.7])));
    bench
        .say(&NEW)
        .assert_refused(2, &["f.stl", "0.7000 long", "scale it"]);
    assert!(!bench.path("my.toml").exists());
}

#[test]
fn an_insert_upside_down_is_refused_with_the_line_to_write() {
    let bench = meshes();
    let case = "[insert]\nshape = \"mesh\"\nfile = \"i.stl\"\nlength_unit = \"cm\"\n\
        axes = [\"left\", \"anterior\", \"inferior\"]\n";
    bench.write("case.toml", case);
    let said = bench.say(&["check", "case.toml"]);
    said.assert_refused(
        3,
        &["oriented upside down", "write axes = [\"", "case.toml:5"],
    );
    bench.write("case.toml", &case.replace("cm", "in"));
    let said = bench.say(&["check", "case.toml"]);
    said.assert_refused(2, &["write length_unit = \"cm\"", "case.toml:4"]);
}
