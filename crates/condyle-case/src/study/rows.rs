//! Tests that are given row by row.

use std::ops::Range;

use super::count::check_count;
use super::input::Input;
use super::reason::StudyReason;
use crate::case::Case;
use crate::config::{DataFile, Level, Log, Placed, Section};

/// Inputs, and the values of each test; no rows where a design chooses them.
pub(super) struct Rows {
    pub inputs: Vec<Input>,
    pub rows: Vec<Vec<Level>>,
}

/// Reads the tests of `file`, which the table `section` names.
pub(super) fn read_rows(
    section: &Section<'_>,
    file: &DataFile,
    case: &Case,
    log: &mut Log<'_>,
) -> Option<Rows> {
    let source = file.source(section, "file", log)?;
    let table = log.noted(&source, split(source.inner()))?;
    let at = section.value_span("file");
    check_count("inputs", table.keys.len(), at.clone(), log)?;
    let input = |(place, key): (usize, &String)| {
        let column = table.rows.iter().map(|row| row[place].clone());
        Input::of_rows(key, column, at.clone(), case)
    };
    let inputs = table.keys.iter().enumerate().map(input).collect();
    Some(Rows {
        inputs,
        rows: table.rows,
    })
}

struct Table {
    keys: Vec<String>,
    rows: Vec<Vec<Level>>,
}

/// Keys and rows of a CSV text, or every row that does not fit.
fn split(text: &str) -> Result<Table, Vec<Placed>> {
    let mut lines = lines(text);
    let Some(head) = lines.next() else {
        return Err(vec![Placed::new(0..0, StudyReason::NoRows)]);
    };
    let cells = |line: &Range<usize>| -> Vec<String> {
        let cells = text[line.clone()].split(',');
        cells
            .map(|cell| cell.trim().trim_matches('"').to_owned())
            .collect()
    };
    let keys = cells(&head);
    let (mut rows, mut wrong) = (Vec::new(), Vec::new());
    for line in lines {
        let row = cells(&line);
        if row.len() == keys.len() && row.iter().all(|cell| !cell.is_empty()) {
            rows.push(row.into_iter().map(level).collect());
        } else {
            let (found, wanted) = (row.len(), keys.len());
            wrong.push(Placed::new(line, StudyReason::WrongShape { found, wanted }));
        }
    }
    if rows.is_empty() && wrong.is_empty() {
        wrong.push(Placed::new(head, StudyReason::NoRows));
    }
    if wrong.is_empty() {
        Ok(Table { keys, rows })
    } else {
        Err(wrong)
    }
}

fn level(cell: String) -> Level {
    match cell.parse::<f64>() {
        Ok(number) if number.is_finite() => Level::Number(number),
        Ok(_) | Err(_) => Level::Word(cell),
    }
}

/// The lines that are neither blank nor a remark.
fn lines(text: &str) -> impl Iterator<Item = Range<usize>> + '_ {
    let mut start = 0;
    let spans = text.split_inclusive('\n').map(move |line| {
        let span = start..start + line.trim_end().len();
        start += line.len();
        span
    });
    spans.filter(|span| {
        let line = text[span.clone()].trim_start();
        !line.is_empty() && !line.starts_with('#')
    })
}
