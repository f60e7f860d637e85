//! `condyle export` as a user calls it.

use std::{fs, path::Path};

use assert_cmd::Command;

fn export(folder: &Path, case: &str, arguments: &[&str]) -> (i32, String) {
    fs::write(folder.join("case.toml"), case).expect("the folder takes files");
    let mut command = Command::cargo_bin("condyle").expect("the command is built");
    command.current_dir(folder).arg("export").arg("case.toml");
    let output = command.args(arguments).output().expect("it runs");
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    (output.status.code().unwrap_or(-1), said)
}

const COARSE: &str = "[insert]\nshape = \"generic\"\nedge_mm = 3.0\n";

const DEFORMABLE: &str = "[contact]\nmodel = \"deformable\"\n";
const PRESSED: [&str; 4] = ["--out", "a.inp", "--pressed-at", "14"];

#[test]
fn a_file_is_written_once_and_never_overwritten() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let case = format!("{COARSE}{DEFORMABLE}");
    let (code, said) = export(folder.path(), &case, &PRESSED);
    assert_eq!((code, said.as_str()), (0, ""));
    let written = fs::read_to_string(folder.path().join("a.inp")).expect("it is there");
    assert!(written.starts_with("*HEADING\n") && written.ends_with("*END STEP\n"));
    for keyword in ["TYPE=C3D8I", "*STEP, NAME=PRESSED", "*BOUNDARY"] {
        assert!(written.contains(keyword), "no {keyword}");
    }
    // The same case by --set.
    let set = ["--set", "contact.model=deformable", "--force"];
    let (code, said) = export(folder.path(), COARSE, &[&PRESSED[..], &set].concat());
    assert_eq!((code, said.as_str()), (0, ""));
    let again = fs::read_to_string(folder.path().join("a.inp")).expect("it is there");
    assert_eq!(again, written);
    let (code, said) = export(folder.path(), &case, &PRESSED);
    assert_eq!(code, 2);
    assert!(
        said.contains("a.inp: ") && said.contains("choose another name"),
        "{said}"
    );
}

#[test]
fn a_bad_case_leaves_with_two_and_no_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let aside =
        format!("{COARSE}{DEFORMABLE}[femur]\nshape = \"sphere\"\nstart_mm = [90.0, 0.0]\n");
    for (case, expected) in [
        ("[insert]\nshape = \"round\"\n", "round"),
        (&aside, "are apart"),
    ] {
        let (code, said) = export(folder.path(), case, &PRESSED);
        assert_eq!(code, 2, "{said}");
        assert!(said.contains(expected), "{said}");
        assert!(!folder.path().join("a.inp").exists());
    }
}

#[test]
fn a_place_or_a_case_that_cannot_be_pressed_leaves_with_two_and_no_file() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let deformable = format!("{COARSE}{DEFORMABLE}");
    let kinematic = format!(
        "{deformable}[contact.deformable]\nplasticity = \"j2\"\nkinematic_modulus_mpa = 10.0\n"
    );
    let resting = format!("{deformable}[contact.deformable]\nbackside = \"resting\"\n");
    for (case, percent, expected) in [
        (
            &*resting,
            "14",
            "write [contact.deformable] backside = \"bonded\"",
        ),
        (deformable.as_str(), "101", "it must be from 0 to 100"),
        (deformable.as_str(), "half", "it must be a number"),
        (COARSE, "14", "write [contact] model = \"deformable\""),
        (&kinematic, "14", "kinematic_modulus_mpa = 10; write"),
    ] {
        let arguments = ["--out", "a.inp", "--pressed-at", percent];
        let (code, said) = export(folder.path(), case, &arguments);
        assert_eq!(code, 2, "{said}");
        assert!(said.contains(expected), "{said}");
        assert!(!folder.path().join("a.inp").exists());
    }
}
