//! Prints every case and its table, or those whose names contain the words given; with `--page`
//! writes the page of the book.

use std::path::Path;
use std::process::ExitCode;

use condyle_verification::{CASES, Row, page, table};

const PAGE: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/src/verification.md");

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if words == ["--page"] {
        return write_page();
    }
    let wanted =
        |name: &str| words.is_empty() || words.iter().any(|word| name.contains(word.as_str()));
    let mut holds = true;
    for case in CASES.iter().filter(|case| wanted(case.name)) {
        let rows = (case.rows)();
        println!(
            "{} (verification/{})\n\n{}",
            case.title(),
            case.name,
            table(&rows)
        );
        holds &= rows.iter().all(Row::holds);
    }
    if holds {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn write_page() -> ExitCode {
    let page = page();
    if let Err(error) = std::fs::write(Path::new(PAGE), &page) {
        eprintln!("{PAGE} cannot be written: {error}");
        return ExitCode::FAILURE;
    }
    if page.contains("**fails**") {
        ExitCode::FAILURE
    } else {
        ExitCode::SUCCESS
    }
}
