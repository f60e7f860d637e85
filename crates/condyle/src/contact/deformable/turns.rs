//! The permanent set that loads and flow agree on, the one found under the other in turns.

use crate::number::Mixing;

/// The search for the set that stays as it is when loads are found with it, and the flow under these.
///
/// Where the insert gives way by flow more than elastically, each turn would lead farther away: such a turn is taken back, and
/// from then on the search goes shorter ways.
pub(super) struct Turns {
    mixing: Mixing,
    nearest: Option<Turn>,
    part: f64,
}

/// A set that was tried, and what the turn left.
struct Turn {
    tried_mm: Vec<f64>,
    left_mm: Vec<f64>,
    size_mm: f64,
}

impl Default for Turns {
    fn default() -> Self {
        Self {
            mixing: Mixing::default(),
            nearest: None,
            part: 1.0,
        }
    }
}

impl Turns {
    /// The set to try next, mm, after one was tried and another found.
    pub fn next(&mut self, tried_mm: &[f64], found_mm: &[f64]) -> Vec<f64> {
        let pairs = found_mm.iter().zip(tried_mm);
        let left_mm: Vec<f64> = pairs.map(|(found, tried)| found - tried).collect();
        let size_mm = left_mm.iter().map(|left| left * left).sum::<f64>().sqrt();
        if let Some(nearest) = &self.nearest
            && size_mm > nearest.size_mm
            && let Some(nearer) = self.nearer()
        {
            return nearer;
        }
        self.nearest = Some(Turn {
            tried_mm: tried_mm.to_vec(),
            left_mm,
            size_mm,
        });
        self.mixing.next(tried_mm, found_mm, self.part)
    }

    /// A set between the one that left least and what was found from it; none before a set was found.
    pub fn nearer(&mut self) -> Option<Vec<f64>> {
        let nearest = self.nearest.as_ref()?;
        self.part *= 0.5;
        self.mixing = Mixing::default();
        let pairs = nearest.tried_mm.iter().zip(&nearest.left_mm);
        let nearer = pairs.map(|(tried, left)| tried + self.part * left);
        Some(nearer.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_that_lead_away_are_led_to_where_they_agree() {
        // Plain turns would grow to three times as much each.
        let found = |x: &[f64]| vec![1.0 - 3.0 * x[0], 2.0 - 0.5 * x[1] - 0.1 * x[0]];
        let (mut turns, mut x) = (Turns::default(), vec![0.0, 0.0]);
        for _ in 0..12 {
            let image = found(&x);
            x = turns.next(&x, &image);
        }
        let left = found(&x)
            .iter()
            .zip(&x)
            .map(|(a, b)| (a - b).abs())
            .sum::<f64>();
        assert!(left < 1e-8, "{x:?} {left}");
    }
}
