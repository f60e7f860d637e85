//! Units at the end of names.

/// Every unit that ends a name, with how a person writes it.
const UNITS: &[(&str, &str)] = &[
    ("_mg_per_mm3", "mg/mm3"),
    ("_mm3_per_nm", "mm3/(N m)"),
    ("_nm_s_per_rad", "N m s/rad"),
    ("_n_s_per_mm", "N s/mm"),
    ("_mm_per_s", "mm/s"),
    ("_n_per_mm", "N/mm"),
    ("_kg_m2", "kg m2"),
    ("_per_mpa", "1/MPa"),
    ("_mpa", "MPa"),
    ("_deg", "degrees"),
    ("_kg", "kg"),
    ("_gb", "GB"),
    ("_hz", "Hz"),
    ("_nm", "N m"),
    ("_mm", "mm"),
    ("_n", "N"),
    ("_s", "s"),
];

/// A key's name without its unit, and the unit in words.
pub(crate) fn split_unit(name: &str) -> (&str, Option<&'static str>) {
    UNITS
        .iter()
        .find_map(|&(suffix, unit)| Some((name.strip_suffix(suffix)?, Some(unit))))
        .unwrap_or((name, None))
}

/// The unit that `name` ends in, in words.
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
