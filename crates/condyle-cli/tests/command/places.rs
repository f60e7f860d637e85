//! What is kept names no place of one machine.

use std::fs;
use std::path::Path;

use crate::bench::{Bench, SMALL, assert_same_bytes, files_but_wall_time};
use crate::shapes::{FLEXED_A_LITTLE, femur, insert, inside_out, stl};

/// A coarse implant of triangles that is put right with a warning; its meshes are in a folder.
fn bench() -> Bench {
    let meshes = "[femur]\nshape = \"mesh\"\nfile = \"meshes/femur.stl\"\n";
    let insert_mesh = format!("{meshes}[insert]\nshape = \"mesh\"\nfile = \"meshes/insert.stl\"");
    let text = SMALL
        .replace("[insert]", &insert_mesh)
        .replace("edge_mm = 2.5", "edge_mm = 1.5")
        .replace("updates = 3", "updates = 1")
        + FLEXED_A_LITTLE
        + "[accuracy]\nestimate = false\n";
    let bench = Bench::with_case(&text);
    fs::create_dir(bench.path("meshes")).unwrap();
    bench.write("meshes/femur.stl", &stl(&femur()));
    bench.write("meshes/insert.stl", &stl(&inside_out(insert())));
    bench
}

/// Runs the case by its absolute path into the folder at `out`.
fn run(bench: &Bench, out: &Path) {
    let case = bench.path("case.toml").display().to_string();
    let said = bench.say(&["run", &case, "--out", &out.display().to_string()]);
    assert_eq!(said.code, Some(0), "{}", said.err);
}

#[test]
fn no_file_of_a_run_names_an_absolute_path() {
    let bench = bench();
    run(&bench, &bench.path("results/out"));
    let place = fs::canonicalize(bench.path(".")).unwrap();
    let place = place.display().to_string();
    for (name, bytes) in files_but_wall_time(&bench.path("results/out")) {
        let text = String::from_utf8_lossy(&bytes);
        assert!(!text.contains(&place), "{name}");
    }
    let case = fs::read_to_string(bench.path("results/out/case.toml")).unwrap();
    assert!(case.contains("file = \"../../meshes/femur.stl\""), "{case}");
    let warnings = bench.summary("results/out").warnings;
    let words = "insert.stl: the triangles faced inwards and were reversed";
    assert_eq!(warnings, [words]);
}

#[test]
fn the_case_as_run_still_finds_its_meshes() {
    let bench = bench();
    run(&bench, &bench.path("results/out"));
    let said = bench.say(&["run", "results/out/case.toml", "--out", "results/again"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert_same_bytes(&bench.path("results/out"), &bench.path("results/again"));
    let said = bench.say(&["run", "case.toml", "--out", "results/out", "--resume"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
}

#[test]
fn a_run_stopped_after_its_case_was_written_goes_on() {
    let bench = bench();
    run(&bench, &bench.path("results/out"));
    fs::create_dir(bench.path("results/begun")).unwrap();
    let case = bench.path("results/out/case.toml");
    fs::copy(case, bench.path("results/begun/case.toml")).unwrap();
    let said = bench.say(&["run", "case.toml", "--out", "results/begun", "--resume"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert_same_bytes(&bench.path("results/out"), &bench.path("results/begun"));
}
