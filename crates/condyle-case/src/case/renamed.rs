//! Keys under the names that they had in the previous version: they are still read, with a note of the new name.

use toml::de::DeTable;

use super::contents::CaseNote;
use crate::config::rename;

/// Old and new dotted paths.
const RENAMED: &[(&str, &str)] = &[
    ("contact.law", "contact.foundation.law"),
    (
        "contact.softening_strain",
        "contact.foundation.softening_strain",
    ),
    (
        "contact.softening_stress_mpa",
        "contact.foundation.softening_stress_mpa",
    ),
    ("contact.table", "contact.foundation.table"),
    ("contact.table_file", "contact.foundation.table_file"),
    ("contact.strain_table", "contact.foundation.strain_table"),
    (
        "contact.strain_table_file",
        "contact.foundation.strain_table_file",
    ),
    (
        "contact.peak_error_percent",
        "contact.foundation.peak_error_percent",
    ),
    ("contact.plasticity", "contact.deformable.plasticity"),
    (
        "contact.yield_stress_mpa",
        "contact.deformable.yield_stress_mpa",
    ),
    (
        "contact.kinematic_modulus_mpa",
        "contact.deformable.kinematic_modulus_mpa",
    ),
    ("contact.hardening", "contact.deformable.hardening"),
    (
        "contact.friction_model",
        "contact.deformable.friction_model",
    ),
    ("contact.backside", "contact.deformable.backside"),
    (
        "contact.backside_friction",
        "contact.deformable.backside_friction",
    ),
    (
        "contact.backside_spacing_mm",
        "contact.deformable.backside_spacing_mm",
    ),
];

pub(super) fn current_path(path: &str) -> &str {
    let renamed = RENAMED.iter().find(|(old, _)| *old == path);
    renamed.map_or(path, |(_, new)| new)
}

/// Moves every key of a case to its current path.
pub(super) fn rename_keys(document: &mut DeTable<'_>) -> Vec<CaseNote> {
    let moved = RENAMED
        .iter()
        .filter(|(old, new)| rename(document, old, new));
    moved
        .map(|&(old, new)| CaseNote::Renamed { old, new })
        .collect()
}
