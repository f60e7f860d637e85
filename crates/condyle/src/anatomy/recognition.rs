//! The recognition of a body's orientation from its shape, and the start position of the femur over the insert.

use super::{
    signs::{fit_femur, fit_insert},
    views::{Orientation, Picture, Views, mean, median, part},
};
use crate::{Mat3, geometry::TriangleMesh};

/// Lead in score of another orientation that makes the given one likely wrong. The right orientation of
/// about a hundred shapes, whole, cut, leaning and noisy, was never so far behind.
pub(super) const LIKELY_MARGIN: f64 = 2.0;
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

    /// Returns the score of the best orientation.
    pub(super) fn score(&self) -> f64 {
        self.scores[0].1
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
        self.nearest_after(&Mat3::identity())
    }

    /// Returns [`Recognition::nearest`] for a body that was turned by `turn` before.
    pub fn nearest_after(&self, turn: &Mat3) -> Orientation {
        // The trace of a rotation is 1 + 2 cos(angle).
        let least_turn = |orientation: &Orientation| (orientation.rotation() * turn).trace();
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

/// Height above the lowest row of a dish or a condyle within which rows are averaged, as a share of the
/// body's longest extent: on a flat one the middle of the flat part counts.
const FLAT: f64 = 0.003;
/// Part of a side's rows within that height above which the side is a plateau, which no start is over.
const PLATEAU: f64 = 0.8;

/// Returns the start position of the femoral frame in the insert frame, (x, z), mm, at which the lowest points of the
/// condyles are over the lowest points of the dishes, and the middle of the femur is over the middle of the insert.
///
/// Both bodies in mm, x anterior, y superior, z right; the femur is flexed by `flexion_rad` first. None for
/// bodies without extent.
pub fn start_over_the_dishes_mm(
    femur: &TriangleMesh,
    insert: &TriangleMesh,
    flexion_rad: f64,
) -> Option<(f64, f64)> {
    let (sine, cosine) = flexion_rad.sin_cos();
    let flexion = Mat3::new(cosine, -sine, 0.0, sine, cosine, 0.0, 0.0, 0.0, 1.0);
    let femur = femur.clone().mapped(|vertex| flexion * vertex);
    let isb = Orientation::ISB;
    let (anterior, superior, right) = (isb.anterior, isb.superior, isb.right);
    let (femur_views, insert_views) = (Views::new(&femur)?, Views::new(insert)?);
    let condyles = femur_views.picture(superior.reversed(), anterior, right);
    let dishes = insert_views.picture(superior, anterior, right);
    let condyle_x = femur_views.place(0, farthest_row(&condyles, 1.0));
    let dish_x = insert_views.place(0, farthest_row(&dishes, -1.0));
    Some((dish_x - condyle_x, middle_z(insert) - middle_z(&femur)))
}

/// Returns the row at which both sides are highest towards the viewer, or lowest (`sign` -1); the ends do not count,
/// where an insert may be bevelled.
fn farthest_row(picture: &Picture, sign: f64) -> f64 {
    let rows = || part(picture.rows, 0.2, 0.8);
    let side = |from, to| {
        let height = |row: usize| median(picture.across(row, from, to)).map(|height| sign * height);
        let farthest = rows().filter_map(height).reduce(f64::max);
        let is_far = |row: &usize| {
            height(*row)
                .zip(farthest)
                .is_some_and(|(one, far)| one > far - FLAT)
        };
        let is_plateau = rows().filter(is_far).count() as f64 > PLATEAU * rows().len() as f64;
        (
            mean(rows().filter(is_far).map(|row| row as f64 + 0.5)),
            is_plateau,
        )
    };
    match [side(0.2, 0.35), side(0.65, 0.8)] {
        // The femur starts over the only dish.
        [(_, true), (dish, false)] | [(dish, false), (_, true)] => dish,
        [(left, _), (right, _)] => (left + right) / 2.0,
    }
}

fn middle_z(mesh: &TriangleMesh) -> f64 {
    let (low, high) = mesh.bounds();
    (low.z + high.z) / 2.0
}
