//! The preparation of a mesh femur and the compliance of a deformable insert are kept for the next run, and no result depends on it.

use std::fs;

use crate::bench::{Bench, SMALL, assert_same_bytes};
use crate::shapes::{FLEXED_A_LITTLE, femur, insert, stl};

/// A coarse implant of triangles.
fn bench() -> Bench {
    let meshes = "[femur]\nshape = \"mesh\"\nfile = \"femur.stl\"\n";
    let insert_mesh = format!("{meshes}[insert]\nshape = \"mesh\"\nfile = \"insert.stl\"");
    let text = SMALL
        .replace("[insert]", &insert_mesh)
        .replace("edge_mm = 2.5", "edge_mm = 1.5")
        + FLEXED_A_LITTLE;
    let bench = Bench::with_case(&text);
    bench.write("femur.stl", &stl(&femur()));
    bench.write("insert.stl", &stl(&insert()));
    bench
}

#[track_caller]
fn run(bench: &Bench, out: &str, cache: &str) {
    let mut command = bench.command(&["run", "case.toml", "--out", out]);
    let output = command.env("CONDYLE_CACHE", cache).output();
    let output = output.expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(0), "{said}");
}

#[test]
fn a_kept_femur_gives_the_same_bytes() {
    let bench = bench();
    run(&bench, "none", "off");
    assert!(!bench.path("off").exists());
    run(&bench, "first", "kept");
    run(&bench, "second", "kept");
    let kept = fs::read_dir(bench.path("kept")).expect("the cache is there");
    assert_eq!(kept.count(), 1);
    assert_same_bytes(&bench.path("none"), &bench.path("first"));
    assert_same_bytes(&bench.path("none"), &bench.path("second"));
}

#[test]
fn a_kept_compliance_gives_the_same_bytes_and_belongs_to_its_material() {
    let text = SMALL.to_owned() + "[contact]\nmodel = \"deformable\"\n";
    let bench = Bench::with_case(&text);
    let kept = || {
        let files = fs::read_dir(bench.path("kept")).expect("the cache is there");
        let mut files: Vec<_> = files.map(|file| file.unwrap().path()).collect();
        files.sort();
        files
    };
    run(&bench, "none", "off");
    run(&bench, "first", "kept");
    let first = kept();
    let names = first.iter().map(|file| file.to_string_lossy());
    assert!(first.len() == 1 && names.clone().all(|name| name.contains("compliance-")));
    let written = fs::metadata(&first[0]).unwrap().modified().unwrap();
    run(&bench, "second", "kept");
    let again = fs::metadata(&first[0]).unwrap().modified().unwrap();
    assert_eq!(
        written, again,
        "nothing new was found, and it was written again"
    );
    assert_same_bytes(&bench.path("none"), &bench.path("first"));
    assert_same_bytes(&bench.path("none"), &bench.path("second"));
    // A softer insert finds nothing of this one.
    bench.write(
        "case.toml",
        &(text + "[material]\nyoungs_modulus_mpa = 400\n"),
    );
    run(&bench, "soft_alone", "off");
    run(&bench, "soft", "kept");
    assert_eq!(kept().len(), 2);
    assert_same_bytes(&bench.path("soft_alone"), &bench.path("soft"));
    // What is damaged is computed anew.
    for file in kept() {
        let mut bytes = fs::read(&file).unwrap();
        bytes.truncate(bytes.len() / 2);
        fs::write(&file, bytes).unwrap();
    }
    run(&bench, "third", "kept");
    assert_same_bytes(&bench.path("soft_alone"), &bench.path("third"));
}

#[test]
fn two_runs_at_once_share_a_cache() {
    let bench = bench();
    let outs = ["one", "two"];
    let started = outs.map(|out| {
        let mut command = bench.command(&["run", "case.toml", "--out", out]);
        command
            .env("CONDYLE_CACHE", "kept")
            .spawn()
            .expect("it runs")
    });
    for mut run in started {
        assert!(run.wait().expect("it ends").success());
    }
    assert_same_bytes(&bench.path("one"), &bench.path("two"));
    let kept = fs::read_dir(bench.path("kept")).expect("the cache is there");
    assert_eq!(kept.count(), 1);
}
