//! The recognition of a body's orientation from its shape.

use super::{
    signs::{fit_femur, fit_insert},
    views::{Orientation, Views},
};
use crate::geometry::TriangleMesh;

/// Lead in score of another orientation that makes the given one likely wrong. The right orientation of
/// about a hundred shapes, whole, cut, leaning and noisy, was never so far behind.
const LIKELY_MARGIN: f64 = 2.0;
/// Lead that makes it certainly wrong: more than any one sign can contribute.
const CERTAIN_MARGIN: f64 = 6.0;

/// Difference in score below which two orientations fit equally well.
const EQUAL_MARGIN: f64 = 0.5;

/// The scores of the 24 orientations of a body, from its shape alone.
#[derive(Clone, Debug)]
pub struct Recognition {
    /// The best first.
    scores: Vec<(Orientation, f64)>,
}

/// The certainty that an orientation is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sureness {
    /// Some signs contradict it.
    Likely,
    /// Several signs that hold for every design contradict it.
    Certain,
}

impl Recognition {
    /// Recognises a femoral component; none if the shape is not a whole component.
    pub fn of_femur(mesh: &TriangleMesh) -> Option<Self> {
        Self::new(mesh, fit_femur)
    }

    /// Recognises an insert, closed or an open articulating surface; none if the shape does not have two dishes.
    pub fn of_insert(mesh: &TriangleMesh) -> Option<Self> {
        Self::new(mesh, fit_insert)
    }

    /// Scores all orientations; none if the best is not plausible.
    fn new(mesh: &TriangleMesh, fit: impl Fn(&Views, &Orientation) -> (f64, bool)) -> Option<Self> {
        let views = Views::new(mesh)?;
        let mut fits: Vec<_> = Orientation::all()
            .map(|orientation| (orientation, fit(&views, &orientation)))
            .collect();
        fits.sort_by(|(_, (a, _)), (_, (b, _))| b.total_cmp(a));
        let is_plausible = fits
            .first()
            .is_some_and(|(_, (_, is_plausible))| *is_plausible);
        let scores = fits
            .iter()
            .map(|&(orientation, (score, _))| (orientation, score));
        is_plausible.then(|| Self {
            scores: scores.collect(),
        })
    }

    /// Returns the orientations that fit best and cannot be distinguished, best first.
    pub fn best(&self) -> impl Iterator<Item = Orientation> {
        self.within(LIKELY_MARGIN)
    }

    /// Returns the orientations whose scores are less than `margin` below the best, best first.
    fn within(&self, margin: f64) -> impl Iterator<Item = Orientation> {
        let highest = self.scores[0].1;
        let scores = self.scores.iter();
        scores
            .take_while(move |(_, score)| highest - score < margin)
            .map(|(orientation, _)| *orientation)
    }

    /// Returns the certainty that `orientation` is wrong; none if it may be right.
    pub fn against(&self, orientation: &Orientation) -> Option<Sureness> {
        let highest = self.scores[0].1;
        let (_, score) = self.scores.iter().find(|(one, _)| one == orientation)?;
        if highest - score >= CERTAIN_MARGIN {
            Some(Sureness::Certain)
        } else if highest - score >= LIKELY_MARGIN {
            Some(Sureness::Likely)
        } else {
            None
        }
    }

    /// Returns the orientation with the smallest rotation from x anterior, y superior, z right of those that fit as well
    /// as the best.
    pub fn nearest(&self) -> Orientation {
        // The trace of a rotation is 1 + 2 cos(angle).
        let least_turn = |orientation: &Orientation| orientation.rotation().trace();
        let equal = self.within(EQUAL_MARGIN);
        equal
            .reduce(|a, b| {
                if least_turn(&b) > least_turn(&a) {
                    b
                } else {
                    a
                }
            })
            .unwrap_or(Orientation::ISB)
    }

    /// Returns the certainty that all but the best are wrong; none if another may be right.
    pub fn sureness(&self) -> Option<Sureness> {
        let second = self.scores[1].0;
        self.against(&second)
    }
}
