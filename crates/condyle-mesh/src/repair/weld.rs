//! Cleans a mesh: welds open edges, and removes doubled faces, triangles without area and slivers.

use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

use super::edges::{EdgeUse, by_edge};
use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Merges vertices of open edges that are no farther apart than `within`; returns their places.
///
/// Only open edges: a connected surface needs no welding.
pub(super) fn weld(mesh: &mut TriangleMesh, uses: &[EdgeUse], within: f64) -> Vec<Vec3> {
    let mut is_open = vec![false; mesh.vertices.len()];
    for edge in by_edge(uses).filter(|edge| edge.len() == 1) {
        for end in edge[0].ends {
            is_open[end as usize] = true;
        }
    }
    // Vertices by cubic cells of that size: those within reach are in the 27 cells around.
    let mut kept: HashMap<[i64; 3], Vec<u32>> = HashMap::new();
    let mut replacement: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut places = Vec::new();
    for vertex in (0..mesh.vertices.len()).filter(|&vertex| is_open[vertex]) {
        let at = mesh.vertices[vertex];
        let cell = [at.x, at.y, at.z].map(|coordinate| (coordinate / within).floor() as i64);
        let steps = (0..27).map(|n: i64| [n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1]);
        let around = steps.map(|step| [0, 1, 2].map(|i| cell[i].saturating_add(step[i])));
        let mut near = around.filter_map(|cell| kept.get(&cell)).flatten().copied();
        let is_near = |other: &u32| (mesh.vertices[*other as usize] - at).norm() <= within;
        if let Some(other) = near.find(is_near) {
            replacement[vertex] = other;
            places.push(at);
        } else {
            kept.entry(cell).or_default().push(vertex as u32);
        }
    }
    rename(mesh, &replacement);
    places
}

fn rename(mesh: &mut TriangleMesh, replacement: &[u32]) {
    for triangle in &mut mesh.triangles {
        *triangle = triangle.map(|vertex| replacement[vertex as usize]);
    }
}

/// Removes the vertices of no triangle; the others keep their order.
pub(crate) fn drop_unused(mesh: &mut TriangleMesh) {
    let mut new_number = vec![u32::MAX; mesh.vertices.len()];
    for &vertex in mesh.triangles.iter().flatten() {
        new_number[vertex as usize] = 0;
    }
    let mut vertices = Vec::new();
    for (old, number) in new_number.iter_mut().enumerate().filter(|(_, n)| **n == 0) {
        *number = vertices.len() as u32;
        vertices.push(mesh.vertices[old]);
    }
    mesh.vertices = vertices;
    rename(mesh, &new_number);
}

/// Keeps one triangle of each three corners, and none of a flap; returns the places of the others.
pub(super) fn make_single(mesh: &mut TriangleMesh) -> Vec<Vec3> {
    let flaps = flaps(mesh);
    let mut seen = HashSet::with_capacity(mesh.triangles.len());
    let mut places = Vec::new();
    let vertices = &mesh.vertices;
    mesh.triangles.retain(|triangle| {
        let corners = sorted(triangle);
        let is_kept = seen.insert(corners) && !flaps.contains(&corners);
        if !is_kept {
            places.push(triangle.iter().map(|&v| vertices[v as usize]).sum::<Vec3>() / 3.0);
        }
        is_kept
    });
    places
}

fn sorted(triangle: &[u32; 3]) -> [u32; 3] {
    let mut corners = *triangle;
    corners.sort_unstable();
    corners
}

/// Returns the corners, ascending, of triangles that lie back to back and stand on a surface.
///
/// A fan of slivers that folds back on itself becomes such a flap when the rounding of a file merges its two tips. The surface is
/// whole without it, whereas that of a sheet with two sides is not: each edge of a flap has an even number of other triangles.
fn flaps(mesh: &TriangleMesh) -> BTreeSet<[u32; 3]> {
    let mut turns: HashMap<[u32; 3], [u8; 2]> = HashMap::with_capacity(mesh.triangles.len());
    for triangle in &mesh.triangles {
        let corners @ [low, middle, _] = sorted(triangle);
        let ascends = [[0, 1], [1, 2], [2, 0]].map(|side| side.map(|i| triangle[i]));
        let turn = usize::from(ascends.contains(&[low, middle]));
        turns.entry(corners).or_default()[turn] += 1;
    }
    turns.retain(|_, count| *count == [1, 1]);
    let mut flaps = BTreeSet::from_iter(turns.into_keys());
    let mut on_edge: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    on_edge.extend(flaps.iter().flat_map(sides).map(|ends| (ends, 0)));
    if !flaps.is_empty() {
        let others = mesh
            .triangles
            .iter()
            .filter(|t| !flaps.contains(&sorted(t)));
        for ends in others.flat_map(sides) {
            on_edge.entry(ends).and_modify(|count| *count += 1);
        }
    }
    // A pair next to an edge with one other triangle is part of a sheet, and so are the pairs connected with it.
    loop {
        let is_of_sheet = |of: &&[u32; 3]| sides(of).iter().any(|side| on_edge[side] % 2 == 1);
        let of_sheets: Vec<[u32; 3]> = flaps.iter().filter(is_of_sheet).copied().collect();
        if of_sheets.is_empty() {
            break;
        }
        for of in of_sheets {
            flaps.remove(&of);
            on_edge.extend(sides(&of).map(|side| (side, 1)));
        }
    }
    // A body of which every triangle is doubled stands on nothing.
    let stands = on_edge.values().any(|count| *count == 2);
    if stands { flaps } else { BTreeSet::new() }
}

/// Height over longest edge below which a triangle has no area: rounding of double precision.
const FLAT: f64 = 1e-12;
/// Splitting a neighbour that is flat leaves it flat; more rounds of that than this do not help.
const MAX_ROUNDS: usize = 8;

/// Removes triangles of two equal corners and those of three corners in a line; returns their number.
///
/// The neighbour along the longest edge of the latter is split at the middle corner, so that the
/// surface stays as closed as it was.
pub(super) fn remove_degenerate(mesh: &mut TriangleMesh) -> usize {
    let before = mesh.triangles.len();
    mesh.triangles.retain(has_three_corners);
    let mut merged = 0;
    let mut flat = all_flat(mesh);
    let mut on_edge = TrianglesOnEdges::new();
    if !flat.is_empty() {
        (0..mesh.triangles.len()).for_each(|index| add_edges(&mut on_edge, mesh, index));
    }
    for _ in 0..MAX_ROUNDS {
        let mut merge = |mesh: &mut TriangleMesh, flat: &[usize], into_flat| {
            let merges = |&&t: &&usize| merge_into_neighbour(mesh, t, into_flat, &mut on_edge);
            flat.iter().filter(merges).count()
        };
        // Those of a fan vanish one after the other, from the neighbour with an area on.
        let mut merged_now = merge(mesh, &flat, false);
        while merged_now > 0 {
            merged += merged_now;
            flat.retain(|&t| is_flat(&mesh.corners(t)));
            flat.reverse();
            merged_now = merge(mesh, &flat, false);
        }
        let merged_flat = merge(mesh, &flat, true);
        merged += merged_flat;
        flat = all_flat(mesh);
        if merged_flat == 0 || flat.is_empty() {
            break;
        }
    }
    let vertices = &mesh.vertices;
    mesh.triangles
        .retain(|triangle| !is_flat(&triangle.map(|vertex| vertices[vertex as usize])));
    // A merged triangle takes half of its neighbour, so that the number of triangles stays.
    before - mesh.triangles.len() + merged
}

fn all_flat(mesh: &TriangleMesh) -> Vec<usize> {
    let all = 0..mesh.triangles.len();
    all.filter(|&t| is_flat(&mesh.corners(t))).collect()
}

fn has_three_corners([a, b, c]: &[u32; 3]) -> bool {
    a != b && b != c && c != a
}

/// Returns whether the height of a triangle is negligible relative to its longest edge: twice the area over the
/// square of the longest edge is that ratio.
fn is_flat([a, b, c]: &[Vec3; 3]) -> bool {
    let [ab, bc, ca] = [b - a, c - b, a - c].map(|edge| edge.norm_squared());
    (b - a).cross(&(c - a)).norm() <= FLAT * ab.max(bc).max(ca)
}

/// Gives a flat triangle the half of its neighbour beyond its middle corner; returns false if that is not possible, or the
/// neighbour is flat and must not be.
fn merge_into_neighbour(
    mesh: &mut TriangleMesh,
    index: usize,
    into_flat: bool,
    on_edge: &mut TrianglesOnEdges,
) -> bool {
    // An earlier merge of the round may have changed it.
    if !is_flat(&mesh.corners(index)) {
        return false;
    }
    let [a, b, c] = mesh.triangles[index];
    let length = |[from, _, to]: &[u32; 3]| {
        (mesh.vertices[*from as usize] - mesh.vertices[*to as usize]).norm_squared()
    };
    let turned = [[a, b, c], [b, c, a], [c, a, b]].into_iter();
    let longest_edge_last = turned.max_by(|one, other| length(one).total_cmp(&length(other)));
    let [end, middle, other_end] = longest_edge_last.unwrap_or([a, b, c]);
    // An edge of more triangles does not belong to a surface; it is not searched repeatedly.
    const MAX_ROUND: usize = 16;
    let round = on_edge.get(&[end.min(other_end), end.max(other_end)]);
    let round = round.filter(|round| round.len() <= MAX_ROUND).into_iter();
    let others = round.flatten().copied().filter(|&other| other != index);
    let has_both = |t: &[u32; 3]| t.contains(&end) && t.contains(&other_end);
    let neighbour = others
        .filter(|&other| has_both(&mesh.triangles[other]))
        .filter(|&other| into_flat || !is_flat(&mesh.corners(other)))
        .min();
    let Some(neighbour) = neighbour else {
        return false;
    };
    let whole = mesh.triangles[neighbour];
    if whole.contains(&middle) {
        return false;
    }
    let with_middle_for = |old: u32| whole.map(|v| if v == old { middle } else { v });
    mesh.triangles[neighbour] = with_middle_for(end);
    mesh.triangles[index] = with_middle_for(other_end);
    add_edges(on_edge, mesh, neighbour);
    add_edges(on_edge, mesh, index);
    true
}

/// The triangles that have, or had before they were split, an edge.
type TrianglesOnEdges = HashMap<[u32; 2], Vec<usize>>;

fn add_edges(on_edge: &mut TrianglesOnEdges, mesh: &TriangleMesh, index: usize) {
    for ends in sides(&mesh.triangles[index]) {
        on_edge.entry(ends).or_default().push(index);
    }
}

/// Returns the sides of a triangle, the lower number first.
fn sides(&[a, b, c]: &[u32; 3]) -> [[u32; 2]; 3] {
    [[a, b], [b, c], [c, a]].map(|[a, b]| [a.min(b), a.max(b)])
}

/// Largest number of triangles around a vertex that is processed; the tip of a fan has more.
const MAX_AROUND: usize = 64;
/// A collapsed edge keeps its neighbours from collapsing in the same round; more rounds do not help.
const MAX_COLLAPSE_ROUNDS: usize = 8;

/// Collapses edges shorter than `thinnest` where the surface keeps its shape; returns the places of the
/// triangles that vanish.
pub(super) fn collapse_slivers(mesh: &mut TriangleMesh, thinnest: f64) -> Vec<Vec3> {
    let mut places = Vec::new();
    for _ in 0..MAX_COLLAPSE_ROUNDS {
        let is_short = |[a, b]: &[u32; 2]| {
            let way = mesh.vertices[*b as usize] - mesh.vertices[*a as usize];
            way.norm_squared() < thinnest * thinnest
        };
        let all = mesh.triangles.iter().flat_map(sides);
        let short: BTreeSet<[u32; 2]> = all.filter(is_short).collect();
        let collapsed = collapse_some(mesh, short);
        if collapsed.is_empty() {
            break;
        }
        places.extend(collapsed);
    }
    places
}

/// Collapses those of some short edges that are not next to one another.
fn collapse_some(mesh: &mut TriangleMesh, short: BTreeSet<[u32; 2]>) -> Vec<Vec3> {
    let mut places = Vec::new();
    if short.is_empty() {
        return places;
    }
    let around = mesh.triangles_around();
    let mut replacement: Vec<u32> = (0..mesh.vertices.len() as u32).collect();
    let mut is_settled = vec![false; mesh.vertices.len()];
    for ends in short {
        let stars = ends.map(|end| &around[end as usize]);
        if stars.iter().any(|star| star.len() > MAX_AROUND) {
            continue;
        }
        let [one, other] = stars.map(|star| -> BTreeSet<u32> {
            let corners = star.iter().map(|&t| mesh.triangles[t as usize]);
            corners.flatten().collect()
        });
        let is_free = !one.union(&other).any(|&vertex| is_settled[vertex as usize]);
        let star = stars[0].iter().map(|&t| mesh.triangles[t as usize]);
        let on_edge = star.filter(|corners| ends.iter().all(|end| corners.contains(end)));
        let on_edge: Vec<[u32; 3]> = on_edge.collect();
        // The common neighbours of both ends must be the tips of the triangles on the edge, and no others: then
        // the surface is connected after the collapse as before.
        let is_tip = |vertex: &u32| !ends.contains(vertex);
        let tips: BTreeSet<u32> = on_edge.iter().flatten().copied().filter(is_tip).collect();
        let common = one.intersection(&other).copied().filter(is_tip);
        if is_free && common.eq(tips) {
            for &vertex in one.union(&other) {
                is_settled[vertex as usize] = true;
            }
            replacement[ends[1] as usize] = ends[0];
            places.extend(on_edge.iter().map(|_| mesh.vertices[ends[0] as usize]));
        }
    }
    rename(mesh, &replacement);
    mesh.triangles.retain(has_three_corners);
    places
}

#[cfg(test)]
mod tests {
    use crate::{
        Vec3,
        repair::{checked_mesh, tests::unit_block},
    };

    #[test]
    fn a_triangle_of_two_equal_corners_goes_without_a_gap() {
        let mut mesh = unit_block();
        mesh.triangles.insert(5, [0, 1, 1]);
        let shell = checked_mesh(mesh).unwrap();
        assert_eq!(shell.removed_degenerate, 1);
        assert!(shell.closed);
        assert_eq!(shell.mesh, unit_block());
    }

    #[test]
    fn a_flap_of_triangles_back_to_back_goes_and_a_sheet_stays() {
        let mut mesh = unit_block();
        mesh.vertices.push(Vec3::new(-0.3, -0.3, 0.4));
        mesh.vertices.push(Vec3::new(-0.3, -0.3, 0.6));
        for fold in [[0, 4, 8], [4, 9, 8]] {
            let [a, b, c] = fold;
            mesh.triangles.extend([fold, [a, c, b]]);
        }
        let shell = checked_mesh(mesh).unwrap();
        assert!(shell.closed);
        assert_eq!(shell.mesh, unit_block());
        assert_eq!(shell.defects[0].count, 4);
        let mut sheet = unit_block();
        sheet.triangles.truncate(4);
        let back = sheet.triangles.clone().into_iter();
        sheet.triangles.extend(back.map(|[a, b, c]| [a, c, b]));
        assert_eq!(checked_mesh(sheet).unwrap().mesh.triangles.len(), 4);
        let mut doubled = unit_block();
        for face in 0..2 {
            let [a, b, c] = doubled.triangles[face];
            doubled.triangles.push([a, c, b]);
        }
        assert_eq!(checked_mesh(doubled).unwrap().mesh, unit_block());
    }

    /// The first edge of the block gets a middle vertex that only one of its two triangles knows.
    #[test]
    fn three_corners_in_a_line_go_without_a_gap() {
        let mut mesh = unit_block();
        mesh.vertices.push(Vec3::new(0.5, 0.0, 0.0));
        // Triangle 4 is [0, 1, 5], on the other side of edge 0-1 is triangle 1, [0, 3, 1].
        mesh.triangles[4] = [0, 8, 5];
        mesh.triangles.push([8, 1, 5]);
        mesh.triangles.push([0, 1, 8]);
        let shell = checked_mesh(mesh).unwrap();
        assert_eq!(shell.removed_degenerate, 1);
        assert!(
            shell.closed,
            "the triangle across is split at the middle vertex"
        );
        assert_eq!(shell.mesh.triangles.len(), 14);
        assert!((shell.mesh.signed_volume() - 1.0).abs() < 1e-14);
    }

    /// A fan along the edges of a face starts with flat triangles, each the neighbour of the next.
    #[test]
    fn a_fan_over_many_vertices_in_a_line_stays_closed() {
        for count in [1, 8, 40] {
            let mut mesh = unit_block();
            // Triangle 1 is [0, 3, 1], and triangle 4, [0, 1, 5], is on the other side of edge 0-1.
            let line = (1..=count).map(|n| f64::from(n) / f64::from(count + 1));
            mesh.vertices.extend(line.map(|x| Vec3::new(x, 0.0, 0.0)));
            let along: Vec<u32> = std::iter::once(0).chain(8..8 + count).chain([1]).collect();
            let pairs = || along.windows(2).map(|pair| [pair[0], pair[1]]);
            mesh.triangles[4] = [0, 8, 5];
            mesh.triangles
                .extend(pairs().skip(1).map(|[a, b]| [a, b, 5]));
            mesh.triangles
                .extend(pairs().skip(1).map(|[a, b]| [0, b, a]));
            let shell = checked_mesh(mesh).unwrap();
            assert!(shell.closed && shell.defects.is_empty());
            assert_eq!(shell.removed_degenerate, count as usize);
            assert_eq!(shell.mesh.triangles.len(), 12 + 2 * count as usize);
            assert!((shell.mesh.signed_volume() - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn a_flat_triangle_on_the_rim_is_dropped() {
        let mut mesh = unit_block();
        mesh.triangles.truncate(2);
        mesh.vertices.push(Vec3::new(0.5, 0.0, 0.0));
        mesh.vertices.push(Vec3::new(-1.0, 0.0, 0.0));
        mesh.triangles.push([1, 8, 9]);
        let shell = checked_mesh(mesh).unwrap();
        assert_eq!(
            (shell.removed_degenerate, shell.mesh.triangles.len()),
            (1, 2)
        );
    }
}
