//! Whole cases read from memory.

use std::fs;
use std::path::Path;

use condyle::evolve::WearTest;
use condyle::geometry::{Counterface, GenericFemur, GenericFemurShape, TriangleMesh};

use super::assert_shows;
use crate::case::{Built, Case, CaseReader};
use condyle_mesh::files::MemoryFiles;
use condyle_mesh::formats::write_stl;

const CASE: &str = "
[femur]
shape = \"mesh\"
file = \"../shapes/femur.stl\"
[insert]
shape = \"hexahedra\"
file = \"insert.inp\"
[contact]
law = \"tabulated\"
table_file = \"pressure.csv\"
[machine.flexion]
file = \"gait.csv\"
interpolation = \"half-cosine\"
";

const INSERT: &str = "*NODE\n1, -20, -30, 30\n2, 20, -30, 30\n3, 20, -30, -30\n4, -20, -30, -30\n\
    5, -20, -24, 30\n6, 20, -24, 30\n7, 20, -24, -30\n8, -20, -24, -30\n\
    *ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n";

fn stl(mesh: &TriangleMesh) -> Vec<u8> {
    let mut bytes = Vec::new();
    write_stl(&mut bytes, mesh).expect("memory takes everything");
    bytes
}

/// The files of the case, each with its path.
fn files() -> [(&'static str, Vec<u8>); 5] {
    let femur = GenericFemur::new(GenericFemurShape::default()).surface_mesh(6.0);
    [
        ("cases/case.toml", CASE.into()),
        ("cases/insert.inp", INSERT.into()),
        (
            "cases/pressure.csv",
            "overclosure_mm,pressure_mpa\n0,0\n0.1,5\n".into(),
        ),
        (
            "cases/gait.csv",
            "percent,flexion_deg\n0,0\n25,20\n50,0\n75,60\n".into(),
        ),
        ("shapes/femur.stl", stl(&femur)),
    ]
}

fn built(case: &Case) -> Built {
    case.build(1).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn a_case_from_memory_equals_that_from_the_disk() {
    let folder = tempfile::tempdir().unwrap();
    let mut memory = MemoryFiles::default();
    for (path, bytes) in files() {
        let on_disk = folder.path().join(path);
        fs::create_dir_all(on_disk.parent().unwrap()).unwrap();
        fs::write(on_disk, &bytes).unwrap();
        memory = memory.with(path, bytes);
    }
    let there = Case::read(&folder.path().join("cases/case.toml")).unwrap();
    let here = CaseReader::new(memory).read(Path::new("cases/case.toml"));
    let here = here.unwrap_or_else(|problems| panic!("{problems}"));
    assert_eq!(here.contact, there.contact);
    assert_eq!(here.machine, there.machine);
    assert_eq!(
        here.inputs_blake3().unwrap(),
        there.inputs_blake3().unwrap()
    );
    let (here, there) = (built(&here), built(&there));
    assert_eq!(here.warnings, there.warnings);
    assert_same_test(&here.test, &there.test);
}

fn assert_same_test(here: &WearTest, there: &WearTest) {
    let field = |test: &WearTest| match test.counterface.as_ref() {
        Counterface::Mesh(field) => field.clone(),
        other => panic!("{other:?}"),
    };
    assert!(field(here) == field(there));
    assert_eq!(here.flexion_axis_mm, there.flexion_axis_mm);
    assert_eq!(here.start_mm, there.start_mm);
    assert_eq!(here.insert.mesh().nodes, there.insert.mesh().nodes);
    assert_eq!(here.insert.surface_nodes(), there.insert.surface_nodes());
    assert_eq!(
        format!("{:?}", here.machine()),
        format!("{:?}", there.machine())
    );
}

#[test]
fn a_file_that_is_not_in_memory_is_missing() {
    let files = MemoryFiles::default().with("case.toml", CASE);
    let problems = CaseReader::new(files).read(Path::new("case.toml"));
    assert_shows(
        &problems.unwrap_err().to_string(),
        &["`file`: there is no file ../shapes/femur.stl", "insert.inp"],
    );
}
