//! An insert with a post: its walls belong to the articulating surface, and bear load.

use std::f64::consts::PI;

use condyle::{
    Mat3, Vec3,
    contact::{Bodies, ContactLaw, ContactMemory, Foundation, PressureLaw},
    geometry::{Counterface, Insert, Meshing, TriangleMesh},
    spatial::{Pose, RelativeMotion},
};

/// Places along x and z at which the body changes its height, mm.
const X_MM: [f64; 4] = [-16.0, -5.0, 6.0, 20.0];
const Z_MM: [f64; 4] = [-22.0, -7.0, 7.0, 22.0];
/// Heights of the block and of its post, mm.
const BLOCK_MM: f64 = 9.0;
const POST_MM: f64 = 22.0;

/// Returns a block with a square post, in the large triangles of a program for design.
fn block_with_post() -> TriangleMesh {
    let height_mm = |i: usize, k: usize| match (i, k) {
        (1, 1) => POST_MM,
        (0..3, 0..3) => BLOCK_MM,
        _ => 0.0,
    };
    let mut quads: Vec<[Vec3; 4]> = Vec::new();
    for i in 0..3 {
        for k in 0..3 {
            let y = height_mm(i, k);
            let corners = [(i, k), (i, k + 1), (i + 1, k + 1), (i + 1, k)];
            let at = |y: f64| corners.map(|(i, k)| Vec3::new(X_MM[i], y, Z_MM[k]));
            let (top, bottom) = (at(y), at(0.0));
            quads.push(top);
            quads.push([bottom[3], bottom[2], bottom[1], bottom[0]]);
            let around = [
                (i.wrapping_sub(1), k),
                (i, k + 1),
                (i + 1, k),
                (i, k.wrapping_sub(1)),
            ];
            for (side, (other_i, other_k)) in around.into_iter().enumerate() {
                let low = at(height_mm(other_i, other_k));
                if low[0].y < y {
                    let next = (side + 1) % 4;
                    quads.push([top[side], low[side], low[next], top[next]]);
                }
            }
        }
    }
    let vertices = quads.concat();
    let numbers = (0..quads.len() as u32).map(|n| [0, 1, 2, 3].map(|corner| 4 * n + corner));
    condyle_mesh::repair::checked_mesh(TriangleMesh::of_quads(vertices, numbers))
        .unwrap()
        .mesh
}

fn insert(edge_mm: f64) -> Insert {
    let meshing = Meshing { edge_mm, layers: 3 };
    let (insert, holes) = Insert::over_holes(&block_with_post(), true, None, meshing).unwrap();
    assert!(holes.is_empty(), "{holes:?}");
    insert
}

#[test]
fn verify_the_walls_of_a_post_belong_to_the_surface() {
    let insert = insert(0.8);
    let (x, z) = (X_MM[2] - X_MM[1], Z_MM[2] - Z_MM[1]);
    let walls_mm2 = 2.0 * (x + z) * (POST_MM - BLOCK_MM);
    let (length_mm, width_mm) = (X_MM[3] - X_MM[0], Z_MM[3] - Z_MM[0]);
    let near = |found: f64, exact: f64, within: f64| {
        assert!((found / exact - 1.0).abs() < within, "{found} {exact}");
    };
    // Hexahedra cut the sharp edges of the post.
    near(
        insert.surface().area_mm2(),
        length_mm * width_mm + walls_mm2,
        0.03,
    );
    near(
        insert.volume_mm3(),
        length_mm * width_mm * BLOCK_MM + x * z * (POST_MM - BLOCK_MM),
        0.01,
    );
    assert!(
        insert.mesh().worst_quality() > 0.05,
        "{}",
        insert.mesh().worst_quality()
    );
    let is_one_of = |value: f64, of: &[f64]| of.iter().any(|at| (value - at).abs() < 1e-6);
    for at in insert.surface().positions {
        let is_on_top = is_one_of(at.y, &[BLOCK_MM, POST_MM]);
        let is_on_wall = is_one_of(at.x, &X_MM[1..3]) || is_one_of(at.z, &Z_MM[1..3]);
        assert!(is_on_top || is_on_wall, "{at}");
    }
}

/// Exact for a shallow ball on a layer of thickness h: F = pi R K d^2 / h, here across the wall.
#[test]
fn verify_a_ball_on_the_wall_of_a_post_has_the_force_of_a_layer() {
    const RADIUS_MM: f64 = 6.0;
    const MODULUS_MPA: f64 = 2142.0;
    const DEPTH_MM: f64 = 0.1;
    const HEIGHT_MM: f64 = 15.5;
    let insert = insert(0.5);
    let surface = insert.surface();
    let counterface = Counterface::sphere(RADIUS_MM).prepared_for(surface.mean_spread_mm2());
    let bodies = Bodies {
        counterface: &counterface,
        insert: &insert,
        surface: &surface,
    };
    let pressure = PressureLaw::Linear {
        modulus_mpa: MODULUS_MPA,
    };
    let law = Foundation::new(pressure, 0.0, 1.0);
    let centres_mm = [
        Vec3::new(X_MM[1] - RADIUS_MM + DEPTH_MM, HEIGHT_MM, 0.0),
        Vec3::new(X_MM[2] + RADIUS_MM - DEPTH_MM, HEIGHT_MM, 0.0),
        Vec3::new(0.5, HEIGHT_MM, Z_MM[2] + RADIUS_MM - DEPTH_MM),
    ];
    // The thickness below a wall is the height above the backside.
    let exact_n = PI * RADIUS_MM * MODULUS_MPA * DEPTH_MM * DEPTH_MM / HEIGHT_MM;
    for centre_mm in centres_mm {
        let mut contact = law.contact(bodies, ContactMemory::default());
        let pose = Pose::new(Mat3::identity(), centre_mm);
        let force_n = contact.respond(&RelativeMotion::at_rest(pose)).wrench.force;
        let outwards = Vec3::new(centre_mm.x - 0.5, 0.0, centre_mm.z).normalize();
        let normal_n = force_n.dot(&outwards).abs();
        assert!(
            (normal_n / exact_n - 1.0).abs() < 0.02,
            "{normal_n} {exact_n} at {centre_mm}"
        );
        assert!(
            (force_n - outwards * force_n.dot(&outwards)).norm() < 0.01 * exact_n,
            "{force_n}"
        );
    }
}
