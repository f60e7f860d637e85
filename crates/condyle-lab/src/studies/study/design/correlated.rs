//! Inputs that go together.

use condyle_io::study::Correlation;
use nalgebra::DMatrix;

use super::super::quantile::{deviations, share_below};
use super::place::Place;

/// Makes inputs that know nothing of each other go together: of their normal scores z it takes L z, where L L^T is the
/// matrix of correlations.
pub(in super::super) struct Correlated(DMatrix<f64>);

impl Correlated {
    /// None where the correlations contradict each other.
    pub fn new(inputs: usize, correlations: &[Correlation]) -> Option<Self> {
        let mut matrix = DMatrix::identity(inputs, inputs);
        for correlation in correlations {
            let [one, other] = correlation.inputs;
            matrix[(one, other)] = correlation.coefficient;
            matrix[(other, one)] = correlation.coefficient;
        }
        Some(Self(matrix.cholesky()?.unpack()))
    }

    /// The same places, correlated. An input that goes with no other stays where it is, to the bit.
    pub fn apply(&self, places: &mut [Place]) {
        let score = |place: &Place| match place {
            Place::Share(share) => deviations(*share),
            Place::AsItIs | Place::Along(_) => 0.0,
        };
        let scores: Vec<f64> = places.iter().map(score).collect();
        for (row, place) in places.iter_mut().enumerate() {
            let before = self.0.row(row);
            if before.iter().take(row).all(|factor| *factor == 0.0) {
                continue;
            }
            let sum = before
                .iter()
                .zip(&scores)
                .map(|(factor, score)| factor * score);
            *place = Place::Share(share_below(sum.sum()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::sobol_places;
    use super::*;

    fn of(coefficient: f64) -> Correlation {
        Correlation {
            inputs: [0, 2],
            coefficient,
        }
    }

    #[test]
    fn verify_scores_have_the_correlation_and_others_stay() {
        let correlated = Correlated::new(3, &[of(0.8)]).unwrap();
        let mut sum = 0.0;
        let count = 4096;
        for row in 0..count {
            let mut places = sobol_places(row, 3, 1);
            let before = places.clone();
            correlated.apply(&mut places);
            assert_eq!(before[..2], places[..2]);
            let score = |place: Place| match place {
                Place::Share(share) => deviations(share),
                _ => f64::NAN,
            };
            sum += score(places[0]) * score(places[2]);
        }
        let found = sum / count as f64;
        assert!((found - 0.8).abs() < 0.01, "{found}");
    }

    #[test]
    fn contradictions_are_found() {
        let pair = |inputs, coefficient| Correlation {
            inputs,
            coefficient,
        };
        let all = [pair([0, 1], 0.9), pair([1, 2], 0.9), pair([0, 2], -0.9)];
        assert!(Correlated::new(3, &all).is_none());
    }
}
