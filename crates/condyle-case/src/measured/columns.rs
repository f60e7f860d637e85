//! Checks of columns that all measured data share.

use crate::config::*;

pub(super) fn unless<T>(problems: Vec<Placed>, value: T) -> Result<T, Vec<Placed>> {
    if problems.is_empty() {
        Ok(value)
    } else {
        Err(problems)
    }
}

pub(super) fn repeated(columns: &Columns<'_>) -> Vec<Placed> {
    let names = columns.names();
    let again = |index: &usize| names[..*index].contains(&names[*index]);
    let problem = |index: usize| (columns.name_span(index), repeated_column(names[index]));
    (0..names.len()).filter(again).map(problem).collect()
}

pub(super) fn misnamed_first(columns: &Columns<'_>, wanted: &'static str) -> Option<Placed> {
    let found = columns.names()[0];
    let fault = || {
        Fault::new(
            format!("the first column must be `{wanted}`, this one is `{found}`"),
            format!("put `{wanted}` first, and name it so"),
        )
    };
    (!found.eq_ignore_ascii_case(wanted)).then(|| (columns.name_span(0), fault()))
}

/// Reads the first column, whose numbers grow within `limits`, `range` in words.
pub(super) fn growing(
    columns: &Columns<'_>,
    limits: Limits,
    range: &'static str,
) -> Result<Vec<f64>, Vec<Placed>> {
    let (column, cells) = (columns.names()[0], columns.numbers(0)?);
    let falls = |pair: &&[Cell]| pair[1].value <= pair[0].value;
    let problem = |pair: &[Cell]| {
        let (value, before) = (pair[1].value, pair[0].value);
        let message =
            format!("`{column}` is {value}, after {before} in the row above: it must increase");
        let fault = Fault::new(message, "sort the rows, and keep one of each");
        (pair[1].span.clone(), fault)
    };
    let mut problems: Vec<Placed> = cells.windows(2).filter(falls).map(problem).collect();
    problems.extend(outside(column, &cells, limits, range));
    unless(problems, cells.iter().map(|cell| cell.value).collect())
}

/// Returns a problem for every number outside `limits`, `range` in words.
pub(super) fn outside(
    column: &str,
    cells: &[Cell],
    limits: Limits,
    range: &'static str,
) -> Vec<Placed> {
    let wrong = cells.iter().filter(|cell| !limits.allow(cell.value));
    let problem = |cell: &Cell| {
        let message = format!("`{column}` is {}: it must be {range}", cell.value);
        let fault = Fault::new(message, "correct the number, or remove the row");
        (cell.span.clone(), fault)
    };
    wrong.map(problem).collect()
}

pub(super) fn too_few(column: &str, found: usize, needed: usize) -> Fault {
    let message = format!("`{column}` has {found} numbers where {needed} are needed");
    Fault::new(message, "add rows, or omit the column")
}
