//! A folder for a test, and the command run in it.

use condyle_results::catalogue;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use condyle_results::{Checkpoint, Summary};
use tempfile::TempDir;

/// The generic implant on a coarse mesh: about a tenth of a second.
pub const SMALL: &str = "\
[insert]
edge_mm = 2.5
layers = 2
[march]
updates = 3
[time]
increments = 50
";

/// A folder of its own, taken away at the end.
pub struct Bench {
    folder: TempDir,
}

/// What the command said.
pub struct Said {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Bench {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder can be made");
        Self { folder }
    }

    /// A bench with `case.toml`.
    pub fn with_case(text: &str) -> Self {
        let bench = Self::new();
        bench.write("case.toml", text);
        bench
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, text: &str) {
        fs::write(self.path(name), text).expect("the folder can be written");
    }

    /// The command, to be run in the folder.
    pub fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_condyle"));
        command.args(arguments).current_dir(self.folder.path());
        // Tests leave nothing in the user's folders.
        command.env("CONDYLE_CACHE", "off");
        command.stdin(Stdio::null());
        command
    }

    /// Runs the command to its end.
    pub fn say(&self, arguments: &[&str]) -> Said {
        let output = self.command(arguments).output().expect("it runs");
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("it speaks UTF-8");
        Said {
            code: output.status.code(),
            out: text(output.stdout),
            err: text(output.stderr),
        }
    }

    /// Runs `case.toml` into the folder `out`, which must work.
    #[track_caller]
    pub fn run_into(&self, out: &str) -> Said {
        let said = self.say(&["run", "case.toml", "--out", out]);
        assert_eq!(said.code, Some(0), "{}", said.err);
        said
    }

    /// Runs `case.toml` into the folder `out`, goes on until it is done, and must work.
    #[track_caller]
    pub fn resume(&self, out: &str) -> Said {
        let said = self.say(&["run", "case.toml", "--out", out, "--resume"]);
        assert_eq!(said.code, Some(0), "{}", said.err);
        said
    }

    pub fn summary(&self, out: &str) -> Summary {
        summary(&self.path(out))
    }

    /// A table of the results folder, as columns by name.
    pub fn table(&self, out: &str, name: &str) -> BTreeMap<String, Vec<f64>> {
        let text = fs::read_to_string(self.path(out).join(name)).expect("the table is there");
        let mut lines = text.lines().map(|line| line.split(','));
        let names: Vec<&str> = lines.next().expect("it has a header").collect();
        let mut table: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for line in lines {
            let cells: Vec<&str> = line.collect();
            assert_eq!(cells.len(), names.len(), "{name}");
            for (column, cell) in names.iter().zip(cells) {
                let value = cell.parse().expect("a number");
                table.entry((*column).to_owned()).or_default().push(value);
            }
        }
        table
    }
}

impl Said {
    /// Asserts the exit code, and that the error has every one of `expected`, in this order.
    #[track_caller]
    pub fn assert_refused(&self, code: i32, expected: &[&str]) {
        assert_eq!(self.code, Some(code), "{}", self.err);
        let shown = unwrapped(&self.err);
        let mut rest = shown.as_str();
        for words in expected {
            let Some(at) = rest.find(words) else {
                panic!("no {words:?} in\n{rest}\nof\n{}", self.err);
            };
            rest = &rest[at + words.len()..];
        }
    }
}

/// Messages without the margin of their wrapped lines.
fn unwrapped(shown: &str) -> String {
    shown.replace("\n  | ", " ").replace("\n        ", " ")
}

pub fn summary(folder: &Path) -> Summary {
    let text = fs::read_to_string(folder.join("summary.json")).expect("the summary is there");
    serde_json::from_str(&text).expect("the summary is JSON of the contract")
}

/// Every file of a folder with its bytes; the wall time in the summary is set to zero.
pub fn files_but_wall_time(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files: BTreeMap<String, Vec<u8>> = fs::read_dir(folder)
        .expect("the folder is there")
        .map(|entry| {
            let entry = entry.expect("the folder can be read");
            let name = entry.file_name().to_string_lossy().into_owned();
            (name, fs::read(entry.path()).expect("a file can be read"))
        })
        .collect();
    if files.contains_key("summary.json") {
        let mut summary = summary(folder);
        summary.set(&catalogue::WALL_S, 0.0);
        summary
            .error
            .iter_mut()
            .for_each(|error| error.wall_s = 0.0);
        let text = serde_json::to_vec(&summary).expect("numbers and text");
        files.insert("summary.json".to_owned(), text);
    }
    files
}

/// Asserts that two results folders have the same files with the same bytes.
#[track_caller]
pub fn assert_same_bytes(one: &Path, other: &Path) {
    let (one, other) = (files_but_wall_time(one), files_but_wall_time(other));
    let names = |files: &BTreeMap<String, Vec<u8>>| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(&one), names(&other));
    for (name, bytes) in &one {
        assert!(*bytes == other[name], "{name} differs");
    }
}

/// Updates that the checkpoint of a folder has.
pub fn updates_kept(folder: &Path) -> usize {
    let bytes = fs::read(folder.join("checkpoint")).expect("the checkpoint is there");
    let checkpoint = Checkpoint::from_bytes(&bytes).expect("the checkpoint is whole");
    checkpoint.state.updates.len()
}

/// Returns the folder of the shipped cases, if the data of subject DM are there; otherwise prints that `test` is skipped.
pub fn dm_cases(test: &str) -> Option<PathBuf> {
    cases_with_data(test, "dm-knee/tibial-insert.stl")
}

/// Returns the folder of the shipped cases, if a file of the shared data is there; otherwise prints that `test` is skipped.
pub fn cases_with_data(test: &str, file: &str) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let there = root.join("../shared/data").join(file).is_file();
    if !there {
        eprintln!("skipped: {test}: shared/data/{file} is not there");
    }
    there.then(|| root.join("cases"))
}

/// Returns a folder of reproducers from outside, if it is there; otherwise prints that `test` is skipped.
pub fn reproducer(report: &str, test: &str) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/reproducers");
    let folder = root.join(report);
    if !folder.is_dir() {
        eprintln!("skipped: {test}: shared/reproducers/{report} is not there");
        return None;
    }
    folder.canonicalize().ok()
}
