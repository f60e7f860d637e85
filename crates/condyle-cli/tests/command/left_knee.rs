//! A left knee wears as its mirror image does, and its results lie on the left.

use condyle_mesh::formats::read_vtu_points;
use condyle_results::catalogue;

use crate::bench::{Bench, SMALL};
use crate::shapes::{FLEXED_A_LITTLE, Triangle, femur, insert, moved, stl};

fn mirrored(triangles: Vec<Triangle>) -> Vec<Triangle> {
    moved(triangles, true, |[x, y, z]| [x, y, -z])
}

#[track_caller]
fn assert_mirror_images(right: &Bench, left: &Bench) {
    right.run_into("out");
    left.run_into("out");
    for name in ["wear.csv", "kinematics.csv"] {
        let (right, left) = (right.table("out", name), left.table("out", name));
        for (column, values) in &right {
            let largest = values
                .iter()
                .fold(0.0, |most: f64, value| most.max(value.abs()));
            for (one, other) in values.iter().zip(&left[column]) {
                assert!(
                    (one - other).abs() <= 1e-7 * largest,
                    "{name} {column}: {one} {other}"
                );
            }
        }
    }
    let shares = [right, left].map(|bench| bench.summary("out")[&catalogue::MEDIAL_LOAD_SHARE]);
    assert!((shares[0] - shares[1]).abs() < 1e-7);
    for update in ["insert_0000.vtu", "insert_0002.vtu"] {
        assert_mirrored(right, left, update);
    }
}

#[track_caller]
fn assert_mirrored(right: &Bench, left: &Bench, name: &str) {
    let read = |bench: &Bench| read_vtu_points(bench.path("out").join(name)).unwrap();
    let (right, left) = (read(right), read(left));
    assert_eq!(right.mesh.nodes.len(), left.mesh.nodes.len());
    for (one, other) in right.mesh.nodes.iter().zip(&left.mesh.nodes) {
        let apart = (one.x - other.x).abs() + (one.y - other.y).abs() + (one.z + other.z).abs();
        assert!(apart < 1e-6, "{one} {other}");
    }
    assert!((right.mesh.volume() / left.mesh.volume() - 1.0).abs() < 1e-9);
    assert!(left.mesh.worst_quality() > 0.0);
    for (name, values) in &right.point_data {
        let other = left.values(name).unwrap();
        let close = |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-6 * a.abs().max(1.0);
        assert!(values.iter().zip(other).all(close), "{name}");
    }
}

#[test]
fn a_generic_implant() {
    let case = |side: &str, z: f64| {
        let start = format!("[femur]\nstart_mm = [-7.0, {z:?}]\n");
        Bench::with_case(&format!("side = \"{side}\"\n{start}{SMALL}"))
    };
    assert_mirror_images(&case("right", 0.5), &case("left", -0.5));
}

#[test]
fn an_implant_of_triangles() {
    let meshes = "\
[femur]
shape = \"mesh\"
file = \"femur.stl\"
start_mm = [0.0, START]
[insert]
shape = \"mesh\"
file = \"insert.stl\"";
    let case = |side: &str, start: &str, femur: &[Triangle], insert: &[Triangle]| {
        let text = SMALL
            .replace("edge_mm = 2.5", "edge_mm = 1.5")
            .replace("[insert]", &meshes.replace("START", start));
        let bench = Bench::with_case(&format!("side = \"{side}\"\n{text}{FLEXED_A_LITTLE}"));
        bench.write("femur.stl", &stl(femur));
        bench.write("insert.stl", &stl(insert));
        bench
    };
    let right = case("right", "0.4", &femur(), &insert());
    let left = case("left", "-0.4", &mirrored(femur()), &mirrored(insert()));
    assert_mirror_images(&right, &left);
}

#[test]
fn medial_and_lateral_name_the_axes_of_either_side() {
    let text = "\
[femur]
shape = \"mesh\"
file = \"femur.stl\"
axes = [\"anterior\", \"superior\", \"AXIS\"]
[insert]
shape = \"mesh\"
file = \"insert.stl\"
axes = [\"anterior\", \"superior\", \"AXIS\"]";
    let case = |side: &str, axis: &str, flip: bool| {
        let text = SMALL
            .replace("edge_mm = 2.5", "edge_mm = 1.5")
            .replace("[insert]", &text.replace("AXIS", axis));
        let bench = Bench::with_case(&format!("side = \"{side}\"\n{text}{FLEXED_A_LITTLE}"));
        let shape = |triangles| if flip { mirrored(triangles) } else { triangles };
        bench.write("femur.stl", &stl(&shape(femur())));
        bench.write("insert.stl", &stl(&shape(insert())));
        bench
    };
    assert_mirror_images(
        &case("right", "lateral", false),
        &case("left", "medial", true),
    );
}
