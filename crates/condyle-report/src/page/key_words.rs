//! Titles and units of keys that are not in the catalogue.

use condyle_results::split_unit;

use crate::number::with_powers;

/// Parts of names that are written in capitals.
const CAPITALS: [&str; 5] = ["ap", "ie", "ml", "vv", "is"];

/// Returns a key as a title and its unit: `ap_range_mm` is ("AP range", "mm").
pub(super) fn in_words(key: &str) -> (String, String) {
    let (name, unit) = match key.strip_suffix("_cycles") {
        Some(name) => (name, Some("cycles")),
        None => split_unit(key),
    };
    let words: Vec<String> = name.split('_').map(word).collect();
    let unit = with_powers(unit.unwrap_or_default()).replace(' ', "\u{a0}");
    (first_letter_large(&words.join(" ")), unit)
}

/// Returns the text with its first letter in capitals.
pub(super) fn first_letter_large(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().collect::<String>() + letters.as_str()
    })
}

fn word(part: &str) -> String {
    if CAPITALS.contains(&part) {
        return part.to_uppercase();
    }
    part.to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_key_is_a_title_with_a_unit() {
        for (key, title, unit) in [
            ("ap_range_mm", "AP range", "mm"),
            ("peak_memory_mb", "Peak memory", "MB"),
            ("cycles_solved", "Cycles solved", ""),
            ("worn_area_mm2", "Worn area", "mm\u{b2}"),
            ("is", "IS", ""),
            ("peak_pressure_at_cycles", "Peak pressure at", "cycles"),
        ] {
            assert_eq!(in_words(key), (title.to_owned(), unit.to_owned()));
        }
    }
}
