//! Anderson's mixing: from what a map made of the points tried so far, where it comes back to itself.

use std::collections::VecDeque;

use nalgebra::{DMatrix, DVector};

/// So many differences are mixed at most: more hold little that is new.
const DEPTH: usize = 8;
/// Part of the mean square of the differences that is added to each, so that those which say the same do not cancel
/// to rounding.
const MIN_PART: f64 = 1e-12;
/// The history is dropped once the residual grows to so many times the least: the map is no longer nearly linear there.
const BENT: f64 = 3.0;

/// The search for a point $x$ that a map $g$ leaves where it is.
///
/// With what is left, $f = g(x) - x$, the next point is $x + \beta f - \sum_j \gamma_j (\Delta x_j + \beta \Delta f_j)$, of
/// the $\gamma$ that make $|f - \sum_j \gamma_j \Delta f_j|$ least [walker-ni2011].
#[derive(Default)]
pub(crate) struct Mixing {
    last: Option<Seen>,
    changes: VecDeque<Seen>,
    least: Option<f64>,
}

/// A point reached and its residual, or the change of both from one point to the next.
struct Seen {
    reached: DVector<f64>,
    left: DVector<f64>,
}

impl Mixing {
    /// Returns the next point to try, from the `image` of the point `tried`, with the relaxation $\beta$ `part`.
    pub fn next(&mut self, tried: &[f64], image: &[f64], part: f64) -> Vec<f64> {
        let tried = DVector::from_column_slice(tried);
        let left = DVector::from_column_slice(image) - &tried;
        self.forget_where_bent(left.norm());
        let seen = Seen {
            reached: tried + part * &left,
            left,
        };
        if let Some(last) = &self.last {
            self.changes.push_back(Seen {
                reached: &seen.reached - &last.reached,
                left: &seen.left - &last.left,
            });
        }
        if self.changes.len() > DEPTH {
            self.changes.pop_front();
        }
        let mut next = seen.reached.clone();
        if let Some(parts) = self.parts(&seen.left) {
            for (change, part) in self.changes.iter().zip(parts.iter()) {
                next.axpy(-part, &change.reached, 1.0);
            }
        }
        self.last = Some(seen);
        next.as_slice().to_vec()
    }

    fn forget_where_bent(&mut self, size: f64) {
        let least = self.least.map_or(size, |least| least.min(size));
        self.least = Some(least);
        if size > BENT * least {
            *self = Self {
                least: Some(size),
                ..Self::default()
            };
        }
    }

    /// The $\gamma$ of the changes; none where there are none.
    fn parts(&self, left: &DVector<f64>) -> Option<DVector<f64>> {
        let count = self.changes.len();
        let of = |i: usize| &self.changes[i].left;
        let mut products = DMatrix::from_fn(count, count, |i, j| of(i).dot(of(j)));
        let mean = products.trace() / count as f64;
        for i in 0..count {
            products[(i, i)] += MIN_PART * mean;
        }
        let wanted = DVector::from_fn(count, |i, _| of(i).dot(left));
        Some(products.cholesky()?.solve(&wanted))
    }
}

/// The search for the set that stays as it is when loads are found with it, and the flow under these.
///
/// Where the insert deflects by flow more than elastically, each turn would lead farther away: such a turn is taken back, and
/// from then on the search goes shorter ways.
pub(crate) struct Turns {
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
    fn a_slow_map_is_led_to_its_fixed_point_in_few_steps() {
        // Plain steps would take 1 / (1 - 0.99) = 100 for each factor e.
        let factors = [0.99, 0.95, 0.7, 0.3, -0.2];
        let map = |x: &[f64]| -> Vec<f64> {
            let pairs = x.iter().zip(factors);
            pairs.map(|(x, factor)| factor * x + 1.0).collect()
        };
        let (mut mixing, mut x) = (Mixing::default(), vec![0.0; 5]);
        for _ in 0..8 {
            let image = map(&x);
            x = mixing.next(&x, &image, 1.0);
        }
        for (x, factor) in x.iter().zip(factors) {
            let exact = 1.0 / (1.0 - factor);
            assert!((x / exact - 1.0).abs() < 1e-6, "{x} {exact}");
        }
    }

    #[test]
    fn what_stays_stays() {
        let mut mixing = Mixing::default();
        for _ in 0..3 {
            assert_eq!(mixing.next(&[1.0, 2.0], &[1.0, 2.0], 1.0), [1.0, 2.0]);
        }
    }

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
