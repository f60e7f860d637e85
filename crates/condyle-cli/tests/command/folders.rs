//! The results folder: a run that is in it is never lost.

use std::fs::{self, File};

use crate::bench::{Bench, SMALL, assert_same_bytes, files_but_wall_time};

#[test]
fn a_folder_with_a_run_is_refused_and_not_touched() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    let before = files_but_wall_time(&bench.path("out"));
    let summary = fs::read(bench.path("out/summary.json")).unwrap();
    let said = bench.say(&["run", "case.toml", "--out", "out"]);
    said.assert_refused(
        2,
        &["out: the folder already holds a run", "--out", "--resume"],
    );
    assert_eq!(files_but_wall_time(&bench.path("out")), before);
    assert_eq!(fs::read(bench.path("out/summary.json")).unwrap(), summary);
}

#[test]
fn a_single_file_of_a_run_is_enough_to_refuse() {
    for name in [
        "case.toml",
        "summary.json",
        "report.html",
        "insert_0000.vtu",
    ] {
        let bench = Bench::with_case(SMALL);
        fs::create_dir(bench.path("out")).unwrap();
        bench.write(&format!("out/{name}"), "mine");
        let said = bench.say(&["run", "case.toml", "--out", "out"]);
        said.assert_refused(2, &["already holds a run", name]);
        assert_eq!(
            said.err.contains("--resume"),
            name == "case.toml",
            "{}",
            said.err
        );
        let left = files_but_wall_time_of_names(&bench);
        assert_eq!(left, [name]);
    }
}

fn files_but_wall_time_of_names(bench: &Bench) -> Vec<String> {
    let entries = fs::read_dir(bench.path("out")).unwrap();
    let name = |entry: fs::DirEntry| entry.file_name().to_string_lossy().into_owned();
    entries.map(|entry| name(entry.unwrap())).collect()
}

#[test]
fn the_case_is_never_written_over_by_a_run_beside_it() {
    let bench = Bench::with_case(SMALL);
    for more in [&[][..], &["--resume"]] {
        let said = bench.say(&[&["run", "case.toml", "--out", "."], more].concat());
        said.assert_refused(2, &["."]);
        assert_eq!(fs::read_to_string(bench.path("case.toml")).unwrap(), SMALL);
    }
}

#[test]
fn other_files_in_the_folder_stay() {
    let bench = Bench::with_case(SMALL);
    fs::create_dir(bench.path("out")).unwrap();
    bench.write("out/notes.txt", "mine");
    bench.run_into("out");
    assert_eq!(
        fs::read_to_string(bench.path("out/notes.txt")).unwrap(),
        "mine"
    );
}

#[test]
fn a_file_in_place_of_the_folder() {
    let bench = Bench::with_case(SMALL);
    bench.write("out", "mine");
    let said = bench.say(&["run", "case.toml", "--out", "out"]);
    said.assert_refused(2, &["out: this is a file, not a folder", "--out"]);
    assert_eq!(fs::read_to_string(bench.path("out")).unwrap(), "mine");
}

#[test]
fn resume_needs_a_run() {
    let bench = Bench::with_case(SMALL);
    let said = bench.say(&["run", "case.toml", "--out", "out", "--resume"]);
    said.assert_refused(2, &["holds no run to resume", "omit --resume"]);
    assert!(!bench.path("out").exists());
}

#[test]
fn resume_with_a_changed_case_is_refused() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    let before = files_but_wall_time(&bench.path("out"));
    bench.write("case.toml", &SMALL.replace("updates = 3", "updates = 4"));
    let said = bench.say(&["run", "case.toml", "--out", "out", "--resume"]);
    said.assert_refused(2, &["is of another case or other meshes", "--out"]);
    assert_eq!(files_but_wall_time(&bench.path("out")), before);
}

#[test]
fn resume_of_a_finished_run_says_so_and_harms_nothing() {
    let bench = Bench::with_case(SMALL);
    let first = bench.run_into("out");
    let summary = fs::read(bench.path("out/summary.json")).unwrap();
    let before = files_but_wall_time(&bench.path("out"));
    let again = bench.resume("out");
    assert!(
        again.err.contains("this run is done already"),
        "{}",
        again.err
    );
    assert_eq!(again.out, first.out);
    assert_eq!(fs::read(bench.path("out/summary.json")).unwrap(), summary);
    assert_eq!(files_but_wall_time(&bench.path("out")), before);
}

#[test]
fn a_damaged_checkpoint_is_refused_with_advice() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    let file = bench.path("out/checkpoint");
    let good = fs::read(&file).unwrap();
    let mut flipped = good.clone();
    flipped[good.len() / 2] ^= 1;
    let damages = [
        flipped,
        good[..good.len() / 2].to_vec(),
        good[..30].to_vec(),
        Vec::new(),
        b"no checkpoint".to_vec(),
    ];
    for damaged in damages {
        fs::write(&file, &damaged).unwrap();
        let said = bench.say(&["run", "case.toml", "--out", "out", "--resume"]);
        said.assert_refused(
            2,
            &[
                "checkpoint cannot be used",
                "run the case again in another folder",
            ],
        );
        assert_eq!(fs::read(&file).unwrap(), damaged);
    }
    bench.run_into("anew");
    fs::write(&file, good).unwrap();
    assert_same_bytes(&bench.path("out"), &bench.path("anew"));
}

#[test]
fn a_damaged_mesh_is_found_by_name_wherever_it_is_read() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    let file = bench.path("out/insert_0003.vtu");
    let mut bytes = fs::read(&file).unwrap();
    // A digit of a number far into the data: still a mesh, and another one.
    let place = bytes.len() - bytes.len() / 3;
    bytes[place] ^= 1;
    fs::write(&file, &bytes).unwrap();
    let said = bench.say(&["run", "case.toml", "--out", "out", "--resume"]);
    assert_ne!(said.code, Some(0));
    let words = ["insert_0003.vtu: the file is damaged", "--force"];
    assert!(
        words.iter().all(|word| said.err.contains(word)),
        "{}",
        said.err
    );
    let said = bench.say(&["report", "out"]);
    assert_eq!(said.code, Some(0));
    assert!(said.err.contains(words[0]), "{}", said.err);
    fs::remove_file(bench.path("out/summary.json")).unwrap();
    let said = bench.say(&["run", "case.toml", "--out", "out", "--resume"]);
    said.assert_refused(2, &["insert_0003.vtu: the file is damaged"]);
}

#[test]
fn the_default_folder_has_the_name_of_the_case() {
    let bench = Bench::with_case(SMALL);
    assert_eq!(bench.say(&["run", "case.toml"]).code, Some(0));
    assert!(bench.path("results/case/summary.json").exists());
}

#[test]
fn what_is_said_of_a_folder_fits_the_run_in_it() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    let said = || bench.say(&["run", "case.toml", "--out", "out"]);
    said().assert_refused(2, &["a run, which is done", "--out", "--force"]);
    assert!(!said().err.contains("resume it with --resume"));
    fs::remove_file(bench.path("out/summary.json")).unwrap();
    said().assert_refused(
        2,
        &["already holds a run", "resume it with --resume", "--force"],
    );
}

#[test]
fn what_is_made_from_a_run_that_is_not_finished_says_so() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    assert_eq!(bench.say(&["report", "out"]).err, "");
    fs::remove_file(bench.path("out/summary.json")).unwrap();
    let said = bench.say(&["report", "out"]);
    assert_eq!(said.code, Some(0));
    assert!(
        said.err.contains("the run in out is not finished"),
        "{}",
        said.err
    );
    let page = fs::read_to_string(bench.path("out/report.html")).unwrap();
    assert!(page.contains("This run is not finished"));
}

/// Every increment of the first and last cycle.
const WITH_FRAMES: &str = "[output]\ncycle_frames = true\n";

#[test]
fn the_frames_of_both_cycles_go_with_the_run_that_they_are_of() {
    let bench = Bench::with_case(&format!("{SMALL}{WITH_FRAMES}"));
    let said = bench.run_into("out");
    assert!(
        said.out
            .contains("out/insert.pvd, out/cycle_first.pvd, out/cycle_last.pvd")
    );
    for name in ["cycle_first/insert_0001.vtu", "cycle_last/femur_0040.vtu"] {
        assert!(bench.path("out").join(name).exists(), "{name}");
    }
    bench.write("out/cycle_last/insert_0002.vtu.part", "");
    bench.write("case.toml", SMALL);
    let said = bench.say(&["run", "case.toml", "--out", "out", "--force"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    bench.run_into("anew");
    assert_same_bytes(&bench.path("out"), &bench.path("anew"));
}

#[test]
fn a_run_is_written_over_where_that_is_asked_for() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    assert_eq!(bench.say(&["report", "out", "--pictures"]).code, Some(0));
    assert_eq!(bench.say(&["plot", "out"]).code, Some(0));
    bench.write("out/notes.txt", "mine");
    // What was measured was held against the run that was.
    fs::create_dir(bench.path("out/compare")).unwrap();
    bench.write("out/compare/compare.json", "{}");
    bench.write("out/compare/compare_wear.csv", "cycles,mass_loss_mg\n");
    bench.write("case.toml", &SMALL.replace("updates = 3", "updates = 1"));
    let said = bench.say(&["run", "case.toml", "--out", "out", "--force"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let notes = fs::read_to_string(bench.path("out/notes.txt")).unwrap();
    assert_eq!(notes, "mine");
    fs::remove_file(bench.path("out/notes.txt")).unwrap();
    bench.run_into("anew");
    assert_same_bytes(&bench.path("out"), &bench.path("anew"));
}

#[test]
fn a_case_that_cannot_start_leaves_the_run_that_it_would_write_over() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    let before = files_but_wall_time(&bench.path("out"));
    let apart = "[femur]\nshape = \"sphere\"\nstart_mm = [90.0, 0.0]\n";
    for wrong in ["[march]\nupdates = 0\n", apart] {
        bench.write("case.toml", wrong);
        let said = bench.say(&["run", "case.toml", "--out", "out", "--force"]);
        assert_eq!(said.code, Some(2), "{}", said.err);
        assert_eq!(files_but_wall_time(&bench.path("out")), before);
    }
}

#[test]
fn what_may_be_no_run_is_not_written_over() {
    let bench = Bench::with_case(SMALL);
    let said = bench.say(&["run", "case.toml", "--out", ".", "--force"]);
    said.assert_refused(2, &["case.toml is there, but no checkpoint", "--out"]);
    bench.run_into("out");
    let said = bench.say(&["run", "out/case.toml", "--out", "out", "--force"]);
    said.assert_refused(2, &["the run reads out/case.toml of the folder", "--out"]);
    assert_eq!(fs::read_to_string(bench.path("case.toml")).unwrap(), SMALL);
    assert!(bench.path("out/summary.json").exists());
    let both = ["run", "case.toml", "--out", "out", "--force", "--resume"];
    assert_eq!(bench.say(&both).code, Some(2));
}

#[test]
fn a_run_stopped_before_its_first_file_is_gone_on_with() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("whole");
    for left in [&[][..], &["in_use"], &["in_use", "case.toml.part"]] {
        fs::create_dir(bench.path("out")).unwrap();
        for name in left {
            bench.write(&format!("out/{name}"), "");
        }
        bench.resume("out");
        assert_same_bytes(&bench.path("out"), &bench.path("whole"));
        fs::remove_dir_all(bench.path("out")).unwrap();
    }
    fs::create_dir(bench.path("out")).unwrap();
    bench.write("out/notes.txt", "mine");
    let said = bench.say(&["run", "case.toml", "--out", "out", "--resume"]);
    said.assert_refused(2, &["holds no run to resume"]);
}

#[test]
fn a_folder_in_use_is_refused_until_it_is_free() {
    let bench = Bench::with_case(SMALL);
    fs::create_dir(bench.path("out")).unwrap();
    let held = File::create(bench.path("out/in_use")).unwrap();
    held.lock().unwrap();
    for more in [&[][..], &["--resume"], &["--force"]] {
        let said = bench.say(&[&["run", "case.toml", "--out", "out"], more].concat());
        let words = ["out: another run is writing into this folder", "--out"];
        said.assert_refused(2, &words);
        assert_eq!(files_but_wall_time_of_names(&bench), ["in_use"]);
    }
    drop(held);
    bench.run_into("out");
}

/// Runs a command twice that writes `file`, over a file of someone else and with `--force`.
fn assert_foreign_files_are_kept(bench: &Bench, arguments: &[&str], file: &str) {
    bench.write(file, "mine");
    let said = bench.say(arguments);
    said.assert_refused(2, &[file, "--force"]);
    assert_eq!(fs::read_to_string(bench.path(file)).unwrap(), "mine");
    let said = bench.say(&[arguments, &["--force"]].concat());
    assert_eq!(said.code, Some(0), "{arguments:?}: {}", said.err);
    assert_ne!(fs::read_to_string(bench.path(file)).unwrap(), "mine");
}

#[test]
fn foreign_files_are_replaced_with_force_only() {
    let deformable = format!("{SMALL}[contact]\nmodel = \"deformable\"\n");
    let bench = Bench::with_case(&deformable);
    bench.run_into("out");
    fs::create_dir(bench.path("there")).unwrap();
    bench.write("measured.toml", "[gravimetric]\nfile = \"masses.csv\"\n");
    bench.write(
        "masses.csv",
        "cycles,k1_mg\n0,920\n400000,918\n800000,915\n1000000,913\n",
    );
    let compare = ["compare", "out", "measured.toml", "--out", "compared"];
    fs::create_dir(bench.path("compared")).unwrap();
    let commands: [(&[&str], &str); 7] = [
        (&compare, "compared/compare.json"),
        (&["man", "there"], "there/condyle.1"),
        (&["new", "new.toml"], "new.toml"),
        (&["check", "case.toml", "--picture", "a.svg"], "a.svg"),
        (&["plot", "out", "--out", "there"], "there/wear.svg"),
        (&["report", "out", "out", "--out", "a.html"], "a.html"),
        (
            &[
                "export",
                "case.toml",
                "--pressed-at",
                "14",
                "--out",
                "a.inp",
            ],
            "a.inp",
        ),
    ];
    for (arguments, file) in commands {
        assert_foreign_files_are_kept(&bench, arguments, file);
    }
}

#[test]
fn a_plot_goes_on_after_a_full_disk_and_replaces_its_own() {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    for out in [&["--out", "there"][..], &[]] {
        let plot = [&["plot", "out"], out].concat();
        for _ in 0..2 {
            let said = bench.say(&plot);
            assert_eq!(said.code, Some(0), "{}", said.err);
        }
    }
    bench.write("out/pictures/wear.svg", "of an older run");
    assert_eq!(bench.say(&["plot", "out"]).code, Some(0));
    bench.write("there/wear.svg", "mine");
    let said = bench.say(&["plot", "out", "--out", "there"]);
    said.assert_refused(2, &["there/wear.svg", "--force"]);
}

#[test]
#[cfg(target_os = "linux")]
fn a_device_takes_a_picture_without_force() {
    let bench = Bench::with_case(SMALL);
    let said = bench.say(&["check", "case.toml", "--json", "--picture", "/dev/null"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
}
