//! Pressure from overclosure.

use thiserror::Error;

use crate::number::Number;

/// The pressure of an elastic layer on a rigid base as a function of overclosure: $d$ is the overclosure, $h$ the
/// thickness, and $K$ the modulus of the layer confined sideways.
///
/// A tenth of a millimetre into 8 mm of polyethylene:
///
/// ```
/// use condyle::contact::{PressureLaw, confined_modulus};
///
/// let law = PressureLaw::Linear { modulus_mpa: confined_modulus(463.0, 0.46) };
/// let (pressure_mpa, slope_mpa_per_mm) = law.pressure(0.1, 8.0);
/// assert!((pressure_mpa - 26.8).abs() < 0.1);
/// assert!((slope_mpa_per_mm - 268.0).abs() < 1.0);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum PressureLaw {
    /// $p = K d/h$.
    Linear {
        /// Modulus K of the confined layer, MPa: see [`confined_modulus`].
        modulus_mpa: f64,
    },
    /// $p = -K \ln(1 - d/h)$: stiffens as the layer is compressed.
    Logarithmic {
        /// Modulus K of the confined layer, MPa: see [`confined_modulus`].
        modulus_mpa: f64,
    },
    /// $d/h = (p/K)(1 + (p/s)^2)$: softens, as polyethylene does.
    Softening {
        /// Modulus K of the confined layer at no pressure, MPa: see [`softening_modulus`].
        modulus_mpa: f64,
        /// Pressure s at which the strain is twice that of the initial modulus, MPa.
        softening_stress_mpa: f64,
    },
    /// Pressure against overclosure, independent of the thickness, as Abaqus tabulates it.
    Tabulated(PressureTable),
    /// Pressure against the strain d/h: the table of a layer 1 mm thick.
    TabulatedStrain(PressureTable),
}

/// Part of the layer's thickness from which on the logarithmic law continues as a straight line, so that a Newton iterate
/// beyond the layer, where the logarithm is undefined, still finds its way back.
const LOGARITHM_ENDS_AT: f64 = 0.9;

/// Returns the modulus of an elastic layer confined sideways, $K = (1 - \nu) E/((1 + \nu)(1 - 2 \nu))$, MPa.
///
/// Source: the elastic foundation of Bei & Fregly 2004; `youngs_modulus_mpa` > 0,
/// `poissons_ratio` in \[0, 0.5).
pub fn confined_modulus(youngs_modulus_mpa: f64, poissons_ratio: f64) -> f64 {
    let v = poissons_ratio;
    (1.0 - v) * youngs_modulus_mpa / ((1.0 + v) * (1.0 - 2.0 * v))
}

/// Returns the modulus of a spherical shell bonded to a rigid outer sphere whose inside is displaced evenly, MPa: the
/// pressure per displacement, times the thickness, as [`confined_modulus`] of a flat layer.
///
/// $K = \frac{E h}{R (r - 1)} \left(\frac{1}{1 - 2 \nu} + \frac{2 r}{1 + \nu}\right)$ with
/// $r = (1 + h/R)^3$, the form of Bartel et al. 1985 for the cup of a hip; a nearly incompressible shell is softer than a
/// flat layer, since it is longer around outside than inside.
pub fn shell_modulus(
    youngs_modulus_mpa: f64,
    poissons_ratio: f64,
    radius_mm: f64,
    thickness_mm: f64,
) -> f64 {
    let v = poissons_ratio;
    let r = ((radius_mm + thickness_mm) / radius_mm).powi(3);
    let shape = 1.0 / (1.0 - 2.0 * v) + 2.0 * r / (1.0 + v);
    youngs_modulus_mpa * thickness_mm * shape / (radius_mm * (r - 1.0))
}

/// Returns the modulus at zero pressure, MPa, of a confined layer whose material follows the uniaxial curve
/// $\epsilon = \tfrac{1}{2} \epsilon_0 (\sigma/\sigma_0 + (\sigma/\sigma_0)^3)$:
/// [`confined_modulus`] of $E = 2 \sigma_0/\epsilon_0$.
///
/// Source: the form of the curve Fregly, Bei and Sylvester 2003; `softening_strain` is
/// $\epsilon_0$ > 0, `softening_stress_mpa` is $\sigma_0$ > 0.
pub fn softening_modulus(
    softening_strain: f64,
    softening_stress_mpa: f64,
    poissons_ratio: f64,
) -> f64 {
    confined_modulus(
        2.0 * softening_stress_mpa / softening_strain,
        poissons_ratio,
    )
}

impl PressureLaw {
    /// Returns the pressure, MPa, and its derivative by the overclosure, MPa/mm, for an `overclosure_mm` >= 0 of a layer of
    /// thickness 1/`per_thickness`, in every lane.
    #[inline(always)]
    pub fn pressures<T: Number>(&self, overclosure_mm: T, per_thickness: T) -> (T, T) {
        if let Self::Linear { modulus_mpa } = self {
            let stiffness = T::splat(*modulus_mpa) * per_thickness;
            // The linear law stays in lanes; the others need functions that exist for single numbers only.
            return (stiffness * overclosure_mm, stiffness);
        }
        let at = |lane| self.pressure(overclosure_mm.lane(lane), 1.0 / per_thickness.lane(lane));
        (
            T::from_lanes(|lane| at(lane).0),
            T::from_lanes(|lane| at(lane).1),
        )
    }

    /// Returns the single variable on which the pressure depends: the strain d/h, or with a table the overclosure d, mm.
    ///
    /// Taken as the overclosure of a layer 1 mm thick it gives the same pressure.
    pub fn measure(&self, overclosure_mm: f64, per_thickness: f64) -> f64 {
        match self {
            Self::Linear { .. }
            | Self::Logarithmic { .. }
            | Self::Softening { .. }
            | Self::TabulatedStrain(_) => overclosure_mm * per_thickness,
            Self::Tabulated(_) => overclosure_mm,
        }
    }

    /// Returns the pressure, MPa, and its derivative by the overclosure, MPa/mm, for an `overclosure_mm` >= 0 of a layer
    /// `thickness_mm` thick.
    pub fn pressure(&self, overclosure_mm: f64, thickness_mm: f64) -> (f64, f64) {
        match self {
            Self::Linear { modulus_mpa } => {
                let stiffness = modulus_mpa / thickness_mm;
                (stiffness * overclosure_mm, stiffness)
            }
            Self::Logarithmic { modulus_mpa } => {
                let strain = overclosure_mm / thickness_mm;
                let (value, slope) = minus_log_one_minus(strain);
                (modulus_mpa * value, modulus_mpa * slope / thickness_mm)
            }
            Self::Softening {
                modulus_mpa,
                softening_stress_mpa,
            } => {
                let per_stress = modulus_mpa / softening_stress_mpa;
                let (value, slope) = root_of_cube(per_stress * overclosure_mm / thickness_mm);
                let slope_mpa_per_mm = modulus_mpa * slope / thickness_mm;
                (softening_stress_mpa * value, slope_mpa_per_mm)
            }
            Self::Tabulated(table) => table.pressure(overclosure_mm),
            Self::TabulatedStrain(table) => {
                let (value, slope) = table.pressure(overclosure_mm / thickness_mm);
                (value, slope / thickness_mm)
            }
        }
    }
}

/// Returns -ln(1 - x) and its derivative, continued as a straight line beyond [`LOGARITHM_ENDS_AT`].
fn minus_log_one_minus(x: f64) -> (f64, f64) {
    let end = x.min(LOGARITHM_ENDS_AT);
    // With `ln_1p` strains of 1e-9 keep their digits.
    let slope = 1.0 / (1.0 - end);
    (-(-end).ln_1p() + (x - end) * slope, slope)
}

/// Returns the root x of x + x^3 = y for y >= 0, and dx/dy.
///
/// With $x = \tfrac{2}{\sqrt 3} \sinh t$ the left side is $\tfrac{2}{3 \sqrt 3} \sinh 3t$.
fn root_of_cube(y: f64) -> (f64, f64) {
    // Cardano's formula subtracts two nearly equal roots for a small y; this form does not cancel.
    let root_of_three = 3f64.sqrt();
    let third = (1.5 * root_of_three * y).asinh() / 3.0;
    let x = 2.0 / root_of_three * third.sinh();
    (x, 1.0 / (1.0 + 3.0 * x * x))
}

/// An error in the points of a pressure table.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PressureTableError {
    /// Fewer than two points.
    #[error("a pressure table needs two points or more, it has {count}")]
    TooShort { count: usize },
    /// The first point is not the origin.
    #[error(
        "a pressure table starts at overclosure 0 mm and pressure 0 MPa, this one at {overclosure_mm} mm and {pressure_mpa} MPa"
    )]
    NotFromZero {
        overclosure_mm: f64,
        pressure_mpa: f64,
    },
    /// A point is not above the one before, or not finite.
    #[error(
        "point {index} of the pressure table does not rise: overclosure and pressure must both grow from point to point"
    )]
    NotRising { index: usize },
}

/// Pressure against overclosure, linear between points and beyond the last.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureTable {
    /// (overclosure mm, pressure MPa), from (0, 0), both rising.
    points: Vec<(f64, f64)>,
}

impl PressureTable {
    /// Creates a table through (overclosure mm, pressure MPa) `points`.
    ///
    /// # Errors
    /// Fewer than two points, a first that is not (0, 0), or one that does not rise.
    pub fn new(points: Vec<(f64, f64)>) -> Result<Self, PressureTableError> {
        if points.len() < 2 {
            return Err(PressureTableError::TooShort {
                count: points.len(),
            });
        }
        let (overclosure_mm, pressure_mpa) = points[0];
        if (overclosure_mm, pressure_mpa) != (0.0, 0.0) {
            return Err(PressureTableError::NotFromZero {
                overclosure_mm,
                pressure_mpa,
            });
        }
        let rises = |pair: &[(f64, f64)]| {
            let ((xa, ya), (xb, yb)) = (pair[0], pair[1]);
            xb > xa && yb > ya && xb.is_finite() && yb.is_finite()
        };
        match points.windows(2).position(|pair| !rises(pair)) {
            Some(before) => Err(PressureTableError::NotRising { index: before + 1 }),
            None => Ok(Self { points }),
        }
    }

    /// Returns the points, (overclosure mm, pressure MPa).
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    fn pressure(&self, overclosure_mm: f64) -> (f64, f64) {
        let after = self
            .points
            .partition_point(|point| point.0 <= overclosure_mm);
        // Beyond the last point its piece continues.
        let piece = after.clamp(1, self.points.len() - 1);
        let ((xa, ya), (xb, yb)) = (self.points[piece - 1], self.points[piece]);
        let slope = (yb - ya) / (xb - xa);
        (ya + slope * (overclosure_mm - xa), slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOFTENING: PressureLaw = PressureLaw::Softening {
        modulus_mpa: 2000.0,
        softening_stress_mpa: 18.4,
    };

    #[test]
    fn verify_stiffness_of_facts_at_six_eight_and_ten_mm() {
        let law = PressureLaw::Linear {
            modulus_mpa: confined_modulus(463.0, 0.46),
        };
        for (thickness, stiffness) in [(6.0, 357.0), (8.0, 268.0), (10.0, 214.0)] {
            assert!((law.pressure(1.0, thickness).0 - stiffness).abs() < 1.0);
        }
    }

    #[test]
    fn slopes_are_derivatives() {
        let table = PressureTable::new(vec![(0.0, 0.0), (0.1, 5.0), (0.4, 60.0)]).unwrap();
        let laws = [
            PressureLaw::Linear {
                modulus_mpa: 2000.0,
            },
            PressureLaw::Logarithmic {
                modulus_mpa: 2000.0,
            },
            SOFTENING,
            PressureLaw::Tabulated(table.clone()),
            PressureLaw::TabulatedStrain(table),
        ];
        for law in laws {
            for overclosure in [0.02, 0.25, 0.5, 3.0, 9.5] {
                let step = 1e-6;
                let rise = law.pressure(overclosure + step, 9.0).0
                    - law.pressure(overclosure - step, 9.0).0;
                let slope = law.pressure(overclosure, 9.0).1;
                assert!((rise / (2.0 * step) / slope - 1.0).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn verify_logarithmic_law_starts_as_the_linear_one() {
        let (value, slope) = minus_log_one_minus(1e-9);
        assert!((value / 1e-9 - 1.0).abs() < 1e-8 && (slope - 1.0).abs() < 1e-8);
        assert!((minus_log_one_minus(0.5).0 - 2f64.ln()).abs() < 1e-15);
    }

    #[test]
    fn verify_softening_law_is_the_curve_of_the_material_confined() {
        let (strain_at, stress_at) = (0.0597, 18.4);
        let modulus_mpa = softening_modulus(strain_at, stress_at, 0.46);
        let law = PressureLaw::Softening {
            modulus_mpa,
            softening_stress_mpa: stress_at,
        };
        let confined = confined_modulus(1.0, 0.46);
        for pressure in [0.1, 5.0, 18.4, 60.0] {
            let part: f64 = pressure / stress_at;
            let strain = 0.5 * strain_at * (part + part.powi(3)) / confined;
            assert!((law.pressure(9.0 * strain, 9.0).0 / pressure - 1.0).abs() < 1e-13);
        }
        assert!((modulus_mpa / 2850.0 - 1.0).abs() < 1e-3);
        assert!((law.pressure(1e-9, 1.0).1 / modulus_mpa - 1.0).abs() < 1e-9);
    }

    #[test]
    fn a_layer_of_a_millimetre_with_the_measure_has_the_same_pressure() {
        let table = PressureTable::new(vec![(0.0, 0.0), (0.1, 5.0), (0.4, 60.0)]).unwrap();
        let (modulus_mpa, overclosure, thickness) = (2000.0, 0.3, 9.0);
        for law in [
            PressureLaw::Linear { modulus_mpa },
            PressureLaw::Logarithmic { modulus_mpa },
            SOFTENING,
            PressureLaw::Tabulated(table.clone()),
            PressureLaw::TabulatedStrain(table),
        ] {
            let pressure = law.pressure(overclosure, thickness).0;
            let measure = law.measure(overclosure, 1.0 / thickness);
            assert!((law.pressure(measure, 1.0).0 / pressure - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn every_table_error_says_what_is_wrong() {
        let fail =
            |points: &[(f64, f64)]| PressureTable::new(points.to_vec()).unwrap_err().to_string();
        assert!(fail(&[(0.0, 0.0)]).contains("it has 1"));
        assert!(fail(&[(0.1, 0.0), (0.2, 1.0)]).contains("0.1 mm"));
        assert!(fail(&[(0.0, 0.0), (0.2, 1.0), (0.3, 1.0)]).contains("point 2"));
    }
}
