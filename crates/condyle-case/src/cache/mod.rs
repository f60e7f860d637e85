//! Cache of expensive results between runs.

#[cfg(feature = "file-system")]
mod disk;
mod keep;

#[cfg(feature = "file-system")]
pub use disk::Cache;
pub use keep::{Keep, KeepNothing};

pub(crate) use keep::kept;
