//! The pictures as files of their own.

use crate::fixture;

use std::path::Path;

use condyle_report::{picture_svg, write_pictures};

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fixture::write(folder.path());
    folder
}

#[test]
fn pictures_are_svg_files_with_title_and_description() {
    let folder = folder();
    let names = ["wear_map", "wear", "kinematics"];
    for svg in names.map(|name| picture_svg(folder.path(), name).expect("the folder is whole")) {
        assert!(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\""));
        assert!(svg.contains("<title id") && svg.contains("<desc id"));
        assert!(!svg.contains("var(--") && !svg.contains("NaN"));
    }
}

#[test]
fn pictures_go_into_the_folder_under_their_names() {
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pictures");
    std::fs::create_dir_all(&kept).expect("a folder can be made");
    fixture::write(&kept);
    let names = write_pictures(&kept).expect("the folder is whole");
    let expected = ["wear_map.svg", "wear.svg", "kinematics.svg"].map(|name| kept.join(name));
    assert_eq!(names, expected);
}
