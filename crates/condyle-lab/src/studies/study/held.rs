//! The folder of a study, held by whoever runs its tests.

use std::{fs, path::Path};

use condyle_io::results::{FolderLock, ResultsFolder};

use super::{
    error::StudyError,
    plan::{Plan, Test},
    shard::Shard,
    store::{Keeping, Store},
    test_run::TestResult,
};

/// The folder of a study, which nobody else writes into as long as this is there.
pub struct HeldFolder {
    pub(super) store: Store,
    _lock: Option<FolderLock>,
}

impl HeldFolder {
    /// Takes the folder `out` for a plan; folder and database are made if they are not there.
    ///
    /// # Errors
    /// A folder of something else, in use by another, or that cannot be written.
    pub fn take(plan: &Plan, out: &Path) -> Result<Self, StudyError> {
        Self::take_for(plan, Shard::WHOLE, out)
    }

    pub(super) fn take_for(plan: &Plan, shard: Shard, out: &Path) -> Result<Self, StudyError> {
        fs::create_dir_all(out).map_err(|source| StudyError::Refused {
            path: out.to_path_buf(),
            source,
        })?;
        let lock = ResultsFolder::lock(out)?;
        let store = Store::open(out, &Keeping { plan, shard })?;
        Ok(Self { store, _lock: lock })
    }

    /// Numbers of the tests of a plan that are not kept.
    ///
    /// # Errors
    /// A search, whose tests are not known before they are due.
    pub fn missing(&self, plan: &Plan) -> Result<Vec<u64>, StudyError> {
        if plan.is_search() {
            return Err(StudyError::NoShards);
        }
        let rows = (0..).zip(self.store.kept(plan.tests())?);
        Ok(rows
            .filter(|(_, is_kept)| !is_kept)
            .map(|(row, _)| row)
            .collect())
    }

    /// Keeps what tests found, all in one step; of a test that is kept already nothing changes.
    ///
    /// # Errors
    /// A disk that is full.
    pub fn keep(&self, plan: &Plan, found: &[(Test, TestResult)]) -> Result<(), StudyError> {
        self.store.keep(plan, found)
    }
}
