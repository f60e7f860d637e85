//! Left knees are mirrored in z on the way in and out, as are right hips and ankles: every run computes +z as lateral.

use condyle::machine::{
    TestedJoint,
    knee::{KNEE, LATERAL, MEDIAL},
};
use condyle::{Mat3, Vec3, spatial::Pose};
use condyle_fem::HexMesh;

/// The side of the body: a right or a left knee.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// A right knee: +z is lateral.
    #[default]
    Right,
    /// A left knee, mirrored on the way in and out: +z is medial.
    Left,
}

impl Side {
    /// Both sides.
    pub const ALL: &'static [Self] = &[Self::Right, Self::Left];

    /// The words that files use for them.
    pub const WORDS: &'static [&'static str] = &["right", "left"];

    /// Returns the word that files use.
    pub fn word(self) -> &'static str {
        Self::WORDS[self as usize]
    }

    /// Returns a description in one sentence.
    pub fn about(self) -> &'static str {
        match self {
            Self::Right => "A right knee.",
            Self::Left => "A left knee, mirrored on input and output.",
        }
    }

    /// Returns the side that `word` names.
    pub fn from_word(word: &str) -> Option<Self> {
        Self::ALL.iter().copied().find(|side| side.word() == word)
    }

    /// Returns the other side.
    pub fn other(self) -> Self {
        match self {
            Self::Right => Self::Left,
            Self::Left => Self::Right,
        }
    }

    /// Returns the side of the knee whose frame has +z on the same side of the body. Hips and ankles stand upside down in
    /// their machines: with x anterior and y inferior, z of a right-handed frame points to the left.
    pub fn in_frame_of(self, joint: TestedJoint) -> Self {
        match joint {
            TestedJoint::Hip | TestedJoint::Ankle => self.other(),
            TestedJoint::Knee | TestedJoint::Disc | TestedJoint::Specimen => self,
        }
    }

    /// Names of the regions at -z and at +z.
    pub fn regions(self) -> [&'static str; 2] {
        let [medial, lateral] = [MEDIAL, LATERAL].map(|region| KNEE.regions[region].label);
        match self {
            Self::Right => [medial, lateral],
            Self::Left => [lateral, medial],
        }
    }
}

/// The names of the directions of a bearing in pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Directions {
    /// The joint of the body.
    pub joint: TestedJoint,
    /// Its side in the frame of its machine (see [`Side::in_frame_of`]).
    pub side: Side,
}

impl Directions {
    /// Returns whether the joint is a knee, whose surface has a medial and a lateral side.
    pub fn is_knee(self) -> bool {
        self.joint == TestedJoint::Knee
    }

    /// Returns the names of +x and -x.
    pub fn along_x(self) -> [&'static str; 2] {
        match self.joint {
            TestedJoint::Specimen => ["+x", "\u{2212}x"],
            _ => ["Anterior", "Posterior"],
        }
    }

    /// Returns the names of -z and +z.
    pub fn along_z(self) -> [&'static str; 2] {
        match self.joint {
            TestedJoint::Specimen => ["\u{2212}z", "+z"],
            TestedJoint::Disc => ["Left", "Right"],
            _ => self.side.regions(),
        }
    }
}

/// Returns a place of the computed frame in the frame of `side`, and back.
pub fn point_on_side(point: &Vec3, side: Side) -> Vec3 {
    match side {
        Side::Right => *point,
        Side::Left => Vec3::new(point.x, point.y, -point.z),
    }
}

/// Returns the pose of mirrored bodies in the mirrored frame: M R M and M t, with M the mirror.
pub(super) fn pose_on_side(pose: &Pose, side: Side) -> Pose {
    let mirror = Mat3::from_diagonal(&point_on_side(&Vec3::repeat(1.0), side));
    Pose::new(mirror * pose.rotation * mirror, mirror * pose.translation)
}

/// Returns a face with its corners reordered if mirrored, so that it faces out.
pub(super) fn face_on_side<const N: usize>(mut corners: [u32; N], side: Side) -> [u32; N] {
    if side == Side::Left {
        corners[1..].reverse();
    }
    corners
}

pub(super) fn mesh_on_side(mesh: &HexMesh, side: Side) -> HexMesh {
    match side {
        Side::Right => mesh.clone(),
        // Mirrored corners would give negative volumes; each face is listed the other way round.
        Side::Left => HexMesh {
            nodes: mesh
                .nodes
                .iter()
                .map(|node| point_on_side(node, side))
                .collect(),
            hexes: mesh
                .hexes
                .iter()
                .map(|&[a, b, c, d, e, f, g, h]| [a, d, c, b, e, h, g, f])
                .collect(),
        },
    }
}

#[cfg(test)]
mod tests {
    use condyle::geometry::{GenericInsertShape, Meshing};

    use super::*;

    #[test]
    fn a_left_insert_is_the_mirror_image_and_not_inside_out() {
        let insert = GenericInsertShape::default()
            .insert(Meshing {
                edge_mm: 6.0,
                layers: 1,
            })
            .unwrap();
        let left = mesh_on_side(insert.mesh(), Side::Left);
        assert!((left.volume() - insert.mesh().volume()).abs() < 1e-9);
        assert!((left.worst_quality() - insert.mesh().worst_quality()).abs() < 1e-12);
        assert_eq!(left.nodes[0].z, -insert.mesh().nodes[0].z);
    }

    #[test]
    fn a_mirrored_pose_takes_a_mirrored_point_to_the_mirrored_place() {
        let (sine, cosine) = 0.3f64.sin_cos();
        let turn = Mat3::new(cosine, sine, 0.0, -sine, cosine, 0.0, 0.0, 0.0, 1.0)
            * Mat3::new(1.0, 0.0, 0.0, 0.0, cosine, sine, 0.0, -sine, cosine);
        let pose = Pose::new(turn, Vec3::new(1.0, 2.0, 3.0));
        let point = Vec3::new(-4.0, 5.0, 6.0);
        let left = |point: &Vec3| point_on_side(point, Side::Left);
        let there = pose_on_side(&pose, Side::Left).to_insert(&left(&point));
        assert!((there - left(&pose.to_insert(&point))).norm() < 1e-12);
    }
}
