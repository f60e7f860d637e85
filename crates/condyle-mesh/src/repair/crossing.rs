//! Pairs of triangles that pass through one another, and how deep.

use std::ops::ControlFlow;

use super::{box_tree::BoxTree, edges::edge_uses};
use crate::{Vec3, triangle_mesh::TriangleMesh};

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Crossings {
    /// Pairs of triangles whose cut is not a wrinkle, ascending, each with a point of the cut, mm.
    pub(super) found: Vec<([usize; 2], Vec3)>,
    /// The place where the search ended because too many triangles lie on one another.
    pub(super) gave_up_at_mm: Option<Vec3>,
    pub(super) wrinkles: usize,
}

/// Shift that separates two triangles, over the shorter of their longest edges, below which they only touch.
///
/// Single-precision coordinates of 100 mm are rounded to 8e-6 mm, which is 2e-4 of an edge of
/// 0.04 mm, the shortest of the real meshes at hand.
const MIN_DEPTH: f64 = 1e-3;

/// Depth over the diagonal of the mesh up to which neighbours that cross are a wrinkle.
///
/// Remeshed scans have such knots of a few elements (up to 0.1 mm on an insert of 97 mm); the surface around is
/// sound, and they do not affect a contact patch.
const WRINKLE_DEPTH: f64 = 1.0 / 500.0;

/// Number of crossings at which the search ends: the mesh is then not a surface with flaws, but no surface at all.
const MAX_CROSSINGS: usize = 10_000;

/// Part of a triangle that is left out at the corner that it shares with another, where the two must touch.
const LEFT_OUT: f64 = 0.05;

/// Finds where a triangle mesh passes through itself.
///
/// Two triangles cross if only a shift of more than [`MIN_DEPTH`] separates them. Those that share an edge or overlap
/// in one plane do not; those that share a corner are compared without the region of that corner. A pair is a wrinkle
/// if a corner of one is a corner of the other or joined to one by an edge, and it is no deeper than
/// [`WRINKLE_DEPTH`]: two sheets that cross are not such neighbours everywhere.
pub(super) fn crossings(mesh: &TriangleMesh) -> Crossings {
    let mut pairs: Vec<([usize; 2], f64)> = Vec::new();
    let gave_up = BoxTree::new(mesh, 0.0).for_close_pairs(|one, other| {
        let triangles = [one.min(other), one.max(other)];
        pairs.extend(crossing_depth(mesh, triangles).map(|depth| (triangles, depth)));
        if pairs.len() == MAX_CROSSINGS {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    });
    if pairs.is_empty() && gave_up.is_none() {
        return Crossings::default();
    }
    let (low, high) = mesh.bounds();
    let shallow = WRINKLE_DEPTH * (high - low).norm();
    let uses = edge_uses(mesh);
    let is_edge = |a: u32, b: u32| {
        let ends = [a.min(b), a.max(b)];
        uses.binary_search_by_key(&ends, |edge| edge.ends).is_ok()
    };
    let are_neighbours = |triangles: [usize; 2]| {
        let [one, other] = triangles.map(|triangle| mesh.triangles[triangle]);
        let mut corners = one.iter().flat_map(|&a| other.map(|b| (a, b)));
        corners.any(|(a, b)| a == b || is_edge(a, b))
    };
    let is_wrinkle = |&(triangles, depth)| depth <= shallow && are_neighbours(triangles);
    let place = |triangles: [usize; 2]| {
        let [one, other] = triangles.map(|triangle| mesh.corners(triangle));
        // An edge of one pierces the other; by rounding it may just miss, and the crossing is between the two.
        let pierced = piercing(&one, &other).or_else(|| piercing(&other, &one));
        pierced.unwrap_or_else(|| (one.iter().sum::<Vec3>() + other.iter().sum::<Vec3>()) / 6.0)
    };
    let deep = pairs.iter().filter(|pair| !is_wrinkle(*pair));
    let mut found: Vec<_> = deep.map(|&(pair, _)| (pair, place(pair))).collect();
    found.sort_unstable_by_key(|(triangles, _)| *triangles);
    Crossings {
        gave_up_at_mm: gave_up.map(place),
        wrinkles: pairs.len() - found.len(),
        found,
    }
}

fn crossing_depth(mesh: &TriangleMesh, pair: [usize; 2]) -> Option<f64> {
    let [one, other] = pair.map(|triangle| mesh.triangles[triangle]);
    let [mut first, mut second] = pair.map(|triangle| mesh.corners(triangle));
    // Most pairs end here: the plane of the first triangle has the second on one side.
    let normal = (first[1] - first[0]).cross(&(first[2] - first[0]));
    let above = second.map(|corner| normal.dot(&(corner - first[0])));
    if above.iter().all(|&above| above > 0.0) || above.iter().all(|&above| above < 0.0) {
        return None;
    }
    let [longest, other_longest] = [&first, &second].map(|corners| {
        let [a, b, c] = edges(corners).map(|edge| edge.norm());
        a.max(b).max(c)
    });
    let min_depth = MIN_DEPTH * longest.min(other_longest);
    let is_shared = one.map(|vertex| other.contains(&vertex));
    match is_shared.iter().filter(|&&is_shared| is_shared).count() {
        0 => {}
        1 => {
            let corner = is_shared.iter().position(|&is_shared| is_shared);
            cut_corner(&mut first, corner.unwrap_or_default());
            let corner = other.iter().position(|vertex| one.contains(vertex));
            cut_corner(&mut second, corner.unwrap_or_default());
        }
        _ => return None,
    }
    depth_above(min_depth, &first, &second)
}

fn cut_corner(corners: &mut Corners, corner: usize) {
    let opposite = (corners[(corner + 1) % 3] + corners[(corner + 2) % 3]) / 2.0;
    corners[corner] += LEFT_OUT * (opposite - corners[corner]);
}

type Corners = [Vec3; 3];

/// Returns the shortest shift of one of two triangles that separates them, if it is more than `min_depth` >= 0.
///
/// By the separating-axis theorem the shortest such shift is along the normal of one of the two or across an edge of
/// each (eleven directions). It is 0 for triangles that touch or lie in one plane, so the test needs no exact
/// arithmetic: rounding moves the depth by about 1e-16 of the coordinates.
fn depth_above(min_depth: f64, first: &Corners, second: &Corners) -> Option<f64> {
    let origin = first[0];
    let [first, second] = [first, second].map(|corners| corners.map(|corner| corner - origin));
    let [along_first, along_second] = [edges(&first), edges(&second)];
    let normals = [along_first, along_second].map(|[a, b, _]| a.cross(&b));
    let across = along_first
        .iter()
        .flat_map(|a| along_second.map(|b| (a.cross(&b), a.norm_squared() * b.norm_squared())));
    let faces = normals
        .into_iter()
        .map(|normal| (normal, normal.norm_squared()));
    let mut depth = f64::INFINITY;
    for (axis, scale) in faces.chain(across) {
        let length_squared = axis.norm_squared();
        // Parallel edges have no direction across them.
        if length_squared <= 1e-20 * scale {
            continue;
        }
        // Shift along the axis, times its length, that separates the projections of the two triangles.
        let [(low, high), (other_low, other_high)] = [&first, &second].map(|corners| {
            let [a, b, c] = corners.each_ref().map(|corner| corner.dot(&axis));
            (a.min(b).min(c), a.max(b).max(c))
        });
        let along = (high - other_low).min(other_high - low);
        if along <= 0.0 || along * along <= min_depth * min_depth * length_squared {
            return None;
        }
        depth = depth.min(along / length_squared.sqrt());
    }
    Some(depth)
}

fn edges([a, b, c]: &Corners) -> [Vec3; 3] {
    [b - a, c - b, a - c]
}

fn piercing(edges_of: &Corners, plate: &Corners) -> Option<Vec3> {
    let normal = (plate[1] - plate[0]).cross(&(plate[2] - plate[0]));
    let is_within = |at: &Vec3| {
        (0..3).all(|i| {
            let (from, to) = (plate[i], plate[(i + 1) % 3]);
            (to - from).cross(&(at - from)).dot(&normal) >= 0.0
        })
    };
    (0..3).find_map(|i| {
        let (from, to) = (edges_of[i], edges_of[(i + 1) % 3]);
        let [above, below] = [from, to].map(|end| normal.dot(&(end - plate[0])));
        let at = from + (to - from) * (above / (above - below));
        (above * below < 0.0 && is_within(&at)).then_some(at)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::tests::{joined, strip, unit_block};

    #[test]
    fn sound_shells_do_not_cross() {
        assert_eq!(crossings(&unit_block()), Crossings::default());
        assert_eq!(crossings(&strip(40, 0.1)), Crossings::default());
        assert_eq!(crossings(&TriangleMesh::default()), Crossings::default());
    }

    #[test]
    fn blocks_that_only_touch_do_not_cross() {
        let adjacent = TriangleMesh::block(Vec3::new(1.0, 0.25, 0.25), Vec3::new(2.0, 0.75, 1.75));
        assert_eq!(
            crossings(&joined(unit_block(), adjacent)),
            Crossings::default()
        );
        let sunk = TriangleMesh::block(Vec3::new(0.999_9, 0.25, 0.25), Vec3::new(2.0, 0.75, 1.75));
        assert_eq!(
            crossings(&joined(unit_block(), sunk)),
            Crossings::default(),
            "below the least depth"
        );
    }

    #[test]
    fn a_cut_through_the_diagonals_of_faces_is_found() {
        // The edges of the bar meet the top only on its diagonal.
        let bar = TriangleMesh::block(Vec3::new(0.25, 0.25, 0.5), Vec3::new(0.75, 0.75, 1.5));
        assert!(!crossings(&joined(unit_block(), bar)).found.is_empty());
    }

    #[test]
    fn of_millions_of_crossings_enough_are_found() {
        let (mut mesh, along) = (TriangleMesh::default(), |i: u32| f64::from(i) * 1e-3);
        for i in 0..3000 {
            let upright = [[0.0, -9.0, -9.0], [0.0, 9.0, -9.0], [0.0, 0.0, 9.0]];
            let level = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [0.0, 9.0, 0.0]];
            let upright = upright.map(|corner| Vec3::from(corner) + Vec3::x() * along(i));
            let level = level.map(|corner| Vec3::from(corner) + Vec3::z() * along(i));
            let first = mesh.vertices.len() as u32;
            mesh.vertices.extend(upright.into_iter().chain(level));
            let corners = [first, first + 1, first + 2];
            mesh.triangles
                .extend([corners, corners.map(|corner| corner + 3)]);
        }
        let crossings = crossings(&mesh);
        assert_eq!(crossings.found.len() + crossings.wrinkles, MAX_CROSSINGS);
        assert!(!crossings.found.is_empty());
    }

    #[test]
    fn the_search_ends_at_sheets_that_lie_on_one_another() {
        let mut mesh = TriangleMesh::default();
        for i in 0..19_000 {
            let corners = [[0.0, 0.0], [9.0, 0.0], [0.0, 9.0]];
            // Tilted, so that no box is flat.
            let lifted = corners.map(|[x, y]| Vec3::new(x, y, x + y + 1e-6 * f64::from(i)));
            let first = mesh.vertices.len() as u32;
            mesh.vertices.extend(lifted);
            mesh.triangles.push([first, first + 1, first + 2]);
        }
        let crossings = crossings(&mesh);
        assert!(crossings.found.is_empty() && crossings.gave_up_at_mm.is_some());
    }

    #[test]
    fn triangles_that_share_a_corner_and_cross_are_found() {
        let vertices = [
            [0., 0., 0.],
            [2., -1., 0.],
            [2., 1., 0.],
            [2., 0., -1.],
            [2., 0., 1.],
        ];
        let mesh = TriangleMesh {
            vertices: vertices.map(Vec3::from).to_vec(),
            triangles: vec![[0, 1, 2], [0, 3, 4]],
        };
        let (triangles, at_mm) = crossings(&mesh).found.remove(0);
        assert_eq!(triangles, [0, 1]);
        assert!(at_mm.z.abs() < 1e-14 && at_mm.y.abs() < 1e-14);
        let apart = mesh.clone().mapped(|v| {
            if v.z < 0.0 {
                Vec3::new(2.0, 0.0, 0.5)
            } else {
                *v
            }
        });
        assert_eq!(crossings(&apart), Crossings::default());
    }

    #[test]
    fn crossings_come_by_the_numbers_of_their_triangles() {
        let wall = TriangleMesh::block(Vec3::new(-1.0, 0.4, -50.0), Vec3::new(30.5, 0.6, 50.0));
        let (triangles, _) = crossings(&joined(strip(40, 0.1), wall)).found.remove(0);
        assert_eq!(triangles[0], 0);
    }

    /// Returns a sheet of squares of 1 mm, `steps` a side, with one vertex pulled through its neighbours.
    fn wrinkled(steps: u32) -> TriangleMesh {
        let number = |i: u32, j: u32| i + (steps + 1) * j;
        let mut mesh = TriangleMesh::default();
        for j in 0..=steps {
            let row = |i: u32| Vec3::new(f64::from(i), f64::from(j), 0.5 * f64::from(i * i % 3));
            mesh.vertices.extend((0..=steps).map(row));
        }
        for j in 0..steps {
            for i in 0..steps {
                let [a, b, c, d] = [
                    number(i, j),
                    number(i + 1, j),
                    number(i, j + 1),
                    number(i + 1, j + 1),
                ];
                mesh.triangles.extend([[a, b, c], [b, d, c]]);
            }
        }
        let middle = number(steps / 2, steps / 2) as usize;
        mesh.vertices[middle] += Vec3::new(1.5, 0.3, -0.5);
        mesh
    }

    #[test]
    fn a_knot_of_neighbours_is_a_wrinkle_on_a_fine_mesh_and_a_crossing_on_a_coarse_one() {
        let fine = crossings(&wrinkled(100));
        assert!(fine.found.is_empty() && fine.wrinkles > 0, "{fine:?}");
        let coarse = crossings(&wrinkled(4));
        assert!(!coarse.found.is_empty(), "{coarse:?}");
    }

    const FLOOR: Corners = [
        Vec3::new(0.0, 0.0, 0.0),
        Vec3::new(4.0, 0.0, 0.0),
        Vec3::new(0.0, 4.0, 0.0),
    ];

    fn upright(tip_z: f64, at: [f64; 2]) -> Corners {
        let [x, y] = at;
        let tip = Vec3::new(x, y, tip_z);
        [
            tip,
            tip + Vec3::new(0.5, 0.0, 3.0),
            tip + Vec3::new(-0.5, 0.2, 3.0),
        ]
    }

    #[test]
    fn verify_depth_of_a_tip_through_a_plate() {
        let depth = depth_above(0.0, &FLOOR, &upright(-0.25, [1.0, 1.0])).unwrap();
        assert!((depth - 0.25).abs() < 1e-14, "{depth}");
        assert_eq!(depth_above(0.26, &FLOOR, &upright(-0.25, [1.0, 1.0])), None);
    }

    #[test]
    fn apart_touching_and_coplanar_triangles_do_not_cross() {
        assert_eq!(depth_above(0.0, &FLOOR, &upright(0.1, [1.0, 1.0])), None);
        assert_eq!(depth_above(0.0, &FLOOR, &upright(0.0, [1.0, 1.0])), None);
        assert_eq!(depth_above(0.0, &FLOOR, &upright(-0.25, [5.0, 1.0])), None);
        let shifted = FLOOR.map(|corner| corner + Vec3::new(0.5, 0.5, 0.0));
        assert_eq!(depth_above(0.0, &FLOOR, &shifted), None);
    }

    #[test]
    fn an_edge_pierces_where_both_triangles_are() {
        let tip = upright(-0.5, [1.0, 1.0]);
        let at = piercing(&FLOOR, &tip).or_else(|| piercing(&tip, &FLOOR));
        let at = at.unwrap();
        assert!(
            at.z.abs() < 1e-14 && (at.x - 1.0).abs() < 0.1 && (at.y - 1.0).abs() < 0.1,
            "{at}"
        );
    }
}
