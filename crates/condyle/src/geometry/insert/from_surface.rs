//! An insert from a triangle mesh: hexahedra in columns along y.

use condyle_mesh::{
    TriangleMesh,
    columns::{ColumnError, Hole, Meshing, column_mesh},
};

use super::{Insert, error::InsertError};

impl Insert {
    /// Returns the insert between the top and the bottom of a closed surface, or `thickness_mm` deep below an open one,
    /// in columns of hexahedra; see [`column_mesh`].
    ///
    /// # Errors
    /// As [`column_mesh`] and [`Insert::new`], and a hole inside the outline.
    pub fn from_surface(
        surface: &TriangleMesh,
        is_closed: bool,
        thickness_mm: Option<f64>,
        meshing: Meshing,
    ) -> Result<Self, InsertError> {
        match Self::over_holes(surface, is_closed, thickness_mm, meshing)? {
            (insert, holes) if holes.is_empty() => Ok(insert),
            (_, holes) => Err(ColumnError::Holes { holes }.into()),
        }
    }

    /// As [`Insert::from_surface`], with hexahedra over holes and posts inside the outline, as if the surface around
    /// them went on smoothly, and these holes.
    ///
    /// # Errors
    /// As [`Insert::from_surface`], but for holes.
    pub fn over_holes(
        surface: &TriangleMesh,
        is_closed: bool,
        thickness_mm: Option<f64>,
        meshing: Meshing,
    ) -> Result<(Self, Vec<Hole>), InsertError> {
        let (columns, holes) = column_mesh(surface, is_closed, thickness_mm, meshing)?;
        let insert = Self::new(columns.mesh, &columns.articulating, &columns.backside)?;
        Ok((insert.with_rim_along_walls(), holes))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Vec3, geometry::GenericInsertShape};

    /// The generic dish as an open surface of triangles, fine or coarse.
    fn dish(edge_mm: f64) -> TriangleMesh {
        let insert = GenericInsertShape::default()
            .insert(Meshing { edge_mm, layers: 1 })
            .unwrap();
        let surface = insert.surface();
        let cut = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
        TriangleMesh {
            vertices: surface.positions,
            triangles: insert
                .surface_faces()
                .iter()
                .flat_map(|&face| cut(face))
                .collect(),
        }
    }

    #[test]
    fn verify_volume_of_a_box() {
        let shell = TriangleMesh::block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0));
        assert!((shell.signed_volume() - 4800.0).abs() < 1e-9);
        let insert = Insert::from_surface(
            &shell,
            true,
            None,
            Meshing {
                edge_mm: 1.0,
                layers: 3,
            },
        )
        .unwrap();
        assert!(
            (insert.mesh().volume() - 4800.0).abs() < 1e-6
                && (insert.volume_mm3() - 4800.0).abs() < 1e-6,
            "{}",
            insert.mesh().volume()
        );
        assert!(
            insert
                .thickness_mm()
                .iter()
                .all(|thickness| (thickness - 8.0).abs() < 1e-9)
        );
    }

    #[test]
    fn verify_heights_from_a_coarse_dish_are_those_of_the_dish() {
        let shape = GenericInsertShape::default();
        let meshing = Meshing {
            edge_mm: 0.77,
            layers: 1,
        };
        let insert = Insert::from_surface(&dish(2.0), false, Some(9.0), meshing).unwrap();
        for position in insert.surface().positions {
            let in_dish = position.x.abs() < 12.0 && (position.z.abs() - 23.0).abs() < 9.0;
            if in_dish {
                // The flat facets lie up to 25 micrometres off.
                let error = position.y - shape.height_mm(position.x, position.z);
                assert!(error.abs() < 1e-3, "{error} at {position}");
            }
        }
    }

    #[test]
    fn errors_say_what_to_give() {
        let meshing = Meshing::default();
        let open = Insert::from_surface(&dish(2.0), false, None, meshing)
            .err()
            .unwrap();
        assert!(open.to_string().contains("give thickness_mm"));
        let tiny = TriangleMesh::block(Vec3::zeros(), Vec3::new(0.02, 0.01, 0.03))
            .mapped(|v| v + Vec3::repeat(5.0));
        let huge = Meshing {
            edge_mm: 100.0,
            layers: 1,
        };
        match Insert::from_surface(&tiny, true, None, huge) {
            Err(error) => assert!(error.to_string().contains("smaller edge_mm"), "{error}"),
            Ok(insert) => assert_eq!(insert.mesh().hexes.len(), 1),
        }
        let nothing = Insert::from_surface(
            &TriangleMesh {
                vertices: vec![Vec3::zeros(); 3],
                triangles: vec![[0, 1, 2]],
            },
            true,
            None,
            meshing,
        );
        assert!(
            nothing
                .err()
                .unwrap()
                .to_string()
                .contains("smaller edge_mm")
        );
    }
}
