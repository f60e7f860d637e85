//! Kept content equals computed content, and a damaged cache has no effect on results.

use std::{cell::Cell, thread};

use tempfile::TempDir;

use super::super::kept;
use super::*;

/// A substitute for a long computation.
fn numbers() -> Vec<f64> {
    (0..100).map(|i| f64::from(i).sqrt()).collect()
}

/// The one file in a folder.
fn only_file(folder: &TempDir) -> PathBuf {
    let files: Vec<PathBuf> = fs::read_dir(folder.path())
        .expect("the folder is there")
        .map(|entry| entry.expect("it can be read").path())
        .collect();
    assert_eq!(files.len(), 1, "{files:?}");
    files[0].clone()
}

/// Returns true if a cache had to compute the numbers of `inputs`.
fn computes(cache: &Cache, inputs: &[&[u8]]) -> bool {
    let computed = Cell::new(false);
    let made: Result<Vec<f64>, ()> = kept(cache, "numbers", inputs, || {
        computed.set(true);
        Ok(numbers())
    });
    assert_eq!(made, Ok(numbers()));
    computed.get()
}

fn kept_once() -> (TempDir, Cache) {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let cache = Cache::in_folder(folder.path());
    assert!(computes(&cache, &[b"inputs"]));
    (folder, cache)
}

#[test]
fn computed_content_is_kept_for_the_same_inputs() {
    let (_folder, cache) = kept_once();
    assert!(!computes(&cache, &[b"inputs"]));
    assert!(computes(&cache, &[b"others"]));
    // The same bytes, cut otherwise.
    assert!(computes(&cache, &[b"in", b"puts"]));
}

#[test]
fn a_cache_that_is_off_keeps_nothing() {
    assert!(computes(&Cache::off(), &[b"inputs"]));
    assert!(computes(&Cache::off(), &[b"inputs"]));
}

#[test]
fn failed_computations_are_not_kept() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let cache = Cache::in_folder(folder.path());
    let failed: Result<Vec<f64>, &str> = kept(&cache, "numbers", &[b"inputs"], || Err("bad"));
    assert_eq!(failed, Err("bad"));
    assert!(computes(&cache, &[b"inputs"]));
}

#[test]
fn a_damaged_file_is_ignored_and_written_again() {
    let (folder, cache) = kept_once();
    let file = only_file(&folder);
    let whole = fs::read(&file).expect("it can be read");
    let mut turned = whole.clone();
    turned[50] ^= 1;
    let longer = [whole.as_slice(), b"x"].concat();
    for damaged in [&turned, &longer, &whole[..40], &whole[..20], &[]] {
        fs::write(&file, damaged).expect("it can be written");
        assert!(computes(&cache, &[b"inputs"]));
        assert!(fs::read(only_file(&folder)).expect("it is there") == whole);
    }
}

#[test]
fn a_file_of_other_inputs_is_not_taken_for_these() {
    let (folder, cache) = kept_once();
    let file = only_file(&folder);
    let bytes = fs::read(&file).expect("it can be read");
    fs::remove_file(&file).expect("it can be removed");
    assert!(computes(&cache, &[b"others"]));
    fs::write(only_file(&folder), bytes).expect("it can be written");
    assert!(computes(&cache, &[b"others"]));
}

#[test]
fn a_folder_that_cannot_be_written_is_no_error() {
    let (folder, _) = kept_once();
    let below_a_file = Cache::in_folder(only_file(&folder).join("below"));
    assert!(computes(&below_a_file, &[b"inputs"]));
    assert!(computes(&below_a_file, &[b"inputs"]));
}

#[test]
fn many_at_once_leave_one_whole_file() {
    let folder = tempfile::tempdir().expect("a folder can be made");
    let cache = Cache::in_folder(folder.path());
    thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| computes(&cache, &[b"inputs"]));
        }
    });
    only_file(&folder);
    assert!(!computes(&cache, &[b"inputs"]));
}

#[test]
fn the_newest_files_are_kept_and_no_other_is_touched() {
    let (folder, cache) = kept_once();
    let own = folder.path().join("thesis.txt");
    fs::write(&own, "mine").expect("it can be written");
    for i in 0..MAX_FILES {
        assert!(computes(&cache, &[&i.to_le_bytes()]));
    }
    let files = fs::read_dir(folder.path()).expect("the folder is there");
    assert_eq!(files.count(), MAX_FILES + 1);
    assert!(own.is_file());
    assert!(!computes(&cache, &[&(MAX_FILES - 1).to_le_bytes()]));
}

/// The folder of a cache with these variables.
fn folder(variables: &[(&str, &str)]) -> Option<PathBuf> {
    let variable = |name: &str| {
        let found = variables.iter().find(|(other, _)| *other == name);
        found.map(|(_, value)| OsString::from(value))
    };
    Cache::by_environment(variable).folder
}

#[cfg(unix)]
#[test]
fn the_environment_determines_the_folder() {
    let at = |path: &str| Some(PathBuf::from(path));
    let (home, xdg) = (("HOME", "/users/ann"), ("XDG_CACHE_HOME", "/fast"));
    assert_eq!(folder(&[]), None);
    assert_eq!(folder(&[home]), at("/users/ann/.cache/condyle"));
    assert_eq!(folder(&[home, xdg]), at("/fast/condyle"));
    let relative = ("XDG_CACHE_HOME", "fast");
    assert_eq!(folder(&[home, relative]), at("/users/ann/.cache/condyle"));
    assert_eq!(folder(&[home, xdg, ("CONDYLE_CACHE", "off")]), None);
    assert_eq!(folder(&[home, ("CONDYLE_CACHE", "kept")]), at("kept"));
    let empty = ("CONDYLE_CACHE", "");
    assert_eq!(folder(&[xdg, empty]), at("/fast/condyle"));
}
