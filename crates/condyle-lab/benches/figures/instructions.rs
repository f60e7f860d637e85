//! Instructions counted by callgrind, which are the same on a busy machine and an idle one.

use std::{
    collections::BTreeMap,
    path::Path,
    process::{Command, ExitCode, Stdio},
    thread::ScopedJoinHandle,
};

use crate::{
    budgets::{self, Counts, Verdict, verdict},
    cases::{self, GENERIC, REAL, SMALL},
    counted::COUNTED,
    readable,
};

/// Prints counts and their budgets; fails if a count exceeds its budget.
pub fn hold() -> ExitCode {
    let (counts, budgets) = (counts(), budgets::read());
    let mut is_above = false;
    for (case, work, count) in each(&counts) {
        let budget = budgets.get(case).and_then(|of_case| of_case.get(work));
        let (verdict, percent) = verdict(count, budget.copied());
        is_above |= matches!(verdict, Verdict::Above | Verdict::NotRecorded);
        println!(
            "{case:<16}{work:<20}{count:>14}  {percent:+6.2} %  {}",
            said(&verdict)
        );
    }
    if is_above {
        println!(
            "More instructions than the budget allows. Find out why; if it is worth it, record anew with \
             scripts/test.d/35-budget --record, commit crates/condyle-lab/benches/budgets.toml and say why."
        );
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}

fn said(verdict: &Verdict) -> &'static str {
    match verdict {
        Verdict::Within => "within the budget",
        Verdict::Above => "ABOVE THE BUDGET by more than 5 %",
        Verdict::Below => "below the budget by more than 5 %: record it anew, lower",
        Verdict::NotRecorded => "NO BUDGET on record",
    }
}

/// Records what is counted now as the budgets.
pub fn record() {
    let counts = counts();
    for (case, work, count) in each(&counts) {
        println!("{case:<16}{work:<20}{count:>14}");
    }
    budgets::write(counts);
}

fn each(counts: &Counts) -> impl Iterator<Item = (&str, &str, u64)> {
    counts.iter().flat_map(|(case, works)| {
        works
            .iter()
            .map(move |(work, count)| (case.as_str(), work.as_str(), *count))
    })
}

/// Returns the counts of every case whose data exist; all cases run at once.
fn counts() -> Counts {
    let small = SMALL.iter().map(|(name, _)| *name);
    let names = [GENERIC, REAL].into_iter().chain(small);
    let names: Vec<&str> = names.filter(|name| cases::read(name).is_some()).collect();
    let folder = tempfile::tempdir().expect("a folder for a copy of this program");
    let program = &readable::copy(folder.path());
    std::thread::scope(|scope| {
        let spawned = names
            .iter()
            .map(|&name| scope.spawn(move || (name.to_owned(), counts_of(name, program))));
        let running: Vec<_> = spawned.collect();
        let counted = running.into_iter().map(ScopedJoinHandle::join);
        counted
            .map(|counted| counted.expect("is counted"))
            .collect()
    })
}

fn counts_of(case: &str, program: &Path) -> BTreeMap<String, u64> {
    let folder = tempfile::tempdir().expect("a folder for what callgrind writes");
    let profile = folder.path().join("callgrind.out");
    let times = run_counted(program, case, &profile);
    let profile = std::fs::read_to_string(&profile).expect("callgrind has written");
    let count = |(work, times): (&str, u64)| {
        let (_, function) = COUNTED.iter().find(|(name, _)| *name == work)?;
        Some((work.to_owned(), inclusive(&profile, function) / times))
    };
    let times = times.lines().filter_map(|line| {
        let (work, times) = line.split_once(' ')?;
        Some((work, times.parse().ok()?))
    });
    times.filter_map(count).collect()
}

/// Runs a copy of this program on a case under callgrind; what it prints.
fn run_counted(program: &Path, case: &str, profile: &Path) -> String {
    let told = Command::new("valgrind")
        .args(["--tool=callgrind", "--quiet"])
        .arg(format!("--callgrind-out-file={}", profile.display()))
        .arg(program)
        .args(["counted", case])
        .stderr(Stdio::inherit())
        .output()
        .expect("valgrind runs");
    assert!(told.status.success(), "valgrind: {}", told.status);
    String::from_utf8(told.stdout).expect("plain text")
}

/// Instructions of a function and all that it calls.
///
/// A function's part of the profile begins with `fn=(number)`, and the last number of every line of
/// costs in it is instructions, of its own or of a call.
fn inclusive(profile: &str, function: &str) -> u64 {
    let number = number_of(profile, function);
    let mut is_inside = false;
    let mut sum = 0;
    for line in profile.lines() {
        if let Some(name) = line.strip_prefix("fn=") {
            is_inside = name.split(' ').next() == Some(number);
        } else if is_inside && line.starts_with(|first: char| "0123456789+-*".contains(first)) {
            let last = line.rsplit(' ').next();
            sum += last.and_then(|last| last.parse::<u64>().ok()).unwrap_or(0);
        }
    }
    sum
}

/// The number that stands for a function's name, with its brackets.
fn number_of<'a>(profile: &'a str, function: &str) -> &'a str {
    let named = profile.lines().filter(|line| line.contains(function));
    let mut numbers = named.filter_map(|line| line.split_once("fn=")?.1.split_once(' '));
    let found = numbers.find(|(_, name)| name.contains(function));
    found
        .unwrap_or_else(|| panic!("callgrind has not seen {function}"))
        .0
}
