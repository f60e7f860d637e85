//! A table of pressure against overclosure.

use thiserror::Error;

/// Why points make no pressure table.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PressureTableError {
    /// Fewer than two points.
    #[error("a pressure table needs two points or more, it has {count}")]
    TooShort {
        /// How many there are.
        count: usize,
    },
    /// The first point is not the origin.
    #[error(
        "a pressure table starts at overclosure 0 mm and pressure 0 MPa, this one at {overclosure_mm} mm and {pressure_mpa} MPa"
    )]
    NotFromZero {
        /// First overclosure.
        overclosure_mm: f64,
        /// First pressure.
        pressure_mpa: f64,
    },
    /// A point that does not rise above the one before, or is not finite.
    #[error(
        "point {index} of the pressure table does not rise: overclosure and pressure must both grow from point to point"
    )]
    NotRising {
        /// Which point, from 0.
        index: usize,
    },
}

/// Pressure against overclosure, linear between points and beyond the last.
#[derive(Clone, Debug, PartialEq)]
pub struct PressureTable {
    /// (overclosure mm, pressure MPa), from (0, 0), both rising.
    points: Vec<(f64, f64)>,
}

impl PressureTable {
    /// A table through (overclosure mm, pressure MPa) `points`.
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
            pair[1].0 > pair[0].0
                && pair[1].1 > pair[0].1
                && pair[1].0.is_finite()
                && pair[1].1.is_finite()
        };
        match points.windows(2).position(|pair| !rises(pair)) {
            Some(before) => Err(PressureTableError::NotRising { index: before + 1 }),
            None => Ok(Self { points }),
        }
    }

    /// The points, (overclosure mm, pressure MPa).
    pub fn points(&self) -> &[(f64, f64)] {
        &self.points
    }

    /// Pressure, MPa, and its derivative by the overclosure, MPa/mm.
    pub(super) fn pressure(&self, overclosure_mm: f64) -> (f64, f64) {
        let after = self
            .points
            .partition_point(|point| point.0 <= overclosure_mm);
        let piece = after.clamp(1, self.points.len() - 1);
        let ((xa, ya), (xb, yb)) = (self.points[piece - 1], self.points[piece]);
        let slope = (yb - ya) / (xb - xa);
        (ya + slope * (overclosure_mm - xa), slope)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_table_error_says_what_is_wrong() {
        let fail =
            |points: &[(f64, f64)]| PressureTable::new(points.to_vec()).unwrap_err().to_string();
        assert!(fail(&[(0.0, 0.0)]).contains("it has 1"));
        assert!(fail(&[(0.1, 0.0), (0.2, 1.0)]).contains("0.1 mm"));
        assert!(fail(&[(0.0, 0.0), (0.2, 1.0), (0.3, 1.0)]).contains("point 2"));
    }
}
