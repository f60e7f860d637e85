//! An insert from a triangle mesh: hexahedra in columns along y.

mod backside;
mod bridge;
mod core;
mod evened;
mod footprint;
mod holes;
mod outline;
mod ring;
mod shaped;
mod vertical_lines;

use thiserror::Error;

pub use self::holes::Hole;
use self::{
    backside::ease_steps,
    core::Core,
    footprint::Footprint,
    holes::holes,
    outline::{Loop, Place, outline},
    ring::Ring,
};
use super::{
    columns::{Column, ColumnGrid, Plan},
    generic_insert::Meshing,
    insert::{Insert, error::InsertError},
    triangle_mesh::TriangleMesh,
};

/// Pieces of the insert seen from above that are smaller than this many hexahedra are chips, and left out.
const MIN_PIECE: f64 = 4.0;
/// Where a node on the outline is off the shell by what a chord of the outline is, it is moved by one of
/// these shares of the way to the next node inside.
const HAIRS: [f64; 9] = [0.0, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.25, 0.5];

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
    /// Places inside the outline where no column may stand.
    #[error(
        "inside the insert's outline no hexahedra can stand on {}; fill it in the mesh",
        listed_holes(holes)
    )]
    Holes {
        /// All of them.
        holes: Vec<Hole>,
    },
    /// A place inside the outline where nothing is below or above.
    #[error(
        "the insert has a hole at x {x_mm:.2}, z {z_mm:.2} mm, where no column of hexahedra can stand; mend the mesh"
    )]
    NoColumn {
        /// Anterior, mm.
        x_mm: f64,
        /// To the right of a right knee, mm.
        z_mm: f64,
    },
    /// A part of the insert in which no cell of the grid fits.
    #[error(
        "the insert is too narrow for an edge of {edge_mm} mm around x {x_mm:.1}, z {z_mm:.1} mm; use a smaller edge_mm, or delete \
         what lies there if it is no part of the insert"
    )]
    TooCoarse {
        /// The edge asked for.
        edge_mm: f64,
        /// Middle of that part, anterior, mm.
        x_mm: f64,
        /// The same to the right of a right knee, mm.
        z_mm: f64,
    },
    /// The columns make no insert.
    #[error(transparent)]
    Insert(#[from] InsertError),
}

/// Hexahedra between the top and the bottom of a shell, or below an open surface.
///
/// Seen from above, the cells of a grid fill what lies well inside the outline, and a ring of quads
/// with their outer nodes on the outline fills the rest. The outline is that of the part in which the
/// shell is no wall (steeper than 56 degrees) and thicker than 0.15 of the median. The vertical line
/// through each place meets the shell; its highest and its lowest point bound the column. Facets
/// are lifted to the curved surface that the vertex normals imply. Below an open surface the
/// backside is flat, `thickness_mm` below the lowest point.
///
/// # Errors
/// An open shell without a thickness, one in which no column fits, a hole inside the outline, an
/// outline with details finer than the edge, or more nodes than memory holds.
pub fn insert_from_shell(
    shell: &TriangleMesh,
    is_closed: bool,
    thickness_mm: Option<f64>,
    meshing: Meshing,
) -> Result<Insert, ShellInsertError> {
    let (insert, holes) = insert_over_holes(shell, is_closed, thickness_mm, meshing)?;
    if holes.is_empty() {
        Ok(insert)
    } else {
        Err(ShellInsertError::Holes { holes })
    }
}

/// As [`insert_from_shell`], with hexahedra over holes and posts inside the outline, as if the surface around them went
/// on smoothly; and which those are. Whatever touches there, or beside it, touches what is made up.
///
/// # Errors
/// As [`insert_from_shell`], but for holes.
pub fn insert_over_holes(
    shell: &TriangleMesh,
    is_closed: bool,
    thickness_mm: Option<f64>,
    meshing: Meshing,
) -> Result<(Insert, Vec<Hole>), ShellInsertError> {
    let edge_mm = meshing.edge_mm;
    let (low, high) = shell.bounds();
    let (low, high) = ((low.x, low.z), (high.x, high.z));
    let grid = ColumnGrid::filling(low, high, edge_mm, meshing.layers)?;
    let mut footprint = Footprint::new(shell, is_closed, edge_mm);
    let outlines = outline(&footprint, edge_mm);
    let holes = holes(&mut footprint, &outlines, edge_mm);
    let fitted = fitted_plan(&grid, &footprint, edge_mm);
    let (plan, mut columns) = match fitted {
        // Of two reasons, the holes come first: what cannot be fitted may come from what was made up over them.
        Err(_) if !holes.is_empty() => return Err(ShellInsertError::Holes { holes }),
        fitted => fitted?,
    };
    if is_closed {
        ease_steps(&plan, &mut columns);
    } else {
        let thickness_mm = thickness_mm.ok_or(ShellInsertError::OpenWithoutThickness)?;
        put_on_flat_backside(&mut columns, thickness_mm);
    }
    let built = plan.hexahedra(&columns, meshing.layers);
    let insert = Insert::new(built.mesh, &built.articulating, &built.backside)?;
    Ok((insert.with_rim_along_walls(), holes))
}

/// The plan of the hexahedra with its rim on the outline, and the columns on its places.
fn fitted_plan(
    grid: &ColumnGrid,
    footprint: &Footprint<'_>,
    edge_mm: f64,
) -> Result<(Plan, Vec<Column>), ShellInsertError> {
    let outlines = outline(footprint, edge_mm);
    let outer: Vec<&Loop> = outlines
        .iter()
        .filter(|outline| outline.area_mm2() > MIN_PIECE * edge_mm * edge_mm)
        .collect();
    let pieces = matched(grid, &outer, Core::pieces(grid, footprint), edge_mm)?;
    let mut ring = Ring::new(grid, &pieces);
    ring.even_out(edge_mm);
    standing(&ring, footprint)
}

/// For every outline the largest piece of the core inside.
fn matched<'a>(
    grid: &ColumnGrid,
    outlines: &[&'a Loop],
    mut pieces: Vec<Core>,
    edge_mm: f64,
) -> Result<Vec<(Core, &'a Loop)>, ShellInsertError> {
    if outlines.is_empty() {
        return Err(ShellInsertError::NoColumns { edge_mm });
    }
    pieces.sort_by_key(|piece| std::cmp::Reverse(piece.cells.len()));
    let of_outline = |outline: &&'a Loop| {
        let is_inside = |piece: &&Core| {
            let (x, z) = grid.place_of_mm(piece.cells[0][0]);
            outline.goes_round(&Place::new(x, z))
        };
        match pieces.iter().find(is_inside) {
            Some(piece) if piece.loops.len() == 1 => Ok((piece.clone(), *outline)),
            _ => Err(ShellInsertError::TooCoarse {
                edge_mm,
                x_mm: outline.middle()[0],
                z_mm: outline.middle()[1],
            }),
        }
    };
    outlines.iter().map(of_outline).collect()
}

/// The columns on every place of a plan; those on the outline stand a hair inside where they must.
fn standing(
    ring: &Ring<'_>,
    footprint: &Footprint<'_>,
) -> Result<(Plan, Vec<Column>), ShellInsertError> {
    let mut plan = ring.plan();
    for (outer, inner) in ring.spokes() {
        let [outer, inner] = [outer, inner].map(|n| n as usize);
        let (from, to) = (plan.places_mm[outer], plan.places_mm[inner]);
        let inward = HAIRS.iter().map(|share| {
            (
                from.0 + share * (to.0 - from.0),
                from.1 + share * (to.1 - from.1),
            )
        });
        let holds = inward.clone().find(|place| footprint.holds(*place));
        let meets = || { inward }.find(|place| footprint.through(*place).is_some());
        plan.places_mm[outer] = holds.or_else(meets).unwrap_or(from);
    }
    let column = |&place: &(f64, f64)| {
        let through = footprint.through(place);
        through
            .map(|through| (through.bottom, through.top))
            .ok_or(place)
    };
    let columns: Result<_, _> = plan.places_mm.iter().map(column).collect();
    let columns = columns.map_err(|(x_mm, z_mm)| ShellInsertError::NoColumn { x_mm, z_mm })?;
    Ok((plan, columns))
}

/// Ends every column at a plane below the lowest point.
fn put_on_flat_backside(columns: &mut [Column], thickness_mm: f64) {
    let lowest = columns
        .iter()
        .map(|column| column.1)
        .fold(f64::INFINITY, f64::min);
    for (bottom, _) in columns {
        *bottom = lowest - thickness_mm;
    }
}

/// Holes in words, one after the other.
pub fn listed_holes(holes: &[Hole]) -> String {
    let each: Vec<String> = holes.iter().map(Hole::to_string).collect();
    each.join(", on ")
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
