//! What may not stand in a committed file.

use crate::repository::{TextFile, text_files};

fn lines_with(word: &str, may_stand: impl Fn(&TextFile, &str) -> bool) -> Vec<String> {
    let mut found = Vec::new();
    for file in text_files() {
        for (number, line) in file.text.lines().enumerate() {
            if line.contains(word) && !may_stand(&file, line) {
                found.push(format!("{}:{}: {}", file.path, number + 1, line.trim()));
            }
        }
    }
    found
}

#[test]
fn work_left_to_do_has_an_owner() {
    for word in [concat!("TO", "DO"), concat!("FIX", "ME")] {
        let owned = format!("{word}(");
        let found = lines_with(word, |_, line| line.contains(&owned));
        assert!(
            found.is_empty(),
            "write {word}(name):\n{}",
            found.join("\n")
        );
    }
}

#[test]
fn no_file_names_a_folder_of_one_machine() {
    for folder in [
        concat!("/wo", "rk/"),
        concat!("/tm", "p/"),
        concat!("/ro", "ot/"),
        concat!("/ho", "me/"),
    ] {
        let found = lines_with(folder, |_, _| false);
        assert!(found.is_empty(), "{folder}:\n{}", found.join("\n"));
    }
}

#[test]
fn no_file_is_larger_than_a_reader_can_use() {
    const LARGEST_BYTES: usize = 512 * 1024;
    // A CAD file is read by programs.
    for file in text_files()
        .iter()
        .filter(|file| !file.path.ends_with(".step"))
    {
        let size = file.text.len();
        assert!(size <= LARGEST_BYTES, "{}: {size} bytes", file.path);
    }
}

/// Files of the library about one joint of the body: the preset, and shapes and landmarks of knees.
const OF_ONE_JOINT: [&str; 6] = [
    "machine/knee.rs",
    "anatomy/",
    "geometry/construct.rs",
    "geometry/generic_femur.rs",
    "geometry/generic_insert.rs",
    "geometry/landmarks.rs",
];

/// Lines that list such files, their items and the joints of the body.
const LISTS: [&str; 5] = [
    "lib.rs",
    "prelude.rs",
    "geometry/mod.rs",
    "geometry/counterface.rs",
    "machine/mod.rs",
];

#[test]
fn the_library_speaks_of_counterface_and_bearing() {
    let mut found = Vec::new();
    for file in text_files() {
        let Some(path) = file.path.strip_prefix("crates/condyle/src/") else {
            continue;
        };
        let is_exempt = |names: &[&str]| names.iter().any(|name| path.starts_with(name));
        if is_exempt(&OF_ONE_JOINT) || is_exempt(&LISTS) || path.contains("test") {
            continue;
        }
        let production = file.text.split("#[cfg(test)]").next().unwrap_or_default();
        for (number, line) in production.lines().enumerate() {
            let is_stored_name = line.contains("femur_pose_and_loads");
            let is_joint_of_body = line.contains("Knee");
            if !is_stored_name
                && !is_joint_of_body
                && line.split(|c: char| !c.is_alphabetic()).any(is_of_knees)
            {
                found.push(format!("{path}:{}: {}", number + 1, line.trim()));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

fn is_of_knees(word: &str) -> bool {
    let lower = word.to_lowercase();
    ["femur", "femoral", "tibia", "knee"]
        .iter()
        .any(|of_knees| lower.contains(of_knees))
        || ["AP", "IE"].contains(&word)
}
