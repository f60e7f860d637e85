//! What is said about a folder that is not right.

use crate::fixture;

use std::path::Path;

use condyle_report::{ReportError, picture_svg, write_pictures, write_report};

/// What is said about a whole folder after one file in it was replaced.
fn said_after(name: &str, text: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fixture::write(folder.path());
    std::fs::write(folder.path().join(name), text).expect("the folder can be written");
    said(folder.path(), write_report(folder.path()))
}

/// The message with the folder's own path taken out.
fn said<T>(folder: &Path, result: Result<T, ReportError>) -> String {
    let error = result.err().expect("is wrong").to_string();
    error.replace(&folder.display().to_string(), "DIR")
}

#[test]
fn a_folder_that_is_not_there() {
    let said = said(Path::new("nowhere"), write_report(Path::new("nowhere")));
    assert_eq!(
        said,
        "There is no folder DIR. Give the folder that `condyle run --out` wrote."
    );
}

#[test]
fn a_folder_without_results() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let said = said(folder.path(), write_report(folder.path()));
    assert!(
        said.starts_with("The folder DIR holds no results: no summary.json,"),
        "{said}"
    );
}

#[test]
fn a_summary_that_is_no_json() {
    let said = said_after("summary.json", "{\n  \"cycles\": 5 5\n}");
    assert!(
        said.starts_with("The file DIR/summary.json is not a summary in JSON:"),
        "{said}"
    );
    assert!(said.contains("line 2"), "{said}");
}

#[test]
fn a_cell_that_is_no_number() {
    let said = said_after("wear.csv", "cycles,mass_loss_mg\n0,0\n500000,much\n");
    let expected =
        "Line 3 of DIR/wear.csv holds `much` in column `mass_loss_mg`, which is not a number.";
    assert_eq!(said, expected);
}

#[test]
fn a_row_that_is_cut_off() {
    let said = said_after("kinematics.csv", "cycles,percent,ap_mm\n0,0,0.1\n0,0.5\n");
    assert_eq!(
        said,
        "Line 3 of DIR/kinematics.csv has 2 values; its header names 3 columns."
    );
}

#[test]
fn a_file_that_is_no_text() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fixture::write(folder.path());
    std::fs::write(folder.path().join("case.toml"), [0xff, 0xfe, 0x00]).expect("can be written");
    let said = said(folder.path(), write_report(folder.path()));
    assert!(
        said.starts_with("The file DIR/case.toml cannot be read:"),
        "{said}"
    );
}

#[test]
fn a_mesh_that_is_damaged() {
    let said = said_after("insert_0011.vtu", "<VTKFile");
    assert!(said.contains("insert_0011.vtu"), "{said}");
}

#[test]
fn a_page_that_cannot_be_written() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fixture::write(folder.path());
    std::fs::create_dir(folder.path().join("report.html")).expect("a folder can be made");
    let said = said(folder.path(), write_report(folder.path()));
    assert!(
        said.starts_with("The file DIR/report.html cannot be written:"),
        "{said}"
    );
}

#[test]
fn pictures_of_files_that_are_not_there() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    std::fs::write(folder.path().join("summary.json"), "{}").expect("can be written");
    for (result, name) in [
        (picture_svg(folder.path(), "wear_map"), "insert_*.vtu"),
        (picture_svg(folder.path(), "wear"), "wear.csv"),
        (picture_svg(folder.path(), "kinematics"), "kinematics.csv"),
    ] {
        let said = said(folder.path(), result);
        assert!(
            said.starts_with(&format!("The file DIR/{name} is missing, and the ")),
            "{said}"
        );
    }
}

#[test]
fn pictures_of_tables_without_their_columns() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    std::fs::write(folder.path().join("wear.csv"), "cycles,colour\n0,1\n").expect("can be written");
    std::fs::write(folder.path().join("kinematics.csv"), "cycles\n0\n").expect("can be written");
    let wear = said(folder.path(), picture_svg(folder.path(), "wear"));
    let expected =
        "The file DIR/wear.csv has no rows of cycles, mass_loss_mg, which the picture wear needs.";
    assert_eq!(wear, expected);
    let kinematics = said(folder.path(), picture_svg(folder.path(), "kinematics"));
    assert!(
        kinematics.contains("has no rows of percent, flexion_deg"),
        "{kinematics}"
    );
}

#[test]
fn a_map_of_a_mesh_without_wear() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let mut surface = fixture::surface();
    surface.fields.retain(|(name, _)| name != "wear_depth_mm");
    fixture::write_mesh(&folder.path().join("insert_0000.vtu"), &surface);
    let said = said(folder.path(), write_pictures(folder.path()));
    assert_eq!(
        said,
        "The file DIR/insert_*.vtu has no point data of its field, such as `wear_depth_mm`, which the picture wear_map needs."
    );
}
