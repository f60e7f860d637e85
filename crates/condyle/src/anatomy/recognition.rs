//! Which of the 24 orientations a body has, and how sure that is.

use super::{femur::FemurSigns, insert::InsertSigns, orientation::Orientation, views::Views};
use crate::geometry::TriangleMesh;

/// So much better another orientation must fit for the given one to be likely wrong. The right one of
/// some hundred shapes, whole, cut, leaning and noisy, never came so far behind.
const LIKELY_MARGIN: f64 = 2.0;
/// The same for it to be wrong for certain: more than any one sign can tell.
const CERTAIN_MARGIN: f64 = 6.0;

/// Two that differ by less fit equally well.
const EQUAL_MARGIN: f64 = 0.5;

/// How the 24 orientations fit a body, told from its shape alone.
#[derive(Clone, Debug)]
pub struct Recognition {
    /// The best first.
    scores: Vec<(Orientation, f64)>,
}

/// How sure it is that a body lies otherwise than it is said to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sureness {
    /// Some signs say so.
    Likely,
    /// Several signs that hold for every design say so.
    Certain,
}

impl Recognition {
    /// Recognises a femoral component; none if the shape is not that of a whole one, so that nothing
    /// can be told.
    pub fn of_femur(mesh: &TriangleMesh) -> Option<Self> {
        let views = Views::new(mesh)?;
        Self::of(|orientation| {
            let signs = FemurSigns::of(&views, orientation);
            (signs.score(), signs.is_a_femur())
        })
    }

    /// Recognises an insert, closed or an open articulating surface; none if the shape is not that of
    /// two dishes, so that nothing can be told.
    pub fn of_insert(mesh: &TriangleMesh) -> Option<Self> {
        let views = Views::new(mesh)?;
        Self::of(|orientation| {
            let signs = InsertSigns::of(&views, orientation);
            (signs.score(), signs.is_an_insert())
        })
    }

    /// None if the best is not plausible.
    fn of(fit: impl Fn(&Orientation) -> (f64, bool)) -> Option<Self> {
        let mut fits: Vec<_> = Orientation::all()
            .map(|orientation| (orientation, fit(&orientation)))
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

    /// Those that fit best and cannot be told from one another, best first.
    pub fn best(&self) -> impl Iterator<Item = Orientation> {
        let highest = self.scores[0].1;
        let is_close = move |(_, score): &&(Orientation, f64)| highest - score < LIKELY_MARGIN;
        self.scores
            .iter()
            .take_while(is_close)
            .map(|(orientation, _)| *orientation)
    }

    /// How sure it is that the body does not lie as `orientation` says; none if it may.
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

    /// Of those that fit as well as the best, the one that takes the smallest turn from x anterior,
    /// y superior, z right.
    pub fn nearest(&self) -> Orientation {
        let least_turn = |orientation: &Orientation| orientation.rotation().trace();
        let highest = self.scores[0].1;
        let is_equal = |(_, score): &&(Orientation, f64)| highest - score < EQUAL_MARGIN;
        let equal = self.scores.iter().take_while(is_equal);
        let best = equal.map(|(orientation, _)| *orientation);
        best.reduce(|a, b| {
            if least_turn(&b) > least_turn(&a) {
                b
            } else {
                a
            }
        })
        .unwrap_or(Orientation::ISB)
    }

    /// How sure it is that all but the best are wrong; none if another may be right.
    pub fn sureness(&self) -> Option<Sureness> {
        let second = self.scores[1].0;
        self.against(&second)
    }
}
