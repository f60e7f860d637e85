//! An insert from a triangle mesh: hexahedra in columns along y.

mod rim;
mod through;

use thiserror::Error;

use self::{
    rim::{drop_steep, drop_thin},
    through::columns_through,
};
use super::{
    columns::{Column, ColumnGrid},
    generic_insert::Meshing,
    insert::{Insert, error::InsertError},
    triangle_mesh::TriangleMesh,
};

/// Why a shell makes no insert.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ShellInsertError {
    /// An open surface without a thickness below it.
    #[error(
        "the insert's surface is open, so nothing says how thick the insert is; give thickness_mm, below the lowest point"
    )]
    OpenWithoutThickness,
    /// No column stands on the grid.
    #[error(
        "no column of hexahedra fits into the insert at an edge of {edge_mm} mm; use a smaller edge_mm, and check length_unit and axes"
    )]
    NoColumns {
        /// The edge asked for.
        edge_mm: f64,
    },
    /// The columns make no insert.
    #[error(transparent)]
    Insert(#[from] InsertError),
}

/// Hexahedra between the top and the bottom of a shell, or below an open surface.
///
/// A vertical line through every grid point meets the shell; its highest and its lowest point
/// bound the column. Facets are lifted to the curved surface that the vertex normals imply. Below
/// an open surface the backside is flat, `thickness_mm` below the lowest point. Thin and steep
/// columns at the rim are left out, so the outline follows the grid.
///
/// # Errors
/// An open shell without a thickness, one in which no column fits, or more nodes than memory holds.
pub fn insert_from_shell(
    shell: &TriangleMesh,
    is_closed: bool,
    thickness_mm: Option<f64>,
    meshing: Meshing,
) -> Result<Insert, ShellInsertError> {
    let edge_mm = meshing.edge_mm;
    let (low, high) = shell.bounds();
    let (low, high) = ((low.x, low.z), (high.x, high.z));
    let grid = ColumnGrid::filling(low, high, edge_mm, meshing.layers)?;
    let mut columns = columns_through(shell, &grid);
    if !is_closed {
        let thickness_mm = thickness_mm.ok_or(ShellInsertError::OpenWithoutThickness)?;
        put_on_flat_backside(&mut columns, thickness_mm);
    }
    drop_thin(&mut columns);
    drop_steep(&grid, &mut columns, edge_mm);
    let built = grid.hexahedra(&columns, meshing.layers);
    if built.mesh.hexes.is_empty() {
        return Err(ShellInsertError::NoColumns { edge_mm });
    }
    Ok(Insert::new(
        built.mesh,
        &built.articulating,
        &built.backside,
    )?)
}

/// Ends every column at a plane below the lowest point.
fn put_on_flat_backside(columns: &mut [Column], thickness_mm: f64) {
    let lowest = columns
        .iter()
        .flatten()
        .map(|column| column.1)
        .fold(f64::INFINITY, f64::min);
    for (bottom, _) in columns.iter_mut().flatten() {
        *bottom = lowest - thickness_mm;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        Vec3,
        geometry::{GenericInsertShape, shell::fixtures::block},
    };

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
        let shell = block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0));
        assert!((shell.signed_volume() - 4800.0).abs() < 1e-9);
        let insert = insert_from_shell(
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
        let insert = insert_from_shell(&dish(2.0), false, Some(9.0), meshing).unwrap();
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
        let open = insert_from_shell(&dish(2.0), false, None, meshing)
            .err()
            .unwrap();
        assert!(open.to_string().contains("give thickness_mm"));
        let tiny =
            block(Vec3::zeros(), Vec3::new(0.02, 0.01, 0.03)).mapped(|v| v + Vec3::repeat(5.0));
        let huge = Meshing {
            edge_mm: 100.0,
            layers: 1,
        };
        match insert_from_shell(&tiny, true, None, huge) {
            Err(error) => assert!(error.to_string().contains("smaller edge_mm"), "{error}"),
            Ok(insert) => assert_eq!(insert.mesh().hexes.len(), 1),
        }
        let nothing = insert_from_shell(
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
