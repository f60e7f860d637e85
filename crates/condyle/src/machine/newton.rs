//! Newton's iteration with a line search.

use super::{
    WarmStart,
    joint_vectors::{JointForces, JointMotions, JointStiffness, Levers},
};
use crate::{Vec3, contact::MAX_REGIONS};

/// A correction that is backtracked keeps at least this part.
const MIN_PART_OF_CORRECTION: f64 = 0.1;
/// A correction backtracked to less than this has found no better place, mm.
const SHORTEST_CORRECTION_MM: f64 = 1e-9;
/// What a correction leaves of a residual is predicted to be up to this many times what it left a
/// cycle before.
const CAUTION: f64 = 2.0;
/// A whole correction that leaves more of the residual is none of the last, quadratic ones.
const CONVERGING: f64 = 0.1;
/// A correction by the tangent of the one before is predicted to leave this many times the part of the residual that
/// the one before left.
const CHORD_CAUTION: f64 = 4.0;
/// Farthest that one iteration may move, mm; on the lever, rad.
const LONGEST_CORRECTION_MM: f64 = 1.0;

/// Newton's iteration, on its way.
pub(super) struct NewtonIteration {
    levers: Levers,
    positions: [f64; 6],
    /// Length of the residual from which the last correction was computed, N.
    residual_n: f64,
    /// The part of the last correction that was taken.
    taken: JointMotions,
    /// How the regions slid where the last correction was computed, mm/s.
    mean_slip: [Vec3; MAX_REGIONS],
    /// Whether all of it was taken.
    is_whole: bool,
    /// What may be left of a residual, N, by prediction alone; none where every correction is to have a tangent of its
    /// own, and what it leaves is to be computed.
    may_leave_n: Option<f64>,
    /// Predicted length of the residual where the iteration is now, N; infinite where nothing is
    /// known of it.
    predicted_n: f64,
    /// The contraction: what a whole correction left of a residual near the solution, over the square
    /// of the residual, when that was seen last, 1/N.
    contraction_per_n: f64,
    /// How many times that a correction is predicted to leave.
    caution: f64,
    /// The tangent of the last correction.
    tangent: Option<JointStiffness>,
}

impl NewtonIteration {
    /// An iteration that starts from `positions`, and may know the contraction from a cycle before.
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
            taken: JointMotions::zero(),
            mean_slip: [Vec3::zeros(); MAX_REGIONS],
            is_whole: false,
            predicted_n: f64::INFINITY,
            contraction_per_n: warm_start.map_or(f64::INFINITY, |last| last.contraction_per_n),
            caution: CAUTION,
            tangent: None,
        }
    }

    /// Where it is.
    pub fn positions(&self) -> [f64; 6] {
        self.positions
    }

    /// Length of the residual from which the last correction was computed, N.
    pub fn residual_n(&self) -> f64 {
        self.residual_n
    }

    /// Whether no more is left, as predicted, than may be.
    pub fn is_predicted_done(&self) -> bool {
        self.may_leave_n
            .is_some_and(|may_leave_n| self.predicted_n <= may_leave_n)
    }

    /// What the last whole correction left of a residual, over its square, 1/N.
    pub fn contraction_per_n(&self) -> f64 {
        self.contraction_per_n
    }

    /// Moves to better positions; false where there are none.
    ///
    /// A correction that has made the residual longer is backtracked, another is followed by the next.
    /// `tangent` is asked for the tangent here where that of the last correction does not serve.
    pub fn improve(
        &mut self,
        residual: &JointForces,
        mean_slip: [Vec3; MAX_REGIONS],
        tangent: impl FnOnce() -> JointStiffness,
    ) -> bool {
        let residual_n = residual.length_n(&self.levers);
        if residual_n > self.residual_n {
            return self.backtrack(residual_n, &mean_slip);
        }
        self.mean_slip = mean_slip;
        self.learn(residual_n);
        let (tangent, leaves_n) = self
            .chord(residual_n)
            .unwrap_or_else(|| (tangent(), self.newton_leaves_n(residual_n)));
        let solved = tangent.correction(residual);
        let Some(correction) = solved.filter(JointMotions::is_finite) else {
            return false;
        };
        let part = correction.part_within(LONGEST_CORRECTION_MM, &self.levers);
        self.is_whole = part == 1.0;
        self.predicted_n = if self.is_whole {
            leaves_n
        } else {
            f64::INFINITY
        };
        self.residual_n = residual_n;
        self.tangent = Some(tangent);
        self.taken = correction * part;
        self.taken.move_from(&mut self.positions);
        true
    }

    /// Goes back a part of the last correction, after which the residual is longer; false where that
    /// leads nowhere.
    ///
    /// Mostly friction has turned round, and then the place to go on from is where the slip stands
    /// still: there friction resists most, and a correction from there does not fly past. Otherwise it
    /// is the minimum of the parabola through both lengths and the slope that Newton's method implies.
    fn backtrack(&mut self, residual_n: f64, mean_slip: &[Vec3; MAX_REGIONS]) -> bool {
        if let Some(part) = standstill(&self.mean_slip, mean_slip) {
            self.keep(part);
            self.residual_n = f64::INFINITY;
            return true;
        }
        let (before, after) = (self.residual_n.powi(2), residual_n.powi(2));
        self.keep((before / (before + after)).max(MIN_PART_OF_CORRECTION));
        self.taken.longest_mm(&self.levers) > SHORTEST_CORRECTION_MM
    }

    /// Keeps a part of the last correction only.
    fn keep(&mut self, part: f64) {
        (self.taken * (part - 1.0)).move_from(&mut self.positions);
        self.taken *= part;
        self.is_whole = false;
    }

    /// Learns the contraction from what the last correction, if it was whole, has left.
    ///
    /// Near the solution each leaves c r^2 of a residual r. One that shortened r0 to r1 says that c = r1/r0^2; before
    /// there is one, a cycle ago says it, with caution.
    fn learn(&mut self, residual_n: f64) {
        if !self.is_whole {
            return;
        }
        let left = residual_n / self.residual_n;
        self.contraction_per_n = if left <= CONVERGING {
            left / self.residual_n
        } else {
            f64::INFINITY
        };
        self.caution = 1.0;
    }

    /// What a whole correction by the tangent here is predicted to leave of a residual, N.
    fn newton_leaves_n(&self, residual_n: f64) -> f64 {
        self.caution * self.contraction_per_n * residual_n * residual_n
    }

    /// The tangent of the last correction, and what a whole one by it is predicted to leave of a residual, N; none
    /// where that is more than may be left.
    ///
    /// A tangent is the dearest part of a correction, and the last one need not be that good: the method of chords
    /// leaves about the part that the correction before left.
    fn chord(&self, residual_n: f64) -> Option<(JointStiffness, f64)> {
        let leaves_n = CHORD_CAUTION * residual_n / self.residual_n * residual_n;
        let serves = self.is_whole && leaves_n <= self.may_leave_n?;
        Some((self.tangent.filter(|_| serves)?, leaves_n))
    }
}

/// The part of a correction after which the first of the regions, slipping as `before` and then as
/// `after`, stands still; none if none turns round.
fn standstill(before: &[Vec3; MAX_REGIONS], after: &[Vec3; MAX_REGIONS]) -> Option<f64> {
    let regions = before.iter().zip(after);
    let turning = regions.filter(|(before, after)| before.dot(after) < 0.0);
    let part = |(before, after): (&Vec3, &Vec3)| {
        let change = after - before;
        -before.dot(&change) / change.norm_squared()
    };
    turning.map(part).reduce(f64::min)
}
