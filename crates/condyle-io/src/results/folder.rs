//! The folder of a run.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use condyle::evolve::March;
use thiserror::Error;

use super::{
    Checkpoint, CheckpointError, Summary,
    insert_series::{insert_file_name, insert_pvd, insert_vtu},
    replace::{replace_file, replace_file_durably},
    tables::{kinematics_csv, wear_csv},
};
use crate::{case::Side, mesh::MeshFileError};

/// Why a results folder cannot be used.
#[derive(Debug, Error)]
pub enum ResultsError {
    /// A run is already in it.
    #[error("{}: the folder already holds a run; give another folder with --out, or go on with --resume", folder.display())]
    HoldsRun {
        /// The folder.
        folder: PathBuf,
    },
    /// No run is in it to go on with.
    #[error("{}: the folder holds no run to go on with; leave out --resume", folder.display())]
    HoldsNone {
        /// The folder.
        folder: PathBuf,
    },
    /// The run in it is one of another case.
    #[error("{}: the run in this folder is one of another case or other meshes; give another folder with --out", folder.display())]
    OtherCase {
        /// The folder.
        folder: PathBuf,
    },
    /// A checkpoint that cannot be read.
    #[error("{}: the checkpoint cannot be used: {source}", file.display())]
    Checkpoint {
        /// The file.
        file: PathBuf,
        /// Why.
        source: CheckpointError,
    },
    /// The system refused to read or write.
    #[error("{}: {source}; check that the folder can be written and the disk is not full", file.display())]
    Refused {
        /// The file or folder.
        file: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// An insert that cannot be written.
    #[error(transparent)]
    Insert(#[from] MeshFileError),
}

/// The folder of a run.
#[derive(Clone, Debug)]
pub struct ResultsFolder {
    path: PathBuf,
}

/// Files that show that a folder holds a run.
const SIGNS_OF_A_RUN: [&str; 3] = ["checkpoint", "summary.json", "wear.csv"];

impl ResultsFolder {
    /// A folder for a new run, made if it is not there.
    ///
    /// # Errors
    /// A folder that holds a run, or that cannot be made.
    pub fn create(path: &Path) -> Result<Self, ResultsError> {
        let folder = Self {
            path: path.to_owned(),
        };
        if SIGNS_OF_A_RUN.iter().any(|name| folder.file(name).exists()) {
            return Err(ResultsError::HoldsRun {
                folder: path.to_owned(),
            });
        }
        fs::create_dir_all(path).map_err(|source| ResultsError::Refused {
            file: path.to_owned(),
            source,
        })?;
        Ok(folder)
    }

    /// The folder of a run to go on with, and its checkpoint.
    ///
    /// # Errors
    /// A folder without a run, with one of other inputs, or with a damaged checkpoint.
    pub fn reopen(path: &Path, inputs_blake3: &str) -> Result<(Self, Checkpoint), ResultsError> {
        let folder = Self {
            path: path.to_owned(),
        };
        let file = folder.file("checkpoint");
        if !file.exists() {
            return Err(ResultsError::HoldsNone {
                folder: path.to_owned(),
            });
        }
        let bytes = fs::read(&file).map_err(|source| ResultsError::Refused {
            file: file.clone(),
            source,
        })?;
        let checkpoint = Checkpoint::from_bytes(&bytes)
            .map_err(|source| ResultsError::Checkpoint { file, source })?;
        if checkpoint.inputs_blake3 != inputs_blake3 {
            return Err(ResultsError::OtherCase {
                folder: path.to_owned(),
            });
        }
        Ok((folder, checkpoint))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes the case as run.
    ///
    /// # Errors
    /// Where the system refuses.
    pub fn write_case(&self, toml: &str) -> Result<(), ResultsError> {
        self.replace("case.toml", toml.as_bytes())
    }

    /// Writes all that the march has found so far, and last of all the checkpoint: whatever it
    /// remembers is then already in the other files.
    ///
    /// # Errors
    /// Where the system refuses.
    pub fn write_update(
        &self,
        march: &March,
        side: Side,
        inputs_blake3: &str,
    ) -> Result<(), ResultsError> {
        let state = march.state();
        self.replace(
            &insert_file_name(state.updates.len()),
            &insert_vtu(march, side)?,
        )?;
        self.replace("insert.pvd", insert_pvd(&state.updates).as_bytes())?;
        self.replace("wear.csv", wear_csv(&state.updates).as_bytes())?;
        self.replace(
            "kinematics.csv",
            kinematics_csv(state.first_and_last.as_ref()).as_bytes(),
        )?;
        let checkpoint = Checkpoint {
            inputs_blake3: inputs_blake3.to_owned(),
            state: state.clone(),
        };
        let file = self.file("checkpoint");
        replace_file_durably(&file, &checkpoint.to_bytes())
            .map_err(|source| ResultsError::Refused { file, source })
    }

    /// Writes the summary.
    ///
    /// # Errors
    /// Where the system refuses.
    pub fn write_summary(&self, summary: &Summary) -> Result<(), ResultsError> {
        let mut text =
            serde_json::to_string_pretty(summary).expect("numbers and text always serialise");
        text.push('\n');
        self.replace("summary.json", text.as_bytes())
    }

    fn replace(&self, name: &str, bytes: &[u8]) -> Result<(), ResultsError> {
        let file = self.file(name);
        replace_file(&file, bytes).map_err(|source| ResultsError::Refused { file, source })
    }

    fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }
}
