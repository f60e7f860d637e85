//! The numbers that a study keeps of every test.

use condyle_results::Summary;

/// A number that a study keeps of every test.
#[derive(Clone, Copy, Debug)]
pub struct Output {
    /// Its name in tables, which ends in its unit.
    pub name: &'static str,
    /// Its name on the screen.
    pub title: &'static str,
    /// Its unit; empty for a pure number.
    pub unit: &'static str,
    /// Where a summary has it.
    pub of: fn(&Summary) -> f64,
}

macro_rules! outputs {
    ($($name:ident, $title:literal, $unit:literal;)+) => {
        /// All of them, in the order of the table.
        pub const OUTPUTS: &[Output] = &[$(Output {
            name: stringify!($name),
            title: $title,
            unit: $unit,
            of: |summary| summary.$name,
        }),+];
    };
}

outputs! {
    mass_loss_mg, "mass loss", "mg";
    volume_loss_mm3, "volume loss", "mm3";
    max_depth_mm, "deepest wear", "mm";
    peak_pressure_mpa, "peak pressure", "MPa";
    first_cycle_peak_pressure_mpa, "peak pressure of the first cycle", "MPa";
    last_cycle_peak_pressure_mpa, "peak pressure of the last cycle", "MPa";
    peak_contact_area_mm2, "largest contact area", "mm2";
    ap_range_mm, "AP range", "mm";
    ie_range_deg, "IE range", "degrees";
    medial_load_share, "medial load share", "";
}

impl Output {
    /// The output called `name`.
    pub fn named(name: &str) -> Option<&'static Self> {
        OUTPUTS.iter().find(|output| output.name == name)
    }
}
