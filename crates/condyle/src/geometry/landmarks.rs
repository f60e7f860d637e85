//! Landmarks of the bodies, from which the places of a machine are measured: the dishes of an insert, the posterior
//! arc of a femur and the dome of a talus.

use std::ops::RangeInclusive;

use condyle_mesh::{TriangleMesh, bounds};

use crate::{Mat3, Vec3};

/// The lowest places of an insert's two dishes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dishes {
    /// The dish at lower z, medial in a right knee, mm.
    pub medial_mm: Vec3,
    /// The other dish, mm.
    pub lateral_mm: Vec3,
}

/// Part of the length within which dishes are searched, without the rims ...
const ALONG: (f64, f64) = (0.15, 0.85);
/// ... and of the width, between the rim and the eminence or the hole of a post; mirrored for the other side.
const ACROSS: (f64, f64) = (0.1, 0.425);
/// Height above the lowest place within which places are averaged, mm: their middle does not jump with the mesh, as
/// the lowest place does.
const LOW_MM: f64 = 0.3;
/// A dish has at least one in this many of its side's points within that height: those of sound knees have ten.
const MIN_POINTS_OF_DISH: usize = 200;
/// Part of a side's points within that height above which the side is a plateau, whose lowest place is anywhere on it.
const PLATEAU: f64 = 0.8;

/// Half-width of the eminence, relative to the distance of the dishes from the middle; the contact of knees begins at about 0.6.
const EMINENCE: f64 = 0.4;

impl Dishes {
    /// Finds the dishes of an articulating surface from `points` distributed about evenly on it; none if a side has
    /// none.
    ///
    /// The lowest place of a side is the middle of its points less than 0.3 mm above the lowest one, without rim and
    /// eminence. That of a plateau opposite to a dish mirrors the lowest place of the dish.
    pub fn find(points: &[Vec3]) -> Option<Self> {
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
        let (mut medial_mm, is_medial_flat) = lowest(&medial.collect::<Vec<_>>())?;
        let (mut lateral_mm, is_lateral_flat) = lowest(&lateral.collect::<Vec<_>>())?;
        let mirrored = |own: Vec3, other: Vec3| Vec3::new(other.x, own.y, low.z + high.z - other.z);
        match (is_medial_flat, is_lateral_flat) {
            (true, false) => medial_mm = mirrored(medial_mm, lateral_mm),
            (false, true) => lateral_mm = mirrored(lateral_mm, medial_mm),
            _ => {}
        }
        Some(Self {
            medial_mm,
            lateral_mm,
        })
    }

    /// Returns whether a place of the insert is on the eminence between the dishes.
    pub fn is_on_eminence(&self, place: &Vec3) -> bool {
        let half_mm = (self.lateral_mm.z - self.medial_mm.z) / 2.0;
        (place.z - self.middle_mm().z).abs() < EMINENCE * half_mm
    }

    /// Returns the middle between the dishes, at the height of the lower one, mm.
    pub fn middle_mm(&self) -> Vec3 {
        let between = (self.medial_mm + self.lateral_mm) / 2.0;
        Vec3::new(
            between.x,
            self.medial_mm.y.min(self.lateral_mm.y),
            between.z,
        )
    }
}

/// Returns the lowest place of a side, and whether the side is a plateau.
fn lowest(points: &[&Vec3]) -> Option<(Vec3, bool)> {
    let mut heights: Vec<f64> = points.iter().map(|point| point.y).collect();
    heights.sort_unstable_by(f64::total_cmp);
    // The middle of enough points: the fillet of a rounded corner may reach lower.
    let enough = heights.len() / MIN_POINTS_OF_DISH;
    let at_bottom = heights
        .windows(enough + 1)
        .find(|few| few[enough] < few[0] + LOW_MM)?;
    let lowest = at_bottom[0];
    let low = points
        .iter()
        .filter(|point| (lowest..lowest + LOW_MM).contains(&point.y));
    let (count, sum) = low.fold((0.0, Vec3::zeros()), |(count, sum), point| {
        (count + 1.0, sum + **point)
    });
    let place = Vec3::new(sum.x / count, lowest, sum.z / count);
    Some((place, count > PLATEAU * points.len() as f64))
}

/// A circle in the sagittal plane that fits the outline of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FittedArc {
    /// Its centre (x, y), mm.
    pub centre_mm: (f64, f64),
    /// Largest distance of the outline from the circle along a direction of the fit, mm.
    pub off_mm: f64,
}

impl FittedArc {
    /// Fits the posterior condyles of a femur.
    pub fn posterior(femur: &TriangleMesh) -> Self {
        // Distal of 30 degrees the larger distal radius begins, above 90 the condyle ends in many designs.
        Self::fitted(femur, 30..=90)
    }

    /// Fits the dome of a talus around its lowest place.
    pub fn of_dome(talus: &TriangleMesh) -> Self {
        // Domes span 100 to 130 degrees; 80 leaves room for a talus that is turned in its file.
        Self::fitted(talus, -40..=40)
    }

    /// Fits the outline where it faces `behind_deg` behind straight down.
    ///
    /// The support h(d), the extent of the surface in direction d, is c . d + r for a circle of centre c and radius r, so a
    /// straight least-squares fit gives the centre.
    fn fitted(mesh: &TriangleMesh, behind_deg: RangeInclusive<i32>) -> Self {
        let support = |behind_deg: i32| {
            let (sine, cosine) = f64::from(behind_deg).to_radians().sin_cos();
            let (x, y) = (-sine, -cosine);
            let reaches = mesh.vertices.iter().map(|v| v.x * x + v.y * y);
            (
                Vec3::new(x, y, 1.0),
                reaches.fold(f64::NEG_INFINITY, f64::max),
            )
        };
        let supports = Vec::from_iter(behind_deg.step_by(2).map(support));
        let mut normal_matrix = Mat3::zeros();
        let mut right_side = Vec3::zeros();
        for (row, reach) in &supports {
            normal_matrix += row * row.transpose();
            right_side += row * *reach;
        }
        let solved = normal_matrix.lu().solve(&right_side).unwrap_or_default();
        let off = supports
            .iter()
            .map(|(row, reach)| (row.dot(&solved) - reach).abs());
        Self {
            centre_mm: (solved.x, solved.y),
            off_mm: off.fold(0.0, f64::max),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{GenericFemur, GenericFemurShape, GenericInsertShape, Meshing};

    fn generic() -> Vec<Vec3> {
        let insert = GenericInsertShape::default().insert(Meshing::default());
        insert.unwrap().surface().positions
    }

    #[test]
    fn verify_dishes_of_the_generic_insert() {
        let dishes = Dishes::find(&generic()).unwrap();
        for (found, z) in [(dishes.medial_mm, -23.0), (dishes.lateral_mm, 23.0)] {
            assert!((found - Vec3::new(0.0, 0.0, z)).norm() < 0.5, "{found}");
        }
        assert!(dishes.middle_mm().norm() < 0.3, "{:?}", dishes.middle_mm());
    }

    #[test]
    fn dishes_move_with_the_insert() {
        let shift = Vec3::new(4.0, -30.0, 5.0);
        let moved: Vec<Vec3> = generic().iter().map(|point| point + shift).collect();
        let [here, there] = [&generic(), &moved].map(|points| Dishes::find(points).unwrap());
        assert!((there.middle_mm() - here.middle_mm() - shift).norm() < 1e-9);
    }

    /// A medial pivot: the lateral side is a plane, whose lowest place says nothing.
    #[test]
    fn verify_a_plateau_mirrors_the_dish_on_the_other_side() {
        // The corner of the plateau is rounded.
        let pivot = |point: &Vec3| {
            let x = point.x - 5.0;
            let height = if point.z < 0.0 {
                point.y - 0.01 * point.x.powi(2) + 0.01 * x * x
            } else {
                0.001 * x
            };
            Vec3::new(point.x, height, point.z)
        };
        let corner = Vec3::new(15.0, -0.9, 28.0);
        let points = generic()
            .iter()
            .map(pivot)
            .chain([corner])
            .collect::<Vec<_>>();
        let Dishes {
            medial_mm,
            lateral_mm,
        } = Dishes::find(&points).unwrap();
        assert!(
            (medial_mm.z + 23.0).abs() < 0.5 && medial_mm.x > 1.0,
            "{medial_mm}"
        );
        assert_eq!((lateral_mm.x, lateral_mm.z), (medial_mm.x, -medial_mm.z));
    }

    #[test]
    fn no_points_have_no_dishes() {
        assert_eq!(Dishes::find(&[]), None);
    }

    #[test]
    fn verify_posterior_arc_of_the_generic_femur_is_its_origin() {
        let mesh = GenericFemur::new(GenericFemurShape::default()).surface_mesh(0.5);
        let (x, y) = FittedArc::posterior(&mesh).centre_mm;
        assert!(x.abs() < 0.05 && y.abs() < 0.05, "{x} {y}");
    }

    #[test]
    fn verify_the_dome_of_a_talus_is_a_circle_though_its_back_is_not() {
        let arc = |n: i32| {
            let (sine, cosine) = f64::from(n).to_radians().sin_cos();
            [-15.0, 15.0].map(|z| Vec3::new(3.0 + 24.0 * sine, 5.0 - 24.0 * cosine, z))
        };
        let talus = TriangleMesh {
            vertices: (-60..=60).flat_map(arc).collect(),
            triangles: Vec::new(),
        };
        let dome = FittedArc::of_dome(&talus);
        let (x, y) = dome.centre_mm;
        assert!(
            (x - 3.0).hypot(y - 5.0) < 1e-3 && dome.off_mm < 1e-4,
            "{dome:?}"
        );
        assert!(FittedArc::posterior(&talus).off_mm > 0.2);
    }
}
