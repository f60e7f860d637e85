//! Bodies that make no knee: said with the mesh, and at the key of the case that is behind it.

use crate::bench::{Bench, SMALL};
use crate::shapes::{self, FLEXED_A_LITTLE, Triangle, inside_out, stl};
use condyle_results::catalogue;

const MESH_INSERT: &str = "[insert]\nshape = \"mesh\"\nfile = \"insert.stl\"\nedge_mm = 1.5\n";
const MESH_FEMUR: &str = "[femur]\nshape = \"mesh\"\nfile = \"femur.stl\"\n";
const SHORT: &str = "[march]\nupdates = 1\n[time]\nincrements = 40\nmost_cycles_to_repeat = 1\n";

/// A bench with an insert and a femur of triangles, and a case that begins as `text` does.
fn knee(text: &str, insert: &[Triangle], femur: &[Triangle]) -> Bench {
    let bench = Bench::with_case(&format!("{text}{SHORT}{FLEXED_A_LITTLE}"));
    bench.write("insert.stl", &stl(insert));
    bench.write("femur.stl", &stl(femur));
    bench
}

fn knee_of(text: &str) -> Bench {
    knee(text, &shapes::insert(), &shapes::femur())
}

#[track_caller]
fn assert_refused(bench: &Bench, code: i32, words: &[&str]) {
    let said = bench.say(&["run", "case.toml", "--out", "out"]);
    said.assert_refused(code, words);
    assert!(said.err.contains('^'), "no caret in\n{}", said.err);
    assert!(
        !bench.path("out").exists(),
        "a failed start leaves a folder"
    );
    let checked = bench.say(&["check", "case.toml"]);
    assert_eq!((checked.code, checked.err), (Some(code), said.err));
}

#[track_caller]
fn assert_runs(bench: &Bench, warnings: &[&str]) {
    let said = bench.run_into("out");
    let summary = bench.summary("out");
    assert!(summary[&catalogue::MASS_LOSS_MG] > 0.0);
    assert_eq!(summary.warnings.len(), warnings.len(), "{}", said.err);
    for (warning, expected) in summary.warnings.iter().zip(warnings) {
        assert!(warning.contains(expected), "{warning}");
        assert!(said.err.contains(&format!("warning: {warning}")));
    }
}

#[test]
fn a_sound_knee_of_triangles_runs_without_a_warning() {
    assert_runs(&knee_of(&format!("{MESH_INSERT}{MESH_FEMUR}")), &[]);
}

#[test]
fn a_shell_that_crosses_itself() {
    let mut crossing = shapes::insert();
    crossing.extend(shapes::block([-5.0, 5.0, -5.0], [5.0, 30.0, 5.0]));
    let bench = knee(
        &format!("{MESH_INSERT}{MESH_FEMUR}"),
        &crossing,
        &shapes::femur(),
    );
    let words = [
        "insert.stl: the surface is not sound where bodies can touch: 44 pairs of triangles that cross at",
        "repair the mesh there",
        "case.toml:3:8",
    ];
    assert_refused(&bench, 2, &words);
    let mut crossing = shapes::femur();
    crossing.extend(shapes::block([-5.0, -25.0, 10.0], [5.0, 0.0, 15.0]));
    let bench = knee(
        &format!("{MESH_INSERT}{MESH_FEMUR}"),
        &shapes::insert(),
        &crossing,
    );
    let words = [
        "femur.stl: the surface is not sound where bodies can touch",
        "triangles that cross at",
        "case.toml:7:8",
    ];
    assert_refused(&bench, 2, &words);
}

#[test]
fn normals_inside_out_are_turned_round_with_a_warning() {
    let (insert, femur) = (inside_out(shapes::insert()), inside_out(shapes::femur()));
    let bench = knee(&format!("{MESH_INSERT}{MESH_FEMUR}"), &insert, &femur);
    let turned = |file: &str| format!("{file}: the triangles faced inwards and were reversed");
    assert_runs(&bench, &[&turned("insert.stl"), &turned("femur.stl")]);
    let sound = knee_of(&format!("{MESH_INSERT}{MESH_FEMUR}"));
    sound.run_into("out");
    let mass_mg = |bench: &Bench| bench.summary("out")[&catalogue::MASS_LOSS_MG];
    assert!((mass_mg(&bench) / mass_mg(&sound) - 1.0).abs() < 1e-6);
}

#[test]
fn an_open_insert_needs_a_thickness() {
    let open = |more: &str| {
        let text = format!("{MESH_INSERT}{more}{MESH_FEMUR}");
        knee(&text, &shapes::open_insert(), &shapes::femur())
    };
    let words = [
        "insert.stl: the insert's surface is open",
        "give thickness_mm",
        "case.toml:3:8",
    ];
    assert_refused(&open(""), 2, &words);
    assert_runs(&open("thickness_mm = 9.0\n"), &[]);
    let closed = knee_of(&format!("{MESH_INSERT}thickness_mm = 9.0\n{MESH_FEMUR}"));
    let words = [
        "the mesh is closed",
        "remove [insert] `thickness_mm`",
        "case.toml:5:16",
    ];
    assert_refused(&closed, 2, &words);
}

#[test]
fn a_file_that_is_no_mesh() {
    let bench = knee_of(&format!("{MESH_INSERT}{MESH_FEMUR}"));
    bench.write("femur.stl", "this is no mesh");
    assert_refused(&bench, 2, &["femur.stl", "case.toml:7:8"]);
    let broken = stl(&shapes::insert()).replacen("vertex", "vertex oops", 1);
    bench.write("insert.stl", &broken);
    assert_refused(&bench, 2, &["insert.stl:4: ", "case.toml:3:8"]);
}

#[test]
fn an_insert_so_steep_that_no_column_stands_in_it() {
    // So high a body is taken for one with its tray unless the case says where the polyethylene ends.
    let text = MESH_INSERT.replace("edge_mm = 1.5\n", "edge_mm = 2.0\nclip_below_mm = 0.01\n");
    let steep = shapes::wedge(10.0);
    let bench = knee(&format!("{text}{MESH_FEMUR}"), &steep, &shapes::femur());
    let words = [
        "insert.stl: no column",
        "use a smaller edge_mm",
        "case.toml:4:11",
    ];
    assert_refused(&bench, 2, &words);
}

#[test]
fn two_bodies_apart() {
    let sphere = "[femur]\nshape = \"sphere\"\nstart_mm = [90.0, 0.0]\n";
    let words = [
        "apart",
        "lowered at x 90.0",
        "check length_unit, axes and start_mm",
        "case.toml:3:12",
    ];
    assert_refused(&Bench::with_case(&format!("{sphere}{SMALL}")), 2, &words);
    let far = |[x, y, z]: [f64; 3]| [x + 500.0, y, z];
    let femur = shapes::moved(shapes::femur(), false, far);
    let text = format!("{MESH_INSERT}{MESH_FEMUR}length_unit = \"mm\"\n");
    let bench = knee(&text, &shapes::insert(), &femur);
    assert_refused(
        &bench,
        2,
        &["counterface and insert are apart", "case.toml:8:15"],
    );
}

#[test]
fn two_bodies_deeply_overlapped_at_the_start() {
    let locked = "[machine.freedoms.is]\ndrive = \"locked\"\nlocked_at_mm = -6.0\n";
    let words = ["overlap by", "more than half", "case.toml:3:16"];
    assert_refused(&Bench::with_case(&format!("{locked}{SMALL}")), 2, &words);
    let heavy = "[machine.axial_force]\nknots_n = [[0, 2000]]\n\
        [machine.freedoms.vv]\ndrive = \"locked\"\n[machine.freedoms.ml]\ndrive = \"locked\"\n";
    let flat = SMALL.replace(
        "[insert]",
        "[femur]\nshape = \"sphere\"\n[insert]\nshape = \"flat\"",
    );
    let soft = format!("[material]\nyoungs_modulus_mpa = 1.0\n{heavy}{flat}");
    let words = [
        "counterface and insert overlap by",
        "the material",
        "case.toml:2:22",
    ];
    assert_refused(&Bench::with_case(&soft), 2, &words);
}

#[test]
fn a_femur_that_slides_off_is_physics() {
    let text = format!("[femur]\nshape = \"sphere\"\nstart_mm = [22.0, 0.0]\n{SMALL}");
    let words = [
        "the counterface does not settle",
        "check axes and start_mm",
        "case.toml:3:12",
    ];
    assert_refused(&Bench::with_case(&text), 3, &words);
}

#[test]
fn an_insert_worn_through_is_physics_and_what_was_computed_is_kept() {
    let text = SMALL.replace("updates = 3", "updates = 4\ncycles = 300_000_000");
    let bench = Bench::with_case(&format!("{text}[wear]\nlaw = \"archard\"\n"));
    let said = bench.say(&["run", "case.toml", "--out", "out"]);
    said.assert_refused(
        3,
        &[
            "worn through at",
            "use fewer cycles or a thicker insert",
            "kept in out",
        ],
    );
    for name in [
        "case.toml",
        "checkpoint",
        "insert_0000.vtu",
        "insert.pvd",
        "wear.csv",
    ] {
        assert!(bench.path("out").join(name).exists(), "{name}");
    }
    assert!(!bench.path("out").join("summary.json").exists());
    let again = bench.say(&["run", "case.toml", "--out", "out", "--resume"]);
    assert_eq!(again.code, Some(3));
}

/// Friction so steep that the steps asked for need many times the machine's inertia.
const HEAVY: &str = "\
[contact]
friction = 0.259
slip_tolerance_mm_per_s = 0.07
[insert]
edge_mm = 2.5
layers = 1
[march]
updates = 1
[time]
increments = 23
integrator = \"explicit\"
explicit_step_s = 1e-4
[accuracy]
estimate = false
";

#[test]
fn inertia_that_explicit_steps_were_given_is_not_passed_over() {
    let bench = Bench::with_case(HEAVY);
    let said = bench.say(&["run", "case.toml", "--out", "out"]);
    if said.code == Some(0) {
        let doubts = bench.summary("out").plausibility;
        assert!(doubts.iter().any(|doubt| doubt.check == "added_inertia"));
    }
    for words in ["times the machine's inertia added to it", "explicit_step_s"] {
        let all = format!("{}{}", said.out, said.err);
        assert!(all.contains(words), "{words}: {all}");
    }
}

#[test]
fn a_femur_that_falls_off_in_the_cycle_is_physics() {
    let pushed = "[machine.ap_force]\nknots_n = [[0, 0], [50, 2000], [100, 0]]\n";
    let loose = "[machine.springs]\nposterior_n_per_mm = 0.0\nanterior_n_per_mm = 0.0\n";
    let bench = Bench::with_case(&format!("{pushed}{loose}{SMALL}"));
    let said = bench.say(&["run", "case.toml", "--out", "out"]);
    said.assert_refused(
        3,
        &[
            "update 1: the counterface never touches the insert",
            "it was lowered at x ",
            "ends at AP ",
            " mm, ML ",
            " deg, VV ",
            "the loads and their signs, and the springs",
            "vv_axis_medial_mm",
            "kept in out",
        ],
    );
    assert!(!bench.path("out/summary.json").exists());
}

/// Two layers of hexahedra, the upper of which lies on the lower and shares no node with it.
fn unjoined_layers() -> String {
    let (along, across) = (8, 12);
    let mut nodes = String::from("*NODE\n");
    let mut hexes = String::from("*ELEMENT, TYPE=C3D8\n");
    let mut number = 0;
    for (layer, heights) in [[-9.0, -4.0], [-4.0, 0.0]].iter().enumerate() {
        let first = |level: usize| 1 + (2 * layer + level) * (along + 1) * (across + 1);
        for (level, y) in heights.iter().enumerate() {
            for place in 0..(along + 1) * (across + 1) {
                let (i, k) = (place % (along + 1), place / (along + 1));
                let (x, z) = (5.0 * i as f64 - 20.0, 5.0 * k as f64 - 30.0);
                nodes += &format!("{}, {x}, {y}, {z}\n", first(level) + place);
            }
        }
        for (i, k) in (0..along).flat_map(|i| (0..across).map(move |k| (i, k))) {
            let corner = |di: usize, dk: usize| (i + di) + (k + dk) * (along + 1);
            let around = [corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)];
            let both = [0, 1].map(|level| around.map(|place| first(level) + place));
            let corners = both.as_flattened().iter().map(ToString::to_string);
            number += 1;
            hexes += &format!("{number}, {}\n", corners.collect::<Vec<_>>().join(", "));
        }
    }
    let faces = |first: usize, face: &str| {
        let elements = first..first + along * across;
        elements
            .map(|element| format!("{element}, {face}\n"))
            .collect::<String>()
    };
    let (top, bottom) = (faces(1 + along * across, "S2"), faces(1, "S1"));
    format!(
        "{nodes}{hexes}*SURFACE, TYPE=ELEMENT, NAME=TOP\n{top}*SURFACE, TYPE=ELEMENT, NAME=BOTTOM\n{bottom}"
    )
}

#[test]
fn layers_of_hexahedra_that_are_not_joined_are_refused() {
    let insert = "[insert]\nshape = \"hexahedra\"\nfile = \"insert.inp\"\narticulating_surface = \"TOP\"\nbackside = \"BOTTOM\"\n";
    let bench = Bench::with_case(&format!("{insert}{SHORT}"));
    bench.write("insert.inp", &unjoined_layers());
    let words = [
        "lies at the place of node",
        "merge coincident nodes",
        "case.toml:3:8",
    ];
    assert_refused(&bench, 2, &words);
}

#[test]
fn a_load_that_presses_a_yielding_insert_flat_is_physics() {
    let soft = "yield_stress_mpa = 0.5\nhardening = [[0.0, 0.5]]\n";
    let contact = format!(
        "[contact]\nmodel = \"deformable\"\n[contact.deformable]\nplasticity = \"j2\"\n{soft}"
    );
    let bench = Bench::with_case(&format!("{contact}{SMALL}"));
    let said = bench.say(&["run", "case.toml", "--out", "out"]);
    let words = [
        "update 1",
        "the load presses the insert flat",
        "check the load, and [contact.deformable] yield_stress_mpa and its hardening",
        "kept in out",
    ];
    said.assert_refused(3, &words);
}
