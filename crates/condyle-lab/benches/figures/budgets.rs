//! The maximum number of instructions of each piece of work, as recorded in `benches/budgets.toml`.

use std::{collections::BTreeMap, fmt::Write, fs, path::PathBuf};

/// Instructions by case and piece of work.
pub type Counts = BTreeMap<String, BTreeMap<String, u64>>;

/// Growth that is let pass: another libc or processor moves counts a little.
const TOLERANCE_PERCENT: f64 = 5.0;

const HEADER: &str = "\
# Instructions (callgrind) on x86-64 with AVX2. A change that takes over 5 % more fails `scripts/test budget`.
# Recorded by `scripts/test.d/35-budget --record`.
";

/// The result of the comparison of a count with its budget.
#[derive(PartialEq)]
pub enum Verdict {
    Within,
    Above,
    Below,
    NotRecorded,
}

/// The verdict on a count, and the change in percent.
pub fn verdict(count: u64, budget: Option<u64>) -> (Verdict, f64) {
    let Some(budget) = budget else {
        return (Verdict::NotRecorded, 0.0);
    };
    let percent = 100.0 * (count as f64 / budget as f64 - 1.0);
    let verdict = match percent {
        percent if percent > TOLERANCE_PERCENT => Verdict::Above,
        percent if percent < -TOLERANCE_PERCENT => Verdict::Below,
        _ => Verdict::Within,
    };
    (verdict, percent)
}

fn path() -> PathBuf {
    concat!(env!("CARGO_MANIFEST_DIR"), "/benches/budgets.toml").into()
}

/// The budgets on record.
pub fn read() -> Counts {
    let text = fs::read_to_string(path()).unwrap_or_default();
    toml::from_str(&text).expect("budgets.toml holds numbers by case")
}

/// Records counts; cases that were not counted keep their budgets.
pub fn write(counts: Counts) {
    let mut all = read();
    all.extend(counts);
    let mut text = HEADER.to_owned();
    for (case, budgets) in all {
        write!(text, "\n[{case}]\n").expect("a string takes all");
        for (work, budget) in budgets {
            writeln!(text, "{work} = {budget}").expect("a string takes all");
        }
    }
    fs::write(path(), text).expect("budgets.toml can be written");
}
