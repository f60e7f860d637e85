//! Where the two dishes of an insert are lowest: what the places of a machine are measured from.

use condyle_mesh::bounds;

use crate::Vec3;

/// The lowest places of an insert's two dishes, mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dishes {
    /// Of the dish at lower z: the medial one of a right knee.
    pub medial_mm: Vec3,
    /// Of the other one.
    pub lateral_mm: Vec3,
}

/// Dishes are looked for in this part of the length, where no rim falls off ...
const ALONG: (f64, f64) = (0.15, 0.85);
/// ... and of the width, beside the rim and the eminence or the hole of a post; mirrored for the other side.
const ACROSS: (f64, f64) = (0.1, 0.425);
/// Places so little above the lowest one are low too, mm: their middle does not jump with the mesh, as the place of
/// the lowest one does.
const LOW_MM: f64 = 0.3;

impl Dishes {
    /// The dishes of an articulating surface, from `points` that lie about evenly on it; none where a side has none.
    ///
    /// The lowest place of a side is the middle of its points less than 0.3 mm above the lowest one, rim and eminence
    /// left out.
    pub fn of(points: &[Vec3]) -> Option<Self> {
        let (low, high) = bounds(points);
        let size = high - low;
        let inside = |part: f64, (from, to): (f64, f64)| (from..=to).contains(&part);
        let in_dish = |point: &Vec3, from_side_mm: f64| {
            inside((point.x - low.x) / size.x, ALONG) && inside(from_side_mm / size.z, ACROSS)
        };
        let medial = points
            .iter()
            .filter(|point| in_dish(point, point.z - low.z));
        let lateral = points
            .iter()
            .filter(|point| in_dish(point, high.z - point.z));
        Some(Self {
            medial_mm: lowest(&medial.collect::<Vec<_>>())?,
            lateral_mm: lowest(&lateral.collect::<Vec<_>>())?,
        })
    }

    /// Half-way between the dishes, at the height of the lower one, mm.
    pub fn middle_mm(&self) -> Vec3 {
        let between = (self.medial_mm + self.lateral_mm) / 2.0;
        Vec3::new(
            between.x,
            self.medial_mm.y.min(self.lateral_mm.y),
            between.z,
        )
    }
}

fn lowest(points: &[&Vec3]) -> Option<Vec3> {
    let heights = points.iter().map(|point| point.y);
    let lowest = heights.fold(f64::INFINITY, f64::min);
    let low = points.iter().filter(|point| point.y < lowest + LOW_MM);
    let (count, sum) = low.fold((0.0, Vec3::zeros()), |(count, sum), point| {
        (count + 1.0, sum + **point)
    });
    (count > 0.0).then(|| Vec3::new(sum.x / count, lowest, sum.z / count))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{GenericInsertShape, Meshing};

    fn generic() -> Vec<Vec3> {
        let insert = GenericInsertShape::default().insert(Meshing::default());
        insert.unwrap().surface().positions
    }

    #[test]
    fn verify_dishes_of_the_generic_insert() {
        let dishes = Dishes::of(&generic()).unwrap();
        for (found, z) in [(dishes.medial_mm, -23.0), (dishes.lateral_mm, 23.0)] {
            assert!((found - Vec3::new(0.0, 0.0, z)).norm() < 0.5, "{found}");
        }
        assert!(dishes.middle_mm().norm() < 0.3, "{:?}", dishes.middle_mm());
    }

    #[test]
    fn dishes_move_with_the_insert() {
        let shift = Vec3::new(4.0, -30.0, 5.0);
        let moved: Vec<Vec3> = generic().iter().map(|point| point + shift).collect();
        let (here, there) = (Dishes::of(&generic()).unwrap(), Dishes::of(&moved).unwrap());
        assert!((there.middle_mm() - here.middle_mm() - shift).norm() < 1e-9);
    }

    #[test]
    fn no_points_have_no_dishes() {
        assert_eq!(Dishes::of(&[]), None);
    }
}
