//! Replacing the run of a folder by another, on request.

use std::{
    fs,
    path::{Path, PathBuf},
};

use super::{
    added::{AddedFiles, COMPARED, PLOTTED},
    cycle_files::{BODIES, KeptCycle},
    files::part_file,
    folder::{ResultsError, ResultsFolder, SIGNS_OF_A_RUN, TIME_SPENT, remove, unusable},
    parts::kinematics_file,
};

/// Pictures that `condyle report` adds to a run on request.
const PICTURES: [&str; 3] = ["wear_map.svg", "wear.svg", "kinematics.svg"];

const ADDED: [AddedFiles; 2] = [COMPARED, PLOTTED];

impl ResultsFolder {
    /// Checks that a new run, which reads the files `read`, can replace the run in `path`; changes
    /// nothing.
    ///
    /// # Errors
    /// The folder contains files with the names of a run but no checkpoint, so they may belong to
    /// another program; the new run reads one of its files; the path is a file.
    pub fn may_be_written_over(path: &Path, read: &[&Path]) -> Result<(), ResultsError> {
        let Some(file) = Self::sign_of_a_run(path)? else {
            return Ok(());
        };
        if !path.join("checkpoint").exists() {
            return Err(unusable(
                path,
                format!(
                    "{file} is there, but no checkpoint, so that it may not belong to a run; give another folder with --out, or \
                 remove the file yourself"
                ),
            ));
        }
        // One file may have several paths.
        let place = |path: &Path| fs::canonicalize(path).ok();
        let files = Self::existing(path).files_of_a_run();
        let files: Vec<PathBuf> = files.iter().filter_map(|file| place(file)).collect();
        match read
            .iter()
            .find(|file| place(file).is_some_and(|file| files.contains(&file)))
        {
            Some(file) => Err(unusable(
                path,
                format!(
                    "the run reads {} of the folder that it would replace; give another folder with --out",
                    file.display()
                ),
            )),
            None => Ok(()),
        }
    }

    /// Removes every file of a run, the checkpoint last: until then the folder can be cleared
    /// again.
    ///
    /// # Errors
    /// The system refuses to remove a file.
    pub fn clear(&self) -> Result<(), ResultsError> {
        for file in self.files_of_a_run() {
            remove(&file)?;
        }
        let folders = KeptCycle::BOTH.into_iter().map(KeptCycle::name);
        for folder in folders.chain(ADDED.map(|added| added.folder)) {
            // Kept if it holds files of others.
            let _ = fs::remove_dir(self.path().join(folder));
        }
        Ok(())
    }

    /// Returns the files that a run may have left, whether they are there or not, the checkpoint last.
    fn files_of_a_run(&self) -> Vec<PathBuf> {
        let inserts = names_in(self.path()).filter(|name| is_numbered(name, "insert"));
        let others = SIGNS_OF_A_RUN
            .into_iter()
            .chain(PICTURES)
            .chain([TIME_SPENT]);
        let named = others
            .filter(|name| *name != "checkpoint")
            .map(str::to_owned);
        let frames = KeptCycle::BOTH
            .into_iter()
            .flat_map(|cycle| self.frames(cycle));
        // Before the case, from which their names are read.
        let case = fs::read_to_string(self.path().join("case.toml")).unwrap_or_default();
        let case: toml::Table = case.parse().unwrap_or_default();
        let activities = case.get("activity").and_then(toml::Value::as_array);
        let activities = activities.into_iter().flatten().enumerate();
        let names = activities
            .filter_map(|(number, one)| Some(kinematics_file(number, one.get("name")?.as_str()?)))
            .chain(named)
            .chain(inserts)
            .chain(frames)
            .chain(ADDED.iter().flat_map(AddedFiles::paths))
            .chain(["checkpoint".to_owned()]);
        let files = names.map(|name| self.path().join(name));
        files.flat_map(|file| [part_file(&file), file]).collect()
    }

    /// Returns the frames of a cycle, by their paths in the folder.
    fn frames(&self, cycle: KeptCycle) -> Vec<String> {
        let folder = cycle.name();
        // One that was being written when the run was stopped has the ending of such files.
        let whole = |name: String| {
            name.strip_suffix(".part")
                .map_or(name.clone(), str::to_owned)
        };
        let names = names_in(&self.path().join(folder)).map(whole);
        let frames = names.filter(|name| BODIES.iter().any(|body| is_numbered(name, body)));
        frames.map(|name| format!("{folder}/{name}")).collect()
    }
}

fn names_in(folder: &Path) -> impl Iterator<Item = String> + use<> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.filter_map(|entry| entry.file_name().into_string().ok())
}

/// Returns whether a name is that of a body after an update or increment.
fn is_numbered(name: &str, body: &str) -> bool {
    let number = name
        .strip_prefix(body)
        .and_then(|rest| rest.strip_prefix('_'))
        .and_then(|rest| rest.strip_suffix(".vtu"));
    number.is_some_and(|digits| digits.bytes().all(|byte| byte.is_ascii_digit()))
}
