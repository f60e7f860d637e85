//! Errors of a results folder with damaged or missing files.

use crate::fixture;

use std::path::Path;

use condyle_report::{ReportError, picture_svg, write_pictures, write_report};

/// The error of a whole folder after one file in it was replaced.
fn error_after(name: &str, text: &str) -> String {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fixture::write(folder.path());
    std::fs::write(folder.path().join(name), text).expect("the folder can be written");
    reported(folder.path(), write_report(folder.path()))
}

/// The message with the folder's own path taken out.
fn reported<T>(folder: &Path, result: Result<T, ReportError>) -> String {
    let error = result.err().expect("is wrong").to_string();
    error.replace(&folder.display().to_string(), "DIR")
}

#[test]
fn a_folder_that_is_not_there() {
    let reported = reported(Path::new("nowhere"), write_report(Path::new("nowhere")));
    assert_eq!(
        reported,
        "There is no folder DIR. Give the folder that `condyle run --out` wrote."
    );
}

#[test]
fn a_folder_without_results() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let reported = reported(folder.path(), write_report(folder.path()));
    assert!(
        reported.starts_with("The folder DIR holds no results: no summary.json,"),
        "{reported}"
    );
}

#[test]
fn a_summary_that_is_no_json() {
    let reported = error_after("summary.json", "{\n  \"cycles\": 5 5\n}");
    assert!(
        reported.starts_with("The file DIR/summary.json is not a summary in JSON:"),
        "{reported}"
    );
    assert!(reported.contains("line 2"), "{reported}");
}

#[test]
fn a_cell_that_is_no_number() {
    let reported = error_after("wear.csv", "cycles,mass_loss_mg\n0,0\n500000,much\n");
    let expected =
        "Line 3 of DIR/wear.csv holds `much` in column `mass_loss_mg`, which is not a number.";
    assert_eq!(reported, expected);
}

#[test]
fn a_row_that_is_cut_off() {
    let reported = error_after("kinematics.csv", "cycles,percent,ap_mm\n0,0,0.1\n0,0.5\n");
    assert_eq!(
        reported,
        "Line 3 of DIR/kinematics.csv has 2 values; its header names 3 columns."
    );
}

#[test]
fn a_file_that_is_no_text() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fixture::write(folder.path());
    std::fs::write(folder.path().join("case.toml"), [0xff, 0xfe, 0x00]).expect("can be written");
    let reported = reported(folder.path(), write_report(folder.path()));
    assert!(
        reported.starts_with("The file DIR/case.toml cannot be read:"),
        "{reported}"
    );
}

#[test]
fn a_mesh_that_is_damaged() {
    let reported = error_after("insert_0011.vtu", "<VTKFile");
    assert!(reported.contains("insert_0011.vtu"), "{reported}");
}

#[test]
fn a_page_that_cannot_be_written() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fixture::write(folder.path());
    std::fs::create_dir(folder.path().join("report.html")).expect("a folder can be made");
    let reported = reported(folder.path(), write_report(folder.path()));
    assert!(
        reported.starts_with("The file DIR/report.html cannot be written:"),
        "{reported}"
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
        let reported = reported(folder.path(), result);
        assert!(
            reported.starts_with(&format!("The file DIR/{name} is missing, and the ")),
            "{reported}"
        );
    }
}

#[test]
fn pictures_of_tables_without_their_columns() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    std::fs::write(folder.path().join("wear.csv"), "cycles,colour\n0,1\n").expect("can be written");
    std::fs::write(folder.path().join("kinematics.csv"), "cycles\n0\n").expect("can be written");
    let wear = reported(folder.path(), picture_svg(folder.path(), "wear"));
    let expected =
        "The file DIR/wear.csv has no rows of cycles, mass_loss_mg, which the picture wear needs.";
    assert_eq!(wear, expected);
    let kinematics = reported(folder.path(), picture_svg(folder.path(), "kinematics"));
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
    let reported = reported(folder.path(), write_pictures(folder.path()));
    assert_eq!(
        reported,
        "The file DIR/insert_*.vtu has no point data of its field, such as `wear_depth_mm`, which the picture wear_map needs."
    );
}
