//! Placement of components.

use condyle::geometry::{Dishes, TriangleMesh};
use condyle::{Mat3, Vec3};

use super::super::femur::FemurPlacement;
use super::super::insert::{InsertOrigin, InsertPlacement};

/// Spacing of the points among which an insert's dishes are searched, mm.
const LOOKED_AT_EVERY_MM: f64 = 0.5;

/// p' = R p + t
#[derive(Clone, Copy, Debug)]
pub(super) struct RigidMotion {
    pub rotation: Mat3,
    pub shift_mm: Vec3,
}

impl RigidMotion {
    fn about(about_mm: Vec3, rotation: Mat3, shift_mm: Vec3) -> Self {
        let shift_mm = about_mm - rotation * about_mm + shift_mm;
        Self { rotation, shift_mm }
    }

    pub(super) fn point(&self, point: &Vec3) -> Vec3 {
        self.rotation * point + self.shift_mm
    }

    pub(super) fn mesh(&self, mesh: TriangleMesh) -> TriangleMesh {
        mesh.mapped(|vertex| self.point(vertex))
    }
}

impl InsertPlacement {
    /// Returns the rotation about the origin, Ry(rotation) Rx(-tilt) Rz(slope).
    pub(super) fn rotation(&self) -> Mat3 {
        rotation(
            self.posterior_slope_deg,
            -self.coronal_tilt_deg,
            self.axial_rotation_deg,
        )
    }

    /// Returns the motion of an insert whose dishes have their middle at `middle_mm`; `None` for no motion.
    pub(super) fn motion(&self, middle_mm: impl FnOnce() -> Vec3) -> Option<RigidMotion> {
        let origin_mm = match self.origin {
            InsertOrigin::File => Vec3::zeros(),
            InsertOrigin::Centre => middle_mm(),
        };
        let rotation = self.rotation();
        let moves = self.is_turned() || self.origin == InsertOrigin::Centre;
        moves.then(|| RigidMotion {
            rotation,
            shift_mm: -(rotation * origin_mm),
        })
    }
}

impl FemurPlacement {
    /// Returns the motion of a component that flexes about (x, y) of the femoral frame; `None` for no motion.
    ///
    /// A component moves on its bone in the direction opposite to that of the bone over the component: Ry(-external)
    /// Rx(varus) Rz(-flexion).
    pub(super) fn motion(&self, (x, y): (f64, f64)) -> Option<RigidMotion> {
        let rotation = rotation(
            -self.flexion_deg,
            self.varus_deg,
            -self.external_rotation_deg,
        );
        let shift_mm = Vec3::new(
            self.anterior_offset_mm,
            self.superior_offset_mm,
            self.lateral_offset_mm,
        );
        let motion = || RigidMotion::about(Vec3::new(x, y, 0.0), rotation, shift_mm);
        self.is_moved().then(motion)
    }
}

/// Returns the rotation about the fixed axes z, x, y, in this order.
fn rotation(about_z_deg: f64, about_x_deg: f64, about_y_deg: f64) -> Mat3 {
    let (sz, cz) = about_z_deg.to_radians().sin_cos();
    let (sx, cx) = about_x_deg.to_radians().sin_cos();
    let (sy, cy) = about_y_deg.to_radians().sin_cos();
    let about_z = Mat3::new(cz, -sz, 0.0, sz, cz, 0.0, 0.0, 0.0, 1.0);
    let about_x = Mat3::new(1.0, 0.0, 0.0, 0.0, cx, -sx, 0.0, sx, cx);
    let about_y = Mat3::new(cy, 0.0, sy, 0.0, 1.0, 0.0, -sy, 0.0, cy);
    about_y * about_x * about_z
}

/// Returns the midpoint between the dishes of an insert of triangles; the origin if it has none.
pub(in crate::case) fn middle_of_mesh(mesh: &TriangleMesh) -> Vec3 {
    middle_of_points(&mesh.seen_from_above(LOOKED_AT_EVERY_MM))
}

pub(super) fn middle_of_points(points: &[Vec3]) -> Vec3 {
    Dishes::find(points).map_or(Vec3::zeros(), |dishes| dishes.middle_mm())
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: InsertPlacement = InsertPlacement {
        origin: InsertOrigin::File,
        posterior_slope_deg: 0.0,
        coronal_tilt_deg: 0.0,
        axial_rotation_deg: 0.0,
    };
    const ON_BONE: FemurPlacement = FemurPlacement {
        flexion_deg: 0.0,
        varus_deg: 0.0,
        external_rotation_deg: 0.0,
        anterior_offset_mm: 0.0,
        superior_offset_mm: 0.0,
        lateral_offset_mm: 0.0,
    };

    fn insert(placement: &InsertPlacement, point: Vec3) -> Vec3 {
        placement
            .motion(Vec3::zeros)
            .expect("it moves")
            .point(&point)
    }

    fn femur(placement: &FemurPlacement, point: Vec3) -> Vec3 {
        let motion = placement.motion((1.0, 2.0)).expect("it moves");
        motion.point(&(point + Vec3::new(1.0, 2.0, 0.0))) - Vec3::new(1.0, 2.0, 0.0)
    }

    #[test]
    fn verify_signs_of_the_insert() {
        let slope = InsertPlacement {
            posterior_slope_deg: 3.0,
            ..NONE
        };
        assert!(insert(&slope, -Vec3::x()).y < 0.0);
        let varus = InsertPlacement {
            coronal_tilt_deg: 3.0,
            ..NONE
        };
        assert!(insert(&varus, -Vec3::z()).y < 0.0);
        let internal = InsertPlacement {
            axial_rotation_deg: 3.0,
            ..NONE
        };
        assert!(insert(&internal, Vec3::x()).z < 0.0);
    }

    #[test]
    fn verify_signs_of_the_femur() {
        let flexed = FemurPlacement {
            flexion_deg: 3.0,
            ..ON_BONE
        };
        assert!(femur(&flexed, Vec3::y()).x > 0.0);
        let varus = FemurPlacement {
            varus_deg: 3.0,
            ..ON_BONE
        };
        assert!(femur(&varus, Vec3::z()).y < 0.0);
        let external = FemurPlacement {
            external_rotation_deg: 3.0,
            ..ON_BONE
        };
        assert!(femur(&external, Vec3::x()).z > 0.0);
        let shifted = FemurPlacement {
            lateral_offset_mm: 3.0,
            ..ON_BONE
        };
        assert_eq!(femur(&shifted, Vec3::zeros()), Vec3::new(0.0, 0.0, 3.0));
    }

    #[test]
    fn slope_comes_before_rotation() {
        let both = InsertPlacement {
            posterior_slope_deg: 5.0,
            axial_rotation_deg: 90.0,
            ..NONE
        };
        // The front rises by the slope and then lies where internal rotation takes it.
        let front = insert(&both, Vec3::x());
        let (sine, cosine) = 5f64.to_radians().sin_cos();
        assert!((front - Vec3::new(0.0, sine, -cosine)).norm() < 1e-12);
    }

    #[test]
    fn the_centre_becomes_the_origin_whatever_the_turn() {
        let centred = InsertPlacement {
            origin: InsertOrigin::Centre,
            coronal_tilt_deg: 4.0,
            ..NONE
        };
        let middle = Vec3::new(4.0, 30.0, -5.0);
        let motion = centred.motion(|| middle).expect("it moves");
        assert!(motion.point(&middle).norm() < 1e-12);
        assert!(NONE.motion(|| middle).is_none() && ON_BONE.motion((0.0, 0.0)).is_none());
    }
}
