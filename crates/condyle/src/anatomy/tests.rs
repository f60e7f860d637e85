use super::{Likeness, Orientation, Recognition, Sureness, Upright, start_over_the_dishes_mm};
use crate::{
    Mat3, Vec3,
    geometry::{
        GenericFemur, GenericFemurShape, GenericInsertShape, Insert, Meshing, TriangleMesh,
        flat_insert,
    },
};

fn generic_femur() -> TriangleMesh {
    GenericFemur::new(GenericFemurShape::default()).surface_mesh(1.0)
}

/// The generic insert as a closed shell of triangles.
fn generic_insert() -> TriangleMesh {
    let (edge_mm, layers) = (2.0, 1);
    let insert = GenericInsertShape::default().insert(Meshing { edge_mm, layers });
    boundary(&insert.unwrap())
}

fn boundary(insert: &Insert) -> TriangleMesh {
    let mesh = insert.mesh();
    TriangleMesh::of_quads(mesh.nodes.clone(), mesh.boundary_quads())
}

/// Returns the shape as a file with axes of this `orientation` stores it.
fn turned(mesh: &TriangleMesh, orientation: &Orientation) -> TriangleMesh {
    let back = orientation.rotation().transpose();
    mesh.clone().mapped(|vertex| back * vertex)
}

fn rejected(mesh: &TriangleMesh, recognise: fn(&TriangleMesh) -> Option<Recognition>) -> usize {
    let in_each = |orientation: Orientation| recognise(&turned(mesh, &orientation)).unwrap();
    let all = Orientation::all().map(in_each);
    all.filter(|recognition| recognition.against(&Orientation::ISB).is_some())
        .count()
}

#[test]
fn a_femur_lying_any_other_way_is_told_and_the_right_one_is_not() {
    let femur = generic_femur();
    assert_eq!(rejected(&femur, Recognition::of_femur), 23);
    let right = Recognition::of_femur(&femur).unwrap();
    assert_eq!(right.against(&Orientation::ISB), None);
}

#[test]
fn an_insert_with_equal_ends_is_told_but_for_back_to_front() {
    let insert = generic_insert();
    assert_eq!(rejected(&insert, Recognition::of_insert), 22);
    let right = Recognition::of_insert(&insert).unwrap();
    assert_eq!(right.against(&Orientation::ISB), None);
    assert_eq!(right.best().count(), 2);
    assert_eq!(right.sureness(), None);
}

#[test]
fn what_was_turned_is_turned_back() {
    let femur = generic_femur();
    for orientation in Orientation::all() {
        let recognition = Recognition::of_femur(&turned(&femur, &orientation)).unwrap();
        let best: Vec<_> = recognition.best().collect();
        assert_eq!(best, [orientation]);
        assert!(recognition.sureness() >= Some(Sureness::Likely));
    }
}

#[test]
fn neither_size_nor_place_nor_cutting_nor_side_matters() {
    let shift = Vec3::new(3.0, -40.0, 9.0);
    let changes: [fn(&Vec3) -> Vec3; 3] =
        [|v| v / 1000.0, |v| v * 12.0, |v| Vec3::new(v.x, v.y, -v.z)];
    for change in changes {
        let femur = generic_femur().mapped(|v| change(v) + shift);
        assert_eq!(rejected(&femur, Recognition::of_femur), 23);
    }
    let coarse = GenericFemur::new(GenericFemurShape::default()).surface_mesh(4.0);
    assert_eq!(rejected(&coarse, Recognition::of_femur), 23);
}

#[test]
fn shapes_of_no_knee_are_not_accused() {
    let (edge_mm, layers) = (2.0, 1);
    let block = flat_insert((46.0, 72.0), 9.0, Meshing { edge_mm, layers }).unwrap();
    let block = boundary(&block);
    assert!(Recognition::of_insert(&block).is_none());
    assert!(Recognition::of_femur(&block).is_none());
    let insert = generic_insert();
    assert!(Recognition::of_femur(&insert).is_none());
    assert!(Recognition::of_femur(&TriangleMesh::default()).is_none());
    assert!(Recognition::of_insert(&generic_femur()).is_none());
}

/// One condyle or one dish could be part of a knee, and is neither accepted nor rejected.
#[test]
fn one_side_alone_is_not_accused() {
    let half = |mut mesh: TriangleMesh| {
        let is_lateral = |corner: &u32| mesh.vertices[*corner as usize].z > 0.0;
        mesh.triangles
            .retain(|triangle| triangle.iter().all(is_lateral));
        let vertices = &mesh.vertices;
        let corners = mesh.triangles.iter().flatten();
        TriangleMesh {
            vertices: corners.map(|&corner| vertices[corner as usize]).collect(),
            triangles: (0..mesh.triangles.len() as u32)
                .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
                .collect(),
        }
    };
    assert!(Recognition::of_femur(&half(generic_femur())).is_none());
    assert!(Recognition::of_insert(&half(generic_insert())).is_none());
}

/// The distal arc's centre, 16 mm out at 20 degrees behind straight down, leans 7 degrees further forward.
#[test]
fn verify_the_generic_femur_starts_with_its_lowest_points_over_the_dishes() {
    let (femur, insert) = (generic_femur(), generic_insert());
    let (x, z) = start_over_the_dishes_mm(&femur, &insert, -7f64.to_radians()).unwrap();
    let expected = -16.0 * 27f64.to_radians().sin();
    assert!((x - expected).abs() < 1.0 && z.abs() < 1e-6, "{x} {z}");
}

fn rotation(axis: Vec3, degrees: f64) -> Mat3 {
    let cross = axis.normalize().cross_matrix();
    let (sine, cosine) = degrees.to_radians().sin_cos();
    Mat3::identity() + cross * sine + cross * cross * (1.0 - cosine)
}

/// The symmetric bodies repeat themselves only roughly under their samples: a degree is left.
#[test]
fn a_pair_turned_about_any_axis_is_turned_back() {
    let (femur, insert) = (generic_femur(), generic_insert());
    for (axis, degrees) in [
        (Vec3::x(), 5.0),
        (Vec3::y(), 20.0),
        (Vec3::z(), 35.0),
        (Vec3::new(1.0, 2.0, -1.0), 27.0),
    ] {
        let turn = rotation(axis, degrees);
        let shift = Vec3::new(1000.0, -700.0, 300.0);
        let [femur, insert] =
            [&femur, &insert].map(|mesh| mesh.clone().mapped(|v| turn * v + shift));
        let of_femur = Upright::of_femur(&femur).unwrap();
        let of_insert = Upright::of_insert(&insert).unwrap();
        let of_insert = of_insert.on_bone_of(&of_femur, &insert);
        let of_femur = of_femur.in_frame_of(&of_insert, &femur);
        for upright in [of_insert, of_femur] {
            assert!(
                (upright.off_square_deg() - degrees).abs() < 1.5,
                "{axis} {degrees} {}",
                upright.off_square_deg()
            );
            let left = upright.rotation() * turn;
            let nearest = Orientation::nearest_to(&left).rotation();
            let trace = (nearest.transpose() * left).trace();
            assert!(
                trace > 1.0 + 2.0 * 1.5f64.to_radians().cos(),
                "{axis} {degrees}"
            );
        }
    }
}

#[test]
fn square_bodies_are_not_turned() {
    let away = |v: &Vec3| v + Vec3::new(1000.0, -700.0, 300.0);
    for mesh in [generic_insert(), generic_insert().mapped(away)] {
        assert_eq!(Upright::of_insert(&mesh).unwrap().turn, None);
    }
    for mesh in [generic_femur(), generic_femur().mapped(away)] {
        assert_eq!(Upright::of_femur(&mesh).unwrap().turn, None);
    }
}

/// A ball, or its lower half, of 20-degree facets.
fn ball(radius: f64, is_half: bool) -> TriangleMesh {
    let octahedron = TriangleMesh {
        vertices: [0, 1, 2]
            .into_iter()
            .flat_map(|axis| [Vec3::ith(axis, 1.0), Vec3::ith(axis, -1.0)])
            .collect(),
        triangles: vec![
            [0, 2, 4],
            [2, 1, 4],
            [1, 3, 4],
            [3, 0, 4],
            [2, 0, 5],
            [1, 2, 5],
            [3, 1, 5],
            [0, 3, 5],
        ],
    };
    let middle = |a: &Vec3, b: &Vec3| (a + b).normalize();
    let mut ball = octahedron.in_four(middle).in_four(middle).in_four(middle);
    if is_half {
        let places = ball.vertices.clone();
        let is_below =
            |triangle: &[u32; 3]| triangle.iter().all(|&at| places[at as usize].y < 1e-9);
        ball.triangles.retain(is_below);
    }
    ball.mapped(|vertex| vertex * radius)
}

#[test]
fn a_head_a_cup_a_tray_and_one_compartment_are_distinguished_from_a_knee() {
    let of = |mesh: &TriangleMesh| Likeness::of(mesh);
    assert!(
        matches!(of(&ball(14.0, false)), Some(Likeness::Head(radius)) if (radius - 14.0).abs() < 0.2)
    );
    assert_eq!(of(&ball(16.0, true)), Some(Likeness::Cup));
    let block = |low: [f64; 3], high: [f64; 3]| TriangleMesh::block(low.into(), high.into());
    let plate = block([-23.0, 0.0, -36.0], [23.0, 4.0, 36.0]);
    let stem = block([-6.0, -40.0, -6.0], [6.0, 0.0, 6.0]);
    assert_eq!(of(&plate.joined(&stem)), Some(Likeness::Tray));
    for turn in [Mat3::identity(), rotation(Vec3::new(1.0, 2.0, -1.0), 27.0)] {
        let turned = |mesh: TriangleMesh| mesh.mapped(|vertex| turn * vertex);
        assert_eq!(of(&turned(generic_femur())), Some(Likeness::Femur));
        assert_eq!(of(&turned(generic_insert())), Some(Likeness::Insert));
    }
    let narrow = generic_insert().mapped(|v| Vec3::new(v.x, v.y, v.z * 0.4));
    assert_eq!(of(&narrow), Some(Likeness::OneCompartment));
    let flat_bearing = block([-26.0, 0.0, -12.0], [26.0, 9.0, 12.0]);
    assert_eq!(of(&flat_bearing), Some(Likeness::OneCompartment));
    assert_eq!(of(&TriangleMesh::default()), None);
}

/// Returns the generic insert with another articulating surface, of height `y` over x and z.
fn insert_below(y: impl Fn(f64, f64) -> f64) -> TriangleMesh {
    let backside = generic_insert().bounds().0.y;
    generic_insert().mapped(|v| {
        let is_above = v.y > backside + 1e-9;
        Vec3::new(v.x, if is_above { y(v.x, v.z) } else { v.y }, v.z)
    })
}

/// A medial pivot: a spherical dish on the medial side, and a plane lower than its rim on the lateral one.
#[test]
fn an_insert_with_one_flat_compartment_is_no_tray() {
    let pivot = insert_below(|x, z| {
        let across = (x + 2.0).hypot(z + 22.0);
        let dish = 24.8 - (24.8f64.powi(2) - across.min(24.8).powi(2)).sqrt();
        if z > 3.0 { 0.0 } else { dish.min(6.0) }
    });
    assert_eq!(Likeness::of(&pivot), Some(Likeness::Insert));
}

/// Each side of each wall is flat, and faces along the longest extent.
#[test]
fn a_femur_with_flat_walls_is_no_tray() {
    assert_eq!(Likeness::of(&round_femur()), Some(Likeness::Femur));
}

#[test]
fn dishes_that_slope_over_a_flat_backside_are_recognised() {
    let toroid = |x: f64, z: f64| {
        let dish = |radius: f64, away: f64| radius - (radius * radius - away * away).sqrt();
        dish(50.0, x + 2.0) + dish(26.0, (z.abs() - 23.0).clamp(-12.0, 12.0))
    };
    for slope_deg in [0.0, 7.0, 9.0] {
        let slope = f64::to_radians(slope_deg).tan();
        let insert = insert_below(|x, z| toroid(x, z) + slope * x);
        let upright = Upright::of_insert(&insert).unwrap();
        assert_eq!(upright.turn, None, "{slope_deg}");
        let nearest = upright.recognition.nearest();
        assert_eq!(nearest.rotation()[(1, 1)], 1.0, "{slope_deg}");
    }
}

/// A femoral component whose condyles are parts of one cylinder, which does not show its flexion, cut square to fit the bone.
fn round_femur() -> TriangleMesh {
    let arc = (0..=36).map(|step| (180.0 + 5.0 * f64::from(step)).to_radians());
    let arc = arc.map(|angle| (24.0 * angle.cos(), 24.0 * angle.sin()));
    let outer: Vec<(f64, f64)> = [(-24.0, 12.0)]
        .into_iter()
        .chain(arc)
        .chain([(24.0, 34.0)])
        .collect();
    // From one end to the other, between two heights over the middle of the knee.
    let prism = |outer: &[(f64, f64)], low: f64, high: f64| {
        let inner = outer
            .iter()
            .map(|&(x, y)| (x.clamp(-16.0, 17.0), y.max(-15.0)));
        let section: Vec<(f64, f64)> = outer.iter().copied().chain(inner).collect();
        let at = |z: f64| section.iter().map(move |&(x, y)| Vec3::new(x, y, z));
        let (count, ends) = (outer.len() as u32, 2 * outer.len() as u32);
        let strips = (0..count - 1).flat_map(|i| {
            let [a, b, c, d] = [i, i + 1, i + 1 + count, i + count];
            let [e, f, g, h] = [a, b, c, d].map(|corner| corner + ends);
            [[a, d, c, b], [e, f, g, h], [a, b, f, e], [c, d, h, g]]
        });
        let last = count - 1;
        let closed = [
            [0, ends, ends + count, count],
            [last, last + count, last + count + ends, last + ends],
        ];
        TriangleMesh::of_quads(at(low).chain(at(high)).collect(), strips.chain(closed))
    };
    let trochlea: Vec<(f64, f64)> = outer.iter().copied().filter(|(x, _)| *x > 12.0).collect();
    let trochlea = prism(&trochlea, -10.0, 10.0).mapped(|v| Vec3::new(0.9 * v.x, 0.9 * v.y, v.z));
    prism(&outer, -34.0, -10.0)
        .joined(&prism(&outer, 10.0, 34.0))
        .joined(&trochlea)
}

#[test]
fn the_cuts_of_a_femur_show_the_flexion_that_round_condyles_do_not() {
    assert_eq!(Upright::of_femur(&round_femur()).unwrap().turn, None);
    for degrees in [12.0, 23.0, 40.0] {
        let turn = rotation(Vec3::z(), degrees);
        let found = Upright::of_femur(&round_femur().mapped(|v| turn * v)).unwrap();
        let left = found.rotation() * turn;
        let nearest = Orientation::nearest_to(&left).rotation();
        let off_deg = ((nearest.transpose() * left).trace() - 1.0) / 2.0;
        assert!(off_deg.min(1.0).acos().to_degrees() < 1.5, "{degrees}");
    }
}
