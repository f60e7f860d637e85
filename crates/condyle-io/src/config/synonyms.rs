//! Words for a key that no spelling would lead to: its sign in a formula, or its name elsewhere.

/// What a person may write, in small letters and without a unit, and the key that is meant; where
/// a word has several, the first that the table has.
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

/// The one of `keys` that `word`, in small letters, is another word for.
pub(super) fn meant<'a>(word: &str, keys: &[&'a str]) -> Option<&'a str> {
    let of_word = SYNONYMS.iter().filter(|(written, _)| *written == word);
    let mut there = of_word.filter_map(|(_, key)| keys.iter().find(|known| *known == key));
    there.next().copied()
}
