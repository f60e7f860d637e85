//! Anderson's mixing: the fixed point of a map from its images of the points tried so far.

use std::collections::VecDeque;

use nalgebra::{DMatrix, DVector};

/// Largest number of differences that are kept: more add little information.
const DEPTH: usize = 8;
/// Part of the mean square of the differences that is added to each square, so that nearly equal differences do not
/// cancel to rounding.
const MIN_PART: f64 = 1e-12;
/// Ratio of the residual to the smallest so far at which the history is discarded: the map is no longer nearly
/// linear.
const BENT: f64 = 3.0;

/// The search for a fixed point $x$ of a map $g$.
///
/// With the residual $f = g(x) - x$, the next point is $x + \beta f - \sum_j \gamma_j (\Delta x_j + \beta \Delta f_j)$, with
/// the $\gamma$ that minimise $|f - \sum_j \gamma_j \Delta f_j|$ [walker-ni2011].
#[derive(Default)]
pub(crate) struct Mixing {
    last: Option<Seen>,
    changes: VecDeque<Seen>,
    /// The products of the residual of every change with those of itself and of the changes before.
    products: VecDeque<Vec<f64>>,
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
        let size = left.norm();
        let least = self.least.map_or(size, |least| least.min(size));
        if size > BENT * least {
            *self = Self::default();
        }
        self.least = Some(if size > BENT * least { size } else { least });
        let seen = Seen {
            reached: tried + part * &left,
            left,
        };
        if let Some(last) = &self.last {
            self.changes.push_back(Seen {
                reached: &seen.reached - &last.reached,
                left: &seen.left - &last.left,
            });
            // The oldest difference belongs to the point farthest from the solution.
            if self.changes.len() > DEPTH {
                self.changes.pop_front();
                self.products.pop_front();
                for products in &mut self.products {
                    products.remove(0);
                }
            }
            let own = &self.changes[self.changes.len() - 1].left;
            let products = self.changes.iter().map(|change| change.left.dot(own));
            self.products.push_back(products.collect());
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

    /// Returns the $\gamma$ of the changes; none if there are none.
    fn parts(&self, left: &DVector<f64>) -> Option<DVector<f64>> {
        let count = self.changes.len();
        // Cholesky's factor reads the lower triangle only.
        let product = |i: usize, j: usize| self.products[i].get(j).copied().unwrap_or(0.0);
        let mut products = DMatrix::from_fn(count, count, product);
        // Normal equations suffice: at most eight columns, and the diagonal is raised below.
        let mean = products.trace() / count as f64;
        for i in 0..count {
            products[(i, i)] += MIN_PART * mean;
        }
        // If the factor fails by rounding, the step is a plain one.
        let wanted = DVector::from_fn(count, |i, _| self.changes[i].left.dot(left));
        Some(products.cholesky()?.solve(&wanted))
    }
}

/// The search for the permanent set that agrees with the flow under the loads that it causes.
///
/// Where the insert deflects by flow more than elastically, plain iteration diverges: a turn that increases the residual is
/// taken back, and the search continues with shorter steps.
pub(crate) struct Turns {
    mixing: Mixing,
    nearest: Option<Turn>,
    part: f64,
}

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
    /// Returns the set to try next, mm, after one was tried and another computed from it.
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

    /// Returns a set between the one with the least residual and its image; none before the first.
    pub fn nearer(&mut self) -> Option<Vec<f64>> {
        let nearest = self.nearest.as_ref()?;
        self.part *= 0.5;
        // The old differences belong to longer steps.
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
