//! Newton's iteration with a line search.

use super::{
    WarmStart,
    joint_vectors::{JointForces, JointMotions, JointStiffness, Levers},
};
use crate::{Vec3, contact::MOST_REGIONS};

/// A correction that is backtracked keeps at least this part.
const LEAST_PART_OF_CORRECTION: f64 = 0.1;
/// A correction backtracked to less than this has found no better place, mm.
const SHORTEST_CORRECTION_MM: f64 = 1e-9;
/// What a correction leaves of a residual is predicted to be up to this many times what it left a
/// cycle before.
const CAUTION: f64 = 2.0;
/// A whole correction that leaves more of the residual is none of the last, quadratic ones.
const CONVERGING: f64 = 0.1;
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
    mean_slip: [Vec3; MOST_REGIONS],
    /// Whether all of it was taken.
    is_whole: bool,
    /// Predicted length of the residual where the iteration is now, N; infinite where nothing is
    /// known of it.
    predicted_n: f64,
    /// The contraction: what a whole correction left of a residual near the solution, over the square
    /// of the residual, when that was seen last, 1/N.
    contraction_per_n: f64,
    /// How many times that a correction is predicted to leave.
    caution: f64,
}

impl NewtonIteration {
    /// An iteration that starts from `positions`, and may know the contraction from a cycle before.
    pub fn new(levers: Levers, positions: [f64; 6], warm_start: Option<&WarmStart>) -> Self {
        Self {
            levers,
            positions,
            residual_n: f64::INFINITY,
            taken: JointMotions::zero(),
            mean_slip: [Vec3::zeros(); MOST_REGIONS],
            is_whole: false,
            predicted_n: f64::INFINITY,
            contraction_per_n: warm_start.map_or(f64::INFINITY, |last| last.contraction_per_n),
            caution: CAUTION,
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

    /// Predicted length of the residual where it is now, N.
    pub fn predicted_n(&self) -> f64 {
        self.predicted_n
    }

    /// What the last whole correction left of a residual, over its square, 1/N.
    pub fn contraction_per_n(&self) -> f64 {
        self.contraction_per_n
    }

    /// Moves to better positions; false where there are none.
    ///
    /// A correction that has made the residual longer is backtracked, another is followed by the next.
    pub fn improve(
        &mut self,
        residual: &JointForces,
        mean_slip: [Vec3; MOST_REGIONS],
        tangent: impl FnOnce() -> JointStiffness,
    ) -> bool {
        let residual_n = residual.length_n(&self.levers);
        if residual_n > self.residual_n {
            return self.backtrack(residual_n, &mean_slip);
        }
        self.mean_slip = mean_slip;
        let solved = tangent().correction(residual);
        let Some(correction) = solved.filter(JointMotions::is_finite) else {
            return false;
        };
        let part = correction.part_within(LONGEST_CORRECTION_MM, &self.levers);
        self.predict(residual_n, part == 1.0);
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
    fn backtrack(&mut self, residual_n: f64, mean_slip: &[Vec3; MOST_REGIONS]) -> bool {
        if let Some(part) = standstill(&self.mean_slip, mean_slip) {
            self.keep(part);
            self.residual_n = f64::INFINITY;
            return true;
        }
        let (before, after) = (self.residual_n.powi(2), residual_n.powi(2));
        self.keep((before / (before + after)).max(LEAST_PART_OF_CORRECTION));
        self.taken.longest_mm(&self.levers) > SHORTEST_CORRECTION_MM
    }

    /// Keeps a part of the last correction only.
    fn keep(&mut self, part: f64) {
        (self.taken * (part - 1.0)).move_from(&mut self.positions);
        self.taken *= part;
        self.is_whole = false;
    }

    /// Predicts the residual after a correction from one of `residual_n`.
    ///
    /// Near the solution each whole correction leaves c r^2 of a residual r. One that shortened r0
    /// to r1 says that c = r1/r0^2; before there is one, a cycle ago says it, with caution.
    fn predict(&mut self, residual_n: f64, is_whole: bool) {
        let left = residual_n / self.residual_n;
        if self.is_whole {
            self.contraction_per_n = if left <= CONVERGING {
                left / self.residual_n
            } else {
                f64::INFINITY
            };
            self.caution = 1.0;
        }
        self.predicted_n = if is_whole {
            self.caution * self.contraction_per_n * residual_n * residual_n
        } else {
            f64::INFINITY
        };
        self.residual_n = residual_n;
        self.is_whole = is_whole;
    }
}

/// The part of a correction after which the first of the regions, slipping as `before` and then as
/// `after`, stands still; none if none turns round.
fn standstill(before: &[Vec3; MOST_REGIONS], after: &[Vec3; MOST_REGIONS]) -> Option<f64> {
    let regions = before.iter().zip(after);
    let turning = regions.filter(|(before, after)| before.dot(after) < 0.0);
    let part = |(before, after): (&Vec3, &Vec3)| {
        let change = after - before;
        -before.dot(&change) / change.norm_squared()
    };
    turning.map(part).reduce(f64::min)
}
