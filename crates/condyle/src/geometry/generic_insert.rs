//! The generic tibial insert: two dishes and an eminence between them.

use condyle_mesh::columns::{ColumnGrid, Meshing};

use super::insert::{Insert, InsertError};
use crate::Vec3;

/// Dimensions of the generic insert.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GenericInsertShape {
    /// Sagittal radius of the dishes.
    pub sagittal_radius_mm: f64,
    /// Radius of the dishes across, in the frontal plane.
    pub coronal_radius_mm: f64,
    /// Distance between the two dishes' lowest points.
    pub spacing_mm: f64,
    /// Thickness below the lowest points.
    pub thickness_mm: f64,
}

impl Default for GenericInsertShape {
    fn default() -> Self {
        Self {
            sagittal_radius_mm: 55.0,
            coronal_radius_mm: 30.0,
            spacing_mm: 46.0,
            thickness_mm: 9.0,
        }
    }
}

/// Posterior medial corner of the insert, (x, z), mm, ...
const LOW_MM: (f64, f64) = (-24.0, -36.0);
/// ... and the opposite one.
const HIGH_MM: (f64, f64) = (22.0, 36.0);
/// Height at which the eminence between the dishes is cut off, mm.
const EMINENCE_MM: f64 = 8.0;

impl GenericInsertShape {
    /// Length and width of every generic insert, mm.
    pub const SIZE_MM: (f64, f64) = (HIGH_MM.0 - LOW_MM.0, HIGH_MM.1 - LOW_MM.1);

    /// Returns the height of the articulating surface above its lowest points, mm.
    ///
    /// D(z) = (Rs - Rc) + sqrt(Rc^2 - (|z| - spacing/2)^2) is the distance from the medio-lateral
    /// axis at height Rs, and y = Rs - sqrt(D^2 - x^2), at most 8 mm.
    pub fn height_mm(&self, x_mm: f64, z_mm: f64) -> f64 {
        let (rs, rc) = (self.sagittal_radius_mm, self.coronal_radius_mm);
        let across = z_mm.abs() - self.spacing_mm / 2.0;
        let distance = (rs - rc) + (rc * rc - across * across).max(0.0).sqrt();
        // Beyond the dish the roots would be of negative numbers; there the cap below counts.
        let height = rs - (distance * distance - x_mm * x_mm).max(0.0).sqrt();
        height.min(EMINENCE_MM)
    }

    /// Meshes the insert with its lowest points at y = 0.
    ///
    /// # Errors
    /// Too many nodes, and the errors of [`Insert::new`] for dimensions that do not form a dish.
    pub fn insert(&self, meshing: Meshing) -> Result<Insert, InsertError> {
        self.insert_moved(meshing, Vec3::clone)
    }

    /// Meshes the insert with every point moved by `place`, a rigid motion.
    ///
    /// # Errors
    /// As [`GenericInsertShape::insert`].
    pub fn insert_moved(
        &self,
        meshing: Meshing,
        place: impl Fn(&Vec3) -> Vec3,
    ) -> Result<Insert, InsertError> {
        let grid = ColumnGrid::filling(LOW_MM, HIGH_MM, meshing.edge_mm, meshing.layers)?;
        let columns = grid.columns(|x, z| (-self.thickness_mm, self.height_mm(x, z)));
        let mut built = grid.plan().hexahedra(&columns, meshing);
        let nodes = built.mesh.nodes.iter_mut();
        nodes.for_each(|node| *node = place(node));
        Insert::new(built.mesh, &built.articulating, &built.backside)
    }
}

/// Returns a flat block with its articulating surface at y = 0, for verification.
///
/// `size_mm`: length along x and z, centred; `thickness_mm`: down to the backside.
///
/// # Errors
/// Too many nodes, and the errors of [`Insert::new`] for sizes that are not positive.
pub fn flat_insert(
    size_mm: (f64, f64),
    thickness_mm: f64,
    meshing: Meshing,
) -> Result<Insert, InsertError> {
    let (x, z) = (size_mm.0 / 2.0, size_mm.1 / 2.0);
    let grid = ColumnGrid::filling((-x, -z), (x, z), meshing.edge_mm, meshing.layers)?;
    let columns = vec![(-thickness_mm, 0.0); grid.point_count()];
    let built = grid.plan().hexahedra(&columns, meshing);
    Insert::new(built.mesh, &built.articulating, &built.backside)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_heights_of_the_dish() {
        let shape = GenericInsertShape::default();
        assert_eq!(shape.height_mm(0.0, 23.0), 0.0);
        assert_eq!(shape.height_mm(0.0, 0.0), 8.0);
        let edge = 55.0 - (55f64.powi(2) - 24f64.powi(2)).sqrt();
        assert!((shape.height_mm(-24.0, -23.0) - edge).abs() < 1e-12);
    }

    #[test]
    fn default_mesh_has_about_twelve_thousand_good_hexahedra() {
        let insert = GenericInsertShape::default()
            .insert(Meshing::default())
            .unwrap();
        let mesh = insert.mesh();
        assert!(
            (11_900..12_400).contains(&mesh.hexes.len()),
            "{}",
            mesh.hexes.len()
        );
        assert!(mesh.worst_quality() > 0.4, "{}", mesh.worst_quality());
        let thickness = insert.thickness_mm().iter().copied();
        let thinnest = thickness.fold(f64::INFINITY, f64::min);
        assert!((9.0..9.01).contains(&thinnest), "{thinnest}");
    }
}
