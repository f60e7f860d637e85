//! Suggestions for a key that does not exist.

use condyle::parameter::split_unit;

use super::key::plain;

/// Units a person may write that condyle does not take: (ending, ending taken, factor).
const CONVERSIONS: &[(&str, &str, f64)] = &[
    ("_um", "_mm", 1e-3),
    ("_cm", "_mm", 10.0),
    ("_m", "_mm", 1000.0),
    ("_in", "_mm", 25.4),
    ("_inch", "_mm", 25.4),
    ("_rad", "_deg", 180.0 / std::f64::consts::PI),
    ("_degrees", "_deg", 1.0),
    ("_kn", "_n", 1000.0),
    ("_newton", "_n", 1.0),
    ("_pa", "_mpa", 1e-6),
    ("_kpa", "_mpa", 1e-3),
    ("_gpa", "_mpa", 1000.0),
    ("_khz", "_hz", 1000.0),
    ("_nmm", "_nm", 1e-3),
    ("_g", "_kg", 1e-3),
    ("_tonne", "_kg", 1000.0),
    ("_n_per_m", "_n_per_mm", 1e-3),
    ("_kn_per_m", "_n_per_mm", 1.0),
    ("_g_per_cm3", "_mg_per_mm3", 1.0),
    ("_kg_per_m3", "_mg_per_mm3", 1e-3),
    ("_m_per_s", "_mm_per_s", 1000.0),
    ("_kg_mm2", "_kg_m2", 1e-6),
    ("_ms", "_s", 1e-3),
    ("_us", "_s", 1e-6),
];

pub(crate) fn likeliest(key: &str, keys: &[&str]) -> Option<String> {
    synonym(key, keys).or_else(|| nearest(key, keys.iter().copied()))
}

/// Returns the key for which `key` is a synonym, with or without a unit.
fn synonym(key: &str, keys: &[&str]) -> Option<String> {
    let written = key.to_lowercase();
    let mut words = std::iter::once(written.as_str()).chain(bases(&written));
    words.find_map(|word| meant(word, keys)).map(str::to_owned)
}

pub(super) fn bases(key: &str) -> impl Iterator<Item = &str> {
    let foreign = CONVERSIONS.iter().map(|conversion| conversion.0);
    let own = std::iter::once(split_unit(key).0).filter(move |base| *base != key);
    own.chain(foreign.filter_map(|ending| key.strip_suffix(ending)))
}

pub(super) fn convert(key: &str, meant: &str, number: f64) -> Option<String> {
    let fits = |&&(from, to, _): &&(&str, &str, f64)| {
        key.strip_suffix(from)
            .is_some_and(|base| meant.strip_suffix(to) == Some(base))
    };
    let (_, _, factor) = CONVERSIONS.iter().find(fits)?;
    let rounded: f64 = format!("{:.12e}", number * factor).parse().ok()?;
    Some(plain(rounded))
}

/// Similarity, 0 to 1, below which a word is not suggested.
const ALIKE: f64 = 0.6;

/// Returns the word most similar to `written`.
pub(crate) fn nearest<'a>(written: &str, known: impl Iterator<Item = &'a str>) -> Option<String> {
    known
        .map(|word| (likeness(written, word), word))
        .filter(|(likeness, _)| *likeness >= ALIKE)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, word)| word.to_owned())
}

/// Returns the similarity of two words; a key without its unit counts as the key.
fn likeness(written: &str, known: &str) -> f64 {
    // A character has four bytes at most: this one is longer, and the comparison takes its length times the other's.
    if written.len() > 4 * 2 * known.len() {
        return 0.0;
    }
    let written = written.to_lowercase();
    let whole = strsim::normalized_damerau_levenshtein(&written, known);
    let base = strsim::normalized_damerau_levenshtein(&written, split_unit(known).0);
    whole.max(base)
}

/// Synonyms of keys, in small letters and without a unit; of several keys, the first that a table has is meant.
pub(crate) const SYNONYMS: &[(&str, &str)] = &[
    ("mu", "friction"),
    ("cof", "friction"),
    ("friction_coefficient", "friction"),
    ("coefficient_of_friction", "friction"),
    ("e", "youngs_modulus_mpa"),
    ("modulus", "youngs_modulus_mpa"),
    ("elastic_modulus", "youngs_modulus_mpa"),
    ("nu", "poissons_ratio"),
    ("rho", "density_mg_per_mm3"),
    ("k", "wear_factor_mm3_per_nm"),
    ("k", "posterior_n_per_mm"),
    ("wear_coefficient", "wear_factor_mm3_per_nm"),
    ("stiffness", "posterior_n_per_mm"),
    ("f", "frequency_hz"),
    ("unit", "length_unit"),
    ("units", "length_unit"),
    ("scale", "length_unit"),
    ("mesh", "file"),
    ("path", "file"),
    ("mesh_size", "edge_mm"),
    ("element_size", "edge_mm"),
    ("h", "thickness_mm"),
    ("r", "radius_mm"),
    ("steps", "increments"),
    ("name", "title"),
    ("knee", "side"),
];

pub(super) fn meant<'a>(word: &str, keys: &[&'a str]) -> Option<&'a str> {
    let of_word = SYNONYMS.iter().filter(|(written, _)| *written == word);
    let mut there = of_word.filter_map(|(_, key)| keys.iter().find(|known| *known == key));
    there.next().copied()
}
