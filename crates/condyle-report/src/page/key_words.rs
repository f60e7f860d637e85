//! What a key of the summary says in words, for numbers that the report does not know.

/// Endings of names and the units that people write for them, the longer before what they end with.
const UNITS: [(&str, &str); 21] = [
    ("_mm3_per_nm", "mm\u{b3}/(N\u{a0}m)"),
    ("_mg_per_mm3", "mg/mm\u{b3}"),
    ("_n_per_mm", "N/mm"),
    ("_mm_per_s", "mm/s"),
    ("_kg_m2", "kg\u{a0}m\u{b2}"),
    ("_mm3", "mm\u{b3}"),
    ("_mm2", "mm\u{b2}"),
    ("_mm", "mm"),
    ("_mpa", "MPa"),
    ("_percent", "%"),
    ("_cycles", "cycles"),
    ("_deg", "degrees"),
    ("_rad", "rad"),
    ("_mg", "mg"),
    ("_kg", "kg"),
    ("_nm", "N\u{a0}m"),
    ("_hz", "1/s"),
    ("_mb", "MB"),
    ("_gb", "GB"),
    ("_n", "N"),
    ("_s", "s"),
];
/// Parts of names that are written in capitals.
const CAPITALS: [&str; 5] = ["ap", "ie", "ml", "vv", "is"];

/// A key as a title and its unit: `ap_range_mm` is ("AP range", "mm").
pub(super) fn in_words(key: &str) -> (String, &'static str) {
    let ending = UNITS
        .iter()
        .find_map(|(ending, unit)| Some((key.strip_suffix(ending)?, *unit)));
    let (name, unit) = ending.unwrap_or((key, ""));
    let words: Vec<String> = name.split('_').map(word).collect();
    (first_letter_large(&words.join(" ")), unit)
}

/// Powers in units as they are printed: mm2 is mm\u{b2}.
pub(super) fn with_powers(text: &str) -> String {
    text.replace("mm2", "mm\u{b2}").replace("mm3", "mm\u{b3}")
}

/// The text with its first letter in capitals.
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
            assert_eq!(in_words(key), (title.to_owned(), unit));
        }
    }
}
