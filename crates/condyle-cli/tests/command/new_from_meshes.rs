//! `condyle new` with two meshes, and its messages about wrong axes and units.

use std::{fs, path::Path};

use crate::bench::Bench;
use crate::shapes::{FLEXED_A_LITTLE, Triangle, block, femur, insert, stl, wedge};

/// The triangles in a file of another unit, whose x, y and z point right, anterior and superior.
fn in_cm_right_anterior_superior(triangles: &[Triangle]) -> String {
    let turned = |[x, y, z]: [f64; 3]| [z / 10.0, x / 10.0, y / 10.0];
    let turned: Vec<Triangle> = triangles
        .iter()
        .map(|triangle| triangle.map(turned))
        .collect();
    stl(&turned)
}

fn meshes() -> Bench {
    let bench = Bench::new();
    bench.write("f.stl", &in_cm_right_anterior_superior(&femur()));
    bench.write("i.stl", &in_cm_right_anterior_superior(&insert()));
    bench
}

const NEW: [&str; 6] = ["new", "my.toml", "--femur", "f.stl", "--insert", "i.stl"];

#[test]
fn a_case_of_two_meshes_checks_and_runs_at_one_attempt() {
    let bench = meshes();
    let said = bench.say(&NEW);
    assert_eq!(said.code, Some(0), "{}", said.err);
    assert!(said.err.contains("length_unit \"cm\""), "{}", said.err);
    let text = fs::read_to_string(bench.path("my.toml")).unwrap();
    assert!(
        text.contains("# femur, derived from the shape of f.stl:"),
        "{text}"
    );
    assert_eq!(text.matches("length_unit = \"cm\"").count(), 2, "{text}");
    let checked = bench.say(&["check", "my.toml"]);
    assert_eq!(checked.code, Some(0), "{}", checked.err);
    let short = text
        .replace("edge_mm = 1.05", "edge_mm = 2.5")
        .replace("updates = 10", "updates = 1")
        .replace("increments = 200", "increments = 40");
    let machine = short.find("[machine.flexion]").unwrap_or(short.len());
    let rest = short[machine..]
        .find("\n\n")
        .map_or("", |at| &short[machine + at..]);
    bench.write(
        "my.toml",
        &format!("{}{FLEXED_A_LITTLE}{rest}", &short[..machine]),
    );
    let ran = bench.say(&["run", "my.toml", "--out", "out"]);
    assert_eq!(ran.code, Some(0), "{}", ran.err);
}

#[test]
fn what_no_case_can_be_made_of_is_refused_and_nothing_written() {
    let bench = meshes();
    bench
        .say(&["new", "my.toml", "--femur", "f.stl"])
        .assert_refused(2, &["--insert"]);
    bench
        .say(&["new", "my.toml", "--side", "left"])
        .assert_refused(2, &["--femur"]);
    bench
        .say(&["new", "my.toml", "--femur", "none.stl", "--insert", "i.stl"])
        .assert_refused(2, &["none.stl"]);
    bench.write("f.stl", &stl(&block([0.0; 3], [0.6, 0.5, 0.7])));
    bench
        .say(&NEW)
        .assert_refused(2, &["f.stl", "0.7000 long", "scale it"]);
    assert!(!bench.path("my.toml").exists());
}

#[test]
fn an_insert_upside_down_is_refused_with_the_line_to_write() {
    let bench = meshes();
    let case = "[insert]\nshape = \"mesh\"\nfile = \"i.stl\"\nlength_unit = \"cm\"\n\
        axes = [\"left\", \"anterior\", \"inferior\"]\n";
    bench.write("case.toml", case);
    let said = bench.say(&["check", "case.toml"]);
    said.assert_refused(
        3,
        &["oriented upside down", "write axes = [\"", "case.toml:5"],
    );
    bench.write("case.toml", &case.replace("cm", "in"));
    let said = bench.say(&["check", "case.toml"]);
    said.assert_refused(2, &["write length_unit = \"cm\"", "case.toml:4"]);
}

/// The implant of the repository, exchanged.
#[test]
fn exchanged_bodies_are_refused_with_the_right_command() {
    let bench = cad_knee(1.0);
    let said = bench.say(&["new", "my.toml", "--femur", "i.stl", "--insert", "f.stl"]);
    let right = "exchange them: condyle new my.toml --femur f.stl --insert i.stl";
    said.assert_refused(2, &["i.stl is an insert", right]);
    assert!(!bench.path("my.toml").exists());
    let case = "[femur]\nshape = \"mesh\"\nfile = \"i.stl\"\naxes = [\"right\", \"anterior\", \"superior\"]\n\
        [insert]\nshape = \"mesh\"\nfile = \"f.stl\"\naxes = [\"right\", \"anterior\", \"superior\"]\n";
    bench.write("case.toml", case);
    let said = bench.say(&["check", "case.toml"]);
    assert_ne!(said.code, Some(0));
    assert!(
        said.err.contains("is a femoral component; exchange"),
        "{}",
        said.err
    );
}

/// The files of the implant of the repository, the femur scaled.
fn cad_knee(scale: f64) -> Bench {
    let bench = Bench::new();
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/cad-knee"));
    fs::copy(folder.join("insert.stl"), bench.path("i.stl")).unwrap();
    let mut bytes = fs::read(folder.join("femur.stl")).unwrap();
    // After 84 bytes, each triangle has 12 numbers, of which the first three are its normal, and two more bytes.
    for triangle in bytes[84..].chunks_exact_mut(50) {
        for number in triangle[12..48].chunks_exact_mut(4) {
            let value = f32::from_le_bytes(number.try_into().unwrap());
            number.copy_from_slice(&(value * scale as f32).to_le_bytes());
        }
    }
    fs::write(bench.path("f.stl"), bytes).unwrap();
    bench
}

#[test]
fn a_femur_on_the_eminence_is_reported_by_new_check_and_run() {
    let bench = cad_knee(0.8);
    let said = bench.say(&NEW);
    assert_eq!(said.code, Some(0), "{}", said.err);
    let checked = bench.say(&["check", "my.toml"]);
    assert!(!checked.out.contains("the case is good"), "{}", checked.out);
    for said in [&said.err, &checked.err] {
        let on_eminence = "of the load is on the eminence between the dishes";
        assert!(
            said.contains(on_eminence) && said.contains("unlike those of one implant"),
            "{said}"
        );
    }
    let settings = [
        "march.updates=1",
        "time.increments=40",
        "accuracy.estimate=false",
    ];
    let settings = settings.iter().flat_map(|one| ["--set", one]);
    let run: Vec<&str> = ["run", "my.toml", "--out", "out"]
        .into_iter()
        .chain(settings)
        .collect();
    let said = bench.say(&run);
    assert!(
        said.out.contains("is on the eminence between the dishes"),
        "{}{}",
        said.out,
        said.err
    );
    let bench = cad_knee(1.0);
    let said = bench.say(&NEW);
    assert!(!said.err.contains("warning"), "{}", said.err);
    let checked = bench.say(&["check", "my.toml"]);
    assert!(checked.out.contains("the case is good"), "{}", checked.out);
}

#[test]
fn a_draft_that_does_not_start_ends_with_the_code_of_its_error() {
    let bench = cad_knee(1.0);
    // A wedge of the size of an insert, on which no femur rests.
    bench.write("i.stl", &stl(&wedge(1.0)));
    let said = bench.say(&NEW);
    assert_ne!(said.code, Some(0));
    assert!(
        said.err.contains("wrote my.toml, which does not start:"),
        "{}",
        said.err
    );
    assert!(!said.out.contains("run it with"), "{}", said.out);
}

/// Returns triangles as the text of a PLY file.
#[cfg(unix)]
fn ply(triangles: &[Triangle]) -> String {
    let count = triangles.len();
    let header = format!(
        "ply\nformat ascii 1.0\nelement vertex {}\nproperty double x\nproperty double y\nproperty double z\n\
         element face {count}\nproperty list uchar int vertex_indices\nend_header\n",
        3 * count
    );
    let corners = triangles.iter().flatten();
    let corners = corners.map(|[x, y, z]| format!("{x} {y} {z}\n"));
    let faces = (0..count).map(|n| format!("3 {} {} {}\n", 3 * n, 3 * n + 1, 3 * n + 2));
    header + &corners.chain(faces).collect::<String>()
}

/// Says `words` with another program in place of Python.
#[cfg(unix)]
fn say_with_python(bench: &Bench, python: &str, words: &[&str]) -> (Option<i32>, String) {
    use std::os::unix::fs::PermissionsExt;
    fs::create_dir_all(bench.path("bin")).unwrap();
    bench.write("bin/python3", &format!("#!/bin/sh\n{python}\n"));
    let executable = fs::Permissions::from_mode(0o755);
    fs::set_permissions(bench.path("bin/python3"), executable).unwrap();
    let path = format!("{}:/usr/bin:/bin", bench.path("bin").display());
    let output = bench.command(words).env("PATH", path).output().unwrap();
    (
        output.status.code(),
        String::from_utf8_lossy(&output.stderr).into_owned(),
    )
}

#[cfg(unix)]
#[test]
fn step_files_are_converted_by_the_package_or_the_command_is_named() {
    let bench = Bench::new();
    bench.write("f.step", &ply(&femur()));
    bench.write("i.STP", &ply(&insert()));
    let new = ["new", "my.toml", "--femur", "f.step", "--insert", "i.STP"];
    let missing = "echo \"No module named condyle\" >&2; exit 1";
    let (code, err) = say_with_python(&bench, missing, &new);
    assert_eq!(code, Some(2), "{err}");
    for words in [
        "f.step: the Python package is needed to convert a STEP file",
        "No module named",
        "pip install 'condyle[cad]'",
    ] {
        assert!(err.contains(words), "{err}");
    }
    assert!(!bench.path("my.toml").exists());
    // The arguments are -m condyle.cad FILE MESH.
    let (code, err) = say_with_python(&bench, "cp \"$3\" \"$4\" && echo \"$4: $2\"", &new);
    assert_eq!(code, Some(0), "{err}");
    assert!(err.contains("f.ply: condyle.cad"), "{err}");
    let text = fs::read_to_string(bench.path("my.toml")).unwrap();
    assert!(
        text.contains("file = \"f.ply\"") && text.contains("file = \"i.ply\""),
        "{text}"
    );
    let (code, err) = say_with_python(&bench, "exit 1", &new);
    assert!(
        code == Some(2) && err.contains("f.ply exists: give it in place of f.step"),
        "{err}"
    );
}
