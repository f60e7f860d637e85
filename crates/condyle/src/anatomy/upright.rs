//! The rotation that aligns a body with the axes, from its plane of symmetry and its flat backside.

use super::{
    recognition::{LIKELY_MARGIN, Recognition},
    sampled::{Sampled, within_quarter_deg},
    views::Orientation,
};
use crate::{Mat3, Vec3, geometry::TriangleMesh};

/// Tilt from the axes up to which a body counts as square to them, degrees: the mirror plane of femora with a larger
/// lateral flange leans by up to 2 degrees.
const SQUARE_DEG: f64 = 4.0;
/// Smallest share of an insert's area that is a flat backside; it is a third of the area in most designs.
pub(super) const MIN_BACKSIDE: f64 = 0.15;

/// A body turned so that it lies along the axes of a frame.
#[derive(Clone, Debug)]
pub struct Upright {
    /// Rotation from the given frame to that frame; none for a body that lies square in its own.
    pub turn: Option<Mat3>,
    /// The orientations along the axes of that frame.
    pub recognition: Recognition,
    /// The normal of its mirror plane, in the given frame.
    right: Vec3,
}

impl Upright {
    /// Finds the frame of a femoral component; none if it is not a whole component in any.
    pub fn of_femur(mesh: &TriangleMesh) -> Option<Self> {
        let sampled = Sampled::new(mesh)?;
        by_mirror(mesh, &sampled, &Recognition::of_femur)
    }

    /// Finds the frame of an insert; none if it does not have two dishes in any.
    pub fn of_insert(mesh: &TriangleMesh) -> Option<Self> {
        let sampled = Sampled::new(mesh)?;
        let flat = sampled.flattest();
        if flat.share < MIN_BACKSIDE {
            return by_mirror(mesh, &sampled, &Recognition::of_insert);
        }
        let up = -flat.normal;
        let right = sampled.mirror(Some(up)).normal;
        let turn = frame(&up.cross(&right), &up);
        let is_square = off_square_deg(&turn) < SQUARE_DEG;
        let turn = (!is_square).then_some(turn);
        let recognition = Recognition::of_insert(&turned(mesh, turn.as_ref()))?;
        Some(Self {
            turn,
            recognition,
            right,
        })
    }

    /// Creates a body that lies square in its frame, z to the right in one of its orientations.
    pub fn square(recognition: Recognition) -> Self {
        let right = recognition.nearest().rotation().transpose() * Vec3::z();
        Self {
            turn: None,
            recognition,
            right,
        }
    }

    /// Returns a femur in the frame of its insert, if it lies in it as its own shape shows: the files of one implant mostly
    /// share their axes, and the backside of an insert shows them better than a femur does.
    pub fn in_frame_of(self, insert: &Self, femur: &TriangleMesh) -> Self {
        if lean_deg(&(insert.rotation() * self.right)) > SQUARE_DEG {
            return self;
        }
        let turn = insert.turn;
        // A femur shows its flexion only roughly: square ones of four designs lose up to 1.5.
        let least = self.recognition.score() - LIKELY_MARGIN;
        let recognition = Recognition::of_femur(&turned(femur, turn.as_ref()));
        match recognition.filter(|recognition| recognition.score() > least) {
            Some(recognition) => Self {
                turn,
                recognition,
                ..self
            },
            None => self,
        }
    }

    /// Returns the angle of its mirror plane to the nearest axis of the given frame, degrees.
    pub fn lean_deg(&self) -> f64 {
        lean_deg(&self.right)
    }

    /// Returns the rotation from the given frame to that in which the body lies square.
    pub fn rotation(&self) -> Mat3 {
        self.turn.unwrap_or_else(Mat3::identity)
    }

    /// Returns the angle of a turn about the nearest of the 24 orientations, degrees; 0 for a body that lies square.
    pub fn off_square_deg(&self) -> f64 {
        self.turn.as_ref().map_or(0.0, off_square_deg)
    }
}

/// Finds the frame from the mirror plane, and the turn within it from flat parts of the shape or, without them, from its signs.
fn by_mirror(
    mesh: &TriangleMesh,
    sampled: &Sampled,
    recognise: &dyn Fn(&TriangleMesh) -> Option<Recognition>,
) -> Option<Upright> {
    let right = sampled.mirror(None).normal;
    // The frame nearest to that of the file, of all that share the mirror plane.
    let axes = [0, 1, 2].map(|axis| Vec3::ith(axis, 1.0));
    let most_across = |a: &&Vec3, b: &&Vec3| b.dot(&right).abs().total_cmp(&a.dot(&right).abs());
    let first = axes.iter().min_by(|a, b| most_across(b, a)).copied()?;
    let ahead = (first - right * first.dot(&right)).normalize();
    let up = right.cross(&ahead);
    let frame_at = |degrees: f64| {
        let (sine, cosine) = degrees.to_radians().sin_cos();
        let ahead = ahead * cosine + up * sine;
        frame(&ahead, &right.cross(&ahead))
    };
    let score = |degrees: f64| Some(recognise(&turned(mesh, Some(&frame_at(degrees))))?.score());
    let known_deg = sampled.square_turn_deg(&ahead, &up);
    let degrees = known_deg.or_else(|| turn_by_signs_deg(score))?;
    let turn = frame_at(degrees);
    let is_square = off_square_deg(&turn) < SQUARE_DEG;
    let turn = (!is_square).then_some(turn);
    let recognition = recognise(&turned(mesh, turn.as_ref()))?;
    Some(Upright {
        turn,
        recognition,
        right,
    })
}

/// Returns the turn whose score is best, -45 to 45 degrees; 0 where the given frame fits about as well.
fn turn_by_signs_deg(score: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    const STEP_DEG: f64 = 5.0;
    /// A quarter turn; after it the orientations repeat.
    const STEPS: usize = 18;
    /// Loss of score within which turns fit as well as the best.
    const EQUAL: f64 = 0.5;
    let turns_deg = (0..STEPS).map(|step| step as f64 * STEP_DEG);
    let scores: Vec<(f64, f64)> = turns_deg
        .filter_map(|degrees| Some((degrees, score(degrees)?)))
        .collect();
    let best = *scores.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    let is_enough = scores
        .first()
        .is_some_and(|(degrees, score)| *degrees == 0.0 && best.1 - score < LIKELY_MARGIN);
    if is_enough {
        return Some(0.0);
    }
    // The middle of the turns that fit about as well, counted from the best.
    let from_best = |degrees: f64| within_quarter_deg(degrees - best.0);
    let good = || scores.iter().filter(|one| best.1 - one.1 < EQUAL);
    let mean = good().map(|one| from_best(one.0)).sum::<f64>() / good().count() as f64;
    Some(within_quarter_deg(best.0 + mean))
}

/// Returns the angle of a direction to the nearest axis, degrees.
fn lean_deg(direction: &Vec3) -> f64 {
    direction.amax().clamp(-1.0, 1.0).acos().to_degrees()
}

/// Returns the rotation to the frame whose first axis is `ahead` and whose second is `up`.
fn frame(ahead: &Vec3, up: &Vec3) -> Mat3 {
    let (ahead, up) = (ahead.normalize(), up.normalize());
    let right = ahead.cross(&up);
    Mat3::from_rows(&[ahead.transpose(), up.transpose(), right.transpose()])
}

fn turned(mesh: &TriangleMesh, turn: Option<&Mat3>) -> TriangleMesh {
    let mesh = mesh.clone();
    match turn {
        Some(turn) => mesh.mapped(|vertex| turn * vertex),
        None => mesh,
    }
}

/// Returns the smallest angle of a rotation that takes one to the nearest of the 24 orientations, degrees.
fn off_square_deg(rotation: &Mat3) -> f64 {
    let nearest = Orientation::nearest_to(rotation).rotation();
    let cosine = ((nearest.transpose() * rotation).trace() - 1.0) / 2.0;
    cosine.clamp(-1.0, 1.0).acos().to_degrees()
}
