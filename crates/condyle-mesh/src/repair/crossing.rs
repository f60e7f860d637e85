//! Pairs of triangles that pass through one another, and how deep.

use std::ops::ControlFlow;

use super::{
    box_tree::BoxTree,
    edges::{EdgeUse, edge_uses},
};
use crate::{Vec3, triangle_mesh::TriangleMesh};

/// Two triangles that cut one another.
#[derive(Clone, Debug, PartialEq)]
pub struct Crossing {
    /// Numbers of the triangles, the lower first.
    pub triangles: [usize; 2],
    /// A point of the cut, in the unit of the mesh.
    pub at_mm: Vec3,
}

/// How a mesh crosses itself.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Crossings {
    /// Crossings that are no wrinkle, by the numbers of their triangles.
    pub found: Vec<Crossing>,
    /// Where the search ended because too many triangles lie on one another, in the unit of the mesh.
    pub gave_up_at_mm: Option<Vec3>,
    /// Pairs of triangles that cross as part of a wrinkle.
    pub wrinkles: usize,
}

impl Crossings {
    /// Shift that parts two triangles, over the shorter of their longest edges, below which they
    /// only touch.
    ///
    /// Single-precision coordinates of 100 mm are rounded to 8e-6 mm, which is 2e-4 of an edge of
    /// 0.04 mm, the shortest of the real meshes at hand.
    pub const MIN_DEPTH: f64 = 1e-3;

    /// Depth over the diagonal of the mesh up to which neighbours that cross are a wrinkle.
    ///
    /// Remeshed scans have such knots of a few elements (up to 0.1 mm on an insert of 97 mm); the
    /// surface around is sound, and a contact patch does not feel them.
    pub const WRINKLE_DEPTH: f64 = 1.0 / 500.0;

    /// So many crossings are no flaw of a surface but no surface: no more are looked for.
    const MANY: usize = 10_000;

    /// Part of a triangle left out at the corner that it shares with another: there they touch
    /// as they should.
    const LEFT_OUT: f64 = 0.05;
}

/// Finds where a triangle mesh passes through itself.
///
/// Two triangles cross if only a shift of more than [`Crossings::MIN_DEPTH`] parts them. Those
/// that share an edge or overlap in one plane do not; those that share a corner are compared
/// without what lies next to that corner. A pair is a wrinkle if a corner of one is a corner of
/// the other or joined to one by an edge, and it is no deeper than [`Crossings::WRINKLE_DEPTH`]:
/// two sheets that cross are never such neighbours all along.
pub fn crossings(mesh: &TriangleMesh) -> Crossings {
    let (low, high) = mesh.bounds();
    let shallow = Crossings::WRINKLE_DEPTH * (high - low).norm();
    let (pairs, gave_up) = crossing_pairs(mesh);
    if pairs.is_empty() && gave_up.is_none() {
        return Crossings::default();
    }
    let uses = edge_uses(mesh);
    let is_wrinkle = |pair: &CrossingPair| {
        pair.depth <= shallow && are_neighbours(&uses, pair.triangles.map(|t| mesh.triangles[t]))
    };
    let (wrinkles, deep): (Vec<_>, Vec<_>) = pairs.iter().partition(|pair| is_wrinkle(pair));
    let mut found: Vec<Crossing> = deep
        .iter()
        .map(|pair| crossing(mesh, pair.triangles))
        .collect();
    found.sort_unstable_by_key(|crossing| crossing.triangles);
    Crossings {
        found,
        gave_up_at_mm: gave_up.map(|[one, other]| crossing(mesh, [one, other]).at_mm),
        wrinkles: wrinkles.len(),
    }
}

fn crossing(mesh: &TriangleMesh, triangles: [usize; 2]) -> Crossing {
    let [one, other] = triangles.map(|triangle| mesh.corners(triangle));
    let at_mm = meeting_point(&one, &other);
    Crossing { triangles, at_mm }
}

struct CrossingPair {
    triangles: [usize; 2],
    depth: f64,
}

/// The pairs that cross, until they are [`Crossings::MANY`], and where the search was given up.
fn crossing_pairs(mesh: &TriangleMesh) -> (Vec<CrossingPair>, Option<[usize; 2]>) {
    let mut pairs = Vec::new();
    let gave_up = BoxTree::new(mesh).for_close_pairs(|one, other| {
        let triangles = [one.min(other), one.max(other)];
        if let Some(depth) = crossing_depth(mesh, triangles) {
            pairs.push(CrossingPair { triangles, depth });
        }
        if pairs.len() == Crossings::MANY {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    });
    (pairs, gave_up)
}

/// A corner of one is a corner of the other, or an edge joins the two.
fn are_neighbours(uses: &[EdgeUse], [one, other]: [[u32; 3]; 2]) -> bool {
    let is_edge = |a: u32, b: u32| {
        let ends = [a.min(b), a.max(b)];
        uses.binary_search_by_key(&ends, |edge| edge.ends).is_ok()
    };
    one.iter()
        .any(|&a| other.iter().any(|&b| a == b || is_edge(a, b)))
}

/// Depth of the cut of two triangles, if they cross.
fn crossing_depth(mesh: &TriangleMesh, pair: [usize; 2]) -> Option<f64> {
    let [one, other] = pair.map(|triangle| mesh.triangles[triangle]);
    let shared = one.map(|vertex| other.contains(&vertex));
    let corners = pair.map(|triangle| mesh.corners(triangle));
    if are_parted_by_a_plane(&corners[0], &corners[1]) {
        return None;
    }
    let least = Crossings::MIN_DEPTH * longest_edge(&corners[0]).min(longest_edge(&corners[1]));
    let [first, second] = match shared.iter().filter(|&&is_shared| is_shared).count() {
        0 => corners,
        1 => {
            let places = [
                shared.iter().position(|&is_shared| is_shared),
                other.iter().position(|vertex| one.contains(vertex)),
            ];
            [0, 1].map(|i| without_corner(corners[i], places[i].unwrap_or_default()))
        }
        _ => return None,
    };
    depth_above(least, &first, &second)
}

fn longest_edge([a, b, c]: &Corners) -> f64 {
    (b - a).norm().max((c - b).norm()).max((a - c).norm())
}

fn without_corner(mut corners: Corners, corner: usize) -> Corners {
    let opposite = (corners[(corner + 1) % 3] + corners[(corner + 2) % 3]) / 2.0;
    corners[corner] += Crossings::LEFT_OUT * (opposite - corners[corner]);
    corners
}

/// Corners of a triangle.
pub(super) type Corners = [Vec3; 3];

/// How far one of two triangles must be shifted for them to part, if that is more than `least`.
///
/// By the separating-axis theorem the shortest such shift is along the normal of one of the two or
/// across an edge of each (eleven directions). It is 0 for triangles that touch or lie in one
/// plane, so the test needs no exact arithmetic: rounding moves the depth by some 1e-16 of the
/// coordinates. `least` must not be negative.
pub(super) fn depth_above(least: f64, first: &Corners, second: &Corners) -> Option<f64> {
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
        let along = overlap(&axis, &first, &second);
        if along <= 0.0 || along * along <= least * least * length_squared {
            return None;
        }
        depth = depth.min(along / length_squared.sqrt());
    }
    Some(depth)
}

/// Whether the plane of the first triangle has the second on one side; most pairs end here.
pub(super) fn are_parted_by_a_plane(first: &Corners, second: &Corners) -> bool {
    let normal = (first[1] - first[0]).cross(&(first[2] - first[0]));
    let [a, b, c] = second.map(|corner| normal.dot(&(corner - first[0])));
    (a > 0.0 && b > 0.0 && c > 0.0) || (a < 0.0 && b < 0.0 && c < 0.0)
}

fn edges([a, b, c]: &Corners) -> [Vec3; 3] {
    [b - a, c - b, a - c]
}

/// Shift along `axis`, times its length, that parts the shadows of the two triangles.
fn overlap(axis: &Vec3, first: &Corners, second: &Corners) -> f64 {
    let [(low, high), (other_low, other_high)] = [shadow(axis, first), shadow(axis, second)];
    (high - other_low).min(other_high - low)
}

fn shadow(axis: &Vec3, corners: &Corners) -> (f64, f64) {
    let [a, b, c] = corners.each_ref().map(|corner| corner.dot(axis));
    (a.min(b).min(c), a.max(b).max(c))
}

/// A point that two crossing triangles share: where an edge of one pierces the other.
pub(super) fn meeting_point(first: &Corners, second: &Corners) -> Vec3 {
    let pierced = piercing(first, second).or_else(|| piercing(second, first));
    // Edges that just miss by rounding: the crossing is between the two.
    pierced.unwrap_or_else(|| (first.iter().sum::<Vec3>() + second.iter().sum::<Vec3>()) / 6.0)
}

fn piercing(edges_of: &Corners, plate: &Corners) -> Option<Vec3> {
    let normal = (plate[1] - plate[0]).cross(&(plate[2] - plate[0]));
    (0..3).find_map(|i| {
        let (from, to) = (edges_of[i], edges_of[(i + 1) % 3]);
        let [above, below] = [from, to].map(|end| normal.dot(&(end - plate[0])));
        let at = from + (to - from) * (above / (above - below));
        (above * below < 0.0 && is_within(&at, plate, &normal)).then_some(at)
    })
}

fn is_within(at: &Vec3, plate: &Corners, normal: &Vec3) -> bool {
    (0..3).all(|i| {
        let (from, to) = (plate[i], plate[(i + 1) % 3]);
        (to - from).cross(&(at - from)).dot(normal) >= 0.0
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::repair::fixtures::{joined, strip, unit_block};

    #[test]
    fn sound_shells_do_not_cross() {
        assert_eq!(crossings(&unit_block()), Crossings::default());
        assert_eq!(crossings(&strip(40, 0.1)), Crossings::default());
        assert_eq!(crossings(&TriangleMesh::default()), Crossings::default());
    }

    #[test]
    fn blocks_that_only_touch_do_not_cross() {
        let beside = TriangleMesh::block(Vec3::new(1.0, 0.25, 0.25), Vec3::new(2.0, 0.75, 1.75));
        assert_eq!(
            crossings(&joined(unit_block(), beside)),
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
        assert_eq!(crossing_pairs(&mesh).0.len(), Crossings::MANY);
        assert!(!crossings(&mesh).found.is_empty());
    }

    #[test]
    fn of_sheets_that_lie_on_one_another_the_search_ends_and_says_where() {
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
        let crossing = crossings(&mesh).found.remove(0);
        assert_eq!(crossing.triangles, [0, 1]);
        assert!(crossing.at_mm.z.abs() < 1e-14 && crossing.at_mm.y.abs() < 1e-14);
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
        let crossing = crossings(&joined(strip(40, 0.1), wall)).found.remove(0);
        assert_eq!(crossing.triangles[0], 0);
    }

    /// A sheet of squares of 1 mm, `steps` a side, with one vertex pulled through its neighbours.
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
    fn the_meeting_point_lies_in_both() {
        let tip = upright(-0.5, [1.0, 1.0]);
        let at = meeting_point(&FLOOR, &tip);
        assert!(
            at.z.abs() < 1e-14 && (at.x - 1.0).abs() < 0.1 && (at.y - 1.0).abs() < 0.1,
            "{at}"
        );
    }
}
