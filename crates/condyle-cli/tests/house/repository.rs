//! The files of the repository.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A file that is committed, or about to be.
pub struct TextFile {
    /// Path from the root, with forward slashes.
    pub path: String,
    /// What it holds.
    pub text: String,
}

/// The folder that holds everything.
pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// What a file holds, by its path from the root.
pub fn read(path: &str) -> String {
    std::fs::read_to_string(root().join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Every committed text file; none, and a word on why, where git is not there to list them.
pub fn text_files() -> Vec<TextFile> {
    let listed = Command::new("git")
        .args(["ls-files", "-z"])
        .current_dir(root())
        .output();
    let Some(listed) = listed.ok().filter(|listed| listed.status.success()) else {
        let why = "skipped: rules about committed files: this is no git checkout";
        assert!(std::env::var("CI").as_deref() != Ok("true"), "{why}");
        eprintln!("{why}");
        return Vec::new();
    };
    let paths = String::from_utf8(listed.stdout).expect("paths are UTF-8");
    let file = |path: &str| {
        let text = std::fs::read_to_string(root().join(path)).ok()?;
        let path = path.to_owned();
        Some(TextFile { path, text })
    };
    paths
        .split('\0')
        .filter(|path| !path.is_empty())
        .filter_map(file)
        .collect()
}

/// The committed files whose names end so.
pub fn text_files_ending(ending: &str) -> Vec<TextFile> {
    let mut files = text_files();
    files.retain(|file| file.path.ends_with(ending));
    files
}

/// What `cargo metadata` says of the workspace.
pub fn cargo_metadata() -> serde_json::Value {
    let told = Command::new(env!("CARGO"))
        .args([
            "metadata",
            "--format-version",
            "1",
            "--no-deps",
            "--offline",
        ])
        .current_dir(root())
        .output()
        .expect("cargo runs");
    assert!(
        told.status.success(),
        "{}",
        String::from_utf8_lossy(&told.stderr)
    );
    serde_json::from_slice(&told.stdout).expect("cargo metadata is JSON")
}
