use super::*;
use crate::{
    columns::{Meshing, column_mesh},
    repair::checked_mesh,
};

const RING_MM: f64 = 14.0;
const TUBE_MM: f64 = 22.0;

/// Returns the lower side of a torus about the z axis in rows along the ring and columns across the tube; the corners of
/// every other column are half a row off.
fn torus(rows: u32, columns: u32) -> TriangleMesh {
    let place = |row: u32, column: u32| {
        let is_aside = column % 2 == 1 && row > 0 && row < rows;
        let row = f64::from(row) + if is_aside { 0.5 } else { 0.0 };
        let along = 2.4 * row / f64::from(rows) - 1.2;
        let across = 1.4 * f64::from(column) / f64::from(columns) - 0.7;
        let reach = RING_MM + TUBE_MM * across.cos();
        let place = [
            along.sin() * reach,
            -along.cos() * reach,
            TUBE_MM * across.sin(),
        ];
        Vec3::from(place.map(|x| f64::from(x as f32)))
    };
    let places = (0..=rows).flat_map(|row| (0..=columns).map(move |column| place(row, column)));
    let corner = |row: u32, column: u32| row * (columns + 1) + column;
    let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (row, column)));
    let quads = cells.map(|(i, j)| {
        [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[down, aside]| corner(i + down, j + aside))
    });
    TriangleMesh::of_quads(places.collect(), quads)
}

/// Divides every flat triangle in four, with the rounding of a file in single precision.
fn in_four(mesh: &TriangleMesh) -> TriangleMesh {
    mesh.in_four(|a, b| ((a + b) / 2.0).map(|x| f64::from(x as f32)))
}

/// Returns the gap from a point to the nearest triangle.
fn gap(curved: &DividedMesh, point: &Vec3) -> f64 {
    let triangles = 0..curved.mesh.triangles.len();
    let nearest = triangles.min_by(|&a, &b| {
        curved
            .distance2(a, point)
            .total_cmp(&curved.distance2(b, point))
    });
    let foot = curved.foot(nearest.expect("there are triangles"), point);
    (point - foot.point).dot(&foot.normal)
}

/// Returns the largest error of gaps near the middle of the torus.
fn largest_error(mesh: &TriangleMesh) -> f64 {
    let curved = DividedMesh::new(mesh);
    let mut largest: f64 = 0.0;
    for i in 0..20 {
        for j in 0..20 {
            let (along, across) = (0.09 * f64::from(i) - 0.9, 0.05 * f64::from(j) - 0.5);
            let reach = RING_MM + (TUBE_MM - 0.2) * across.cos();
            let z = (TUBE_MM - 0.2) * across.sin();
            let point = Vec3::new(along.sin() * reach, -along.cos() * reach, z);
            largest = largest.max((gap(&curved, &point) + 0.2).abs());
        }
    }
    largest
}

#[test]
fn verify_curved_triangles_are_nearer_to_a_torus_than_a_fifth_of_the_chord_error() {
    // Long facets along the ring, across it, and even ones.
    for (rows, columns) in [(80, 30), (40, 10), (20, 15), (40, 4), (80, 4)] {
        let sagitta =
            |turn: f64, count: u32, radius: f64| radius * (turn / f64::from(count)).powi(2) / 8.0;
        let around = sagitta(2.4, rows, RING_MM + TUBE_MM);
        let chord_error = around.max(sagitta(1.4, columns, TUBE_MM));
        let error = largest_error(&torus(rows, columns));
        assert!(
            error < 0.2 * chord_error,
            "{rows} {columns}: {error} of {chord_error}"
        );
    }
}

#[test]
fn verify_flat_facets_that_are_subdivided_are_as_curved_as_whole_ones() {
    let chord_error = (RING_MM + TUBE_MM) * (2.4_f64 / 40.0).powi(2) / 8.0;
    let mut mesh = torus(40, 20);
    for divisions in 0..3 {
        let error = largest_error(&mesh);
        assert!(
            error < 0.2 * chord_error,
            "{divisions}: {error} of {chord_error}"
        );
        mesh = in_four(&mesh);
    }
}

/// Returns a disc of radius 20 mm whose upper edge has a fillet of some facets, which meet the plane at 90 degrees over twice
/// their number.
fn filleted(radius_mm: f64, facets: u32) -> TriangleMesh {
    let fillet = (0..=facets).map(|n| {
        let turn = std::f64::consts::FRAC_PI_2 * f64::from(n) / f64::from(facets);
        let (sine, cosine) = turn.sin_cos();
        (
            20.0 - radius_mm * (1.0 - cosine),
            8.0 - radius_mm * (1.0 - sine),
        )
    });
    let profile: Vec<(f64, f64)> = [(0.0, 0.0), (20.0, 0.0)]
        .into_iter()
        .chain(fillet)
        .chain([(0.0, 8.0)])
        .collect();
    checked_mesh(TriangleMesh::revolved(&profile, 48))
        .unwrap()
        .mesh
}

#[test]
fn verify_a_plane_stays_flat_next_to_a_fillet() {
    for (radius_mm, facets) in [(0.2, 4), (0.3, 6), (0.5, 8)] {
        let mut disc = filleted(radius_mm, facets);
        let curved = DividedMesh::new(&disc);
        for (x, z) in [(3.0, 4.0), (10.0, -2.0), (-12.0, 9.0)] {
            let gap = gap(&curved, &Vec3::new(x, 8.5, z));
            assert!((gap - 0.5).abs() < 1e-3, "fillet of {radius_mm} mm: {gap}");
        }
        // The same plane as the backside of an insert.
        for vertex in &mut disc.vertices {
            *vertex = Vec3::new(vertex.x, -vertex.y, -vertex.z);
        }
        let meshing = Meshing {
            edge_mm: 2.0,
            layers: 2,
        };
        let (columns, _) = column_mesh(&disc, true, None, meshing).unwrap();
        let lowest = columns.mesh.nodes.iter().map(|node| node.y);
        let lowest = lowest.fold(f64::INFINITY, f64::min);
        assert!(
            (lowest + 8.0).abs() < 1e-3,
            "fillet of {radius_mm} mm: {lowest}"
        );
        // Without fillet, and with all of its cylinder.
        let (volume, most) = (columns.mesh.volume(), 400.0 * 8.0 * std::f64::consts::PI);
        assert!(volume > 0.95 * most && volume < most, "{volume}");
    }
}

#[test]
fn a_block_keeps_its_edges_and_its_inside() {
    let block = TriangleMesh::block(Vec3::zeros(), Vec3::new(20.0, 8.0, 30.0));
    for mesh in [block.clone(), in_four(&in_four(&block))] {
        let curved = DividedMesh::new(&mesh);
        assert_eq!(curved.mesh.triangles.len(), 12);
        for (point, expected) in [
            (Vec3::new(21.0, 9.0, 15.0), 2f64.sqrt()),
            (Vec3::new(-1.0, -1.0, -1.0), 3f64.sqrt()),
            (Vec3::new(20.5, 4.0, 3.0), 0.5),
            (Vec3::new(19.5, 7.5, 15.0), -0.5),
        ] {
            let gap = gap(&curved, &point);
            assert!((gap - expected).abs() < 1e-9, "{point}: {gap}");
        }
    }
}

#[test]
fn slivers_next_to_a_sharp_edge_raise_no_ridge() {
    // A cylinder that ends at a plane, with facets of its whole length.
    const SIDES: u32 = 40;
    let ring = |z: f64| {
        (0..SIDES).map(move |i| {
            let angle = std::f64::consts::TAU * f64::from(i) / f64::from(SIDES);
            Vec3::new(20.0 * angle.cos(), 20.0 * angle.sin(), z)
        })
    };
    let vertices = ring(0.0).chain(ring(60.0)).collect();
    let next = |i: u32| (i + 1) % SIDES;
    let quads = (0..SIDES).map(|i| [i, next(i), next(i) + SIDES, i + SIDES]);
    let mut mesh = TriangleMesh::of_quads(vertices, quads);
    for i in 1..SIDES - 1 {
        mesh.triangles
            .extend([[0, i + 1, i], [SIDES, SIDES + i, SIDES + i + 1]]);
    }
    let curved = DividedMesh::new(&mesh);
    for i in 0..100 {
        let angle = 0.063 * f64::from(i);
        let point = Vec3::new(
            19.8 * angle.cos(),
            19.8 * angle.sin(),
            1.0 + 0.58 * f64::from(i),
        );
        let gap = gap(&curved, &point);
        // The facets are 0.06 mm from the cylinder.
        assert!((gap + 0.2).abs() < 2e-3, "{gap}");
    }
}

/// Facets of a quarter of a cylinder between two planes that are tangent to it, each divided in sixteen.
#[test]
fn verify_divided_facets_have_the_distance_of_their_cylinder() {
    const SIDES: u32 = 12;
    const RADIUS_MM: f64 = 10.0;
    let profile = |i: u32| match i {
        0 => [-40.0, RADIUS_MM],
        i if i == SIDES + 2 => [RADIUS_MM, -40.0],
        i => {
            let angle = std::f64::consts::FRAC_PI_2 * f64::from(i - 1) / f64::from(SIDES);
            [RADIUS_MM * angle.sin(), RADIUS_MM * angle.cos()]
        }
    };
    let ring = |z: f64| (0..=SIDES + 2).map(move |i| Vec3::new(profile(i)[0], profile(i)[1], z));
    let vertices = ring(0.0).chain(ring(8.0)).collect();
    let next = SIDES + 3;
    let quads = (0..SIDES + 2).map(|i| [i, i + next, i + next + 1, i + 1]);
    let facets = TriangleMesh::of_quads(vertices, quads);
    let divided = in_four(&in_four(&facets));
    let found = Facets::new(&divided);
    assert_eq!(found.mesh.triangles.len(), facets.triangles.len());
    let chord_mm = RADIUS_MM * (1.0 - (std::f64::consts::FRAC_PI_4 / f64::from(SIDES)).cos());
    for facet in 0..found.mesh.triangles.len() {
        let largest_mm = found.chord_mm(facet, [0.5, 0.5, 0.0]);
        let middle: Vec3 = found.mesh.corners(facet).iter().sum::<Vec3>() / 3.0;
        let is_plane = middle.x < 0.0 || middle.y < 0.0;
        // The planes, which are tangent, meet a facet of the cylinder at half the angle, as small as it is.
        let range = if is_plane { 0.0..0.8 } else { 0.6..1.5 };
        assert!(
            range.contains(&(largest_mm / chord_mm)),
            "{middle:?}: {largest_mm} mm"
        );
    }
}

#[test]
fn the_rim_of_a_cylinder_is_split_and_its_side_is_not() {
    const SIDES: u32 = 24;
    let ring = |height: f64| {
        (0..SIDES).map(move |side| {
            let angle = f64::from(side) / f64::from(SIDES) * std::f64::consts::TAU;
            Vec3::new(angle.cos(), angle.sin(), height)
        })
    };
    let ends = [0.0, 1.0].map(|height| Vec3::new(0.0, 0.0, height));
    let vertices: Vec<Vec3> = ring(0.0).chain(ring(1.0)).chain(ends).collect();
    let triangles = (0..SIDES).flat_map(|a| {
        let b = (a + 1) % SIDES;
        let [c, d] = [a + SIDES, b + SIDES];
        [
            [a, b, d],
            [a, d, c],
            [b, a, 2 * SIDES],
            [c, d, 2 * SIDES + 1],
        ]
    });
    let cylinder = TriangleMesh {
        vertices,
        triangles: triangles.collect(),
    };
    let split = split_at_creases(&cylinder, 0.64);
    assert_eq!(split.vertices.len() as u32, 4 * SIDES + 2);
    let normals = split.vertex_normals();
    for (triangle, corners) in split.triangles.iter().enumerate() {
        assert_eq!(split.corners(triangle), cylinder.corners(triangle));
        for &corner in corners {
            let (place, normal) = (split.vertices[corner as usize], normals[corner as usize]);
            let wanted = if triangle % 4 < 2 {
                Vec3::new(place.x, place.y, 0.0)
            } else {
                Vec3::new(0.0, 0.0, 2.0 * place.z - 1.0)
            };
            assert!(
                (normal - wanted).norm() < 1e-9,
                "{triangle}: {normal} {wanted}"
            );
        }
    }
    assert_eq!(
        split_at_creases(&cylinder, -0.5).vertices.len(),
        cylinder.vertices.len()
    );
}
