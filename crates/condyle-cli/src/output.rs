//! Standard output and standard error, either of which may be closed, and exit codes.

use std::{
    fmt::Display,
    fs,
    io::{self, ErrorKind, IsTerminal, Write},
    path::Path,
    process::ExitCode,
};

use condyle_case::config::{Problems, RenderStyle, visible};
use condyle_lab::{
    RunError,
    measured::{CalibrateError, CompareError},
};
use condyle_report::ReportError;
pub use condyle_results::json_text as json;
use condyle_results::{create_file, replace_file};

/// Bad input.
pub const BAD_INPUT: u8 = 2;
/// The physics could not be solved.
pub const PHYSICS: u8 = 3;
/// Interrupted, and resumable.
pub const INTERRUPTED: u8 = 130;

/// The exit code of a command, or the reason why it failed.
pub type Done = Result<ExitCode, Failure>;

/// A message for standard error, and the exit code.
pub struct Failure {
    text: String,
    code: u8,
}

impl Failure {
    pub fn bad_input(error: impl Display) -> Self {
        Self::new(error, BAD_INPUT)
    }

    pub fn interrupted(message: impl Display) -> Self {
        Self {
            text: printable(message),
            code: INTERRUPTED,
        }
    }

    fn new(error: impl Display, code: u8) -> Self {
        let text = printable(format_args!("error: {error}"));
        Self { text, code }
    }

    pub fn exit(self) -> ExitCode {
        show(&self.text);
        ExitCode::from(self.code)
    }
}

impl From<&Problems> for Failure {
    fn from(problems: &Problems) -> Self {
        let style = if io::stderr().is_terminal() {
            RenderStyle::Terminal { width: 100 }
        } else {
            RenderStyle::Plain
        };
        Self {
            text: problems.render(style),
            code: BAD_INPUT,
        }
    }
}

/// The message that a file or folder cannot be written.
pub struct Unwritten(pub String);

impl Unwritten {
    pub fn new(path: &Path, error: &io::Error) -> Self {
        let remedy = match error.kind() {
            ErrorKind::AlreadyExists => "choose another name, or replace it with --force",
            _ => "choose another name or folder",
        };
        Self(format!("{}: {error}; {remedy}", path.display()))
    }
}

impl From<Unwritten> for Failure {
    fn from(unwritten: Unwritten) -> Self {
        Self::bad_input(unwritten.0)
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        let code = if error.is_physics() {
            PHYSICS
        } else {
            BAD_INPUT
        };
        match error.in_case() {
            Some(problems) => Self {
                code,
                ..Self::from(problems)
            },
            None => Self::new(error, code),
        }
    }
}

impl From<CompareError> for Failure {
    fn from(error: CompareError) -> Self {
        match &error {
            CompareError::Measured(problems) => Self::from(problems),
            other => Self::bad_input(other),
        }
    }
}

impl From<CalibrateError> for Failure {
    fn from(error: CalibrateError) -> Self {
        match error {
            CalibrateError::Compare(error) => error.into(),
            CalibrateError::Case(problems) => Self::from(&problems),
            other if other.is_physics() => Self::new(other, PHYSICS),
            other => Self::bad_input(other),
        }
    }
}

impl From<ReportError> for Failure {
    fn from(error: ReportError) -> Self {
        Self::bad_input(error)
    }
}

fn printable(words: impl Display) -> String {
    format!("{}\n", visible(&words.to_string()))
}

/// Prints a line on standard error; its words may come from a file or the command line.
pub fn note(words: impl Display) {
    show(&printable(words));
}

fn show(text: &str) {
    // A closed standard error stops no work.
    let _ = io::stderr().lock().write_all(text.as_bytes());
}

pub fn warn(warnings: impl IntoIterator<Item = impl Display>) {
    for warning in warnings {
        note(format_args!("warning: {warning}"));
    }
}

/// Writes a file requested from a command; an existing one is kept unless `force` replaces it.
pub fn write_file(path: &Path, bytes: &[u8], force: bool) -> Result<(), Unwritten> {
    let write = if force { replace_file } else { create_file };
    write(path, bytes).map_err(|error| Unwritten::new(path, &error))
}

/// Writes a file into a folder, which is created if it does not exist. A file with the same bytes is no reason to refuse: a
/// command that a full disk ended goes on when it is repeated.
pub fn write_into(path: &Path, bytes: &[u8], force: bool) -> Result<(), Unwritten> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder).map_err(|error| Unwritten::new(folder, &error))?;
    let is_own = fs::read(path).is_ok_and(|there| there == bytes);
    write_file(path, bytes, force || is_own)
}

/// Prints `text` on standard output.
pub fn print(text: &str) -> Done {
    ended(write(text), "")
}

/// Prints `text`, an extract of the results in `folder`.
pub fn print_with_folder(text: &str, folder: &Path) -> Done {
    let kept = format!("; the results are kept in {}", folder.display());
    ended(write(text), &kept)
}

/// Prints a message of the command-line parser, such as its help.
pub fn print_from_parser(words: &clap::Error) -> Done {
    match words.print().or_else(forgive_a_closed_pipe) {
        Err(error) if !words.use_stderr() => ended(Err(error), ""),
        Ok(()) | Err(_) => Ok(ExitCode::from(
            u8::try_from(words.exit_code()).unwrap_or(BAD_INPUT),
        )),
    }
}

fn write(text: &str) -> io::Result<()> {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes()).and_then(|()| out.flush())
}

/// Ignores the error of a pipe that its reader, such as `head`, has closed: it needs no more output.
fn forgive_a_closed_pipe(error: io::Error) -> io::Result<()> {
    match error.kind() {
        ErrorKind::BrokenPipe => Ok(()),
        _ => Err(error),
    }
}

/// Returns the end of a command whose output was `written`; `kept` is the place of the results otherwise.
pub fn ended(written: io::Result<()>, kept: &str) -> Done {
    match written.or_else(forgive_a_closed_pipe) {
        Ok(()) => Ok(ExitCode::SUCCESS),
        Err(error) => Err(Failure::bad_input(format_args!(
            "standard output cannot be written: {error}{kept}; check that the disk is not full, or send it elsewhere"
        ))),
    }
}

/// Text for standard output, line by line.
#[derive(Default)]
pub struct Lines {
    text: String,
}

impl Lines {
    /// Adds a line; its words may come from a file.
    pub fn line(&mut self, words: impl Display) {
        self.text += &printable(words);
    }

    pub fn notes(&mut self, remarks: &[String]) {
        let remarks = remarks.iter();
        remarks.for_each(|remark| self.line(format_args!("note: {remark}")));
    }

    pub fn text(&self) -> &str {
        &self.text
    }
}
