//! Hexahedra in columns along y below the surface of a triangle mesh.

mod footprint;
mod grid;
mod holes;
mod outline;
mod ring;
mod vertical_lines;

use thiserror::Error;

use self::{
    footprint::Footprint,
    holes::holes,
    outline::{Loop, Place, outline},
    ring::{Core, Ring},
};
use super::triangle_mesh::TriangleMesh;

pub use self::{
    grid::{Column, ColumnGrid, ColumnMesh, Meshing, Plan, TooManyNodes},
    holes::Hole,
};

/// Pieces of the insert seen from above that are smaller than this many hexahedra are chips, and left out.
const MIN_PIECE: f64 = 4.0;
/// Where a node on the outline is off the shell by what a chord of the outline is, it is moved by one of
/// these shares of the way to the next node inside.
const HAIRS: [f64; 9] = [0.0, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.25, 0.5];

/// Why a shell makes no insert.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ColumnError {
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
    /// More nodes than can be numbered.
    #[error(transparent)]
    TooManyNodes(#[from] TooManyNodes),
}

/// Hexahedra between the top and the bottom of a closed surface, or below an open one, and the holes inside the outline.
///
/// Seen from above, the cells of a grid fill what lies well inside the outline, and a ring of quads
/// with their outer nodes on the outline fills the rest. The outline is that of the part in which the
/// shell is no wall (steeper than 56 degrees) and thicker than 0.15 of the median. The vertical line
/// through each place meets the shell; its highest and its lowest point bound the column. Facets
/// are lifted to the curved surface that the vertex normals imply. Below an open surface the
/// backside is flat, `thickness_mm` below the lowest point.
///
/// Hexahedra stand over holes and posts too, as if the surface around them went on smoothly. Contact at or next to one
/// of the holes that are returned touches what the mesh does not have.
///
/// # Errors
/// An open surface without a thickness, one in which no column fits, an outline with details finer than the edge, or
/// more nodes than can be numbered.
pub fn column_mesh(
    shell: &TriangleMesh,
    is_closed: bool,
    thickness_mm: Option<f64>,
    meshing: Meshing,
) -> Result<(ColumnMesh, Vec<Hole>), ColumnError> {
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
        Err(_) if !holes.is_empty() => return Err(ColumnError::Holes { holes }),
        fitted => fitted?,
    };
    if is_closed {
        ease_steps(&plan, &mut columns);
    } else {
        let thickness_mm = thickness_mm.ok_or(ColumnError::OpenWithoutThickness)?;
        put_on_flat_backside(&mut columns, thickness_mm);
    }
    Ok((plan.hexahedra(&columns, meshing.layers), holes))
}

/// The plan of the hexahedra with its rim on the outline, and the columns on its places.
fn fitted_plan(
    grid: &ColumnGrid,
    footprint: &Footprint<'_>,
    edge_mm: f64,
) -> Result<(Plan, Vec<Column>), ColumnError> {
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
) -> Result<Vec<(Core, &'a Loop)>, ColumnError> {
    if outlines.is_empty() {
        return Err(ColumnError::NoColumns { edge_mm });
    }
    pieces.sort_by_key(|piece| std::cmp::Reverse(piece.cells.len()));
    let of_outline = |outline: &&'a Loop| {
        let is_inside = |piece: &&Core| {
            let (x, z) = grid.place_of_mm(piece.cells[0][0]);
            outline.goes_round(&Place::new(x, z))
        };
        match pieces.iter().find(is_inside) {
            Some(piece) if piece.loops.len() == 1 => Ok((piece.clone(), *outline)),
            _ => Err(ColumnError::TooCoarse {
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
) -> Result<(Plan, Vec<Column>), ColumnError> {
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
    let columns = columns.map_err(|(x_mm, z_mm)| ColumnError::NoColumn { x_mm, z_mm })?;
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

/// A corner of the backside is too steep if the scaled Jacobian of a hexahedron there is less: the sine of the
/// corner seen from above, over how many times longer its sides are than seen from above.
const MIN_JACOBIAN: f64 = 0.31;
/// What is no longer than this, as an area over that seen from above, squared, is flat: a corner that is sharp seen
/// from above is not eased further.
const FLAT: f64 = 1.01;
/// Share of a step that is moved from its upper to its lower end in a round.
const MOVED: f64 = 0.1;
/// Rounds at most: a step of six edges is eased in a hundred.
const ROUNDS: usize = 400;

/// Lets material flow from the upper to the lower end of what is too steep in the backside, such as
/// the wall of a recess for a clip, until it is not; as much as flows in one place is missing in another.
pub fn ease_steps(plan: &Plan, columns: &mut [Column]) {
    for _ in 0..ROUNDS {
        let mut was_steep = false;
        for quad in &plan.quads {
            for corner in 0..4 {
                let ends = [quad[(corner + 1) % 4], quad[(corner + 3) % 4]];
                was_steep |= ease(plan, columns, quad[corner], ends);
            }
        }
        if !was_steep {
            return;
        }
    }
}

/// Eases the two sides of a corner if they are too steep, and says whether they are.
fn ease(plan: &Plan, columns: &mut [Column], corner: u32, ends: [u32; 2]) -> bool {
    let corner = corner as usize;
    let ends = ends.map(|end| end as usize);
    let rises = ends.map(|end| columns[end].0 - columns[corner].0);
    let longer = |end: usize, rise: f64| 1.0 + rise * rise / length2(plan, corner, end);
    let area2 = longer(ends[0], rises[0]) * longer(ends[1], rises[1]);
    let is_steep = area2 > FLAT && sine2(plan, corner, ends) < MIN_JACOBIAN * MIN_JACOBIAN * area2;
    if is_steep {
        for (end, rise) in ends.into_iter().zip(rises) {
            columns[corner].0 += MOVED * rise;
            columns[end].0 -= MOVED * rise;
        }
    }
    is_steep
}

/// Squared sine of a corner seen from above.
fn sine2(plan: &Plan, corner: usize, [a, b]: [usize; 2]) -> f64 {
    let along = |end: usize| {
        let ((x, z), (from_x, from_z)) = (plan.places_mm[end], plan.places_mm[corner]);
        (x - from_x, z - from_z)
    };
    let ((ax, az), (bx, bz)) = (along(a), along(b));
    let twice_area = az * bx - ax * bz;
    twice_area * twice_area / (length2(plan, corner, a) * length2(plan, corner, b))
}

fn length2(plan: &Plan, a: usize, b: usize) -> f64 {
    let ((ax, az), (bx, bz)) = (plan.places_mm[a], plan.places_mm[b]);
    (bx - ax).powi(2) + (bz - az).powi(2)
}
