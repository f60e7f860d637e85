//! The triangles of a body do not matter as long as they determine its surface; where they do not, the run is doubtful.

use std::path::Path;

use condyle::geometry::{GenericFemur, GenericFemurShape, TriangleMesh};
use condyle_case::{
    cache::Cache,
    case::{Case, SharedBodies},
};
use condyle_lab::batch_run;
use condyle_mesh::{
    Vec3, coarser,
    formats::{parse_surface, write_stl},
};
use condyle_results::catalogue::{MASS_LOSS_MG, PEAK_PRESSURE_MPA};

use crate::bench::{Bench, SMALL, reproducer};

/// Mass, peak pressure, and whether the mesh of the femur is doubtful.
type Outcome = (f64, f64, bool);

fn outcome(bench: &Bench, case: &str) -> Outcome {
    let said = bench.say(&["run", case, "--out", "out", "--force"]);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let summary = bench.summary("out");
    let is_doubtful = summary
        .plausibility
        .iter()
        .any(|doubt| doubt.check == "femur_mesh");
    (
        summary[&MASS_LOSS_MG],
        summary[&PEAK_PRESSURE_MPA],
        is_doubtful,
    )
}

#[track_caller]
fn assert_same_or_doubtful((mass, peak, is_doubtful): Outcome, right: Outcome, name: &str) {
    let is_same = (mass / right.0 - 1.0).abs() < 0.01 && (peak / right.1 - 1.0).abs() < 0.05;
    assert!(
        is_same || is_doubtful,
        "{name}: {mass} mg, {peak} MPa, not {right:?}"
    );
}

fn run_mesh(bench: &Bench, mesh: &TriangleMesh) -> Outcome {
    let mut stl = Vec::new();
    write_stl(&mut stl, mesh).unwrap();
    std::fs::write(bench.path("femur.stl"), stl).unwrap();
    outcome(bench, "mesh.toml")
}

#[test]
fn verify_any_triangles_of_a_femur_give_its_wear_or_a_doubt() {
    let bench = Bench::new();
    let rest = format!("{SMALL}[accuracy]\nestimate = false\n");
    bench.write("case.toml", &rest);
    let mesh = "[femur]\nshape = \"mesh\"\nfile = \"femur.stl\"\nflexion_axis_mm = [0.0, 0.0]\nstart_mm = [-7.0, 0.0]\n";
    bench.write("mesh.toml", &format!("{mesh}{rest}"));
    let right = outcome(&bench, "case.toml");
    let femur = GenericFemur::new(GenericFemurShape::default());
    // Chord errors of 0.002, 0.01, 0.03 and 0.1 mm, and beyond.
    for edge_mm in [0.6, 1.3, 2.3, 3.0, 4.2, 6.0] {
        let mut mesh = femur.surface_mesh(edge_mm);
        for divided in 0..3 {
            let name = format!("edges of {edge_mm} mm, divided {divided} times");
            let outcome = run_mesh(&bench, &mesh);
            assert_same_or_doubtful(outcome, right, &name);
            assert!(!outcome.2 || edge_mm > 2.3, "{name}: doubtful");
            if edge_mm < 1.0 {
                break;
            }
            mesh = mesh.in_four(|a, b| (a + b) / 2.0);
        }
    }
}

#[test]
fn verify_a_femur_with_long_facets_wears_as_the_same_solid_remeshed() {
    let name = "verify_a_femur_with_long_facets_wears_as_the_same_solid_remeshed";
    let Some(folder) = reproducer("second", name) else {
        return;
    };
    let bench = Bench::new();
    let run = |femur: &Path| {
        let case = std::fs::read_to_string(folder.join("pair/my.toml")).unwrap();
        let insert = folder.join("pair/insert.stl");
        let quoted = |path: &Path| format!("file = {path:?}");
        let case = case.replace("file = \"femur.stl\"", &quoted(femur));
        bench.write(
            "case.toml",
            &case.replace("file = \"insert.stl\"", &quoted(&insert)),
        );
        outcome(&bench, "case.toml")
    };
    // Both are doubtful, since they touch the sharp edges of their notch, and alike all the same.
    let right = run(&folder.join("pair/femur.stl"));
    for file in ["femur.stl", "femur_sub8mm.stl"] {
        let (mass, peak, _) = run(&folder.join("cad-femur").join(file));
        assert_same_or_doubtful((mass, peak, false), right, file);
    }
}

/// The insert of the repository, decimated to some chord error and divided into shorter triangles.
#[test]
fn verify_any_triangles_of_an_insert_give_its_wear_or_a_doubt() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/cad-knee"));
    let bench = Bench::new();
    let file = |name: &str| format!("file = {:?}", folder.join(name));
    bench.write(
        "case.toml",
        &format!(
            "[femur]\nshape = \"mesh\"\n{}\naxes = [\"right\", \"anterior\", \"superior\"]\nstart_mm = [-6.2, 0.0]\n\
             [insert]\nshape = \"mesh\"\n{}\naxes = [\"right\", \"anterior\", \"superior\"]\nedge_mm = 1.05\nlayers = 2\n\
             [march]\nupdates = 2\n[time]\nincrements = 120\n[accuracy]\nestimate = false\n",
            file("femur.stl"),
            file("insert.stl")
        ),
    );
    let right = outcome(&bench, "case.toml");
    let stl = folder.join("insert.stl");
    let insert = parse_surface(&stl, &std::fs::read(&stl).unwrap()).unwrap();
    let case = std::fs::read_to_string(bench.path("case.toml")).unwrap();
    bench.write(
        "mesh.toml",
        &case.replace(&file("insert.stl"), "file = \"decimated.stl\""),
    );
    let undivided = 100.0;
    for (chord_mm, side_mm) in [
        (0.002, 3.0),
        (0.01, 2.0),
        (0.03, undivided),
        (0.03, 2.0),
        (0.1, undivided),
        (0.1, 2.0),
        (0.5, undivided),
        (0.5, 2.0),
    ] {
        let mesh = coarser(&insert, chord_mm).with_sides_up_to(side_mm, |a, b| (a + b) / 2.0);
        let mut stl = Vec::new();
        write_stl(&mut stl, &mesh).unwrap();
        std::fs::write(bench.path("decimated.stl"), stl).unwrap();
        let outcome = outcome(&bench, "mesh.toml");
        let doubts = bench.summary("out").plausibility;
        let is_named = doubts.iter().any(|doubt| doubt.check == "insert_mesh");
        let small = chord_mm < 0.02;
        assert!(!(small && is_named), "{chord_mm} mm is doubtful");
        let name = format!("{chord_mm} mm, {} triangles", mesh.triangles.len());
        println!("{name}: {outcome:?} {right:?} {is_named}");
        assert_same_or_doubtful((outcome.0, outcome.1, is_named), right, &name);
    }
}

/// Vertices of the femur of the repository scattered by a standard deviation.
#[test]
fn a_scan_with_noise_is_doubtful_in_runs_and_in_studies() {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/cad-knee"));
    let stl = folder.join("femur.stl");
    let femur = parse_surface(&stl, &std::fs::read(&stl).unwrap()).unwrap();
    let bench = Bench::new();
    let case = format!(
        "[femur]\nshape = \"mesh\"\nfile = \"femur.stl\"\naxes = [\"right\", \"anterior\", \"superior\"]\n\
         start_mm = [-6.2, 0.0]\n[insert]\nshape = \"mesh\"\nfile = {:?}\naxes = [\"right\", \"anterior\", \"superior\"]\n\
         edge_mm = 2.0\nlayers = 1\n[march]\nupdates = 1\n[time]\nincrements = 40\n[accuracy]\nestimate = false\n",
        folder.join("insert.stl")
    );
    bench.write("case.toml", &case);
    for (scatter_mm, is_noisy) in [(0.002, false), (0.02, true)] {
        let mut scan = femur.clone();
        for (at, vertex) in scan.vertices.iter_mut().enumerate() {
            // Multiples of the golden section are spread evenly over 0 to 1: their deviation is 1 / sqrt(12).
            let part = |times: f64| (at as f64 * times * 0.618_033_988_75).fract() - 0.5;
            *vertex += Vec3::new(part(1.0), part(3.0), part(7.0)) * (scatter_mm * 12f64.sqrt());
        }
        let mut bytes = Vec::new();
        write_stl(&mut bytes, &scan).unwrap();
        std::fs::write(bench.path("femur.stl"), bytes).unwrap();
        let out = format!("scatter-{scatter_mm}");
        bench.run_into(&out);
        let in_study = batch_run(
            &Case::read(&bench.path("case.toml")).unwrap(),
            &Cache::off(),
            &SharedBodies::default(),
        );
        for summary in [bench.summary(&out), in_study.unwrap()] {
            let mut doubts = summary.plausibility.iter();
            let doubt = doubts.find(|doubt| doubt.check == "noisy_mesh");
            assert_eq!(doubt.is_some(), is_noisy, "{scatter_mm} mm: {doubt:?}");
            let found_mm = doubt.map_or(scatter_mm, |doubt| doubt.value);
            assert!((found_mm / scatter_mm - 1.0).abs() < 0.3, "{found_mm} mm");
        }
    }
}

#[test]
fn few_triangles_are_named_as_the_cause() {
    let bench = Bench::new();
    let mesh = "[femur]\nshape = \"mesh\"\nfile = \"femur.stl\"\nflexion_axis_mm = [0.0, 0.0]\nstart_mm = [-7.0, 0.0]\n";
    bench.write("mesh.toml", &format!("{mesh}{SMALL}"));
    let femur = GenericFemur::new(GenericFemurShape::default());
    let coarse = femur.surface_mesh(9.0);
    assert!(coarse.triangles.len() < 400, "{}", coarse.triangles.len());
    let mut stl = Vec::new();
    write_stl(&mut stl, &coarse).unwrap();
    std::fs::write(bench.path("femur.stl"), stl).unwrap();
    let said = bench.say(&["run", "mesh.toml", "--out", "out"]);
    let shown = format!("{}{}", said.out, said.err);
    assert!(shown.contains("triangles of its mesh"), "{shown}");
}
