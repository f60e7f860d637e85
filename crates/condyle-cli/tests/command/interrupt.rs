//! Runs that are stopped: what was computed is kept, and gone on with to the same bytes.

#![cfg(unix)]

use condyle_results::catalogue;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::bench::{Bench, SMALL, assert_same_bytes, files_but_wall_time, updates_kept};

/// Long enough to be met on its way, a second or so.
const LONGER: &str = "\
[insert]
edge_mm = 2.5
layers = 2
[march]
updates = 30
[time]
increments = 60
";

/// A run on its way, its words thrown away.
fn begun(bench: &Bench, resume: bool) -> Child {
    let mut arguments = vec!["run", "case.toml", "--out", "out"];
    arguments.extend(resume.then_some("--resume"));
    let mut command = bench.command(&arguments);
    command.stdout(Stdio::null()).stderr(Stdio::null());
    command.spawn().expect("it starts")
}

fn signal(child: &Child, name: &str) {
    let id = child.id().to_string();
    let sent = Command::new("kill").args([name, &id]).status();
    assert!(sent.expect("kill is there").success());
}

/// Waits until a file is there, or the run has ended.
fn wait_for(file: &Path, child: &mut Child) {
    while !file.exists() && child.try_wait().expect("it can be asked").is_none() {
        sleep(Duration::from_micros(200));
    }
}

#[test]
fn ctrl_c_keeps_the_updates_done_and_resume_reaches_the_same_bytes() {
    for stop in ["-INT", "-TERM"] {
        let bench = Bench::with_case(LONGER);
        let mut child = begun(&bench, false);
        wait_for(&bench.path("out/insert_0003.vtu"), &mut child);
        signal(&child, stop);
        assert_eq!(child.wait().unwrap().code(), Some(130), "{stop}");
        let kept = updates_kept(&bench.path("out"));
        assert!((2..30).contains(&kept), "{kept}");
        assert!(!bench.path("out/summary.json").exists());
        let said = bench.resume("out");
        assert!(
            said.err.contains(&format!("{kept} updates are done")),
            "{}",
            said.err
        );
        bench.run_into("whole");
        assert_same_bytes(&bench.path("out"), &bench.path("whole"));
    }
}

#[test]
fn ctrl_c_before_the_first_update_is_resumable_too() {
    let bench = Bench::with_case(SMALL);
    let child = begun(&bench, false);
    sleep(Duration::from_millis(3));
    signal(&child, "-INT");
    let code = child.wait_with_output().unwrap().status.code();
    if bench.path("out").exists() {
        assert!(matches!(code, Some(0 | 130)), "{code:?}");
        bench.resume("out");
    } else {
        bench.run_into("out");
    }
    bench.run_into("whole");
    assert_same_bytes(&bench.path("out"), &bench.path("whole"));
}

#[test]
fn the_words_of_an_interrupt_say_how_to_go_on() {
    let bench = Bench::with_case(LONGER);
    let mut command = bench.command(&["run", "case.toml", "--out", "out"]);
    let mut child = command
        .stderr(Stdio::piped())
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    wait_for(&bench.path("out/insert_0001.vtu"), &mut child);
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.contains("updates are done"), "{err}");
    assert!(
        err.contains("condyle run case.toml --out out --resume"),
        "{err}"
    );
}

#[test]
fn the_words_of_an_interrupt_name_what_was_changed() {
    let bench = Bench::with_case(LONGER);
    let mut command = bench.command(&["run", "case.toml", "-o", "out", "--set", "title=it's"]);
    command.stderr(Stdio::piped()).stdout(Stdio::null());
    let mut child = command.spawn().unwrap();
    wait_for(&bench.path("out/insert_0001.vtu"), &mut child);
    signal(&child, "-INT");
    let output = child.wait_with_output().unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    let words = r"--out out --resume --set 'title=it'\''s'";
    assert!(err.contains(words), "{err}");
}

#[test]
fn a_run_does_not_write_into_the_folder_of_another() {
    let bench = Bench::with_case(LONGER);
    let mut first = begun(&bench, false);
    wait_for(&bench.path("out/checkpoint"), &mut first);
    signal(&first, "-STOP");
    for more in [&[][..], &["--resume"], &["--force"]] {
        let said = bench.say(&[&["run", "case.toml", "--out", "out"], more].concat());
        said.assert_refused(2, &["another run is writing into this folder"]);
    }
    signal(&first, "-CONT");
    assert!(first.wait().unwrap().success());
    bench.run_into("whole");
    assert_same_bytes(&bench.path("out"), &bench.path("whole"));
}

#[test]
fn killed_again_and_again_it_still_reaches_the_same_bytes() {
    let bench = Bench::with_case(LONGER);
    let mut kills = 0;
    for pause_ms in [2, 11, 23, 37, 52, 68, 85, 103, 122, 142] {
        let resume = bench.path("out/case.toml").exists();
        let mut child = begun(&bench, resume);
        sleep(Duration::from_millis(pause_ms));
        if child.try_wait().unwrap().is_none() {
            signal(&child, "-KILL");
            kills += 1;
        }
        child.wait().unwrap();
    }
    assert!(kills >= 3, "{kills}");
    match bench.path("out/case.toml").exists() {
        true => bench.resume("out"),
        false => bench.run_into("out"),
    };
    bench.run_into("whole");
    assert_same_bytes(&bench.path("out"), &bench.path("whole"));
}

#[test]
fn killed_as_each_file_appears_it_still_reaches_the_same_bytes() {
    let bench = Bench::with_case(LONGER);
    let files = [
        "case.toml",
        "insert_0000.vtu.part",
        "insert_0000.vtu",
        "insert.pvd",
        "checkpoint.part",
        "checkpoint",
        "insert_0001.vtu.part",
        "insert_0002.vtu",
        "insert_0030.vtu",
        "summary.json",
        "report.html",
    ];
    for file in files {
        let mut child = begun(&bench, bench.path("out/case.toml").exists());
        wait_for(&bench.path("out").join(file), &mut child);
        if child.try_wait().unwrap().is_none() {
            signal(&child, "-KILL");
        }
        child.wait().unwrap();
    }
    bench.resume("out");
    bench.run_into("whole");
    assert_same_bytes(&bench.path("out"), &bench.path("whole"));
}

/// What stands in the folder when a run is killed between two files: the first files of the next
/// update, in the order in which they are written, with the checkpoint of the update before.
#[test]
fn stopped_between_any_two_files_it_goes_on_to_the_same_bytes() {
    let whole = Bench::with_case(LONGER);
    whole.run_into("out");
    let done = files_but_wall_time(&whole.path("out"));
    let one = Bench::with_case(LONGER);
    stop_after_the_first_update(&one);
    let before = files_but_wall_time(&one.path("out"));
    let kept = updates_kept(&one.path("out"));
    let next = format!("insert_{:04}.vtu", kept + 1);
    let written = [next.as_str(), "insert.pvd", "wear.csv", "kinematics.csv"];
    for count in 0..=written.len() {
        let bench = Bench::with_case(LONGER);
        fs::create_dir(bench.path("out")).unwrap();
        let mut files = before.clone();
        for name in &written[..count] {
            files.insert((*name).to_owned(), done[*name].clone());
        }
        files.insert("wear.csv.part".to_owned(), b"half".to_vec());
        for (name, bytes) in files {
            fs::write(bench.path("out").join(name), bytes).unwrap();
        }
        bench.resume("out");
        assert_same_bytes(&bench.path("out"), &whole.path("out"));
    }
}

/// Stops a run as soon as it has an update, however fast it is.
fn stop_after_the_first_update(bench: &Bench) {
    let mut child = begun(bench, false);
    wait_for(&bench.path("out/insert_0001.vtu"), &mut child);
    signal(&child, "-INT");
    let interrupted = child.wait().unwrap().code() == Some(130);
    if !interrupted || updates_kept(&bench.path("out")) == 0 {
        fs::remove_dir_all(bench.path("out")).unwrap();
        stop_after_the_first_update(bench);
    }
}

#[test]
fn stopped_after_its_last_update_it_only_sums_up() {
    let whole = Bench::with_case(SMALL);
    whole.run_into("out");
    for gone in [&["summary.json", "report.html"][..], &["report.html"]] {
        let bench = Bench::with_case(SMALL);
        bench.run_into("out");
        for name in gone {
            fs::remove_file(bench.path("out").join(name)).unwrap();
        }
        for left in ["time_spent_s", "time_spent_s.part"] {
            bench.write(&format!("out/{left}"), "0.1\n");
        }
        bench.resume("out");
        assert_same_bytes(&bench.path("out"), &whole.path("out"));
    }
}

#[test]
fn stopped_before_the_first_checkpoint_it_starts_anew() {
    let whole = Bench::with_case(SMALL);
    whole.run_into("out");
    let bench = Bench::with_case(SMALL);
    fs::create_dir(bench.path("out")).unwrap();
    for name in ["case.toml", "insert_0000.vtu"] {
        fs::copy(whole.path("out").join(name), bench.path("out").join(name)).unwrap();
    }
    bench.resume("out");
    assert_same_bytes(&bench.path("out"), &whole.path("out"));
}

#[test]
fn the_time_of_all_parts_is_in_the_summary() {
    let bench = Bench::with_case(LONGER);
    stop_after_the_first_update(&bench);
    let spent = bench.path("out/time_spent_s");
    let before: f64 = fs::read_to_string(&spent).unwrap().trim().parse().unwrap();
    assert!(before > 0.0);
    fs::write(&spent, "1000.0\n").unwrap();
    bench.resume("out");
    let wall_s = bench.summary("out")[&catalogue::WALL_S];
    assert!((1000.0..1100.0).contains(&wall_s), "{wall_s}");
    assert!(!spent.exists());
}

/// Bodies that take some seconds to place: a fine mesh that a deformable insert solves.
const SLOW_TO_PLACE: &str = "\
[insert]
edge_mm = 0.9
layers = 6
[contact]
model = \"deformable\"
";

#[test]
fn a_signal_while_the_bodies_are_placed_ends_the_run_at_once() {
    let bench = Bench::with_case(SLOW_TO_PLACE);
    let mut command = bench.command(&["run", "case.toml", "--out", "out"]);
    command.stderr(Stdio::piped()).stdout(Stdio::null());
    let child = command.spawn().unwrap();
    sleep(Duration::from_millis(500));
    signal(&child, "-TERM");
    let sent = Instant::now();
    let output = child.wait_with_output().unwrap();
    // Far less than the time that the bodies take on any machine.
    assert!(
        sent.elapsed() < Duration::from_secs(2),
        "{:?}",
        sent.elapsed()
    );
    assert_eq!(output.status.code(), Some(130));
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.contains("before the first cycle"), "{err}");
    assert!(!bench.path("out").exists());
}
