//! Functions are short.

use crate::source::{Function, Sources};

const LONGEST_LINES: usize = 60;
const MEDIAN_LINES: usize = 8;

/// Every function of the crates, with its file; tests and `verification` are left out.
fn functions(sources: &Sources) -> Vec<(&str, &Function)> {
    let modules = sources.modules.iter();
    let of_crates = modules.filter(|module| module.file.starts_with("crates/"));
    of_crates
        .flat_map(|module| module.functions.iter().map(|f| (module.file.as_str(), f)))
        .collect()
}

#[test]
fn no_function_is_longer_than_a_screen() {
    let sources = Sources::of_workspace();
    let mut long = functions(sources);
    long.retain(|(_, function)| function.length_lines > LONGEST_LINES);
    long.sort_by_key(|(_, function)| std::cmp::Reverse(function.length_lines));
    let told = long.iter().map(|(file, function)| {
        let (name, line, length) = (&function.name, function.line, function.length_lines);
        format!("  {file}:{line}: `{name}` has {length} lines")
    });
    let told: Vec<_> = told.collect();
    assert!(
        told.is_empty(),
        "more than {LONGEST_LINES} lines:\n{}",
        told.join("\n")
    );
}

#[test]
fn half_of_all_functions_have_at_most_eight_lines() {
    let sources = Sources::of_workspace();
    let all = functions(sources).into_iter();
    let mut lengths: Vec<_> = all.map(|(_, function)| function.length_lines).collect();
    lengths.sort_unstable();
    let median = lengths[lengths.len() / 2];
    let short = lengths.partition_point(|length| *length <= MEDIAN_LINES);
    let count = lengths.len();
    assert!(
        median <= MEDIAN_LINES,
        "the median is {median} lines; {short} of {count} functions are short"
    );
}
