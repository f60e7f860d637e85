use condyle_mesh::repair::checked_mesh;

use super::*;
use crate::{
    Vec3,
    geometry::{GenericInsertShape, Meshing},
};

/// The generic insert as a closed shell, its underside at y = -9 mm.
fn insert() -> TriangleMesh {
    insert_of(Meshing {
        edge_mm: 2.0,
        layers: 1,
    })
}

fn insert_of(meshing: Meshing) -> TriangleMesh {
    let insert = GenericInsertShape::default().insert(meshing).unwrap();
    let quads = insert.mesh().boundary_quads();
    let cut = |[a, b, c, d]: [u32; 4]| [[a, b, c], [a, c, d]];
    TriangleMesh {
        vertices: insert.mesh().nodes.clone(),
        triangles: quads.into_iter().flat_map(cut).collect(),
    }
}

fn underside_of(body: TriangleMesh) -> Underside {
    let shell = checked_mesh(body).unwrap();
    assert!(shell.closed, "the fused body is not closed");
    Underside::find(&shell.mesh)
}

#[test]
fn an_insert_is_whole_be_it_thick_or_thin() {
    assert_eq!(underside_of(insert()), Underside::Whole);
    let thick = insert().mapped(|v| Vec3::new(v.x, if v.y < -8.9 { -24.0 } else { v.y }, v.z));
    assert_eq!(underside_of(thick), Underside::Whole);
}

#[test]
fn verify_the_insert_on_a_larger_plate_ends_at_the_ledge() {
    for stem_mm in [40.0, 8.0] {
        match underside_of(fused(insert(), -9.0, 1.06, 4.0, stem_mm)) {
            Underside::Ledge {
                height_mm,
                below_dishes_mm,
                reach_mm,
            } => {
                assert_eq!(height_mm, -9.0);
                assert!((below_dishes_mm - 9.0).abs() < 0.05, "{below_dishes_mm}");
                assert!((reach_mm - 13.0 - stem_mm).abs() < 0.05, "{reach_mm}");
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn a_plate_that_is_no_larger_does_not_show_where_the_insert_ends() {
    for (plate, ledges) in [(1.0, 0), (0.94, 1)] {
        match underside_of(fused(insert(), -9.0, plate, 4.0, 40.0)) {
            Underside::Unclear {
                plate_mm,
                ledges_mm,
                ..
            } => {
                assert!((plate_mm + 13.0).abs() < 0.01, "{plate_mm}");
                assert_eq!(ledges_mm.len(), ledges, "{ledges_mm:?}");
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn lines_on_the_diagonals_of_a_square_grid_do_not_count_twice() {
    let meshing = Meshing {
        edge_mm: 1.0,
        layers: 1,
    };
    let insert = insert_of(meshing);
    match underside_of(fused(insert, -9.0, 0.94, 4.0, 40.0)) {
        Underside::Unclear { plate_mm, .. } => {
            assert!((plate_mm + 13.0).abs() < 0.01, "{plate_mm}");
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn what_is_thicker_than_any_insert_is_unclear() {
    let body = TriangleMesh::block(Vec3::new(-22.0, -40.0, -35.0), Vec3::new(22.0, 0.0, 35.0));
    assert!(matches!(underside_of(body), Underside::Unclear { .. }));
}

/// A body with a flat underside at `height_mm`, grown together with a plate and a stem below: the plate has the
/// outline of the underside, scaled about its middle, and the stem a fifth of it.
fn fused(
    mut body: TriangleMesh,
    height_mm: f64,
    scale: f64,
    plate_mm: f64,
    stem_mm: f64,
) -> TriangleMesh {
    let outline = open_underside(&mut body, height_mm);
    let places: Vec<Vec3> = outline.iter().map(|&n| body.vertices[n as usize]).collect();
    let middle = places.iter().sum::<Vec3>() / places.len() as f64;
    let below_mm = height_mm - plate_mm;
    let rings = [
        (scale, height_mm),
        (scale, below_mm),
        (0.2, below_mm),
        (0.2, below_mm - stem_mm),
    ];
    let mut above = outline;
    let is_flat = |ring: &(f64, f64)| *ring == (1.0, height_mm);
    for (scale, y) in rings.into_iter().filter(|ring| !is_flat(ring)) {
        let place = |at: &Vec3| {
            let at = middle + (at - middle) * scale;
            Vec3::new(at.x, y, at.z)
        };
        let first = body.vertices.len() as u32;
        body.vertices.extend(places.iter().map(place));
        let below: Vec<u32> = (first..body.vertices.len() as u32).collect();
        for n in 0..above.len() {
            let after = (n + 1) % above.len();
            let quad = [above[n], below[n], below[after], above[after]];
            body.triangles
                .extend([[quad[0], quad[1], quad[2]], [quad[0], quad[2], quad[3]]]);
        }
        above = below;
    }
    let tip = body.vertices.len() as u32;
    body.vertices
        .push(Vec3::new(middle.x, below_mm - stem_mm, middle.z));
    let next = above.iter().cycle().skip(1);
    body.triangles
        .extend(above.iter().zip(next).map(|(&a, &b)| [a, tip, b]));
    body
}

/// Takes away the triangles at a height; gives the line around them, as it lies in what is left.
fn open_underside(body: &mut TriangleMesh, height_mm: f64) -> Vec<u32> {
    let heights: Vec<f64> = body.vertices.iter().map(|vertex| vertex.y).collect();
    let is_there = |n: &u32| (heights[*n as usize] - height_mm).abs() < 1e-9;
    body.triangles
        .retain(|triangle| !triangle.iter().all(is_there));
    let sides = |triangle: &[u32; 3]| {
        let [a, b, c] = *triangle;
        [(a, b), (b, c), (c, a)]
    };
    let next: std::collections::BTreeMap<u32, u32> = body
        .triangles
        .iter()
        .flat_map(sides)
        .filter(|(a, b)| is_there(a) && is_there(b))
        .collect();
    let start = *next.keys().next().unwrap();
    let mut outline = vec![start];
    while let Some(&after) = next.get(&outline[outline.len() - 1])
        && after != start
    {
        outline.push(after);
    }
    outline
}

#[test]
fn verify_areas_of_the_sections_of_a_block_on_a_smaller_one() {
    let body =
        TriangleMesh::block(Vec3::new(-10.0, 0.0, -15.0), Vec3::new(10.0, 8.0, 15.0)).joined(
            &TriangleMesh::block(Vec3::new(-4.0, -20.0, -3.0), Vec3::new(4.0, 0.5, 3.0)),
        );
    let sections = Sections::new(&body, 0.25);
    for (y, area) in [
        (7.9, 600.0),
        (0.25, 600.0),
        (-5.0, 48.0),
        (8.1, 0.0),
        (-20.1, 0.0),
    ] {
        let found = sections.area_mm2(y);
        assert!((found - area).abs() <= 0.05 * area, "{found} at {y}");
    }
}
