//! The three pressure laws on a flat layer of one thickness, and their exact pressures.

use condyle::contact::{PressureLaw, PressureTable, confined_modulus};

/// Thickness of the layer, mm.
pub(crate) const THICKNESS_MM: f64 = 9.0;

/// Points of the tabulated law, mm and MPa: a layer that stiffens.
const TABLE: [(f64, f64); 4] = [(0.0, 0.0), (0.1, 22.0), (0.25, 58.0), (1.0, 260.0)];

/// Modulus of the confined layer of the default material, MPa: E = 463 MPa, v = 0.46.
pub(crate) fn modulus_mpa() -> f64 {
    confined_modulus(463.0, 0.46)
}

/// A law with what is exact of it.
pub(crate) struct ExactLaw {
    /// Its name.
    pub name: &'static str,
    /// As condyle has it.
    pub law: PressureLaw,
    /// Pressure at an overclosure in mm, MPa.
    pub pressure_mpa: fn(f64) -> f64,
    /// Integral of the pressure up to an overclosure, MPa mm.
    pub integral: fn(f64) -> f64,
}

/// The linear, the logarithmic and a tabulated law.
pub(crate) fn exact_laws() -> [ExactLaw; 3] {
    let modulus_mpa = modulus_mpa();
    let table = PressureTable::new(TABLE.to_vec()).expect("a table that rises");
    [
        ExactLaw {
            name: "linear",
            law: PressureLaw::Linear { modulus_mpa },
            pressure_mpa: |d| self::modulus_mpa() * d / THICKNESS_MM,
            integral: |d| self::modulus_mpa() * d * d / (2.0 * THICKNESS_MM),
        },
        ExactLaw {
            name: "logarithmic",
            law: PressureLaw::Logarithmic { modulus_mpa },
            pressure_mpa: |d| -self::modulus_mpa() * (-d / THICKNESS_MM).ln_1p(),
            integral: |d| {
                let x = d / THICKNESS_MM;
                self::modulus_mpa() * THICKNESS_MM * ((1.0 - x) * (-x).ln_1p() + x)
            },
        },
        ExactLaw {
            name: "tabulated",
            law: PressureLaw::Tabulated(table),
            pressure_mpa: |d| {
                let pieces = TABLE.windows(2);
                pieces.map(|ends| rise(ends, d)).sum()
            },
            integral: |d| {
                let pieces = TABLE.windows(2);
                pieces.map(|ends| area_to(ends, d)).sum()
            },
        },
    ]
}

/// Overclosures at which the tabulated law has a kink, mm.
pub(crate) fn kinks_mm() -> impl Iterator<Item = f64> {
    TABLE.iter().map(|point| point.0)
}

/// What one piece of the table adds to the pressure at an overclosure.
fn rise(ends: &[(f64, f64)], d: f64) -> f64 {
    let ((x0, p0), (x1, p1)) = (ends[0], ends[1]);
    (p1 - p0) * (d.clamp(x0, x1) - x0) / (x1 - x0)
}

/// What one piece of the table adds to the integral up to an overclosure: its own triangle, and
/// its rise for all that lies beyond.
fn area_to(ends: &[(f64, f64)], d: f64) -> f64 {
    let (x0, x1) = (ends[0].0, ends[1].0);
    let inside = d.clamp(x0, x1) - x0;
    rise(ends, d) * (inside / 2.0 + (d - x1).max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integrals_are_those_of_the_pressures() {
        for law in exact_laws() {
            let d = 0.4;
            let places = (0..100_000).map(|i| d * (f64::from(i) + 0.5) / 1e5);
            let sum: f64 = places.map(law.pressure_mpa).sum::<f64>() * d / 1e5;
            assert!((sum / (law.integral)(d) - 1.0).abs() < 1e-8, "{}", law.name);
            let pressed = law.law.pressure(d, THICKNESS_MM).0;
            assert!(
                (pressed / (law.pressure_mpa)(d) - 1.0).abs() < 1e-12,
                "{}",
                law.name
            );
        }
    }
}
