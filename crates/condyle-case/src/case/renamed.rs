//! Files of the previous version: its names of keys and its default wear law are still read, with a note.

use toml::{
    Spanned,
    de::{DeTable, DeValue},
};

use super::build::BuildWarning;
use crate::config::{rename, set_value, value_at};

/// Keys of `[contact]` that are in a table of its model.
const MOVED: &[(&str, &[&str])] = &[
    (
        "foundation",
        &[
            "law",
            "softening_strain",
            "softening_stress_mpa",
            "table",
            "table_file",
            "strain_table",
            "strain_table_file",
            "peak_error_percent",
        ],
    ),
    (
        "deformable",
        &[
            "plasticity",
            "yield_stress_mpa",
            "kinematic_modulus_mpa",
            "hardening",
            "friction_model",
            "backside",
            "backside_friction",
            "backside_spacing_mm",
        ],
    ),
];

/// Returns old and new dotted paths.
pub(super) fn renamed() -> impl Iterator<Item = (String, String)> {
    MOVED.iter().flat_map(|(table, keys)| {
        let paths = move |key| (format!("contact.{key}"), format!("contact.{table}.{key}"));
        keys.iter().map(paths)
    })
}

pub(super) fn current_path(path: &str) -> String {
    let new = renamed().find_map(|(old, new)| (old == path).then_some(new));
    new.unwrap_or_else(|| path.to_owned())
}

/// Moves every key of a case to its current path.
pub(super) fn rename_keys(document: &mut DeTable<'_>) -> Vec<BuildWarning> {
    let moved = renamed().filter(|(old, new)| rename(document, old, new));
    let note = |(old, new)| {
        let next = "the next version does not read the old name";
        BuildWarning::new(format!("`{old}` is called `{new}`; {next}"))
    };
    let mut notes: Vec<_> = moved.map(note).collect();
    notes.extend(name_archard(document));
    notes
}

/// Names the law of a file that only gives the factor of Archard's law, the default of the previous version.
fn name_archard(document: &mut DeTable<'_>) -> Option<BuildWarning> {
    let factor = value_at(document, "wear.wear_factor_mm3_per_nm")?.span();
    if value_at(document, "wear.law").is_some() {
        return None;
    }
    let archard = Spanned::new(factor.clone(), DeValue::String("archard".into()));
    set_value(document, "wear.law", factor, archard);
    Some(BuildWarning::new(
        "`wear.law` is not given, but `wear_factor_mm3_per_nm` is, so the law is taken to be \"archard\"; write \
         law = \"archard\", since the next version does not assume it"
            .to_owned(),
    ))
}
