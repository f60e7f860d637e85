//! Newton's iteration with a line search.

use super::{
    WarmStart,
    assembly::Levers,
    balance::{correction, move_by},
};
use crate::{
    Vec3,
    contact::MAX_REGIONS,
    spatial::{Mat6, Vec6},
};

/// Smallest part of a correction that backtracking keeps.
const MIN_PART_OF_CORRECTION: f64 = 0.1;
/// Backtracking to a correction shorter than this has failed, mm.
const SHORTEST_CORRECTION_MM: f64 = 1e-9;
/// Safety factor on the contraction of a cycle before.
const CAUTION: f64 = 2.0;
/// Part of a residual beyond which the correction is not yet in the quadratic range.
const CONVERGING: f64 = 0.1;
/// Safety factor on the contraction of a correction by the tangent of the one before.
const CHORD_CAUTION: f64 = 4.0;
/// Longest correction, mm; on the lever, rad.
const LONGEST_CORRECTION_MM: f64 = 1.0;

pub(super) struct NewtonIteration {
    levers: Levers,
    pub positions: [f64; 6],
    /// Length of the residual from which the last correction was computed, N.
    pub residual_n: f64,
    /// The part of the last correction that was taken.
    taken: Vec6,
    /// Mean slip of the regions where the last correction was computed, mm/s.
    mean_slip: [Vec3; MAX_REGIONS],
    /// Whether the whole correction was taken.
    is_whole: bool,
    /// Largest predicted residual, N, at which the iteration may end without evaluating it; none if every correction
    /// requires its own tangent and every residual is evaluated.
    may_leave_n: Option<f64>,
    /// Predicted length of the residual at the present positions, N; infinite if there is no prediction.
    predicted_n: f64,
    /// The contraction: residual after a whole correction near the solution over the square
    /// of the residual before it, as observed last, 1/N.
    pub contraction_per_n: f64,
    caution: f64,
    tangent: Option<Mat6>,
}

impl NewtonIteration {
    /// Creates an iteration from `positions`, with the contraction of a cycle before if there is a warm start.
    pub fn new(
        levers: Levers,
        may_leave_n: Option<f64>,
        positions: [f64; 6],
        warm_start: Option<&WarmStart>,
    ) -> Self {
        Self {
            levers,
            may_leave_n,
            positions,
            residual_n: f64::INFINITY,
            taken: Vec6::zeros(),
            mean_slip: [Vec3::zeros(); MAX_REGIONS],
            is_whole: false,
            predicted_n: f64::INFINITY,
            contraction_per_n: warm_start.map_or(f64::INFINITY, |last| last.contraction_per_n),
            caution: CAUTION,
            tangent: None,
        }
    }

    /// Returns whether the predicted residual is within the permitted one.
    pub fn is_predicted_done(&self) -> bool {
        self.may_leave_n
            .is_some_and(|may_leave_n| self.predicted_n <= may_leave_n)
    }

    /// Moves to better positions; false if none are found.
    ///
    /// A correction that has made the residual longer is backtracked; otherwise the next one follows. `tangent` is
    /// evaluated only if the tangent of the last correction is not good enough.
    pub fn improve(
        &mut self,
        residual: &Vec6,
        mean_slip: [Vec3; MAX_REGIONS],
        tangent: impl FnOnce() -> Mat6,
    ) -> bool {
        let residual_n = self.levers.length_n(residual);
        if residual_n > self.residual_n {
            return self.backtrack(residual_n, &mean_slip);
        }
        self.mean_slip = mean_slip;
        self.observe_contraction(residual_n);
        let newton_leaves_n = self.caution * self.contraction_per_n * residual_n * residual_n;
        let (tangent, leaves_n) = self
            .chord(residual_n)
            .unwrap_or_else(|| (tangent(), newton_leaves_n));
        let solved = correction(&tangent, residual);
        let is_finite = |motions: &Vec6| motions.iter().all(|motion| motion.is_finite());
        let Some(correction) = solved.filter(is_finite) else {
            return false;
        };
        let part = self.levers.part_within(&correction, LONGEST_CORRECTION_MM);
        self.is_whole = part == 1.0;
        // The contraction is that of whole corrections only.
        self.predicted_n = if self.is_whole {
            leaves_n
        } else {
            f64::INFINITY
        };
        self.residual_n = residual_n;
        self.tangent = Some(tangent);
        self.taken = correction * part;
        move_by(&mut self.positions, &self.taken);
        true
    }

    /// Takes back a part of the last correction, after which the residual is longer; false if too little of it
    /// would remain.
    ///
    /// In most cases friction has reversed, and the iteration continues best from where the slip is zero: there
    /// friction is stiffest, and a correction from there does not overshoot. Otherwise the best part is the minimum
    /// of the parabola through both lengths and the slope that Newton's method implies.
    fn backtrack(&mut self, residual_n: f64, mean_slip: &[Vec3; MAX_REGIONS]) -> bool {
        if let Some(part) = standstill(&self.mean_slip, mean_slip) {
            self.keep(part);
            // Any residual counts as progress from there.
            self.residual_n = f64::INFINITY;
            return true;
        }
        let (before, after) = (self.residual_n.powi(2), residual_n.powi(2));
        self.keep((before / (before + after)).max(MIN_PART_OF_CORRECTION));
        self.levers.longest_mm(&self.taken) > SHORTEST_CORRECTION_MM
    }

    fn keep(&mut self, part: f64) {
        move_by(&mut self.positions, &(self.taken * (part - 1.0)));
        self.taken *= part;
        self.is_whole = false;
    }

    /// Updates the contraction from the residual after the last correction, if it was whole.
    ///
    /// Near the solution a correction leaves c r^2 of a residual r, so one that reduced r0 to r1 gives c = r1/r0^2.
    /// Before the first correction the c of a cycle ago applies, with a safety factor.
    fn observe_contraction(&mut self, residual_n: f64) {
        if !self.is_whole {
            return;
        }
        let left = residual_n / self.residual_n;
        self.contraction_per_n = if left <= CONVERGING {
            left / self.residual_n
        } else {
            f64::INFINITY
        };
        // The contraction of this step is known now.
        self.caution = 1.0;
    }

    /// Returns the tangent of the last correction, and the predicted residual after a whole correction by it, N; none
    /// if that exceeds the permitted one.
    ///
    /// A tangent is the most expensive part of a correction, and the last correction need not be as good: the chord
    /// method reduces the residual by about the same factor as the correction before.
    fn chord(&self, residual_n: f64) -> Option<(Mat6, f64)> {
        let leaves_n = CHORD_CAUTION * residual_n / self.residual_n * residual_n;
        let serves = self.is_whole && leaves_n <= self.may_leave_n?;
        Some((self.tangent.filter(|_| serves)?, leaves_n))
    }
}

/// Returns the part of a correction after which the first of the regions stands still, whose mean slip was `before`
/// and is `after`; none if no slip reverses.
fn standstill(before: &[Vec3; MAX_REGIONS], after: &[Vec3; MAX_REGIONS]) -> Option<f64> {
    let regions = before.iter().zip(after);
    let turning = regions.filter(|(before, after)| before.dot(after) < 0.0);
    let part = |(before, after): (&Vec3, &Vec3)| {
        let change = after - before;
        -before.dot(&change) / change.norm_squared()
    };
    turning.map(part).reduce(f64::min)
}
