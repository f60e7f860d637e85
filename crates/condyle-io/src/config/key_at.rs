//! Which key of a file a place belongs to.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// The dotted path of the key whose name or value holds the start of `place`, or else of the table; none where the
/// text is no TOML, or the place outside of any key.
pub(super) fn key_at(text: &str, place: &Range<usize>) -> Option<String> {
    let (document, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        return None;
    }
    in_table(document.get_ref(), place.start)
}

fn in_table(table: &DeTable<'_>, at: usize) -> Option<String> {
    table.iter().find_map(|(key, value)| {
        let name = key.get_ref();
        match below(value, at) {
            Some(path) => Some(format!("{name}.{path}")),
            None if holds(&key.span(), at) || is_at(value, at) => Some(name.to_string()),
            None => None,
        }
    })
}

/// The path of the key below a value. Tables are looked through wherever they stand, since one may be written in parts.
fn below(value: &Spanned<DeValue<'_>>, at: usize) -> Option<String> {
    match value.get_ref() {
        DeValue::Table(table) => in_table(table, at),
        DeValue::Array(items) => items.iter().find_map(|item| below(item, at)),
        _ => None,
    }
}

/// Whether a value that is no table is there.
fn is_at(value: &Spanned<DeValue<'_>>, at: usize) -> bool {
    !matches!(value.get_ref(), DeValue::Table(_)) && holds(&value.span(), at)
}

fn holds(span: &Range<usize>, at: usize) -> bool {
    span.contains(&at)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_place_belongs_to_its_key() {
        let text = "title = 1\n[contact]\nfriction = \"a\"\nlaw = { x = [1, 2] }\n[[activity]]\nname = 3\n";
        let at = |word: &str| {
            let start = text.find(word).unwrap();
            key_at(text, &(start..start + 1))
        };
        assert_eq!(at("1").as_deref(), Some("title"));
        assert_eq!(at("\"a\"").as_deref(), Some("contact.friction"));
        assert_eq!(at("friction").as_deref(), Some("contact.friction"));
        assert_eq!(at("contact").as_deref(), Some("contact"));
        assert_eq!(at("2]").as_deref(), Some("contact.law.x"));
        assert_eq!(at("3").as_deref(), Some("activity.name"));
        assert_eq!(at("= 1"), None);
        assert_eq!(key_at("no toml", &(0..1)), None);
    }
}
