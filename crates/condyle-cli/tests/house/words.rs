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
