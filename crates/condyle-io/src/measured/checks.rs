//! What is checked of the columns of any measured data.

use std::ops::Range;

use super::reason::MeasuredReason;
use crate::config::{Cell, Columns, Placed};

/// Every column whose name stands before it already.
pub(super) fn repeated(columns: &Columns<'_>) -> Vec<Placed> {
    let names = columns.names();
    let again = |index: &usize| names[..*index].contains(&names[*index]);
    let problem = |index: usize| {
        let column = names[index].to_owned();
        let reason = MeasuredReason::RepeatedColumn { column };
        Placed::new(columns.name_span(index), reason)
    };
    (0..names.len()).filter(again).map(problem).collect()
}

/// Every number that is not larger than the one above.
pub(super) fn not_growing(column: &str, cells: &[Cell]) -> Vec<Placed> {
    let falls = |pair: &&[Cell]| pair[1].value <= pair[0].value;
    let problem = |pair: &[Cell]| {
        let reason = MeasuredReason::NotGrowing {
            column: column.to_owned(),
            value: pair[1].value,
            before: pair[0].value,
        };
        Placed::new(pair[1].span.clone(), reason)
    };
    cells.windows(2).filter(falls).map(problem).collect()
}

/// A column with too few numbers.
pub(super) fn too_few(column: &str, found: usize, needed: usize, span: Range<usize>) -> Placed {
    let column = column.to_owned();
    let reason = MeasuredReason::TooFew {
        column,
        found,
        needed,
    };
    Placed::new(span, reason)
}
