use super::*;
use crate::{
    Vec3,
    geometry::{
        GenericInsertShape, Meshing, checked_shell,
        shell::fixtures::{block, fused},
    },
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
    let shell = checked_shell(body).unwrap();
    assert!(shell.closed, "the fused body is not closed");
    Underside::of(&shell.mesh)
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
    let body = block(Vec3::new(-22.0, -40.0, -35.0), Vec3::new(22.0, 0.0, 35.0));
    assert!(matches!(underside_of(body), Underside::Unclear { .. }));
}
