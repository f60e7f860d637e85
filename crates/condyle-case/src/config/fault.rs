//! Faults of keys, values and files in words, with suggestions for a key that does not exist.

use std::path::Path;

use condyle::parameter::{split_unit, unit_of};
use toml::de::DeValue;

use super::key::{number, plain, quoted_list};

/// A fault and its remedy in words; the remedy may be empty.
#[derive(Clone, Debug)]
pub(crate) struct Fault {
    pub(crate) message: String,
    pub(super) advice: String,
}

impl Fault {
    pub(crate) fn new(message: impl Into<String>, advice: impl Into<String>) -> Self {
        let (message, advice) = (message.into(), advice.into());
        Self { message, advice }
    }
}

pub(crate) fn type_fault(key: &str, wanted: &str, found: &str) -> Fault {
    Fault::new(format!("`{key}` must be {wanted}, this is {found}"), "")
}

pub(crate) fn idle(key: &str, needs: &str) -> Fault {
    Fault::new(
        format!("`{key}` has no effect here: it needs {needs}"),
        format!("remove `{key}`, or add what it needs"),
    )
}

pub(crate) fn both(section: &str, first: &str, second: &str) -> Fault {
    Fault::new(
        format!("{section} has both `{first}` and `{second}`, which are alternatives"),
        format!("keep `{first}` or `{second}`, not both"),
    )
}

pub(crate) fn out_of_range(key: &str, value: &str, range: &str) -> Fault {
    Fault::new(
        format!("`{key}` is {value}, outside its range"),
        format!("it can be {range}"),
    )
}

/// Returns the likeliest reason why `section` has no `key` among `keys`.
pub(crate) fn explain(key: &str, value: &DeValue<'_>, section: &str, keys: &[&str]) -> Fault {
    if let Some(fault) = wrong_unit(key, value, keys) {
        return fault;
    }
    let advice = match likeliest(key, keys) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("remove it; the keys here are {}", keys.join(", ")),
    };
    Fault::new(format!("{section} has no key `{key}`"), advice)
}

fn wrong_unit(key: &str, value: &DeValue<'_>, keys: &[&str]) -> Option<Fault> {
    let same_quantity = |known: &&&str| {
        let (base, unit) = split_unit(known);
        unit.is_some() && bases(key).any(|written| written == base)
    };
    let meant = *keys.iter().find(same_quantity)?;
    let unit = unit_of(meant)?;
    let advice = match number(value).and_then(|number| convert(key, meant, number)) {
        Some(value) => format!("write `{meant} = {value}`"),
        None => format!("write `{meant}`, with the value in {unit}"),
    };
    let message = format!("`{key}` is in another unit: the key is `{meant}`, in {unit}");
    Some(Fault::new(message, advice))
}

pub(crate) fn unknown_word(key: &str, word: &str, words: &[&str]) -> Fault {
    let listed = quoted_list(words);
    let advice = match nearest(word, words.iter().copied()) {
        Some(near) => format!("did you mean \"{near}\"? It can be {listed}"),
        None => format!("it can be {listed}"),
    };
    Fault::new(format!("`{key}` cannot be \"{word}\""), advice)
}

pub(crate) fn other_choice(key: &str, owner: &str, chosen: &str) -> Fault {
    Fault::new(
        format!("`{key}` belongs to {owner}, but this case has {chosen}"),
        format!("remove it, or write `{owner}`"),
    )
}

pub(crate) fn missing_key(section: &str, key: &str, wanted: &str) -> Fault {
    Fault::new(
        format!("{section} needs `{key}`"),
        format!("add `{key} = `, {wanted}"),
    )
}

pub(crate) fn syntax(message: &str) -> Fault {
    let advice = "a line is `key = value`: text in quotes, a number without its unit, a list in square brackets; a table \
        has each key only once";
    Fault::new(format!("this is not TOML: {message}"), advice)
}

pub(crate) fn missing_file(key: &str, path: &Path) -> Fault {
    let holds = |name: &str| path.iter().any(|part| part == name);
    let advice = if holds("dm-knee") {
        "data are not part of condyle: fetch meshes and gait of subject DM of the Grand Challenge (Fregly et al. 2012; \
         in jam-resources, models/knee_tka/grand_challenge/DM) and put them there; see the comment at the top of the \
         case"
    } else if holds("data") {
        "data are not part of condyle: the comment at the top of the case names their \
         source"
    } else {
        "correct the path; it is relative to the folder of the file that names it"
    };
    let message = format!("`{key}`: there is no file {}", path.display());
    Fault::new(message, advice)
}

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
    let written = key.to_lowercase();
    let mut words = std::iter::once(written.as_str()).chain(bases(&written));
    let synonym = words.find_map(|word| meant(word, keys)).map(str::to_owned);
    synonym.or_else(|| nearest(key, keys.iter().copied()))
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
    // Twelve digits hide the rounding error of the conversion.
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
    // A forgotten unit must not make a key look unlike itself: the better of both comparisons counts.
    let whole = strsim::normalized_damerau_levenshtein(&written, known);
    let base = strsim::normalized_damerau_levenshtein(&written, split_unit(known).0);
    whole.max(base)
}

/// Synonyms of keys, in small letters and without a unit; of several keys, the first in the table is meant.
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
    ("k", "circle_factor_mm3_per_nm"),
    ("k", "posterior_n_per_mm"),
    ("wear_coefficient", "wear_factor_mm3_per_nm"),
    ("wear_coefficient", "circle_factor_mm3_per_nm"),
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
