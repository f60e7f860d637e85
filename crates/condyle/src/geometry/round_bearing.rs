//! Round bearings: the cup of a hip, the trough of an ankle and the pin of a pin-on-disc machine.

use std::f64::consts::PI;

use condyle_mesh::columns::{ColumnGrid, Meshing, Place, disc_plan};

use super::insert::{Insert, InsertError};
use crate::{Mat3, Vec3};

/// Dimensions and mounting of a cup around the origin: a hemisphere, or a shallower part of a sphere.
///
/// The machine presses the counterface along -y. With the cup below its head, as in many simulators, and x anterior, z is
/// lateral for a left hip; a right hip is its mirror image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CupShape {
    /// Inner radius.
    pub radius_mm: f64,
    /// Thickness of the wall.
    pub thickness_mm: f64,
    /// Angle between its axis and its rim, seen from the centre: 90 degrees of a hemisphere.
    pub opening_deg: f64,
    /// Angle between the plane of the opening and the plane across the load, in the frontal plane.
    pub inclination_deg: f64,
    /// Rotation of the inclined cup about the load, + turns its opening towards anterior.
    pub anteversion_deg: f64,
}

impl Default for CupShape {
    fn default() -> Self {
        Self {
            radius_mm: 14.1,
            thickness_mm: 8.0,
            opening_deg: 90.0,
            inclination_deg: 30.0,
            anteversion_deg: 0.0,
        }
    }
}

impl CupShape {
    /// Returns the unit vector from the centre to the pole of the cup, its deepest point.
    pub fn pole(&self) -> Vec3 {
        cup_mounting(self.inclination_deg, self.anteversion_deg) * -Vec3::y()
    }

    /// Meshes the cup, its centre at the origin.
    ///
    /// Arc length along meridians is that of the disc's radius, so that quads keep their shape near the pole and are
    /// compressed along the rim by 2/pi.
    ///
    /// # Errors
    /// Too many nodes, and the errors of [`Insert::new`] for dimensions that are not positive.
    pub fn insert(&self, meshing: Meshing) -> Result<Insert, InsertError> {
        let mounting = cup_mounting(self.inclination_deg, self.anteversion_deg);
        let opening = self.opening_deg.to_radians();
        let place = |disc: Place, outward: f64| {
            let (sine, cosine) = (opening * disc.norm()).sin_cos();
            let around = disc.try_normalize(0.0).unwrap_or_default() * sine;
            let radius_mm = self.radius_mm + outward * self.thickness_mm;
            mounting * (Vec3::new(around.x, -cosine, around.y) * radius_mm)
        };
        round_bearing(opening * self.radius_mm, self.thickness_mm, meshing, place)
    }
}

/// Returns the rotation from a cup that opens upwards to the mounted one; the angles are those of [`CupShape`].
pub fn cup_mounting(inclination_deg: f64, anteversion_deg: f64) -> Mat3 {
    let turn = |axis: Vec3, degrees: f64| {
        nalgebra::Rotation3::from_scaled_axis(axis * degrees.to_radians())
    };
    // About x the pole goes from -y towards -z.
    (turn(Vec3::y(), anteversion_deg) * turn(Vec3::x(), inclination_deg)).into_inner()
}

/// Dimensions of a cylindrical trough along z around the origin, its lowest line at y = -radius.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TroughShape {
    /// Radius of the cylinder.
    pub radius_mm: f64,
    /// Length along x.
    pub length_mm: f64,
    /// Width along z.
    pub width_mm: f64,
    /// Thickness below the lowest line.
    pub thickness_mm: f64,
}

impl Default for TroughShape {
    fn default() -> Self {
        Self {
            radius_mm: 25.0,
            length_mm: 30.0,
            width_mm: 28.0,
            thickness_mm: 6.0,
        }
    }
}

impl TroughShape {
    /// Meshes the trough in vertical columns.
    ///
    /// # Errors
    /// Too many nodes, and the errors of [`Insert::new`] for dimensions that are not positive.
    pub fn insert(&self, meshing: Meshing) -> Result<Insert, InsertError> {
        let (x_mm, z_mm) = (self.length_mm / 2.0, self.width_mm / 2.0);
        let grid = ColumnGrid::filling(
            (-x_mm, -z_mm),
            (x_mm, z_mm),
            meshing.edge_mm,
            meshing.layers,
        )?;
        let bottom_mm = -self.radius_mm - self.thickness_mm;
        let columns = grid.columns(|x, _| {
            let top_mm = -(self.radius_mm * self.radius_mm - x * x).max(0.0).sqrt();
            (bottom_mm, top_mm)
        });
        let built = grid.plan().hexahedra(&columns, meshing);
        Insert::new(built.mesh, &built.articulating, &built.backside)
    }
}

/// Returns a cylindrical pin with its flat end at y = 0, `height_mm` high.
///
/// # Errors
/// Too many nodes, and the errors of [`Insert::new`] for dimensions that are not positive.
pub fn pin(radius_mm: f64, height_mm: f64, meshing: Meshing) -> Result<Insert, InsertError> {
    let plan = disc_plan(meshing.edge_mm / radius_mm, meshing.layers)?;
    // The rim is a polygon, which is made as large as the circle: otherwise the pressure of a coarse pin is too high.
    let rim_mm = radius_mm * (PI / plan.area_mm2()).sqrt();
    round_bearing(radius_mm, height_mm, meshing, |disc, down| {
        Vec3::new(disc.x * rim_mm, -down * height_mm, disc.y * rim_mm)
    })
}

/// Returns the bearing whose points are at `place` of a point of the unit disc and of the part of the thickness below
/// it; `extent_mm` is the length on the articulating surface that corresponds to the disc's radius.
fn round_bearing(
    extent_mm: f64,
    thickness_mm: f64,
    Meshing { edge_mm, layers }: Meshing,
    place: impl Fn(Place, f64) -> Vec3,
) -> Result<Insert, InsertError> {
    let plan = disc_plan(edge_mm / extent_mm, layers)?;
    // Heights of 0 to 1 stand for the parts of the thickness above the backside.
    let edge_mm = edge_mm / thickness_mm;
    let columns = vec![(0.0, 1.0); plan.places_mm.len()];
    let mut built = plan.hexahedra(&columns, Meshing { edge_mm, layers });
    for node in &mut built.mesh.nodes {
        *node = place(Place::new(node.x, node.z), 1.0 - node.y);
    }
    let insert = Insert::new(built.mesh, &built.articulating, &built.backside)?;
    let nodes = insert.surface_nodes().len();
    Ok(insert.with_thickness_mm(vec![thickness_mm; nodes]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_volume_surface_and_quality_of_a_cup() {
        let cup = CupShape::default();
        let insert = cup
            .insert(Meshing {
                edge_mm: 1.0,
                layers: 6,
            })
            .unwrap();
        let mesh = insert.mesh();
        assert!(
            (8_000..11_000).contains(&mesh.hexes.len()),
            "{}",
            mesh.hexes.len()
        );
        assert!(mesh.worst_quality() > 0.5, "{}", mesh.worst_quality());
        let (inner, outer) = (cup.radius_mm, cup.radius_mm + cup.thickness_mm);
        let volume = 2.0 / 3.0 * PI * (outer.powi(3) - inner.powi(3));
        // Flat faces of a sphere miss (edge/radius)^2/4 of the volume between chord and arc.
        let of_chords = (1.0 / inner).powi(2) / 4.0;
        assert!((insert.volume_mm3() / volume - 1.0).abs() < 2.0 * of_chords);
        let surface = insert.surface();
        assert!((surface.area_mm2() / (2.0 * PI * inner * inner) - 1.0).abs() < 2.0 * of_chords);
        for (position, normal) in surface.positions.iter().zip(&surface.normals) {
            assert!((position.norm() - inner).abs() < 1e-9);
            // Normals at the rim are those of faces on one side only.
            assert!(normal.dot(position) < -0.998 * inner);
        }
        assert!(
            insert
                .thickness_mm()
                .iter()
                .all(|&thickness| thickness == 8.0)
        );
    }

    #[test]
    fn the_pole_of_an_inclined_cup_is_medial() {
        let pole = CupShape::default().pole();
        let expected = Vec3::new(0.0, -(30f64.to_radians().cos()), -0.5);
        assert!((pole - expected).norm() < 1e-12);
        let turned = CupShape {
            anteversion_deg: 90.0,
            ..CupShape::default()
        }
        .pole();
        assert!((turned.x + 0.5).abs() < 1e-12);
    }

    #[test]
    fn verify_volume_of_a_trough_and_surface_of_a_shallow_cup() {
        let trough = TroughShape::default();
        let (layers, edge_mm) = (4, 1.0);
        let built = trough.insert(Meshing { edge_mm, layers }).unwrap();
        let (r, half) = (trough.radius_mm, trough.length_mm / 2.0);
        // Area below the arc, seen from the side.
        let segment = half * (r * r - half * half).sqrt() + r * r * (half / r).asin();
        let area = trough.length_mm * (r + trough.thickness_mm) - segment;
        let volume = area * trough.width_mm;
        assert!((built.volume_mm3() / volume - 1.0).abs() < 1e-3);
        let dish = CupShape {
            opening_deg: 30.0,
            ..CupShape::default()
        };
        let dish = dish.insert(Meshing { edge_mm, layers }).unwrap();
        let cap = 2.0 * PI * 14.1 * 14.1 * (1.0 - 30f64.to_radians().cos());
        assert!((dish.surface().area_mm2() / cap - 1.0).abs() < 0.01);
        assert!(dish.mesh().worst_quality() > 0.5);
    }

    #[test]
    fn verify_area_and_volume_of_a_pin_on_a_fine_and_on_a_coarse_mesh() {
        for edge_mm in [0.5, 3.0] {
            let insert = pin(4.5, 10.0, Meshing { edge_mm, layers: 5 }).unwrap();
            let area = PI * 4.5 * 4.5;
            assert!((insert.surface().area_mm2() / area - 1.0).abs() < 1e-12);
            assert!((insert.volume_mm3() / (10.0 * area) - 1.0).abs() < 1e-12);
            assert!(insert.mesh().worst_quality() > 0.6);
        }
    }
}
