//! A run to be measured, and made-up measurements of it with known differences.

use serde_json::Value;

use crate::bench::{Bench, SMALL};

/// A bench with the small case run into `out`.
pub fn measured_bench() -> Bench {
    let bench = Bench::with_case(SMALL);
    bench.run_into("out");
    bench
}

/// `condyle compare out measured.toml --json`, which must work.
#[track_caller]
pub fn compared(bench: &Bench, measured: &str) -> Value {
    bench.write("measured.toml", measured);
    let said = bench.say(&["compare", "out", "measured.toml", "--json"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    serde_json::from_str(&said.out).expect("it prints JSON and nothing else")
}

/// `condyle compare out measured.toml`, which must refuse with every one of `expected`, in order.
#[track_caller]
pub fn assert_refused(bench: &Bench, measured: &str, expected: &[&str]) {
    bench.write("measured.toml", measured);
    let said = bench.say(&["compare", "out", "measured.toml"]);
    said.assert_refused(2, expected);
}

#[track_caller]
pub fn close(found: &Value, expected: f64, tolerance: f64) {
    let found = found.as_f64().expect("is a number");
    assert!(
        (found - expected).abs() <= tolerance,
        "{found} is not {expected}"
    );
}

/// Numbers that look like noise, of mean 0 and standard deviation 1, the same every time.
pub fn noise(count: usize) -> Vec<f64> {
    let mut state = 7u64;
    let mut uniform = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005);
        state = state.wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..count)
        .map(|_| (0..12).map(|_| uniform()).sum::<f64>() - 6.0)
        .collect()
}
