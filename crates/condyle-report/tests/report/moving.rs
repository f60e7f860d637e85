//! What moves on the page, from a made-up folder.

use crate::fixture;

use std::{fs, path::Path};

use condyle_report::{Results, scene::Scene, write_report};

const POSES: &str = "\
cycles,percent,origin_x_mm,origin_y_mm,origin_z_mm,r_xx,r_xy,r_xz,r_yx,r_yy,r_yz,r_zx,r_zy,r_zz
0,50,1,2,3,1,0,0,0,1,0,0,0,1
0,100,1,2,4,1,0,0,0,1,0,0,0,1
500000,50,1,2,3,1,0,0,0,1,0,0,0,1
";

fn scene_of(folder: &Path) -> Scene {
    Scene::read(
        folder,
        &Results::read(folder).expect("the last mesh is whole"),
    )
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder can be made");
    fixture::write(folder.path());
    folder
}

#[test]
fn a_damaged_mesh_before_the_last_is_left_out_with_a_note() {
    let folder = folder();
    let damaged = folder.path().join("insert_0003.vtu");
    fs::write(damaged, "<VTKFile").expect("can be written");
    let scene = scene_of(folder.path());
    assert!(scene.has_surface());
    assert!(
        scene.missing[0].contains("insert_0003.vtu"),
        "{:?}",
        scene.missing
    );
    let gone = "9 files from insert_0000.vtu to insert_0009.vtu are not in the folder.";
    assert_eq!(scene.missing[1], gone);
    let page = write_report(folder.path()).expect("the rest is whole");
    let html = fs::read_to_string(page).expect("the page is there");
    assert!(html.contains("Omitted from this page") && html.contains("insert_0003.vtu"));
    assert!(!html.contains(&folder.path().display().to_string()));
}

#[test]
fn the_cycles_of_the_poses_have_their_pressures() {
    let folder = folder();
    let write = |name: &str, text: &str| fs::write(folder.path().join(name), text);
    write("femur_pose.csv", POSES).expect("can be written");
    let pressures = "percent,node,pressure_mpa\n100,7,12.5\n30,7,1\n";
    write("cycle_first_pressure.csv", pressures).expect("can be written");
    let scene = scene_of(folder.path());
    let [first, last] = scene.cycles.as_slice() else {
        panic!("{} cycles", scene.cycles.len());
    };
    assert_eq!(
        (first.name, first.percents.as_slice()),
        ("first", &[50.0, 100.0][..])
    );
    assert_eq!((last.name, last.cycles), ("last", 500_000.0));
    assert_eq!(first.poses[1][2], 4.0);
    assert_eq!(
        first.pressures,
        [vec![], vec![(7, 12.5)]],
        "30 % is no increment"
    );
    assert!(last.pressures.is_empty());
}

#[test]
fn truncated_poses_are_listed_and_the_rest_is_shown() {
    let folder = folder();
    let cut = format!("{}\n", &POSES[..POSES.len() - 9]);
    fs::write(folder.path().join("femur_pose.csv"), cut).expect("can be written");
    let scene = scene_of(folder.path());
    assert!(scene.cycles.is_empty() && scene.has_surface());
    let reason = "Line 4 of femur_pose.csv has 10 values; its header names 14 columns.";
    assert!(scene.missing.iter().any(|why| why == reason));
}
