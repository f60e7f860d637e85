//! Assertions that a case agrees with its exact values, and the page of the book with the case.

use crate::{
    CASES, Case, Row,
    page::{TOP, section, table},
};

const PAGE: &str = include_str!("../../docs/src/verification.md");

/// Numbers on the page may differ by this part between machines and compilers.
const SAME_WITHIN: f64 = 0.25;

const REWRITE: &str = "write the page again: cargo run --release -p condyle-verification -- --page";

impl Case {
    /// Fails with the whole table if a row does not hold, or if the page differs.
    #[track_caller]
    pub(crate) fn assert_holds(&self) {
        let rows = (self.rows)();
        let holds = !rows.is_empty() && rows.iter().all(Row::holds);
        assert!(holds, "{}\n{}", self.title(), table(&rows));
        assert_current(self, &rows);
    }
}

#[track_caller]
fn assert_current(case: &Case, rows: &[Row]) {
    let (now, written) = (section(case, rows), written(case));
    for (now, written) in now.trim().lines().zip(written.lines()) {
        assert!(
            is_same_line(now, written),
            "{written}\nis now\n{now}\n{REWRITE}"
        );
    }
    let counts = [now.trim(), written].map(|text| text.lines().count());
    assert_eq!(counts[0], counts[1], "{}: {REWRITE}", case.title());
}

/// The section of a case on the page.
#[track_caller]
fn written(case: &Case) -> &'static str {
    let heading = format!("## {}\n", case.title());
    let from = PAGE.find(&heading);
    let from = from.unwrap_or_else(|| panic!("no section for {}: {REWRITE}", case.title()));
    let section = &PAGE[from..];
    section.split("\n## ").next().unwrap_or_default().trim()
}

fn is_same_line(one: &str, other: &str) -> bool {
    let mut words = one.split(' ').zip(other.split(' '));
    one.split(' ').count() == other.split(' ').count() && words.all(|(a, b)| is_same_word(a, b))
}

fn is_same_word(one: &str, other: &str) -> bool {
    match (one.parse::<f64>(), other.parse::<f64>()) {
        (Ok(one), Ok(other)) => (one - other).abs() <= SAME_WITHIN * one.abs().max(other.abs()),
        _ => one == other,
    }
}

#[test]
fn page_has_a_section_for_every_case_and_no_other() {
    let headings = PAGE.lines().filter_map(|line| line.strip_prefix("## "));
    let titles: Vec<&str> = CASES.iter().map(Case::title).collect();
    assert_eq!(headings.collect::<Vec<_>>(), titles, "{REWRITE}");
    assert!(PAGE.starts_with(TOP), "{REWRITE}");
}

#[test]
fn lines_may_differ_in_the_digits_of_numbers_only() {
    assert!(is_same_line("| force | 0.054 % |", "| force | 0.060 % |"));
    assert!(!is_same_line("| force | 0.054 % |", "| force | 0.54 % |"));
    assert!(!is_same_line("| force | 0.054 % |", "| area | 0.054 % |"));
    assert!(!is_same_line(
        "| force | 0.054 % |",
        "| force | 0.054 % | 2.0 |"
    ));
}
