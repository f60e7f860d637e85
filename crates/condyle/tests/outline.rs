//! An insert of triangles ends at its own rim, and contact there does not feel how the grid lies.

use condyle::{
    Mat3, Vec3,
    contact::{Bodies, ContactLaw, ContactMemory, Foundation, PressureLaw},
    geometry::{Counterface, Insert, InsertError, Meshing, TriangleMesh},
    spatial::{Pose, RelativeMotion},
};
use condyle_mesh::columns::ColumnError;
use nalgebra::Rotation3;

const MODULUS_MPA: f64 = 2142.0;
const THICKNESS_MM: f64 = 8.0;
/// Radius of the ball that presses on the rim, and of the dishes it conforms to.
const BALL_MM: f64 = 24.0;
const DISH_MM: f64 = 26.0;
const MESHING: Meshing = Meshing {
    edge_mm: 1.05,
    layers: 3,
};

/// A body with vertical sides between a flat backside and a top.
struct Body {
    /// Distance of the outline from the middle by the angle from +x towards -z, mm.
    outline_mm: fn(f64) -> f64,
    /// Height of the top over (x, z), mm.
    top_mm: fn(f64, f64) -> f64,
}

impl Body {
    /// Its triangles: rings of 240 vertices around the middle of the top and of the backside.
    fn shell(&self) -> TriangleMesh {
        const AROUND: u32 = 240;
        const RINGS: u32 = 40;
        let mut shell = TriangleMesh::default();
        for top in [true, false] {
            let height = |x: f64, z: f64| {
                if top {
                    (self.top_mm)(x, z)
                } else {
                    -THICKNESS_MM
                }
            };
            let middle = shell.vertices.len() as u32;
            shell.vertices.push(Vec3::new(0.0, height(0.0, 0.0), 0.0));
            for ring in 1..=RINGS {
                for step in 0..AROUND {
                    let angle = std::f64::consts::TAU * f64::from(step) / f64::from(AROUND);
                    let far = (self.outline_mm)(angle) * f64::from(ring) / f64::from(RINGS);
                    let (x, z) = (far * angle.cos(), -far * angle.sin());
                    shell.vertices.push(Vec3::new(x, height(x, z), z));
                }
            }
            let vertex = |ring: u32, step: u32| match ring {
                0 => middle,
                _ => middle + 1 + (ring - 1) * AROUND + step % AROUND,
            };
            for ring in 0..RINGS {
                for step in 0..AROUND {
                    let quad = [
                        (ring, step),
                        (ring + 1, step),
                        (ring + 1, step + 1),
                        (ring, step + 1),
                    ]
                    .map(|(ring, step)| vertex(ring, step));
                    add(&mut shell, quad, top);
                }
            }
        }
        let rim = 1 + (RINGS - 1) * AROUND;
        let below = rim + 1 + RINGS * AROUND;
        for step in 0..AROUND {
            let after = (step + 1) % AROUND;
            add(
                &mut shell,
                [rim + step, below + step, below + after, rim + after],
                true,
            );
        }
        shell
    }
}

/// A quad as triangles, turned round unless it looks the way it is given.
fn add(shell: &mut TriangleMesh, [a, b, c, d]: [u32; 4], as_given: bool) {
    for [a, b, c] in [[a, b, c], [a, c, d]] {
        let is_flat = a == b || b == c || a == c;
        if !is_flat {
            shell
                .triangles
                .push(if as_given { [a, b, c] } else { [c, b, a] });
        }
    }
}

/// An oval like a knee's from above, with a dish that reaches up to its rim.
const OVAL: Body = Body {
    outline_mm: |angle| 22.0 / (angle.cos().powi(2) + (22.0 / 33.0 * angle.sin()).powi(2)).sqrt(),
    top_mm: |x, z| {
        let across = z.abs() - 20.0;
        DISH_MM - (DISH_MM * DISH_MM - (x * x + across * across).min(400.0)).sqrt()
    },
};

/// A straight-sided block, 40 mm by 60 mm.
const BLOCK: Body = Body {
    outline_mm: |angle| (20.0 / angle.cos().abs()).min(30.0 / angle.sin().abs()),
    top_mm: |_, _| 0.0,
};

fn turn(degrees: f64) -> Mat3 {
    Rotation3::new(Vec3::y() * degrees.to_radians()).into_inner()
}

/// A body turned about the vertical, with a chip next to it that shifts where the grid begins, and is too
/// small to be part of the outline.
fn insert(body: &Body, degrees: f64, shift_mm: f64) -> Insert {
    let mut shell = body.shell().mapped(|vertex| turn(degrees) * vertex);
    if shift_mm > 0.0 {
        let (low, _) = shell.bounds();
        let chip = shell.vertices.len() as u32;
        let corner = low + Vec3::new(-shift_mm, 1.0, -shift_mm);
        let ends = [Vec3::zeros(), Vec3::x(), Vec3::z(), Vec3::y()];
        shell.vertices.extend(ends.map(|end| corner + end * 0.1));
        let faces = [[0, 2, 3], [0, 3, 1], [0, 1, 2], [1, 3, 2]];
        shell
            .triangles
            .extend(faces.map(|face: [u32; 3]| face.map(|n| n + chip)));
    }
    Insert::from_surface(&shell, true, None, MESHING).unwrap()
}

/// Force up on a ball pressed in at a place of the body, N, and the highest pressure, MPa.
fn pressed(insert: &Insert, degrees: f64, centre: Vec3) -> [f64; 2] {
    let law = PressureLaw::Linear {
        modulus_mpa: MODULUS_MPA,
    };
    let law = Foundation::new(law, 0.0, 1.0);
    let surface = &insert.surface();
    let counterface = Counterface::sphere(BALL_MM).prepared_for(surface.mean_spread_mm2());
    let bodies = Bodies {
        counterface: &counterface,
        insert,
        surface,
    };
    let mut contact = law.contact(bodies, ContactMemory::default());
    let motion = RelativeMotion::at_rest(Pose::new(Mat3::identity(), turn(degrees) * centre));
    let force = contact.respond(&motion).wrench.force;
    [force.y.abs(), contact.evaluate(&motion).peak_pressure_mpa]
}

#[test]
fn verify_area_volume_and_shape_of_turned_bodies() {
    for body in [OVAL, BLOCK] {
        let shell = body.shell();
        for degrees in [0.0, 10.0, 27.0, 45.0, 73.0] {
            let insert = insert(&body, degrees, 0.0);
            let volume = insert.mesh().volume() / shell.signed_volume() - 1.0;
            assert!(volume.abs() < 2e-3, "volume {volume:e} at {degrees}");
            let surface = insert.surface();
            let flat = insert.surface_faces().iter().map(|face| {
                let [a, b, c, d] = face.map(|n| surface.positions[n as usize]);
                (c - a).cross(&(d - b)).y / 2.0
            });
            let exact = area_mm2(&body);
            let area = flat.sum::<f64>() / exact - 1.0;
            assert!(area.abs() < 2e-3, "area {area:e} at {degrees}");
            let quality = insert.mesh().worst_quality();
            assert!(quality > 0.3, "quality {quality} at {degrees}");
        }
    }
}

/// Area of a body seen from above, mm2.
fn area_mm2(body: &Body) -> f64 {
    let step = std::f64::consts::TAU / 1e5;
    let slice = |n: u32| (body.outline_mm)(f64::from(n) * step).powi(2) * step / 2.0;
    (0..100_000).map(slice).sum()
}

#[test]
fn verify_a_ball_over_a_straight_rim_finds_half_the_force() {
    const DEEP_MM: f64 = 0.3;
    for degrees in [0.0, 10.0, 27.0, 45.0] {
        let insert = insert(&BLOCK, degrees, 0.0);
        let at = |x: f64, z: f64| pressed(&insert, degrees, Vec3::new(x, BALL_MM - DEEP_MM, z));
        let [whole, peak] = at(0.0, 0.0);
        for (x, z) in [(20.0, 3.3), (-20.0, 0.0), (4.1, 30.0)] {
            let [half, at_rim] = at(x, z);
            let force = 2.0 * half / whole - 1.0;
            assert!(force.abs() < 0.02, "force {force:e} at {degrees}, {x}, {z}");
            let pressure = at_rim / peak - 1.0;
            assert!(
                pressure.abs() < 0.02,
                "pressure {pressure:e} at {degrees}, {x}, {z}"
            );
        }
    }
}

#[test]
fn verify_there_is_no_ridge_beside_the_rim() {
    let insert = insert(&OVAL, 0.0, 0.0);
    for position in insert.surface().positions {
        let [x, y, z] = position.into();
        if x.hypot(z.abs() - 20.0) < 19.0 && z.abs() > 1.0 {
            let error = y - (OVAL.top_mm)(x, z);
            assert!(error.abs() < 2e-3, "{error} at {position}");
        }
    }
}

#[test]
fn contact_at_the_rim_does_not_depend_on_how_the_grid_lies() {
    let upright = insert(&OVAL, 0.0, 0.0);
    let lying = [(0.0, 0.525), (10.0, 0.0), (27.0, 0.3), (45.0, 0.525)];
    for (degrees, shift_mm) in lying {
        let turned = insert(&OVAL, degrees, shift_mm);
        for angle in [0.3_f64, 1.0, 1.57, 2.2, 3.5, 4.9] {
            let far = (OVAL.outline_mm)(angle) - 1.0;
            let (x, z) = (far * angle.cos(), -far * angle.sin());
            let centre = Vec3::new(x, (OVAL.top_mm)(x, z) + BALL_MM - 0.5, z);
            let [force, peak] = pressed(&upright, 0.0, centre);
            let [turned_force, turned_peak] = pressed(&turned, degrees, centre);
            let [force, peak] = [turned_force / force - 1.0, turned_peak / peak - 1.0];
            assert!(
                force.abs() < 0.01,
                "force {force:e} at {angle}, turned by {degrees}"
            );
            assert!(
                peak.abs() < 0.05,
                "pressure {peak:e} at {angle}, turned by {degrees}"
            );
        }
    }
}

#[test]
fn holes_under_the_outline_are_errors_that_list_all_with_their_places() {
    let mut shell = OVAL.shell();
    let over = |vertex: &Vec3, x: f64, z: f64| (vertex.x - x).hypot(vertex.z - z) < 2.0;
    let vertices = shell.vertices.clone();
    let is_cut = |triangle: &[u32; 3]| {
        let vertex = |n: &u32| &vertices[*n as usize];
        triangle
            .iter()
            .any(|n| over(vertex(n), 3.0, 20.0) || over(vertex(n), -2.0, -20.0))
    };
    shell.triangles.retain(|triangle| !is_cut(triangle));
    match Insert::from_surface(&shell, false, Some(8.0), MESHING) {
        Err(InsertError::Columns(ColumnError::Holes { holes })) => {
            assert_eq!(holes.len(), 2, "{holes:?}");
            assert!(holes.iter().all(|hole| hole.goes_through));
            assert!((holes[0].x_mm + 2.0).abs() < 1.0 && (holes[0].z_mm + 20.0).abs() < 1.0);
            assert!((holes[1].x_mm - 3.0).abs() < 1.0 && (holes[1].z_mm - 20.0).abs() < 1.0);
            let said = ColumnError::Holes { holes }.to_string();
            assert!(
                said.contains("hole of") && said.contains("x -2.") && said.contains("z 20."),
                "{said}"
            );
        }
        other => panic!("{:?}", other.err()),
    }
}

#[test]
fn the_surface_goes_on_smoothly_over_a_hole_which_is_named() {
    let mut shell = OVAL.shell();
    let vertices = shell.vertices.clone();
    let is_cut = |n: &u32| vertices[*n as usize].x.hypot(vertices[*n as usize].z) < 3.0;
    shell
        .triangles
        .retain(|triangle| !triangle.iter().any(is_cut));
    let (insert, holes) = Insert::over_holes(&shell, false, Some(8.0), MESHING).unwrap();
    let [hole] = &holes[..] else {
        panic!("{holes:?}");
    };
    assert!(
        hole.goes_through && (25.0..40.0).contains(&hole.area_mm2),
        "{hole:?}"
    );
    assert!(hole.distance_mm([0.0, 0.5]) == 0.0);
    assert!(
        (hole.distance_mm([0.0, 10.0]) - 6.7).abs() < 0.5,
        "{}",
        hole.distance_mm([0.0, 10.0])
    );
    let positions = insert.surface().positions;
    let over: Vec<&Vec3> = positions
        .iter()
        .filter(|at| at.x.hypot(at.z) < 3.0)
        .collect();
    assert!(over.len() > 15);
    let around = (0..60).map(|n| f64::from(n) / 60.0 * std::f64::consts::TAU);
    let around = around.map(|angle| (OVAL.top_mm)(3.4 * angle.cos(), 3.4 * angle.sin()));
    let (low, high) = around.fold((f64::MAX, f64::MIN), |(a, b), y| (a.min(y), b.max(y)));
    assert!(
        over.iter().all(|at| (low..high).contains(&at.y)),
        "{over:?}"
    );
}

/// The oval with a post in its middle, as a posterior-stabilised insert has.
const WITH_POST: Body = Body {
    outline_mm: OVAL.outline_mm,
    top_mm: |x, z| {
        let post = 4.0 * (8.0 - x.hypot(z)).clamp(0.0, 3.0);
        (OVAL.top_mm)(x, z) + post
    },
};

#[test]
fn a_post_belongs_to_the_surface() {
    let shell = WITH_POST.shell();
    let insert = Insert::from_surface(&shell, true, None, MESHING).unwrap();
    let (_, high) = insert.surface().height_range_mm();
    let (_, highest) = shell.bounds();
    // The ridge of the oval goes over the post, and the hexahedra miss it by half an edge.
    assert!(
        high <= highest.y && high > highest.y - 0.5,
        "{high} {highest}"
    );
    let share = insert.volume_mm3() / shell.signed_volume();
    assert!((share - 1.0).abs() < 0.01, "{share}");
    assert!(insert.mesh().worst_quality() > 0.1);
}

/// The oval with a pit in its middle.
const WITH_PIT: Body = Body {
    outline_mm: OVAL.outline_mm,
    top_mm: |x, z| (OVAL.top_mm)(x, z) - 4.0 * (6.0 - x.hypot(z)).clamp(0.0, 2.0),
};

#[test]
fn a_pit_is_an_error_or_left_out_and_named() {
    let shell = WITH_PIT.shell();
    let refused = Insert::from_surface(&shell, true, None, MESHING);
    assert!(matches!(
        refused,
        Err(InsertError::Columns(ColumnError::Holes { .. }))
    ));
    let (insert, holes) = Insert::over_holes(&shell, true, None, MESHING).unwrap();
    assert!(holes.len() == 1 && !holes[0].goes_through, "{holes:?}");
    assert!(insert.mesh().worst_quality() > 0.1);
}
