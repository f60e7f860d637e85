//! What a study of convergence is to run, checked before anything runs.

use std::{
    fs, io,
    path::{Path, PathBuf},
};

use condyle_io::case::{Case, Override, OverrideError};
use condyle_io::config::Problems;
use thiserror::Error;

use crate::RunError;

/// Why a study of convergence is not done.
#[derive(Debug, Error)]
pub enum ConvergeError {
    /// The case file, as it is or with one of the values.
    #[error(transparent)]
    Case(#[from] Problems),
    /// A key or a value that is none.
    #[error(transparent)]
    Override(#[from] OverrideError),
    /// Not written as a key with values.
    #[error("`{written}` is no key with values; write them as `updates=1,2,5,10`")]
    NotKeyAndValues {
        /// As written.
        written: String,
    },
    /// Fewer than two values.
    #[error("`{key}` has {} where two or more are needed to compare; write them as `{key}=10,20,40`", if *found == 0 { "no value" } else { "one value" })]
    TooFew {
        /// The key as written.
        key: String,
        /// How many there are.
        found: usize,
    },
    /// A value that stands twice.
    #[error("`{key}` has the value {value} twice; write each once")]
    Twice {
        /// The key as written.
        key: String,
        /// The value.
        value: f64,
    },
    /// A folder that holds something.
    #[error("{}: the folder is not empty; give another one with --out, or go on with --resume", folder.display())]
    NotEmpty {
        /// The folder.
        folder: PathBuf,
    },
    /// The system refused to read or write.
    #[error("{}: {source}; check that the folder can be written and the disk is not full", path.display())]
    Refused {
        /// The file or folder.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// One of the runs.
    #[error("{number}: {source}")]
    Run {
        /// The key and its value, such as `march.updates = 1`.
        number: String,
        /// Why.
        source: Box<RunError>,
    },
}

/// A case, once for each value of one of its numbers, from coarse to fine.
#[derive(Clone, Debug)]
pub struct ConvergePlan {
    pub(super) path: String,
    pub(super) is_whole: bool,
    pub(super) runs: Vec<Planned>,
}

/// A case with one number changed.
#[derive(Clone, Debug)]
pub struct Planned {
    /// The number.
    pub number: Override,
    /// The case with it.
    pub case: Case,
}

impl ConvergePlan {
    /// The case at `case_path` over values written as `key=value,value,...`.
    ///
    /// The key is a dotted path, such as `march.updates`, or the last word of one, with or without
    /// its unit. A number that counts is finer where it is larger, any other where it is smaller.
    ///
    /// # Errors
    /// Everything that can be known of the input before it runs.
    pub fn new(case_path: &Path, written: &str) -> Result<Self, ConvergeError> {
        let (key, values) = key_and_values(written)?;
        let case = Case::read(case_path)?;
        let path = case.path_of_number(key)?;
        let mut runs = Vec::new();
        for text in values {
            let number = Override::new(&path, text)?;
            let mut case = Case::read_with(case_path, &number)?;
            // The study itself shows what its runs would otherwise estimate one by one.
            case.accuracy.estimate = false;
            runs.push(Planned { number, case });
        }
        let is_whole = runs[0].case.is_whole_number(&path);
        sort(&mut runs, is_whole);
        if let Some(twice) = twice(&runs) {
            let (key, value) = (key.to_owned(), twice);
            return Err(ConvergeError::Twice { key, value });
        }
        Ok(Self {
            path,
            is_whole,
            runs,
        })
    }

    /// Dotted path of the key.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// The runs, from coarse to fine.
    pub fn runs(&self) -> &[Planned] {
        &self.runs
    }

    /// What the error goes with a power of: a value, or one over it where it counts.
    pub(super) fn step(&self, value: f64) -> f64 {
        if self.is_whole { 1.0 / value } else { value }
    }
}

/// Whether `folder` may take a new study; nothing is made.
pub(super) fn check_free(folder: &Path) -> Result<(), ConvergeError> {
    let mut entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
        Err(source) => {
            let path = folder.to_owned();
            return Err(ConvergeError::Refused { path, source });
        }
    };
    match entries.next() {
        None => Ok(()),
        Some(_) => Err(ConvergeError::NotEmpty {
            folder: folder.to_owned(),
        }),
    }
}

fn key_and_values(written: &str) -> Result<(&str, Vec<&str>), ConvergeError> {
    let no_key = || ConvergeError::NotKeyAndValues {
        written: written.to_owned(),
    };
    let (key, values) = written.split_once('=').ok_or_else(no_key)?;
    let key = key.trim();
    if key.is_empty() {
        return Err(no_key());
    }
    let mut values: Vec<&str> = values.split(',').map(str::trim).collect();
    values.retain(|value| !value.is_empty());
    if values.len() < 2 {
        let (key, found) = (key.to_owned(), values.len());
        return Err(ConvergeError::TooFew { key, found });
    }
    Ok((key, values))
}

fn sort(runs: &mut [Planned], is_whole: bool) {
    let value = |run: &Planned| run.number.value();
    runs.sort_by(|one, other| {
        if is_whole {
            value(one).total_cmp(&value(other))
        } else {
            value(other).total_cmp(&value(one))
        }
    });
}

fn twice(runs: &[Planned]) -> Option<f64> {
    let values = runs.windows(2);
    let mut same = values.filter(|pair| pair[0].number.value() == pair[1].number.value());
    Some(same.next()?[0].number.value())
}
