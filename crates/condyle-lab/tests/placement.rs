//! Components placed by the keys of a case, beside files that were turned and shifted by hand.

use std::{fmt::Write, fs, ops::ControlFlow, path::Path};

use condyle::{
    Vec3,
    evolve::March,
    geometry::{GenericFemur, GenericFemurShape, GenericInsertShape, Meshing, TriangleMesh},
    machine::{CycleRow, knee::MEDIAL},
};
use condyle_case::case::Case;
use condyle_lab::Preview;
use nalgebra::Rotation3;
use tempfile::TempDir;

const SHORT: &str = "[march]\ncycles = 500_000\nupdates = 1\n[time]\nincrements = 40\n";

/// The generic dishes as triangles, moved.
fn dishes(place: impl Fn(&Vec3) -> Vec3) -> TriangleMesh {
    let meshing = Meshing {
        edge_mm: 1.0,
        layers: 1,
    };
    let insert = GenericInsertShape::default().insert(meshing).unwrap();
    let faces = insert.surface_faces().iter().copied();
    TriangleMesh::of_quads(insert.surface().positions, faces).mapped(place)
}

fn condyles(place: impl Fn(&Vec3) -> Vec3) -> TriangleMesh {
    let femur = GenericFemur::new(GenericFemurShape::default());
    femur.surface_mesh(1.5).mapped(place)
}

/// A mesh as an OBJ file, to the last digit.
fn save(folder: &TempDir, name: &str, mesh: &TriangleMesh) {
    let mut text = String::new();
    for v in &mesh.vertices {
        writeln!(text, "v {:?} {:?} {:?}", v.x, v.y, v.z).unwrap();
    }
    for [a, b, c] in mesh.triangles.iter().map(|t| t.map(|vertex| vertex + 1)) {
        writeln!(text, "f {a} {b} {c}").unwrap();
    }
    fs::write(folder.path().join(name), text).unwrap();
}

fn march(text: &str, folder: &Path) -> March {
    let case = Case::parse(text, "case.toml", folder).unwrap_or_else(|error| panic!("{error}"));
    let built = case.build(1).unwrap_or_else(|error| panic!("{error}"));
    March::start(built.test).unwrap_or_else(|error| panic!("{error}"))
}

/// Mass worn, deepest wear and the medial part of the load, of a short march.
fn worn(mut march: March) -> [f64; 3] {
    let updated = march.update(&mut |_| ControlFlow::Continue(()));
    let flow = updated.unwrap_or_else(|error| panic!("{error}"));
    assert!(flow.is_continue());
    let update = march.state().updates.last().unwrap();
    let (first, _) = march.state().activities[0].first_and_last.as_ref().unwrap();
    let sum = |value: fn(&CycleRow) -> f64| first.rows.iter().map(value).sum::<f64>();
    let medial = sum(|row| row.region_force_n[MEDIAL]) / sum(|row| row.axial_force_n);
    [update.mass_loss_mg, update.max_depth_mm, medial]
}

#[track_caller]
fn assert_alike(one: [f64; 3], other: [f64; 3], tolerance: f64) {
    for (a, b) in one.into_iter().zip(other) {
        assert!((a / b - 1.0).abs() < tolerance, "{one:?} {other:?}");
    }
}

fn insert_keys(extra: &str) -> String {
    format!(
        "[insert]\nshape = \"mesh\"\nfile = \"i.obj\"\nthickness_mm = 9.0\nedge_mm = 1.5\nlayers = 2\n{extra}{SHORT}"
    )
}

fn with_insert(mesh: &TriangleMesh, extra: &str) -> March {
    let folder = tempfile::tempdir().unwrap();
    save(&folder, "i.obj", mesh);
    march(&insert_keys(extra), folder.path())
}

fn turn(axis: Vec3, degrees: f64) -> Rotation3<f64> {
    Rotation3::new(axis * degrees.to_radians())
}

#[test]
fn cross_an_insert_turned_by_hand_and_back_by_keys_wears_the_same() {
    let by_keys = turn(Vec3::y(), 6.0) * turn(Vec3::x(), -2.0) * turn(Vec3::z(), 4.0);
    let turned = dishes(|point| by_keys.inverse() * point);
    let back = "posterior_slope_deg = 4.0\ncoronal_tilt_deg = 2.0\naxial_rotation_deg = 6.0\n";
    let as_it_was = worn(with_insert(&dishes(Vec3::clone), ""));
    assert_alike(worn(with_insert(&turned, back)), as_it_was, 1e-6);
}

#[test]
fn cross_a_femur_turned_by_hand_and_back_by_keys_wears_the_same() {
    let about = Vec3::new(1.0, 2.0, 0.0);
    let shift = Vec3::new(1.0, -0.5, 0.25);
    let by_keys = turn(Vec3::y(), -3.0) * turn(Vec3::x(), 1.5) * turn(Vec3::z(), -4.0);
    let turned = condyles(|point| by_keys.inverse() * (point - about - shift) + about);
    let of = |mesh: &TriangleMesh, extra: &str| {
        let folder = tempfile::tempdir().unwrap();
        save(&folder, "f.obj", mesh);
        let femur = "[femur]\nshape = \"mesh\"\nfile = \"f.obj\"\nflexion_axis_mm = [1.0, 2.0]\n";
        let insert = "[insert]\nedge_mm = 1.5\nlayers = 2\n";
        worn(march(
            &format!("{femur}{extra}{insert}{SHORT}"),
            folder.path(),
        ))
    };
    let back = "flexion_deg = 4.0\nvarus_deg = 1.5\nexternal_rotation_deg = 3.0\n\
                anterior_offset_mm = 1.0\nsuperior_offset_mm = -0.5\nlateral_offset_mm = 0.25\n";
    assert_alike(of(&turned, back), of(&condyles(Vec3::clone), ""), 1e-6);
}

#[test]
fn verify_a_component_flexed_on_its_bone_is_a_machine_towards_hyperextension() {
    let of = |keys: &str| {
        // Archard's wear is proportional to the slip: its rounding is not amplified, as that of cross-shear is.
        let law = "[wear]\nlaw = \"archard\"\n";
        let text = format!("{keys}[insert]\nedge_mm = 1.5\nlayers = 2\n{law}{SHORT}");
        worn(march(&text, Path::new("")))
    };
    let on_bone = of("[femur]\nflexion_deg = 4.0\n");
    let in_machine = of("[machine]\nflexion_offset_deg = -11.0\n");
    assert_alike(on_bone, in_machine, 1e-5);
}

#[test]
fn verify_a_file_off_its_centre_is_loaded_as_one_that_is_centred() {
    let shift = Vec3::new(3.0, -12.0, 5.0);
    let off = dishes(|point| point + shift);
    let (centred, as_it_was) = (
        worn(with_insert(&off, "origin = \"centre\"\n")),
        worn(with_insert(&dishes(Vec3::clone), "origin = \"centre\"\n")),
    );
    assert_alike(centred, as_it_was, 1e-6);
    let [_, _, in_file] = worn(with_insert(&dishes(Vec3::clone), ""));
    let [_, _, not_centred] = worn(with_insert(&off, "[femur]\nstart_mm = [0.0, 5.0]\n"));
    assert!((centred[2] - in_file).abs() < 0.01, "{centred:?} {in_file}");
    // 5 of the 46 mm between the dishes.
    let moved = not_centred - in_file;
    assert!((moved - 5.0 / 46.0).abs() < 0.01, "{moved}");
}

#[test]
fn verify_slope_and_tilt_let_the_femur_settle_down_the_hill() {
    let settled = |keys: &str| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("case.toml");
        let text = format!("[insert]\nedge_mm = 1.5\nlayers = 2\n{keys}{SHORT}");
        fs::write(&path, text).unwrap();
        let preview = Preview::of(&path, &[], 1).unwrap_or_else(|error| panic!("{error}"));
        Vec3::from(preview.at_rest.flexion_axis_mm)
    };
    let level = settled("");
    let shift = |keys: &str| settled(keys) - level;
    // A dish of radius 55 mm that turns by 5 degrees takes its lowest place 55 sin 5 along.
    let expected_mm = 55.0 * 5f64.to_radians().sin();
    let back_mm = -shift("posterior_slope_deg = 5.0\n").x;
    assert!((back_mm - expected_mm).abs() < 0.1, "{back_mm}");
    let front_mm = shift("posterior_slope_deg = -5.0\n").x;
    assert!((front_mm - expected_mm).abs() < 0.1, "{front_mm}");
    assert!(shift("coronal_tilt_deg = 3.0\n").z < -0.5);
}
