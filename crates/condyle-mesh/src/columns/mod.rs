//! Hexahedra in columns along y below the surface of a triangle mesh.
//!
//! ```
//! use condyle_mesh::{TriangleMesh, Vec3, columns::{Meshing, column_mesh}};
//!
//! let block = TriangleMesh::block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0));
//! let (columns, holes) = column_mesh(&block, true, None, Meshing { edge_mm: 2.0, layers: 3 })?;
//! assert!((columns.mesh.volume() - 4800.0).abs() < 1.0);
//! // The elements at the corners of the outline are mitred, which costs them about sin 45 degrees.
//! assert!(columns.mesh.worst_quality() > 0.6 && holes.is_empty());
//! # Ok::<(), condyle_mesh::columns::ColumnError>(())
//! ```

mod disc;
mod footprint;
mod grid;
mod holes;
mod outline;
mod post;
mod ring;
mod vertical_lines;

use thiserror::Error;

use self::{
    footprint::Footprint,
    holes::holes,
    outline::{Loop, outline, turn},
    post::Post,
    ring::{Core, Ring},
    vertical_lines::{Through, VerticalLines},
};
use super::{divided_mesh::Facets, triangle_mesh::TriangleMesh};

pub use self::{
    disc::disc_plan,
    grid::{Column, ColumnGrid, ColumnMesh, Meshing, Place, Plan, TooManyNodes},
    holes::Hole,
};

/// Area in hexahedra below which a piece of the insert seen from above is a chip, and left out.
const MIN_PIECE: f64 = 4.0;
/// Shares of the way to the next node inside by which a node on the outline is moved until it is on the shell: a
/// chord of the outline may lie outside.
const HAIRS: [f64; 9] = [0.0, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.25, 0.5];

/// Factors on the edge length that are tried where hexahedra are inverted: next to the outline, inversion depends on the
/// place of the grid, and a slightly finer grid lies elsewhere.
const FINER: [f64; 4] = [0.97, 0.94, 0.91, 0.88];

/// Reason why a surface cannot be meshed as an insert.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Clone, Debug, PartialEq, Error)]
pub enum ColumnError {
    /// An open surface without a thickness below it.
    #[error(
        "the insert's surface is open, so its thickness is unknown; give thickness_mm, below the lowest point"
    )]
    OpenWithoutThickness,
    /// No column stands on the grid.
    #[error(
        "no column of hexahedra fits into the insert at an edge of {edge_mm} mm; use a smaller edge_mm, and check length_unit and axes"
    )]
    NoColumns { edge_mm: f64 },
    /// Places inside the outline where no column may stand.
    #[error(
        "no column of hexahedra fits at {}; fill it in the mesh",
        listed_holes(holes)
    )]
    Holes { holes: Vec<Hole> },
    /// A place inside the outline whose vertical line does not meet the surface.
    #[error(
        "the insert has a hole at x {x_mm:.2}, z {z_mm:.2} mm, where no column of hexahedra fits; repair the mesh"
    )]
    NoColumn { x_mm: f64, z_mm: f64 },
    /// A part of the insert in which no cell of the grid fits.
    #[error(
        "the insert is too narrow for an edge of {edge_mm} mm around x {x_mm:.1}, z {z_mm:.1} mm; use a smaller edge_mm, or delete \
         the geometry there if it is not part of the insert"
    )]
    TooCoarse { edge_mm: f64, x_mm: f64, z_mm: f64 },
    /// More nodes than can be numbered.
    #[error(transparent)]
    TooManyNodes(#[from] TooManyNodes),
}

/// Returns hexahedra between the top and the bottom of a closed surface, or below an open one, and the holes inside the
/// outline.
///
/// Seen from above, the cells of a grid fill the part well inside the outline, and a ring of quads
/// with their outer nodes on the outline fills the rest. The outline is that of the part in which the
/// surface is no wall (steeper than 56 degrees) and thicker than 0.15 of the median. The vertical line
/// through each place meets the surface; its highest and its lowest point bound the column. Facets
/// are lifted to the curved surface that the vertex normals imply. Below an open surface the
/// backside is flat, `thickness_mm` below the lowest point. Where hexahedra are inverted, edges shorter by up to 12 % are
/// tried.
///
/// The walls of a post belong to the surface: the columns below them lean. Hexahedra stand over holes, and over a post that
/// overhangs, as if the surface around them continued smoothly. Contact at or next to one of the holes that are returned touches a
/// part that the body does not have.
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
    let found = columns_of(shell, is_closed, thickness_mm, meshing)?;
    if found.0.mesh.worst_quality() > 0.0 {
        return Ok(found);
    }
    let mut finer = FINER.iter().filter_map(|part| {
        let edge_mm = part * meshing.edge_mm;
        columns_of(
            shell,
            is_closed,
            thickness_mm,
            Meshing { edge_mm, ..meshing },
        )
        .ok()
    });
    let sound = |(columns, _): &(ColumnMesh, Vec<Hole>)| columns.mesh.worst_quality() > 0.0;
    Ok(finer.find(sound).unwrap_or(found))
}

/// Returns the hexahedra of one grid, of which some may be inverted next to the outline.
fn columns_of(
    shell: &TriangleMesh,
    is_closed: bool,
    thickness_mm: Option<f64>,
    meshing: Meshing,
) -> Result<(ColumnMesh, Vec<Hole>), ColumnError> {
    let lines = VerticalLines::new(shell, is_closed);
    let post = is_closed.then(|| Post::find(shell, &lines)).flatten();
    let with_post = post.and_then(|post| {
        let spread = post.spread(shell, meshing.edge_mm);
        let over_spread = VerticalLines::new(&spread, true);
        let mut found = vertical_columns(&spread, &over_spread, None, meshing).ok()?;
        post.gather(&mut found, shell, &lines);
        compare(&mut found.0, shell, &lines, |place| lines.at(place));
        // A post that cannot be spread, such as one that overhangs, is bridged as a hole is.
        (found.0.mesh.worst_quality() > 0.0).then_some(found)
    });
    match with_post {
        Some(found) => Ok(found),
        None => vertical_columns(shell, &lines, thickness_mm, meshing),
    }
}

/// Returns the hexahedra of one grid in vertical columns.
fn vertical_columns(
    shell: &TriangleMesh,
    lines: &VerticalLines<'_>,
    thickness_mm: Option<f64>,
    meshing: Meshing,
) -> Result<(ColumnMesh, Vec<Hole>), ColumnError> {
    let edge_mm = meshing.edge_mm;
    let (low, high) = shell.bounds();
    let (low, high) = ([low.x, low.z], [high.x, high.z]);
    let grid = ColumnGrid::filling(low, high, edge_mm, meshing.layers)?;
    let mut footprint = Footprint::new(shell, lines, edge_mm);
    let outlines = outline(&footprint, edge_mm);
    let holes = holes(&mut footprint, &outlines, edge_mm);
    let fitted = fitted_plan(&grid, &footprint, edge_mm);
    let (plan, mut columns) = match fitted {
        // Of two reasons, the holes come first: the bridges over them may be the cause of the other.
        Err(_) if !holes.is_empty() => return Err(ColumnError::Holes { holes }),
        fitted => fitted?,
    };
    if lines.is_closed {
        ease_steps(&plan, &mut columns);
    } else {
        let thickness_mm = thickness_mm.ok_or(ColumnError::OpenWithoutThickness)?;
        let tops = columns.iter().map(|column| column.1);
        let lowest = tops.fold(f64::INFINITY, f64::min);
        for (bottom, _) in &mut columns {
            *bottom = lowest - thickness_mm;
        }
    }
    let mut columns = plan.hexahedra(&columns, meshing);
    let through = |place| footprint.through(place);
    compare(&mut columns, shell, lines, through);
    Ok((columns, holes))
}

/// Ratio of the area of a facet to that of a triangle in it from which the triangle is only a part of the facet: less than 2, for
/// a half.
const DIVIDED: f64 = 1.5;
/// Part of the distance between the smooth surface and its triangles that may be wrong, our choice: for an insert decimated within
/// 0.03 mm, the smooth surface changes the mass by less than 0.1 %, and the triangles by 3 %.
const ERROR_OF_LIFT: f64 = 0.25;

/// Compares columns with the surface that they mesh: the errors and the voids at each node of the articulating surface.
///
/// Triangles that divide a flat facet are lifted at its edges only, and all of the distance that they lack is an error.
fn compare(
    columns: &mut ColumnMesh,
    shell: &TriangleMesh,
    lines: &VerticalLines<'_>,
    through: impl Fn(Place) -> Option<Through>,
) {
    let is_upward = |corners: &[u32; 3]| {
        let [a, b, c] = corners.map(|vertex| shell.vertices[vertex as usize]);
        (b - a).cross(&(c - a)).y > 0.0
    };
    let upward = shell.triangles.iter().copied().filter(is_upward);
    let top = TriangleMesh {
        vertices: shell.vertices.clone(),
        triangles: upward.collect(),
    };
    let facets = Facets::new(&top);
    let is_divided = facets.mesh.triangles.len() < top.triangles.len();
    let over_facets = is_divided.then(|| VerticalLines::new(&facets.mesh, false));
    let mut nodes: Vec<u32> = columns.articulating.iter().flatten().copied().collect();
    nodes.sort_unstable();
    nodes.dedup();
    let places = nodes.into_iter().map(|node| {
        let node = columns.mesh.nodes[node as usize];
        Place::new(node.x, node.z)
    });
    let error_mm = |place: Place| {
        let of_lift_mm = through(place).map(|through| ERROR_OF_LIFT * through.lift_mm.abs());
        let over_facet = over_facets.as_ref().and_then(|lines| lines.highest(place));
        let both = over_facet.zip(lines.highest(place));
        let divided = both.filter(|((_, whole_mm2, _), (_, mm2, _))| DIVIDED * mm2 < *whole_mm2);
        let chord_mm = divided.map(|((facet, _, over), _)| facets.chord_mm(facet, over.weights));
        of_lift_mm.unwrap_or(0.0).max(chord_mm.unwrap_or(0.0))
    };
    columns.mesh_error_mm = places.clone().map(error_mm).collect();
    columns.void_mm = places.map(|place| lines.void_mm(place)).collect();
}

/// Returns the plan of the hexahedra with its rim on the outline, and the columns on its places.
fn fitted_plan(
    grid: &ColumnGrid,
    footprint: &Footprint<'_>,
    edge_mm: f64,
) -> Result<(Plan, Vec<Column>), ColumnError> {
    let outlines = outline(footprint, edge_mm);
    let is_large = |outline: &&Loop| outline.area_mm2() > MIN_PIECE * edge_mm * edge_mm;
    let outer: Vec<&Loop> = outlines.iter().filter(is_large).collect();
    if outer.is_empty() {
        return Err(ColumnError::NoColumns { edge_mm });
    }
    let mut cores = Core::pieces(grid, footprint);
    cores.sort_by_key(|core| std::cmp::Reverse(core.cells.len()));
    // Every outline is matched with the largest core inside.
    let matched = outer.into_iter().map(|outline| {
        let is_inside = |core: &&Core| outline.goes_round(&grid.place_of_mm(core.cells[0][0]));
        let core = cores.iter().find(is_inside);
        match core.filter(|core| core.loops.len() == 1) {
            Some(core) => Ok((core.clone(), outline)),
            None => Err(ColumnError::TooCoarse {
                edge_mm,
                x_mm: outline.middle()[0],
                z_mm: outline.middle()[1],
            }),
        }
    });
    let mut ring = Ring::new(grid, &matched.collect::<Result<Vec<_>, _>>()?);
    ring.smooth(edge_mm);
    standing(&ring, footprint)
}

/// Returns the columns on every place of a plan; those on the outline are slightly inside where necessary.
fn standing(
    ring: &Ring<'_>,
    footprint: &Footprint<'_>,
) -> Result<(Plan, Vec<Column>), ColumnError> {
    let mut plan = ring.plan();
    for (outer, inner) in ring.spokes() {
        let [from, to] = [outer, inner].map(|n| plan.places_mm[n as usize]);
        let mut inward = HAIRS.map(|share| from + (to - from) * share).into_iter();
        // Where the shell is thick enough if possible, else wherever it is met.
        let holds = inward.clone().find(|place| footprint.holds(*place));
        let meets = || inward.find(|place| footprint.through(*place).is_some());
        plan.places_mm[outer as usize] = holds.or_else(meets).unwrap_or(from);
    }
    let column = |place: &Place| match footprint.through(*place) {
        Some(through) => Ok((through.bottom, through.top)),
        None => Err(ColumnError::NoColumn {
            x_mm: place[0],
            z_mm: place[1],
        }),
    };
    let columns = plan
        .places_mm
        .iter()
        .map(column)
        .collect::<Result<_, _>>()?;
    Ok((plan, columns))
}

/// Lists holes in words.
pub fn listed_holes(holes: &[Hole]) -> String {
    let each: Vec<String> = holes.iter().map(Hole::to_string).collect();
    each.join(", on ")
}

/// Scaled Jacobian of a hexahedron below which a corner of the backside is too steep: the sine of the
/// corner seen from above, over the length of its sides relative to that seen from above.
const MIN_JACOBIAN: f64 = 0.31;
/// Squared ratio of the area of a corner to that seen from above up to which it is flat: a corner that is sharp seen
/// from above is not eased further.
const FLAT: f64 = 1.01;
/// Share of a step that is moved from its upper to its lower end in a round.
const MOVED: f64 = 0.1;
/// Maximum number of rounds: a step of six edges is eased in a hundred.
const MAX_ROUNDS: usize = 400;

/// Moves material from the upper to the lower end of steep parts of the backside, such as
/// the wall of a recess for a clip, until none is too steep. The volume stays.
fn ease_steps(plan: &Plan, columns: &mut [Column]) {
    let corners = plan.quads.iter().flat_map(|quad| {
        let at = move |corner: usize| quad[corner % 4] as usize;
        (0..4).map(move |corner| (at(corner), [at(corner + 1), at(corner + 3)]))
    });
    for _ in 0..MAX_ROUNDS {
        let mut was_steep = false;
        for (corner, ends) in corners.clone() {
            let rises = ends.map(|end| columns[end].0 - columns[corner].0);
            let [a, b] = ends.map(|end| plan.places_mm[end] - plan.places_mm[corner]);
            let [a2, b2] = [a, b].map(|along| along[0].powi(2) + along[1].powi(2));
            // Squares of the area over that seen from above, and of the sine of the corner seen from above.
            let area2 = (1.0 + rises[0] * rises[0] / a2) * (1.0 + rises[1] * rises[1] / b2);
            let twice_area = turn(&a, &b);
            let sine2 = twice_area * twice_area / (a2 * b2);
            if area2 > FLAT && sine2 < MIN_JACOBIAN * MIN_JACOBIAN * area2 {
                was_steep = true;
                for (end, rise) in ends.into_iter().zip(rises) {
                    columns[corner].0 += MOVED * rise;
                    columns[end].0 -= MOVED * rise;
                }
            }
        }
        if !was_steep {
            return;
        }
    }
}
