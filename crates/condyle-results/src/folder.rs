//! The folder of a run.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use condyle::{evolve::March, geometry::TriangleMesh};
use thiserror::Error;

use super::side::Side;
use super::{
    checkpoint::{Checkpoint, CheckpointError},
    cycle_files::{
        KeptCycle, cycle_pressure_csv, cycle_pressure_file, cycle_pvd, femur_vtu, frame_name,
        insert_frame,
    },
    files::{
        CHECKSUMS, DamagedFile, FolderLock, LOCK, check_all, is_listed, part_file, replace_file,
        replace_file_durably, write_checksum,
    },
    insert_fields::{insert_file_name, insert_pvd, insert_vtu},
    parts::kinematics_file,
    settings::setting_differences,
    slip_paths::slip_paths_csv,
    summary::{Summary, json_text},
    tables::{femur_pose_csv, kinematics_csv, wear_csv},
};
use condyle_mesh::formats::MeshFileError;

/// Keys that a message names where two cases differ: enough to recognise a case.
const MAX_KEYS_NAMED: usize = 3;

/// A reason why a results folder cannot be used.
#[expect(missing_docs, reason = "the messages describe the fields")]
#[derive(Debug, Error)]
pub enum ResultsError {
    /// A folder whose state does not permit the run.
    #[error("{}: {problem}", folder.display())]
    Folder { folder: PathBuf, problem: String },
    /// A checkpoint that cannot be read.
    #[error("{}: the checkpoint cannot be used: {source}", file.display())]
    Checkpoint {
        file: PathBuf,
        source: CheckpointError,
    },
    /// The system refused to read or write.
    #[error("{}: {source}; check that the folder can be written and the disk is not full", file.display())]
    Refused { file: PathBuf, source: io::Error },
    /// A mesh of the run that has changed since the run wrote it.
    #[error(transparent)]
    Damaged(#[from] DamagedFile),
    /// An insert that cannot be written.
    #[error(transparent)]
    Insert(#[from] MeshFileError),
}

/// The folder of a run; its writers fail with [`ResultsError::Refused`].
#[derive(Clone, Debug)]
pub struct ResultsFolder {
    path: PathBuf,
}

/// Files of a run that another run never overwrites, in the order in which they are written first.
pub(super) const SIGNS_OF_A_RUN: [&str; 16] = [
    "case.toml",
    "checkpoint",
    "summary.json",
    "wear.csv",
    "kinematics.csv",
    "insert.pvd",
    "insert_0000.vtu",
    "report.html",
    CHECKSUMS,
    "femur.vtu",
    "femur_pose.csv",
    "slip_paths.csv",
    "cycle_first.pvd",
    "cycle_last.pvd",
    "cycle_first_pressure.csv",
    "cycle_last_pressure.csv",
];

/// File with the seconds spent by an unfinished run. It is removed when the run is done, so that the folder has the
/// same bytes whether the run was interrupted or not.
pub(super) const TIME_SPENT: &str = "time_spent_s";

/// The part of a run that a folder holds.
#[derive(Debug)]
pub enum Found {
    /// Nothing, or the case only, where the run was stopped before its first checkpoint: a new run starts.
    Nothing,
    /// A checkpoint, and the seconds that the run has taken so far.
    Checkpoint(Box<Checkpoint>, f64),
    /// The whole run, with its summary.
    Done(Box<Summary>),
}

impl ResultsFolder {
    /// Returns the folder at `path` without changing it.
    pub fn existing(path: &Path) -> Self {
        let path = path.to_owned();
        Self { path }
    }

    /// Checks that a new run can be written to `path`; creates nothing.
    ///
    /// # Errors
    /// A folder that holds a run, done or not, or a file in its place.
    pub fn free(path: &Path) -> Result<(), ResultsError> {
        let Some(file) = Self::sign_of_a_run(path)? else {
            return Ok(());
        };
        let [is_begun, has_summary] =
            ["checkpoint", "summary.json"].map(|name| path.join(name).exists());
        let problem = if is_begun && has_summary {
            "the folder already holds a run, which is done (summary.json is there); give another folder with --out, or \
             replace it with --force: there is nothing left to --resume"
                .to_owned()
        } else if is_begun || file == "case.toml" {
            format!(
                "the folder already holds a run ({file} is there); give another folder with --out, resume it with \
                 --resume, or replace it with --force"
            )
        } else {
            format!(
                "the folder already holds a run or a part of one ({file} is there, and no checkpoint to resume from); give \
                 another folder with --out, or remove the file yourself"
            )
        };
        Err(unusable(path, problem))
    }

    /// Returns the first file in `path` with a name that runs use, if there is one.
    pub(super) fn sign_of_a_run(path: &Path) -> Result<Option<&'static str>, ResultsError> {
        if path.exists() && !path.is_dir() {
            let problem = "this is a file, not a folder; give another folder with --out";
            return Err(unusable(path, problem));
        }
        let is_there = |name: &&str| path.join(name).exists();
        Ok(SIGNS_OF_A_RUN.into_iter().find(is_there))
    }

    /// Locks the folder at `path`, so that no other run writes into it; none if the folder does not exist.
    ///
    /// # Errors
    /// Another run holds the lock, or the folder cannot be written.
    pub fn lock(path: &Path) -> Result<Option<FolderLock>, ResultsError> {
        if !path.is_dir() {
            return Ok(None);
        }
        let taken = FolderLock::take(path).map_err(refused(path))?;
        taken.map(Some).ok_or_else(|| {
            let problem = "another run is writing into this folder; wait until it has ended, or give another folder with \
                           --out";
            unusable(path, problem)
        })
    }

    /// Creates the folder of a run, unless it exists.
    ///
    /// # Errors
    /// The folder cannot be created.
    pub fn create(path: &Path) -> Result<Self, ResultsError> {
        fs::create_dir_all(path).map_err(refused(path))?;
        Ok(Self::existing(path))
    }

    /// Returns the part that the folder holds of a run of `cycles` gait cycles.
    ///
    /// `case_toml` is the case as [`Self::write_case`] would write it.
    ///
    /// # Errors
    /// A folder without a run, with one of other inputs, or with a damaged checkpoint or mesh.
    pub fn reopen(
        path: &Path,
        case_toml: &str,
        inputs_blake3: &str,
        cycles: f64,
    ) -> Result<Found, ResultsError> {
        let folder = Self::existing(path);
        if !folder.file("checkpoint").exists() {
            return match fs::read_to_string(folder.file("case.toml")) {
                Ok(text) if text == case_toml => Ok(Found::Nothing),
                Err(_) if folder.was_only_made() => Ok(Found::Nothing),
                Ok(_) | Err(_) => {
                    let problem = "the folder holds no run to resume: there is no checkpoint, and no case.toml of this \
                                   case; omit --resume to start one";
                    Err(unusable(path, problem))
                }
            };
        }
        let file = folder.file("checkpoint");
        let bytes = fs::read(&file).map_err(refused(&file))?;
        let checkpoint = Checkpoint::from_bytes(&bytes)
            .map_err(|source| ResultsError::Checkpoint { file, source })?;
        if checkpoint.inputs_blake3 != inputs_blake3 {
            return Err(unusable(path, folder.other_inputs(case_toml)));
        }
        if checkpoint.version != env!("CARGO_PKG_VERSION") {
            let (version, own) = (checkpoint.version, env!("CARGO_PKG_VERSION"));
            let problem = format!(
                "the run in this folder was started by condyle {version}, and this is {own}; resume it with that version, or \
                 run the case again in another folder"
            );
            return Err(unusable(path, problem));
        }
        // Before the checkpoint is used: a damaged mesh of an earlier update would stay in the series.
        check_all(&folder.path)?;
        let last = checkpoint.state.updates.last();
        let done = last.is_some_and(|last| last.cycles >= cycles);
        Ok(match folder.summary() {
            Some(summary) if done => Found::Done(summary),
            Some(_) | None => Found::Checkpoint(Box::new(checkpoint), folder.time_spent_s()),
        })
    }

    /// Describes the difference of a case from that of the run in the folder.
    fn other_inputs(&self, case_toml: &str) -> String {
        let own = fs::read_to_string(self.file("case.toml")).unwrap_or_default();
        let differ = setting_differences(&own, case_toml).into_iter();
        let differ = differ.map(|one| {
            let [was, is] = one
                .shown()
                .map(|value| value.unwrap_or("absent".to_owned()));
            format!("{} was {was} and is {is}", one.key)
        });
        let differ: Vec<String> = differ.take(MAX_KEYS_NAMED).collect();
        let differ = match differ.is_empty() {
            true => "all keys agree, and a mesh or waveform differs".to_owned(),
            false => differ.join(", "),
        };
        format!(
            "the run in this folder is of another case or other meshes: {differ}; give another folder with --out"
        )
    }

    /// Returns whether the folder exists and holds nothing but the files of a run before its first file is complete.
    fn was_only_made(&self) -> bool {
        let begun = part_file(Path::new("case.toml"));
        let is_of_beginning = |entry: io::Result<fs::DirEntry>| {
            let name = entry.map(|entry| entry.file_name());
            name.is_ok_and(|name| name == LOCK || *name == begun)
        };
        fs::read_dir(&self.path).is_ok_and(|mut entries| entries.all(is_of_beginning))
    }

    /// Returns the summary, which is the last file of a run.
    fn summary(&self) -> Option<Box<Summary>> {
        let text = fs::read_to_string(self.file("summary.json")).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// Returns the time from [`Self::write_time_spent`], s; 0 without its file.
    fn time_spent_s(&self) -> f64 {
        let text = fs::read_to_string(self.file(TIME_SPENT)).unwrap_or_default();
        let seconds = text.trim().parse().unwrap_or(0.0);
        // `inf` and `nan` parse as numbers.
        if f64::is_finite(seconds) {
            seconds
        } else {
            0.0
        }
    }

    /// Writes how many seconds the run has taken so far.
    pub fn write_time_spent(&self, seconds: f64) -> Result<(), ResultsError> {
        self.replace(TIME_SPENT, format!("{seconds}\n").as_bytes())
    }

    /// Removes the files that only an unfinished run needs.
    pub fn finish(&self) -> Result<(), ResultsError> {
        let file = self.file(TIME_SPENT);
        remove(&part_file(&file))?;
        remove(&file)
    }

    /// Returns the path of the folder.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the case as run.
    pub fn write_case(&self, toml: &str) -> Result<(), ResultsError> {
        self.replace("case.toml", toml.as_bytes())
    }

    /// Writes the femur in its neutral pose, in the insert frame.
    pub fn write_femur(
        &self,
        march: &March,
        femur: &TriangleMesh,
        side: Side,
    ) -> Result<(), ResultsError> {
        let bytes = femur_vtu(femur, &march.neutral_pose(), side)?;
        self.replace("femur.vtu", &bytes)
    }

    /// Writes the cycle that the march has just solved, increment by increment, if it is the first or the last. Call
    /// it before [`Self::write_update`], so that no checkpoint lacks the cycle.
    pub fn write_cycles(
        &self,
        march: &March,
        femur: &TriangleMesh,
        side: Side,
    ) -> Result<(), ResultsError> {
        for kept in KeptCycle::solved_by(march) {
            let Some(cycle) = march.last_cycle() else {
                continue;
            };
            let folder = kept.name();
            Self::create(&self.file(folder))?;
            for increment in 0..cycle.rows.len() {
                let name = |body| format!("{folder}/{}", frame_name(body, increment));
                let insert = insert_frame(march, &cycle, increment, side)?;
                self.replace(&name("insert"), &insert)?;
                let femur = femur_vtu(femur, &cycle.pose(increment), side)?;
                self.replace(&name("femur"), &femur)?;
            }
            let percents: Vec<f64> = cycle.rows.iter().map(|row| row.percent).collect();
            let pvd = cycle_pvd(kept, &percents);
            self.replace(&format!("{folder}.pvd"), pvd.as_bytes())?;
        }
        Ok(())
    }

    /// Writes the results of the march so far, and then the checkpoint: the other files are complete before it refers
    /// to them.
    pub fn write_update(
        &self,
        march: &March,
        side: Side,
        inputs_blake3: &str,
    ) -> Result<(), ResultsError> {
        let state = march.state();
        for cycle in KeptCycle::solved_by(march) {
            if let Some(table) = cycle_pressure_csv(march) {
                self.replace(&cycle_pressure_file(cycle), table.as_bytes())?;
            }
        }
        self.replace(
            &insert_file_name(state.updates.len()),
            &insert_vtu(march, side)?,
        )?;
        self.replace("insert.pvd", insert_pvd(&state.updates).as_bytes())?;
        self.replace("wear.csv", wear_csv(&state.updates).as_bytes())?;
        for (number, activity) in march.test().activities.iter().enumerate() {
            self.replace(
                &kinematics_file(number, &activity.name),
                kinematics_csv(march, number).as_bytes(),
            )?;
        }
        self.replace("femur_pose.csv", femur_pose_csv(march, side).as_bytes())?;
        if let Some(paths) = slip_paths_csv(march, side) {
            self.replace("slip_paths.csv", paths.as_bytes())?;
        }
        // Written last and durably: everything that the checkpoint refers to is on the disk before it.
        let checkpoint = Checkpoint {
            inputs_blake3: inputs_blake3.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            state: state.clone(),
        };
        let file = self.file("checkpoint");
        replace_file_durably(&file, &checkpoint.to_bytes()).map_err(refused(&file))
    }

    /// Writes the summary.
    pub fn write_summary(&self, summary: &Summary) -> Result<(), ResultsError> {
        self.replace("summary.json", json_text(summary).as_bytes())
    }

    fn replace(&self, name: &str, bytes: &[u8]) -> Result<(), ResultsError> {
        let file = self.file(name);
        let write_hash = |bytes| match is_listed(name) {
            true => write_checksum(&self.path, name, bytes),
            false => Ok(()),
        };
        // A run that is killed at any time leaves a file with its own hash or with none, and writes both again when it resumes.
        write_hash(None)
            .and_then(|()| replace_file(&file, bytes))
            .and_then(|()| write_hash(Some(bytes)))
            .map_err(refused(&file))
    }

    fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }
}

/// Creates the error for a folder whose state does not permit the run.
pub(super) fn unusable(folder: &Path, problem: impl Into<String>) -> ResultsError {
    ResultsError::Folder {
        folder: folder.to_owned(),
        problem: problem.into(),
    }
}

fn refused(file: &Path) -> impl FnOnce(io::Error) -> ResultsError {
    let file = file.to_owned();
    move |source| ResultsError::Refused { file, source }
}

pub(super) fn remove(file: &Path) -> Result<(), ResultsError> {
    match fs::remove_file(file) {
        Err(source) if source.kind() != io::ErrorKind::NotFound => Err(refused(file)(source)),
        Ok(()) | Err(_) => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::{check_all, part_file};

    #[test]
    fn a_mesh_of_a_run_killed_before_it_wrote_the_hash_is_not_damaged() {
        let temporary = tempfile::tempdir().expect("a folder can be made");
        let folder = ResultsFolder::existing(temporary.path());
        let (name, file) = ("insert_0012.vtu", temporary.path().join("insert_0012.vtu"));
        folder
            .replace(name, b"of the last update")
            .expect("it can be written");
        // A folder in place of the part file ends the replacement before the file.
        fs::create_dir(part_file(&file)).expect("it can be made");
        folder
            .replace(name, b"of the final cycle")
            .expect_err("the part file is in the way");
        fs::write(&file, b"of the final cycle").expect("it can be written");
        check_all(temporary.path()).expect("the file has no hash");
    }
}
