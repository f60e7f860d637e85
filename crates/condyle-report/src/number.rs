//! Numbers, units and keys as text for readers.

use condyle_results::split_unit;

/// Joins groups of three digits without a line break.
const THIN_SPACE: char = '\u{202f}';
/// A minus as wide as a plus.
const MINUS: char = '\u{2212}';

/// Formats a value with fixed decimals, a true minus, and thin spaces in numbers of five digits or more.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{:.decimals$}", value.abs());
    let (whole, fraction) = text.split_at(text.find('.').unwrap_or(text.len()));
    let mut out = String::new();
    // A number that is rounded to zero has no sign.
    if value < 0.0 && text.bytes().any(|byte| (b'1'..=b'9').contains(&byte)) {
        out.push(MINUS);
    }
    for (index, digit) in whole.chars().enumerate() {
        let is_group = index > 0 && (whole.len() - index).is_multiple_of(3);
        if whole.len() >= 5 && is_group {
            out.push(THIN_SPACE);
        }
        out.push(digit);
    }
    out + fraction
}

/// Formats a value with significant digits, never as a power of ten.
pub(crate) fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return fixed(value, 0);
    }
    let magnitude = value.abs().log10().floor() as i32;
    fixed(value, (digits - 1 - magnitude).max(0) as usize)
}

/// Returns a number of cycles in words: 5 million, 250 000, 1.
pub(crate) fn cycles_in_words(count: f64) -> String {
    if count < 1e6 {
        return fixed(count, 0);
    }
    let millions = fixed(count / 1e6, 3);
    let shortest = millions.trim_end_matches('0').trim_end_matches('.');
    format!("{shortest} million")
}

/// Returns the unit that a key ends in, as it is printed; empty for a pure number.
pub(crate) fn printed_unit(key: &str) -> String {
    with_powers(split_unit(key).1.unwrap_or_default())
}

/// Returns a text with the powers of its units as they are printed: mm2 is mm\u{b2}.
pub fn with_powers(text: &str) -> String {
    text.replace("mm2", "mm\u{b2}").replace("mm3", "mm\u{b3}")
}

/// Returns a key as a title and its unit: `ap_range_mm` is ("AP range", "mm").
pub(crate) fn in_words(key: &str) -> (String, String) {
    let (name, unit) = match key.strip_suffix("_cycles") {
        Some(name) => (name, Some("cycles")),
        None => split_unit(key),
    };
    let unit = with_powers(unit.unwrap_or_default()).replace(' ', "\u{a0}");
    (first_letter_large(&words(name)), unit)
}

fn words(name: &str) -> String {
    let word = |part: &str| match part {
        "ap" | "ie" | "ml" | "vv" | "is" => part.to_uppercase(),
        "mises" => "Mises".to_owned(),
        _ => part.to_owned(),
    };
    name.split('_').map(word).collect::<Vec<_>>().join(" ")
}

/// Returns the dotted path of a key of a case as words: `insert.thickness_mm` is "Thickness of insert, mm". A name that is no
/// path remains.
pub(crate) fn path_in_words(name: &str) -> String {
    let (title, unit) = title_of_path(name);
    let comma = if unit.is_empty() { "" } else { ", " };
    format!("{title}{comma}{unit}")
}

/// Returns the dotted path of a key of a case as a title and its unit: `insert.thickness_mm` is ("Thickness of insert", "mm"). A
/// name that is no path remains.
pub fn title_of_path(name: &str) -> (String, String) {
    let is_key = |part: &str| part.starts_with(|c: char| c.is_ascii_lowercase());
    let is_path = name.split('.').all(is_key) && !name.contains(' ');
    let path = name.rsplit_once('.').filter(|_| is_path);
    let Some((tables, key)) = path else {
        return (name.to_owned(), String::new());
    };
    let table = tables.rsplit('.').next().unwrap_or(tables);
    let (title, unit) = in_words(key);
    // The wear factor of the table `wear` is clear by itself.
    match key.split('_').any(|word| word == table) {
        true => (title, unit),
        false => (format!("{title} of {}", words(table)), unit),
    }
}

/// Returns the text with its first letter in capitals.
pub(crate) fn first_letter_large(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or_else(String::new, |first| {
        first.to_uppercase().collect::<String>() + letters.as_str()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_are_grouped_and_minus_is_a_minus() {
        assert_eq!(fixed(-1_234_567.25, 1), "\u{2212}1\u{202f}234\u{202f}567.2");
        assert_eq!(fixed(2600.0, 0), "2600");
        assert_eq!(fixed(-0.001, 2), "0.00");
    }

    #[test]
    fn significant_digits_hold_for_small_and_large() {
        assert_eq!(significant(0.031_249, 3), "0.0312");
        assert_eq!(significant(24.0617, 4), "24.06");
        assert_eq!(significant(123_456.0, 3), "123\u{202f}456");
        assert_eq!(significant(0.0, 3), "0");
    }

    #[test]
    fn cycles_read_as_words() {
        assert_eq!(cycles_in_words(5e6), "5 million");
        assert_eq!(cycles_in_words(2.5e6), "2.5 million");
        assert_eq!(cycles_in_words(500_000.0), "500\u{202f}000");
    }

    #[test]
    fn a_path_is_words_and_a_name_remains() {
        for (path, words) in [
            ("insert.thickness_mm", "Thickness of insert, mm"),
            ("machine.axial_force.scale", "Scale of axial force"),
            ("machine.ap_force.scale", "Scale of AP force"),
            (
                "wear.wear_factor_mm3_per_nm",
                "Wear factor, mm\u{b3}/(N\u{a0}m)",
            ),
            ("Design 1.5", "Design 1.5"),
            ("v1.5", "v1.5"),
            ("0.25", "0.25"),
            ("friction", "friction"),
        ] {
            assert_eq!(path_in_words(path), words);
        }
    }

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
