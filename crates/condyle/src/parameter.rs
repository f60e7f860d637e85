//! Constants of a law, described so that a case file, a page or another program can offer them.

/// A constant of a law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    /// Name, which ends in the unit unless it is a pure number: `wear_factor_mm3_per_nm`.
    pub name: &'static str,
    /// Description in one sentence.
    pub about: &'static str,
    /// Default value.
    pub default: f64,
    /// Smallest permitted value.
    pub least: f64,
    /// Largest permitted value.
    pub most: f64,
    /// Source of the default: a key of `references.bib`, or `choice`.
    pub source: &'static str,
    /// Certainty of the default.
    pub known: Known,
}

/// The certainty of a constant or a formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Known {
    /// Read in its source.
    Read,
    /// Quoted from memory, not checked at the source: pages say *approximate*.
    Approximate,
    /// A choice of condyle's authors.
    Chosen,
}

impl Parameter {
    /// Returns whether `value` is within the limits; NaN never is.
    pub fn allows(&self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }
}

/// The units with which names may end, each with its usual notation.
const UNITS: &[(&str, &str)] = &[
    ("_mg_per_million_cycles", "mg per million cycles"),
    ("_mm_per_million_cycles", "mm per million cycles"),
    ("_mg_per_mm3", "mg/mm3"),
    ("_mm3_per_nm", "mm3/(N m)"),
    ("_nm_s_per_rad", "N m s/rad"),
    ("_n_s_per_mm", "N s/mm"),
    ("_mm_per_s", "mm/s"),
    ("_nm_per_deg", "N m/deg"),
    ("_n_per_mm", "N/mm"),
    ("_kg_m2", "kg m2"),
    ("_percent", "%"),
    ("_per_mpa", "1/MPa"),
    ("_mpa", "MPa"),
    ("_deg", "degrees"),
    ("_rad", "rad"),
    ("_mm3", "mm3"),
    ("_mm2", "mm2"),
    ("_kg", "kg"),
    ("_mg", "mg"),
    ("_gb", "GB"),
    ("_hz", "Hz"),
    ("_mb", "MB"),
    ("_nm", "N m"),
    ("_mm", "mm"),
    ("_n", "N"),
    ("_s", "s"),
];

/// Returns a key's name without its unit, and the unit in words.
pub fn split_unit(name: &str) -> (&str, Option<&'static str>) {
    UNITS
        .iter()
        .find_map(|&(suffix, unit)| Some((name.strip_suffix(suffix)?, Some(unit))))
        .unwrap_or((name, None))
}

/// Returns the unit that `name` ends in, in words.
pub fn unit_of(name: &str) -> Option<&'static str> {
    split_unit(name).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longest_unit_wins() {
        assert_eq!(unit_of("slip_tolerance_mm_per_s"), Some("mm/s"));
        assert_eq!(unit_of("posterior_n_per_mm"), Some("N/mm"));
        assert_eq!(split_unit("edge_mm"), ("edge", Some("mm")));
        assert_eq!(split_unit("layers"), ("layers", None));
    }
}
