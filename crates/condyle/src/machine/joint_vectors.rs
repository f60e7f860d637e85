//! One number a joint: forces, motions, and how the one changes with the other.
//!
//! Forces are in N and N mm, motions in mm and rad, in the order of the chain. They are types of their
//! own, so that a residual cannot be added to a correction.

use std::ops::{Add, Index, IndexMut, Mul, MulAssign};

use super::JointKind;

/// Lever on which a moment counts as a force and a turn as a motion, mm.
///
/// It is shorter than the way from any of a knee's axes to the contact, some 20 to 30 mm, so a moment
/// within the tolerance is less at the contact than a force within it.
const MOMENT_LEVER_MM: f64 = 10.0;

type Vec6 = nalgebra::Vector6<f64>;
type Mat6 = nalgebra::Matrix6<f64>;

/// The lever of every joint, mm: what turns its moments into forces and its turns into motions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Levers([f64; 6]);

/// A force or a moment on every joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct JointForces(Vec6);

/// A motion of every joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct JointMotions(Vec6);

/// Derivative of forces by motions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct JointStiffness(Mat6);

impl Levers {
    /// The levers of joints of these kinds; 1 for a translation.
    pub fn of(kinds: [JointKind; 6]) -> Self {
        Self(kinds.map(|kind| match kind {
            JointKind::Rotation => MOMENT_LEVER_MM,
            JointKind::Translation => 1.0,
        }))
    }

    /// The lever of joint `j`.
    pub fn of_joint(&self, j: usize) -> f64 {
        self.0[j]
    }
}

impl JointForces {
    /// No force.
    pub fn zero() -> Self {
        Self(Vec6::zeros())
    }

    /// A force for every joint.
    pub fn from_fn(mut force: impl FnMut(usize) -> f64) -> Self {
        Self(Vec6::from_fn(|j, _| force(j)))
    }

    /// The largest, N, moments on their levers.
    pub fn largest_n(&self, levers: &Levers) -> f64 {
        let force = |j: usize| self.0[j].abs() / levers.0[j];
        (0..6).map(force).fold(0.0, f64::max)
    }

    /// The length: root of the sum of the squares, N, moments on their levers.
    pub fn length_n(&self, levers: &Levers) -> f64 {
        let force = |j: usize| self.0[j] / levers.0[j];
        (0..6).map(|j| force(j).powi(2)).sum::<f64>().sqrt()
    }
}

impl JointMotions {
    /// No motion.
    pub fn zero() -> Self {
        Self(Vec6::zeros())
    }

    /// The longest, mm, turns on their levers.
    pub fn longest_mm(&self, levers: &Levers) -> f64 {
        let motion = |j: usize| self.0[j].abs() * levers.0[j];
        (0..6).map(motion).fold(0.0, f64::max)
    }

    /// The part of them that moves no joint farther than `most_mm`: at most all of it.
    pub fn part_within(&self, most_mm: f64, levers: &Levers) -> f64 {
        (most_mm / self.longest_mm(levers)).min(1.0)
    }

    /// Whether all of them are numbers.
    pub fn is_finite(&self) -> bool {
        self.0.iter().all(|motion| motion.is_finite())
    }

    /// Moves joints from where they are.
    pub fn move_from(&self, positions: &mut [f64; 6]) {
        positions
            .iter_mut()
            .zip(&self.0)
            .for_each(|(q, motion)| *q += motion);
    }
}

impl JointStiffness {
    /// Forces that do not change.
    pub fn zero() -> Self {
        Self(Mat6::zeros())
    }

    /// Each joint's force changes with its own motion alone.
    pub fn from_diagonal(slopes: [f64; 6]) -> Self {
        Self(Mat6::from_diagonal(&slopes.into()))
    }

    /// The motions that take `forces` away, K dq = -f; none where there are no such motions.
    pub fn correction(&self, forces: &JointForces) -> Option<JointMotions> {
        self.0.lu().solve(&-forces.0).map(JointMotions)
    }

    /// Takes joint `j` out: its force is its own motion, and no other's.
    pub fn take_out(&mut self, j: usize) {
        self.0.row_mut(j).fill(0.0);
        self.0.column_mut(j).fill(0.0);
        self.0[(j, j)] = 1.0;
    }

    /// The bare matrix.
    pub fn matrix(&self) -> &Mat6 {
        &self.0
    }
}

impl Index<usize> for JointForces {
    type Output = f64;

    fn index(&self, j: usize) -> &f64 {
        &self.0[j]
    }
}

impl IndexMut<usize> for JointForces {
    fn index_mut(&mut self, j: usize) -> &mut f64 {
        &mut self.0[j]
    }
}

impl Index<(usize, usize)> for JointStiffness {
    type Output = f64;

    fn index(&self, place: (usize, usize)) -> &f64 {
        &self.0[place]
    }
}

impl IndexMut<(usize, usize)> for JointStiffness {
    fn index_mut(&mut self, place: (usize, usize)) -> &mut f64 {
        &mut self.0[place]
    }
}

impl Add for JointStiffness {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }
}

impl Mul<f64> for JointMotions {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor)
    }
}

impl MulAssign<f64> for JointMotions {
    fn mul_assign(&mut self, factor: f64) {
        self.0 *= factor;
    }
}
