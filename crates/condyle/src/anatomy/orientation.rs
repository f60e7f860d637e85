//! The 24 orientations of a body along the axes of a frame.

use crate::{Mat3, Vec3};

/// One of the six directions along the axes of a frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct AxisDirection {
    /// 0 for x, 1 for y, 2 for z.
    pub axis: usize,
    /// Whether the direction points along the axis rather than against it.
    pub is_forward: bool,
}

impl AxisDirection {
    const X: Self = Self::along(0);
    const Y: Self = Self::along(1);
    const Z: Self = Self::along(2);
    const ALL: [Self; 6] = [
        Self::X,
        Self::X.reversed(),
        Self::Y,
        Self::Y.reversed(),
        Self::Z,
        Self::Z.reversed(),
    ];

    const fn along(axis: usize) -> Self {
        Self {
            axis,
            is_forward: true,
        }
    }

    pub(super) const fn reversed(self) -> Self {
        Self {
            axis: self.axis,
            is_forward: !self.is_forward,
        }
    }

    fn unit(self) -> Vec3 {
        let sign = if self.is_forward { 1.0 } else { -1.0 };
        Vec3::ith(self.axis, sign)
    }
}

/// The directions of anterior, superior and right of a body in its given frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Orientation {
    pub(super) anterior: AxisDirection,
    pub(super) superior: AxisDirection,
    pub(super) right: AxisDirection,
}

impl Orientation {
    /// x anterior, y superior, z right: the convention of the ISB.
    pub const ISB: Self = Self {
        anterior: AxisDirection::X,
        superior: AxisDirection::Y,
        right: AxisDirection::Z,
    };

    /// Returns the 24 right-handed orientations.
    pub fn all() -> impl Iterator<Item = Self> {
        let pairs = AxisDirection::ALL
            .into_iter()
            .flat_map(|anterior| AxisDirection::ALL.map(|superior| (anterior, superior)));
        pairs
            .filter(|(anterior, superior)| anterior.axis != superior.axis)
            .flat_map(|(anterior, superior)| {
                let right = anterior.unit().cross(&superior.unit());
                let is_right = move |direction: &AxisDirection| direction.unit() == right;
                let right = AxisDirection::ALL.into_iter().find(is_right);
                right.map(|right| Self {
                    anterior,
                    superior,
                    right,
                })
            })
    }

    /// Returns the rotation of a point of the given frame to x anterior, y superior, z right.
    pub fn rotation(&self) -> Mat3 {
        let rows = [self.anterior, self.superior, self.right].map(|axis| axis.unit().transpose());
        Mat3::from_rows(&rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_all_24_are_rotations_and_differ() {
        let all: Vec<Orientation> = Orientation::all().collect();
        assert_eq!(all.len(), 24);
        for (i, one) in all.iter().enumerate() {
            assert_eq!(one.rotation().determinant(), 1.0);
            assert!(all[..i].iter().all(|other| other != one));
        }
        assert_eq!(Orientation::ISB.rotation(), Mat3::identity());
    }
}
