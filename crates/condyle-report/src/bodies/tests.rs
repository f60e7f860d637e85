//! The picture of both bodies.

use std::time::Instant;

use condyle_results::Side;

use super::*;

/// A sheet of `count` by `count` quads, 60 mm wide, bent up by `bend` at its ends.
fn sheet(count: u32, height_mm: f64, bend: f64) -> TriangleMesh {
    let place = |i: u32| 60.0 * (f64::from(i) / f64::from(count) - 0.5);
    let mut surface = TriangleMesh::default();
    for i in 0..=count {
        for k in 0..=count {
            let (x, z) = (place(i), place(k));
            let vertex = Vec3::new(x, height_mm + bend * x * x, z);
            surface.vertices.push(vertex);
        }
    }
    for i in 0..count {
        for k in 0..count {
            let a = i * (count + 1) + k;
            let (b, c, d) = (a + 1, a + count + 2, a + count + 1);
            surface.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    surface
}

fn drawn(femur: &TriangleMesh, insert: &TriangleMesh, side: Side) -> String {
    let contact = sheet(2, 0.1, 0.0);
    bodies_svg(&BodiesPicture {
        title: "A knee <made> of sheets",
        directions: Directions {
            side,
            ..Directions::default()
        },
        femur,
        insert,
        contact: &contact,
        axes: Some(MachineAxes {
            flexion_mm: (-5.0, 24.0),
            vv_mm: (-20.0, -5.0),
            ie_mm: (0.0, 0.0),
            ap_zero_mm: -5.0,
        }),
        caption: "settled",
    })
}

#[test]
fn a_picture_of_sixty_thousand_triangles_is_small_and_soon_there() {
    let (femur, insert) = (sheet(170, 20.0, 0.02), sheet(60, 0.0, 0.01));
    assert!(femur.triangles.len() > 55_000);
    let began = Instant::now();
    let svg = drawn(&femur, &insert, Side::Right);
    println!("{} bytes in {:?}", svg.len(), began.elapsed());
    assert!(svg.len() < 1_000_000, "{}", svg.len());
}

#[test]
fn sides_axes_and_scale_are_named() {
    let (femur, insert) = (sheet(4, 20.0, 0.02), sheet(4, 0.0, 0.01));
    let svg = drawn(&femur, &insert, Side::Right);
    roxmltree::Document::parse(&svg).unwrap();
    let words = [
        "A knee &lt;made&gt; of sheets",
        "From the front",
        "From the lateral side",
        "From above, anterior up",
        "flexion axis",
        "VV axis",
        "IE axis",
        "AP zero",
        "10 mm",
        "settled",
    ];
    for word in words {
        assert!(svg.contains(word), "{word}");
    }
    assert_eq!(svg.matches("data:image/png;base64,").count(), 3);
    assert!(drawn(&femur, &insert, Side::Left).contains("From the medial side"));
}

#[test]
fn what_is_nearer_hides_what_is_behind() {
    let (front, behind) = (sheet(3, 5.0, 0.0), sheet(3, -5.0, 0.0));
    let frame = Frame::around([&front, &behind], VIEWS[2]);
    let mut both = front.clone();
    both.vertices.extend(&behind.vertices);
    let count = front.vertices.len() as u32;
    let behind = behind.triangles.iter();
    both.triangles
        .extend(behind.map(|triangle| triangle.map(|vertex| vertex + count)));
    let (alone, together) = (Raster::new(&front, &frame), Raster::new(&both, &frame));
    assert!(alone.near == together.near && alone.near.iter().any(|near| near.is_finite()));
}

#[test]
fn nothing_to_draw_is_an_empty_picture() {
    let none = TriangleMesh::default();
    let svg = bodies_svg(&BodiesPicture {
        title: "nothing",
        directions: Directions::default(),
        femur: &none,
        insert: &none,
        contact: &none,
        axes: None,
        caption: "",
    });
    roxmltree::Document::parse(&svg).unwrap();
}
