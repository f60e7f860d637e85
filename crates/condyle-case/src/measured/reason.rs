//! Problems of measured data, and checks of columns that all of them share.

use std::ops::Range;

use thiserror::Error;

use crate::config::{Cell, Columns, Limits, Placed, Reason};

/// Measured data that cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum MeasuredReason {
    #[error("the file names no measured data")]
    Nothing,
    #[error("a run has no column `{column}` to compare with")]
    UnknownColumn {
        column: String,
        near: Option<String>,
        columns: String,
    },
    #[error("the column `{column}` is in its file twice")]
    RepeatedColumn { column: String },
    #[error("the first column must be `{wanted}`, this one is `{found}`")]
    FirstColumn { wanted: &'static str, found: String },
    #[error("the name `{column}` does not end in the unit of a mass, _mg")]
    NoMass { column: String },
    #[error("`{column}` is {value}, after {before} in the row above: it must grow")]
    NotGrowing {
        column: String,
        value: f64,
        before: f64,
    },
    #[error("`{column}` is {value}: it must be {range}")]
    OutOfRange {
        column: String,
        value: f64,
        range: &'static str,
    },
    #[error("`{column}` has {found} numbers where {needed} are needed")]
    TooFew {
        column: String,
        found: usize,
        needed: usize,
    },
    #[error("every column of {file} is a soak control: there is no specimen")]
    NoSpecimen { file: String },
    #[error("{rows} weighings are left for the line, of which three are needed")]
    TooFewWeighings { rows: usize },
    #[error("the phase `{name}` is {found}: it must be [start, end] in percent, 0 to 100")]
    Phase { name: String, found: String },
    #[error("`{key}` is [{low}, {high}]: the second must be the larger")]
    EmptyRange {
        key: &'static str,
        low: f64,
        high: f64,
    },
    #[error("`fit = \"region\"` needs `fit_x_mm`, `fit_z_mm` or both")]
    NoRegion,
    #[error("{0}")]
    Scan(String),
}

impl Reason for MeasuredReason {
    fn advice(&self) -> Option<String> {
        Some(match self {
            Self::Nothing => "add one of [kinematics], [gravimetric] and [surface], each with \
                `file = `"
                .to_owned(),
            Self::UnknownColumn { near, columns, .. } => match near {
                Some(near) => format!("did you mean `{near}`? It can be {columns}"),
                None => format!("remove it, or name it one of {columns}"),
            },
            Self::RepeatedColumn { .. } => "give each column a name of its own".to_owned(),
            Self::FirstColumn { wanted, .. } => {
                format!("put `{wanted}` first, and name it so")
            }
            Self::NoMass { .. } => "let its name end in `_mg`, with masses in mg".to_owned(),
            Self::NotGrowing { .. } => "sort the rows, and keep one of each".to_owned(),
            Self::OutOfRange { .. } => "correct the number, or remove the row".to_owned(),
            Self::TooFew { .. } => "add rows, or leave the column out".to_owned(),
            Self::NoSpecimen { .. } => {
                "name the soak controls in `soak_controls`, and leave the specimens out of it"
                    .to_owned()
            }
            Self::TooFewWeighings { .. } => "add weighings, or lower `fit_from_cycles`; the first \
                row starts the test, and its loss of 0 does not count"
                .to_owned(),
            Self::Phase { .. } => "write it as `\"mid stance\" = [10, 30]`".to_owned(),
            Self::EmptyRange { .. } => "write the smaller one first".to_owned(),
            Self::NoRegion => "add one, such as `fit_x_mm = [-20, 20]`".to_owned(),
            Self::Scan(_) => "export the scan again as STL, PLY, or CSV with the columns \
                x_mm,y_mm,z_mm"
                .to_owned(),
        })
    }
}

/// Returns `value`, or the problems if there are any.
pub(super) fn unless<T>(problems: Vec<Placed>, value: T) -> Result<T, Vec<Placed>> {
    if problems.is_empty() {
        Ok(value)
    } else {
        Err(problems)
    }
}

/// Returns a problem for every column whose name is repeated.
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

/// Returns a problem if the first column is not called `wanted`.
pub(super) fn misnamed_first(columns: &Columns<'_>, wanted: &'static str) -> Option<Placed> {
    let found = columns.names()[0].to_owned();
    let span = columns.name_span(0);
    (found != wanted).then(|| Placed::new(span, MeasuredReason::FirstColumn { wanted, found }))
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
        let reason = MeasuredReason::NotGrowing {
            column: column.to_owned(),
            value: pair[1].value,
            before: pair[0].value,
        };
        Placed::new(pair[1].span.clone(), reason)
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
        let reason = MeasuredReason::OutOfRange {
            column: column.to_owned(),
            value: cell.value,
            range,
        };
        Placed::new(cell.span.clone(), reason)
    };
    wrong.map(problem).collect()
}

/// Returns the problem of a column with too few numbers.
pub(super) fn too_few(column: &str, found: usize, needed: usize, span: Range<usize>) -> Placed {
    let column = column.to_owned();
    let reason = MeasuredReason::TooFew {
        column,
        found,
        needed,
    };
    Placed::new(span, reason)
}
