//! The same case gives the same bytes, whenever and on however many threads.

use condyle_results::catalogue;
use std::path::Path;

use crate::bench::{Bench, SMALL, assert_same_bytes, cases_with_data, dm_cases};
use crate::shapes::{FLEXED_A_LITTLE, femur, insert, stl};

/// Runs the bench's case twice on one thread and once on two.
#[track_caller]
fn assert_deterministic(bench: &Bench) {
    let runs = [("one", "1"), ("again", "1"), ("two", "2")];
    for (out, threads) in runs {
        let said = bench.say(&["run", "case.toml", "--out", out, "--threads", threads]);
        assert_eq!(said.code, Some(0), "{}", said.err);
    }
    assert_same_bytes(&bench.path("one"), &bench.path("again"));
    assert_same_bytes(&bench.path("one"), &bench.path("two"));
}

#[test]
fn a_generic_implant() {
    assert_deterministic(&Bench::with_case(SMALL));
}

#[test]
fn an_implant_of_triangles() {
    let meshes = "[femur]\nshape = \"mesh\"\nfile = \"femur.stl\"\n";
    let text = SMALL
        .replace(
            "[insert]",
            &format!("{meshes}[insert]\nshape = \"mesh\"\nfile = \"insert.stl\""),
        )
        .replace("edge_mm = 2.5", "edge_mm = 1.5")
        + FLEXED_A_LITTLE;
    let bench = Bench::with_case(&text);
    bench.write("femur.stl", &stl(&femur()));
    bench.write("insert.stl", &stl(&insert()));
    assert_deterministic(&bench);
}

#[test]
fn the_implant_of_the_repository() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let data = cases.join("cad-knee").canonicalize().unwrap();
    let text = std::fs::read_to_string(cases.join("cad-knee.toml")).unwrap();
    let text = text
        .replace("\"cad-knee/", &format!("\"{}/", data.to_string_lossy()))
        .replace("edge_mm = 1.05", "edge_mm = 2.5")
        .replace("updates = 10", "updates = 1\n[time]\nincrements = 60");
    let bench = Bench::with_case(&text);
    assert_deterministic(&bench);
    assert!(bench.summary("one")[&catalogue::MASS_LOSS_MG] > 0.0);
}

#[test]
fn the_implant_of_subject_dm() {
    let Some(cases) = dm_cases("the_implant_of_subject_dm") else {
        return;
    };
    let data = cases
        .join("../../shared/data/dm-knee")
        .canonicalize()
        .unwrap();
    for name in ["dm-knee.toml", "dm-knee-displacement.toml"] {
        let text = std::fs::read_to_string(cases.join(name)).unwrap();
        let text = text
            .replace("../../shared/data/dm-knee", &data.to_string_lossy())
            .replace("edge_mm = 1.05", "edge_mm = 2.5")
            .replace("updates = 10", "updates = 1\n[time]\nincrements = 60");
        let bench = Bench::with_case(&text);
        assert_deterministic(&bench);
        assert!(bench.summary("one")[&catalogue::MASS_LOSS_MG] > 0.0);
    }
}

/// Returns the case of the conforming implant with edges of `edge_mm`, a single update and `increments`; none without its data.
fn conforming(test: &str, edge_mm: f64, increments: usize) -> Option<String> {
    let cases = cases_with_data(test, "cams-knee/tibia_inlay_JWI_meters.stl")?;
    let data = cases.join("../../shared/data/cams-knee");
    let text = std::fs::read_to_string(cases.join("cams-knee.toml")).unwrap();
    Some(
        text.replace(
            "../../shared/data/cams-knee",
            &data.canonicalize().unwrap().to_string_lossy(),
        )
        .replace("edge_mm = 0.7", &format!("edge_mm = {edge_mm:.1}"))
        .replace(
            "updates = 50",
            &format!("updates = 1\n[time]\nincrements = {increments}"),
        ),
    )
}

#[test]
fn a_conforming_implant() {
    let Some(text) = conforming("a_conforming_implant", 2.5, 60) else {
        return;
    };
    let bench = Bench::with_case(&text);
    assert_deterministic(&bench);
    assert!(bench.summary("one")[&catalogue::MASS_LOSS_MG] > 0.0);
}

/// In swing, this insert hardly rests: loads and backside settle only with exact equilibria.
#[test]
fn a_conforming_implant_rests_on_its_tray() {
    let test = "a_conforming_implant_rests_on_its_tray";
    let Some(text) = conforming(test, 2.0, 200) else {
        return;
    };
    let friction = "friction = 0.07\n";
    let resting =
        format!("{friction}model = \"deformable\"\n[contact.deformable]\nbackside = \"resting\"\n");
    let without = "[accuracy]\nestimate = false\n";
    let bench = Bench::with_case(&(text.replace(friction, &resting) + without));
    bench.run_into("out");
    assert!(bench.summary("out")[&catalogue::MASS_LOSS_MG] > 0.0);
}
