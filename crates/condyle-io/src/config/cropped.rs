//! Long words and lines, cut to what a person reads.

use std::ops::Range;

/// Words longer than this are cut, characters.
const LONGEST_WORD: usize = 80;
/// Of a word that is cut, so much of its start is shown.
const SHOWN: usize = 60;
/// Of a line that is cut, so many bytes before and after the place are shown.
const BEFORE: usize = 60;
const AFTER: usize = 120;

/// `text` with long words cut, each with its length.
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

/// `text` with long lines cut, that of the place to what is around it; the place in what is left.
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

/// A place that began `from` bytes in, when that is `to` bytes in.
fn shifted(place: &Range<usize>, from: usize, to: usize) -> Range<usize> {
    let length = place.end.saturating_sub(place.start);
    let start = place.start - from + to;
    start..start + length
}

/// The start of the character at `at`, or the end of the text.
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
