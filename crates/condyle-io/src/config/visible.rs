//! Text from outside, made harmless for a terminal.

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

/// `text` with a stand-in of as many bytes for every character that steers a terminal, so that
/// places in it stay where they are.
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

/// Control characters, and those that turn the direction of the text around them.
fn steers(character: char) -> bool {
    character.is_control()
        || matches!(character, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
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
}
