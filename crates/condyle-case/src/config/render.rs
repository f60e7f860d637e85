//! Problems as text: the place, a caret under it, and what to do.
//!
//! The contents of a file cannot control the terminal on which they are shown.

use std::fmt;
use std::ops::Range;

use miette::{
    Diagnostic, GraphicalReportHandler, GraphicalTheme, LabeledSpan, NamedSource, SourceCode,
};

use super::problem::{Problem, Problems};

/// Style of rendered problems.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RenderStyle {
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

/// Largest number of problems shown: each is searched from the start of its file.
const MAX_SHOWN: usize = 20;

impl Problems {
    /// Returns the first problems, each with its place, a caret under the spot, and what to do; of more than twenty,
    /// how many more there are.
    pub fn render(&self, style: RenderStyle) -> String {
        let (theme, width) = match style {
            RenderStyle::Plain => (GraphicalTheme::none(), PLAIN_WIDTH),
            RenderStyle::Terminal { width } => (GraphicalTheme::unicode(), width),
        };
        let handler = GraphicalReportHandler::new_themed(theme)
            .with_width(width)
            .with_links(false);
        let mut text = String::new();
        for problem in self.problems().iter().take(MAX_SHOWN) {
            let shown = handler.render_report(&mut text, &Shown::new(problem));
            debug_assert!(shown.is_ok(), "writing to a String does not fail");
        }
        match self.problems().len().saturating_sub(MAX_SHOWN) {
            0 => text,
            1 => text + "and 1 more problem; correct these first\n",
            more => text + &format!("and {more} more problems; correct these first\n"),
        }
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(RenderStyle::Plain))
    }
}

impl std::error::Error for Problems {}

#[derive(Debug)]
pub(super) struct Shown<'a> {
    problem: &'a Problem,
    source: Option<NamedSource<String>>,
    /// In the shown source.
    span: Option<Range<usize>>,
}

impl<'a> Shown<'a> {
    pub(super) fn new(problem: &'a Problem) -> Self {
        let Some(source) = problem.text.as_deref() else {
            let (source, span) = (None, problem.span.clone());
            return Self {
                problem,
                source,
                span,
            };
        };
        let place = problem.span.clone().unwrap_or_default();
        let (text, place) = with_short_lines(&masked(source.inner()), &place);
        let name = visible(&with_short_words(source.name()));
        Self {
            problem,
            source: Some(NamedSource::new(name, text)),
            span: problem.span.is_some().then_some(place),
        }
    }
}

impl fmt::Display for Shown<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&visible(&with_short_words(&self.problem.to_string())))
    }
}

impl std::error::Error for Shown<'_> {}

impl Diagnostic for Shown<'_> {
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        let advice = with_short_words(self.problem.advice()?);
        Some(Box::new(visible(&advice)))
    }

    fn source_code(&self) -> Option<&dyn SourceCode> {
        Some(self.source.as_ref()?)
    }

    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let label = LabeledSpan::underline(self.span.clone()?);
        Some(Box::new(std::iter::once(label)))
    }
}

/// `text` with every character that steers a terminal written as an escape, such as `\u{1b}`; line
/// ends and tabs stay.
pub fn visible(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for character in text.chars() {
        match character {
            '\n' | '\t' => shown.push(character),
            character if steers(character) => shown.extend(character.escape_unicode()),
            character => shown.push(character),
        }
    }
    shown
}

/// Replaces every character that steers a terminal by one of as many bytes, so that places in the text remain valid.
pub(super) fn masked(text: &str) -> String {
    let without_line_ends = |line: &str| line.trim_end_matches(['\r', '\n']).len();
    let mut shown = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let (line, end) = line.split_at(without_line_ends(line));
        shown.extend(line.chars().map(stand_in));
        shown.push_str(end);
    }
    shown
}

fn stand_in(character: char) -> char {
    match character.len_utf8() {
        _ if character == '\t' || !steers(character) => character,
        1 => '?',
        2 => '\u{bf}',
        _ => char::REPLACEMENT_CHARACTER,
    }
}

/// Returns true for control characters and for those that change the direction of text.
pub(super) fn steers(character: char) -> bool {
    character.is_control()
        || matches!(character, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

/// Length above which words are cut, and the length of the shown beginning, characters.
const LONGEST_WORD: usize = 80;
const SHOWN: usize = 60;
/// Shown bytes of a cut line before and after the place.
const BEFORE: usize = 60;
const AFTER: usize = 120;

/// Cuts long words, and adds their length.
pub(super) fn with_short_words(text: &str) -> String {
    let mut short = String::with_capacity(text.len().min(1000));
    for piece in text.split_inclusive(char::is_whitespace) {
        let length = piece.trim_end().chars().count();
        if length <= LONGEST_WORD {
            short.push_str(piece);
        } else {
            short.extend(piece.chars().take(SHOWN));
            short += &format!("... ({length} characters)");
            short.extend(piece.chars().next_back().filter(|end| end.is_whitespace()));
        }
    }
    short
}

/// Cuts long lines, that of the place around it, and returns the text with the place in it.
pub(super) fn with_short_lines(text: &str, place: &Range<usize>) -> (String, Range<usize>) {
    let mut short = String::with_capacity(text.len());
    let (mut at, mut moved) = (0, place.clone());
    for line in text.split_inclusive('\n') {
        let holds_place = (at..at + line.len()).contains(&place.start);
        let from = if holds_place { place.start - at } else { 0 };
        let start = floor(line, from.saturating_sub(BEFORE));
        let end = floor(line, from + AFTER).max(start);
        if line.len() <= BEFORE + AFTER {
            moved = if holds_place {
                shifted(place, at, short.len())
            } else {
                moved
            };
            short.push_str(line);
        } else {
            short += if start > 0 { "..." } else { "" };
            if holds_place {
                moved = shifted(place, at + start, short.len());
                moved.end = moved.end.min(short.len() + end - start);
            }
            short.push_str(&line[start..end]);
            short += if end < line.len() { "...\n" } else { "" };
        }
        at += line.len();
    }
    let end = short.len();
    let inside = |at: usize| floor(&short, at.min(end));
    let moved = if place.start >= at {
        end..end
    } else {
        inside(moved.start)..inside(moved.end)
    };
    (short, moved)
}

/// Moves a place by the difference of two offsets.
fn shifted(place: &Range<usize>, from: usize, to: usize) -> Range<usize> {
    let length = place.end.saturating_sub(place.start);
    let start = place.start - from + to;
    start..start + length
}

fn floor(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_written_as_an_escape() {
        assert_eq!(visible("a\tb\n\u{1b}[31m"), "a\tb\n\\u{1b}[31m");
        assert_eq!(
            visible("\r\u{7f}\u{9b}\u{202e}"),
            "\\u{d}\\u{7f}\\u{9b}\\u{202e}"
        );
        assert_eq!(visible("\u{e9} \u{4e2d}"), "\u{e9} \u{4e2d}");
    }

    #[test]
    fn places_stay_under_a_mask() {
        let text = "a\u{1b}b\u{9b}c\u{202e}\te\u{e9}\r\nf\rg\r\n";
        let shown = masked(text);
        assert_eq!(shown, "a?b\u{bf}c\u{fffd}\te\u{e9}\r\nf?g\r\n");
        assert_eq!(shown.len(), text.len());
    }

    #[test]
    fn a_long_word_is_cut_and_counted() {
        let text = format!("[contact] has no key `{}`, really", "x".repeat(1_000_000));
        let said = with_short_words(&text);
        assert!(said.len() < 200, "{said}");
        assert!(said.contains("... (1000003 characters) really"), "{said}");
        assert_eq!(with_short_words("as it was\n"), "as it was\n");
    }

    #[test]
    fn a_long_line_is_cut_around_the_place() {
        let text = format!(
            "a = 1\n{}b = 2{}\nc = 3\n",
            "-".repeat(500),
            "+".repeat(500)
        );
        let at = text.find("b =").unwrap();
        let (short, place) = with_short_lines(&text, &(at..at + 1));
        assert_eq!(&short[place], "b");
        assert_eq!(short.lines().count(), 3);
        assert!(short.lines().all(|line| line.len() < 200), "{short}");
        let (same, place) = with_short_lines("a = 1\nb = 2\n", &(6..7));
        assert_eq!((same.as_str(), &same[place]), ("a = 1\nb = 2\n", "b"));
    }

    #[test]
    fn a_long_place_ends_with_its_line() {
        let text = format!("{} = 1\nc = 3\n", "\u{e9}".repeat(500));
        let (short, place) = with_short_lines(&text, &(0..1000));
        assert!(short[place].chars().all(|shown| shown == '\u{e9}'));
        let end = text.len();
        assert_eq!(with_short_lines(&text, &(end..end)).1.len(), 0);
    }
}
