//! Storage of expensive results as bytes, by their inputs, between runs.

#[cfg(feature = "file-system")]
mod disk;

use serde::{Serialize, de::DeserializeOwned};

#[cfg(feature = "file-system")]
pub use disk::Cache;

/// Keeps results from run to run.
///
/// A failure is never an error: results that are not found are computed again.
pub trait Keep: Sync {
    /// Returns the content kept under the name `what` for the same `inputs`.
    fn find(&self, what: &str, inputs: &[&[u8]]) -> Option<Vec<u8>>;

    /// Keeps `content` under the name `what` for these `inputs`.
    fn keep(&self, what: &str, inputs: &[&[u8]], content: &[u8]);
}

/// Keeps nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct KeepNothing;

impl Keep for KeepNothing {
    fn find(&self, _: &str, _: &[&[u8]]) -> Option<Vec<u8>> {
        None
    }

    fn keep(&self, _: &str, _: &[&[u8]], _: &[u8]) {}
}

/// Returns the kept result for these inputs, or that of `make`, which is then kept.
pub(crate) fn kept<T: Serialize + DeserializeOwned, E>(
    keep: &dyn Keep,
    what: &str,
    inputs: &[&[u8]],
    make: impl FnOnce() -> Result<T, E>,
) -> Result<T, E> {
    let found = keep.find(what, inputs);
    if let Some(kept) = found.and_then(|content| postcard::from_bytes(&content).ok()) {
        return Ok(kept);
    }
    let made = make()?;
    if let Ok(content) = postcard::to_stdvec(&made) {
        keep.keep(what, inputs, &content);
    }
    Ok(made)
}
