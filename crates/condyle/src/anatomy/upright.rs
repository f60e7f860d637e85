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
/// Largest slope at which an insert lies on the bone in the files of an assembly, degrees.
const MAX_SLOPE_DEG: f64 = 10.0;
/// Lead in score at which the signs of a shape alone show that it is flexed: square femora without cuts, of eight designs,
/// lose up to 3.0.
const FLEXED_MARGIN: f64 = 4.0;

/// A body turned so that it lies along the axes of a frame.
#[derive(Clone, Debug)]
pub struct Upright {
    /// Rotation from the given frame to that frame; none for a body that lies square in its own.
    pub turn: Option<Mat3>,
    /// The orientations along the axes of that frame.
    pub recognition: Recognition,
    /// The superior direction of an insert that keeps its slope, in the given frame.
    pub slope: Option<Vec3>,
    /// True if other flexions fit better than that of the frame, but not certainly.
    pub is_flexion_open: bool,
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
            right,
            ..Self::square(recognition)
        })
    }

    /// Creates a body that lies square in its frame, z to the right in one of its orientations.
    pub fn square(recognition: Recognition) -> Self {
        let right = recognition.nearest().rotation().transpose() * Vec3::z();
        Self {
            turn: None,
            recognition,
            slope: None,
            is_flexion_open: false,
            right,
        }
    }

    /// Returns an insert as it lies, if it only slopes and its femur lies along the same axes: on the bone, its backside has the
    /// slope of the tibial cut.
    pub fn on_bone_of(self, femur: &Self, insert: &TriangleMesh) -> Self {
        let share_axis = femur.medio_lateral().dot(&self.medio_lateral()).abs() > 0.5;
        let keeps_slope =
            self.turn.is_some() && self.only_slopes() && share_axis && femur.turn.is_none();
        match keeps_slope
            .then(|| Recognition::of_insert(insert))
            .flatten()
        {
            Some(recognition) => Self {
                turn: None,
                recognition,
                slope: Some(self.anatomical().row(1).transpose()),
                ..self
            },
            None => self,
        }
    }

    /// Returns true if it is only inclined from front to back, by no more than an insert on the bone.
    pub fn only_slopes(&self) -> bool {
        lean_deg(&self.medio_lateral()) < SQUARE_DEG && self.off_square_deg() < MAX_SLOPE_DEG
    }

    /// Returns its medio-lateral axis in the given frame: an insert may be more alike from front to back, across its mirror plane.
    fn medio_lateral(&self) -> Vec3 {
        self.anatomical().row(2).transpose()
    }

    /// Returns the rotation from the given frame to x anterior, y superior, z right.
    fn anatomical(&self) -> Mat3 {
        let turn = self.rotation();
        self.recognition.nearest_after(&turn).rotation() * turn
    }

    /// Returns a femur in the frame of its insert, if it lies in it as its own shape shows: the files of one implant mostly
    /// share their axes, and the backside of an insert shows them better than a femur does.
    pub fn in_frame_of(self, insert: &Self, femur: &TriangleMesh) -> Self {
        if lean_deg(&(insert.rotation() * self.right)) > SQUARE_DEG {
            return self;
        }
        let turn = insert.turn;
        let own = self.recognition.score();
        // A femur shows its flexion only roughly.
        let recognition = Recognition::of_femur(&turned(femur, turn.as_ref()));
        match recognition.filter(|recognition| own - recognition.score() < FLEXED_MARGIN) {
            Some(recognition) => Self {
                turn,
                is_flexion_open: self.is_flexion_open || own - recognition.score() >= LIKELY_MARGIN,
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
    let (degrees, is_flexion_open) = match known_deg {
        Some(degrees) => (degrees, false),
        None => turn_by_signs_deg(score)?,
    };
    let turn = frame_at(degrees);
    let is_square = off_square_deg(&turn) < SQUARE_DEG;
    let turn = (!is_square).then_some(turn);
    let recognition = recognise(&turned(mesh, turn.as_ref()))?;
    Some(Upright {
        turn,
        is_flexion_open,
        right,
        ..Upright::square(recognition)
    })
}

/// Returns the turn whose score is best, -45 to 45 degrees; 0 unless the given frame fits certainly worse, and true if it fits
/// likely worse.
fn turn_by_signs_deg(score: impl Fn(f64) -> Option<f64>) -> Option<(f64, bool)> {
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
    let given = scores.first().filter(|(degrees, _)| *degrees == 0.0);
    let lead = given.map(|(_, score)| best.1 - score);
    if let Some(lead) = lead.filter(|lead| *lead < FLEXED_MARGIN) {
        return Some((0.0, lead >= LIKELY_MARGIN));
    }
    // The middle of the turns that fit about as well, counted from the best.
    let from_best = |degrees: f64| within_quarter_deg(degrees - best.0);
    let good = || scores.iter().filter(|one| best.1 - one.1 < EQUAL);
    let mean = good().map(|one| from_best(one.0)).sum::<f64>() / good().count() as f64;
    Some((within_quarter_deg(best.0 + mean), false))
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

#[cfg(test)]
mod tests {
    use super::*;

    /// The scores of a femur with a box and a cam, without cuts, every 5 degrees from its own flexion.
    const OF_CAM: [f64; 18] = [
        7.3, 7.9, 8.5, 8.9, 9.5, 10.3, 10.1, 9.5, 8.8, 7.7, 5.7, 6.1, 8.1, 8.5, 8.6, 8.1, 7.8, 7.6,
    ];

    #[test]
    fn signs_turn_a_body_only_where_its_own_frame_fits_certainly_worse() {
        let at = |first: f64| {
            move |degrees: f64| match (degrees / 5.0).round() as usize {
                0 => Some(first),
                step => Some(OF_CAM[step]),
            }
        };
        assert_eq!(turn_by_signs_deg(at(9.0)), Some((0.0, false)));
        assert_eq!(turn_by_signs_deg(at(OF_CAM[0])), Some((0.0, true)));
        assert_eq!(turn_by_signs_deg(at(5.0)), Some((27.5, false)));
    }
}
