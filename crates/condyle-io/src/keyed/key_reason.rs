//! What is wrong in a case file, where, and what to do.

use std::fmt;
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use condyle::contact::PressureTableError;
use condyle::machine::WaveformError;
use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode,
};
use thiserror::Error;

use super::axes::AxesError;
use crate::measured::MeasuredReason;

/// Why a case cannot be used.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Reason {
    /// Not TOML.
    #[error("this is not TOML: {message}")]
    Syntax {
        /// What the parser says.
        message: String,
    },
    /// A key that does not exist.
    #[error("{section} has no key `{key}`")]
    UnknownKey {
        /// As written.
        key: String,
        /// The table it stands in.
        section: String,
        /// A key that looks like it.
        near: Option<String>,
        /// Every key there is.
        keys: Vec<String>,
    },
    /// A key that exists with another unit.
    #[error("`{key}` is in another unit: the key is `{meant}`, in {unit}")]
    WrongUnit {
        /// As written.
        key: String,
        /// The key that is meant.
        meant: String,
        /// Its unit.
        unit: &'static str,
        /// The same value in that unit, where it is known.
        converted: Option<String>,
    },
    /// A key that belongs to another choice.
    #[error("`{key}` belongs to {owner}, but this case has {chosen}")]
    OtherChoice {
        /// As written.
        key: String,
        /// Such as `shape = "mesh"`.
        owner: String,
        /// Such as `shape = "generic"`.
        chosen: String,
    },
    /// A value of another type.
    #[error("`{key}` must be {wanted}, this is {found}")]
    WrongType {
        /// The key.
        key: String,
        /// What it takes.
        wanted: String,
        /// What it got.
        found: &'static str,
    },
    /// A word that is none of the choices.
    #[error("`{key}` cannot be \"{word}\"")]
    UnknownWord {
        /// The key.
        key: String,
        /// As written.
        word: String,
        /// A choice that looks like it.
        near: Option<String>,
        /// Every choice.
        words: String,
    },
    /// A number outside its range.
    #[error("`{key}` is {value}, outside its range")]
    OutOfRange {
        /// The key.
        key: String,
        /// As written.
        value: String,
        /// The range with its unit.
        range: String,
    },
    /// A key that must be there.
    #[error("{section} needs `{key}`")]
    MissingKey {
        /// The key.
        key: String,
        /// The table it is missing from.
        section: String,
        /// What it takes.
        wanted: String,
    },
    /// A file that is not there.
    #[error("`{key}`: there is no file {}", path.display())]
    MissingFile {
        /// The key that names it.
        key: String,
        /// Where it was looked for.
        path: PathBuf,
    },
    /// A file that cannot be read.
    #[error("the file {} cannot be read: {why}", path.display())]
    UnreadableFile {
        /// Which file.
        path: PathBuf,
        /// What the system says.
        why: String,
    },
    /// Axes that are no right-handed frame.
    #[error("`{key}`: {error}")]
    Axes {
        /// The key.
        key: String,
        /// Why.
        error: AxesError,
    },
    /// Points that make no waveform.
    #[error("[{section}]: {error}")]
    Waveform {
        /// The table of the waveform.
        section: String,
        /// Why.
        error: WaveformError,
    },
    /// Points that make no pressure table.
    #[error("`{key}`: {error}")]
    PressureTable {
        /// The key that gives it.
        key: &'static str,
        /// Why.
        error: PressureTableError,
    },
    /// Two keys that exclude each other.
    #[error("{section} has both `{first}` and `{second}`, which say the same thing twice")]
    Both {
        /// The table.
        section: String,
        /// One key.
        first: String,
        /// The other.
        second: String,
    },
    /// None of the keys of which one is needed.
    #[error("{section} needs one of {keys}")]
    NoneOf {
        /// The table.
        section: String,
        /// The keys.
        keys: String,
    },
    /// A key that means nothing without another.
    #[error("`{key}` means nothing here: it needs {needs}")]
    Idle {
        /// The key.
        key: String,
        /// What it needs.
        needs: String,
    },
    /// A waveform of a freedom that is driven otherwise.
    #[error("[{section}] is given, but the {freedom} freedom is {drive}: the two contradict")]
    UnusedWaveform {
        /// The table of the waveform.
        section: String,
        /// The freedom it would drive.
        freedom: &'static str,
        /// How that is driven.
        drive: &'static str,
        /// The drive the waveform is for.
        wanted: &'static str,
    },
    /// A drive that no waveform exists for.
    #[error("the {freedom} freedom cannot be {drive}: a case has no waveform for that")]
    NoSuchDrive {
        /// The freedom.
        freedom: &'static str,
        /// As written.
        drive: &'static str,
        /// Drives it can have.
        drives: &'static str,
    },
    /// Values that are good one by one and make no wear test together.
    #[error("{message}")]
    Unfit {
        /// Why, and what to do.
        message: String,
    },
    /// A CSV file without a header.
    #[error("{file} has no header that names its columns")]
    NoHeader {
        /// The file.
        file: String,
        /// What the header could be.
        example: String,
    },
    /// A CSV file of one column.
    #[error("{file} has one column where two or more are needed")]
    OneColumn {
        /// The file.
        file: String,
        /// What the header could be.
        example: String,
    },
    /// A first column that is no place in the cycle.
    #[error("the first column must be the percent of the cycle, this one is `{column}`")]
    NoPercent {
        /// Name of the first column.
        column: String,
    },
    /// A header with another unit.
    #[error("column `{column}` is in another unit than {unit}, which is needed here")]
    ColumnUnit {
        /// The column.
        column: String,
        /// The unit that is needed.
        unit: &'static str,
        /// How its name should end.
        suffix: &'static str,
    },
    /// A column that is not there.
    #[error("there is no column `{column}` in {file}")]
    NoColumn {
        /// As written in the case.
        column: String,
        /// The file.
        file: String,
        /// Columns there are.
        columns: Vec<String>,
    },
    /// More than one column to choose from.
    #[error("{file} has several columns and the case does not say which to take")]
    WhichColumn {
        /// The file.
        file: String,
        /// Columns there are.
        columns: Vec<String>,
    },
    /// A row that is too short, or holds no number.
    #[error("`{text}` in column `{column}` is not a finite number")]
    NotNumber {
        /// As written; empty where the row is short.
        text: String,
        /// The column.
        column: String,
    },
    /// What only measured data can have wrong.
    #[error(transparent)]
    Measured(#[from] MeasuredReason),
}

impl Reason {
    /// What to do about it.
    pub fn advice(&self) -> Option<String> {
        match self {
            Self::UnknownKey {
                near: Some(near), ..
            } => Some(format!("did you mean `{near}`?")),
            Self::UnknownKey { keys, .. } => {
                Some(format!("remove it; the keys here are {}", keys.join(", ")))
            }
            Self::WrongUnit {
                meant,
                converted: Some(value),
                ..
            } => Some(format!("write `{meant} = {value}`")),
            Self::WrongUnit { meant, unit, .. } => {
                Some(format!("write `{meant}`, with the value in {unit}"))
            }
            Self::OtherChoice { owner, .. } => Some(format!("remove the key, or write `{owner}`")),
            Self::UnknownWord { near, words, .. } => Some(match near {
                Some(near) => format!("did you mean \"{near}\"? It can be {words}"),
                None => format!("it can be {words}"),
            }),
            Self::OutOfRange { range, .. } => Some(format!("it can be {range}")),
            Self::MissingKey { key, wanted, .. } => Some(format!("add `{key} = `, {wanted}")),
            Self::MissingFile { path, .. } => Some(how_to_get(path)),
            Self::Axes { .. } => Some(AxesError::ADVICE.to_owned()),
            Self::Waveform {
                error: WaveformError::Seam { .. },
                ..
            } => Some("or, for a measured cycle, set `remove_drift = true`".to_owned()),
            Self::Both { first, second, .. } => {
                Some(format!("keep `{first}` or `{second}`, not both"))
            }
            Self::Idle { key, .. } => Some(format!("remove `{key}`, or add what it needs")),
            Self::UnusedWaveform {
                section, wanted, ..
            } => Some(format!(
                "remove [{section}], or make the freedom `drive = \"{wanted}\"`"
            )),
            Self::NoSuchDrive { drives, .. } => Some(format!("it can be {drives}")),
            Self::NoHeader { example, .. } => Some(format!(
                "write one above the numbers, with the unit in the name, such as `{example}`"
            )),
            Self::OneColumn { example, .. } => {
                Some(format!("put commas between the columns, as in `{example}`"))
            }
            Self::NoPercent { .. } => {
                Some("name it `percent`, and let it run from 0 to 100".to_owned())
            }
            Self::ColumnUnit { suffix, unit, .. } => Some(format!(
                "let its name end in `{suffix}`, with values in {unit}"
            )),
            Self::NoColumn { columns, .. } => Some(format!("it has {}", columns.join(", "))),
            Self::WhichColumn { columns, .. } => {
                Some(format!("add `column = `, one of {}", columns.join(", ")))
            }
            Self::NotNumber { .. } => Some("write a number there, or remove the row".to_owned()),
            Self::Syntax { .. } => Some(SYNTAX_ADVICE.to_owned()),
            Self::Measured(reason) => Some(reason.advice()),
            Self::WrongType { .. }
            | Self::Unfit { .. }
            | Self::UnreadableFile { .. }
            | Self::Waveform { .. }
            | Self::PressureTable { .. }
            | Self::NoneOf { .. } => None,
        }
    }
}

/// What most often ails a line that is not TOML.
const SYNTAX_ADVICE: &str = "a line is `key = value`: text in quotes, a number without its unit, \
    a list in square brackets; a key stands once in its table";

/// Where a file that is not there comes from.
fn how_to_get(path: &std::path::Path) -> String {
    if path.iter().any(|part| part == "dm-knee") {
        "data are not part of condyle: fetch the Grand Challenge subject DM meshes and gait \
         (Fregly et al. 2012; in jam-resources, models/knee_tka/grand_challenge/DM) and put them \
         there; see the comment at the top of the case"
            .to_owned()
    } else if path.iter().any(|part| part == "data") {
        "data are not part of condyle: the comment at the top of the case says where they come \
         from"
            .to_owned()
    } else {
        "correct the path; it counts from the folder of the file that names it".to_owned()
    }
}

/// A named text that problems point into.
pub(crate) type Source = Arc<NamedSource<String>>;

/// One thing that is wrong, at its place.
#[derive(Clone, Debug)]
pub struct Problem {
    /// What is wrong.
    pub reason: Reason,
    source: Option<Source>,
    span: Option<Range<usize>>,
}

impl Problem {
    pub(crate) fn at(source: &Source, span: Range<usize>, reason: Reason) -> Self {
        Self {
            reason,
            source: Some(Arc::clone(source)),
            span: Some(span),
        }
    }

    fn nowhere(reason: Reason) -> Self {
        Self {
            reason,
            source: None,
            span: None,
        }
    }

    /// Line and column, both from 1; none for a file that could not be opened.
    pub fn line_and_column(&self) -> Option<(usize, usize)> {
        let before = self
            .source
            .as_ref()?
            .inner()
            .get(..self.span.as_ref()?.start)?;
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        let column = before[line_start..].chars().count() + 1;
        Some((before.matches('\n').count() + 1, column))
    }

    /// Name of the file it is in.
    pub fn file(&self) -> Option<&str> {
        self.source.as_ref().map(|source| source.name())
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.reason.fmt(f)
    }
}

impl std::error::Error for Problem {}

impl Diagnostic for Problem {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        Some(Box::new(self.reason.advice()?))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(self.source.as_deref()?)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let label = LabeledSpan::underline(self.span.clone()?);
        Some(Box::new(std::iter::once(label)))
    }
}

/// How problems are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// ASCII without colour, the same everywhere: for logs, pipes and tests.
    Plain,
    /// Colour and line art, for a terminal this many columns wide.
    Terminal {
        /// Columns.
        width: usize,
    },
}

/// Width of text that goes to no terminal, columns.
const PLAIN_WIDTH: usize = 100;

/// Everything that is wrong with a case, in the order of the file.
#[derive(Clone, Debug)]
pub struct CaseError {
    problems: Vec<Problem>,
}

impl CaseError {
    /// Problems of the case file `case` come first, in its order; then those of files it names.
    pub(crate) fn new(mut problems: Vec<Problem>, case: &Source) -> Self {
        let elsewhere = |problem: &Problem| match &problem.source {
            Some(source) => !Arc::ptr_eq(source, case),
            None => false,
        };
        problems.sort_by_key(|problem| {
            let start = problem.span.as_ref().map(|span| span.start);
            (elsewhere(problem), start.filter(|_| !elsewhere(problem)))
        });
        Self { problems }
    }

    /// A case file that cannot be opened.
    pub(crate) fn unreadable(reason: Reason) -> Self {
        Self {
            problems: vec![Problem::nowhere(reason)],
        }
    }

    /// The problems, one or more.
    pub fn problems(&self) -> &[Problem] {
        &self.problems
    }

    /// Every problem with its place, a caret under the spot, and what to do.
    pub fn render(&self, look: Look) -> String {
        let (theme, width) = match look {
            Look::Plain => (GraphicalTheme::none(), PLAIN_WIDTH),
            Look::Terminal { width } => (GraphicalTheme::unicode(), width),
        };
        let handler = GraphicalReportHandler::new_themed(theme)
            .with_width(width)
            .with_links(false);
        let mut text = String::new();
        for problem in &self.problems {
            let shown = handler.render_report(&mut text, problem);
            debug_assert!(shown.is_ok(), "writing to a String does not fail");
        }
        text
    }
}

impl fmt::Display for CaseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(Look::Plain))
    }
}

impl std::error::Error for CaseError {}
