//! How a case is run.

use std::path::PathBuf;

use condyle_io::cache::Cache;

/// How a case is run.
#[derive(Clone, Debug)]
pub struct RunOptions {
    /// Folder for the results.
    pub out: PathBuf,
    /// Go on with the run that is in the folder.
    pub resume: bool,
    /// Write over the run that is in the folder.
    pub force: bool,
    /// Threads for the one-time work on a mesh; results do not depend on it.
    pub threads: usize,
    /// Where the one-time work on a mesh is kept for the next run; results do not depend on it.
    pub cache: Cache,
}
