//! Standard output and standard error that nobody reads, or that have no room left.

#![cfg(target_os = "linux")]

use condyle_results::catalogue;
use std::fs::{self, File, OpenOptions};
use std::io::pipe;

use crate::bench::{Bench, SMALL, Said};

/// Commands that print something.
const COMMANDS: &[&[&str]] = &[
    &["--help"],
    &["run", "--help"],
    &["--version"],
    &["check", "case.toml"],
    &["check", "case.toml", "--print"],
    &["run", "case.toml", "--out", "table"],
    &["run", "case.toml", "--out", "json", "--json"],
    &["report", "table", "--pictures"],
    &["new", "new.toml"],
];

/// The command with a standard output on a full disk.
fn full(bench: &Bench, arguments: &[&str]) -> Said {
    let full: File = OpenOptions::new()
        .write(true)
        .open("/dev/full")
        .expect("Linux has it");
    let output = bench.command(arguments).stdout(full).output().unwrap();
    Said {
        code: output.status.code(),
        out: String::new(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}

#[test]
fn a_reader_that_has_gone_is_no_error() {
    let bench = Bench::with_case(SMALL);
    for arguments in COMMANDS {
        let (reader, writer) = pipe().unwrap();
        drop(reader);
        let output = bench.command(arguments).stdout(writer).output().unwrap();
        let err = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{arguments:?}: {err}");
        assert!(!err.contains("error"), "{arguments:?}: {err}");
    }
    assert_eq!(bench.summary("table")[&catalogue::UPDATES], 3.0);
}

#[test]
fn a_run_goes_on_where_nobody_hears_it() {
    let bench = Bench::with_case(SMALL);
    let (reader, writer) = pipe().unwrap();
    drop(reader);
    let mut command = bench.command(&["run", "case.toml", "--out", "out"]);
    let output = command.stderr(writer).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    assert_eq!(bench.summary("out")[&catalogue::UPDATES], 3.0);
}

#[test]
fn a_full_disk_behind_standard_output_is_an_error() {
    let bench = Bench::with_case(SMALL);
    for arguments in COMMANDS {
        full(&bench, arguments).assert_refused(
            2,
            &[
                "standard output cannot be written",
                "check that the disk is not full",
            ],
        );
    }
}

#[test]
fn a_full_disk_behind_standard_output_costs_no_results() {
    let bench = Bench::with_case(SMALL);
    let said = full(&bench, &["run", "case.toml", "--out", "out"]);
    said.assert_refused(2, &["the results are kept in out"]);
    assert_eq!(bench.summary("out")[&catalogue::UPDATES], 3.0);
    assert!(fs::exists(bench.path("out/report.html")).unwrap());
}

#[test]
fn shells_complete_every_command_and_each_has_a_man_page() {
    let bench = Bench::new();
    for shell in ["bash", "zsh", "fish", "powershell"] {
        let said = bench.say(&["completions", shell]);
        assert_eq!(said.code, Some(0), "{}", said.err);
        assert!(said.out.contains("calibrate-wear"), "{shell}");
    }
    let said = bench.say(&["man", "pages"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    for page in ["condyle.1", "condyle-run.1", "condyle-study-export.1"] {
        let text = fs::read_to_string(bench.path("pages").join(page)).unwrap();
        assert!(text.contains(".SH SYNOPSIS"), "{page}");
    }
}
