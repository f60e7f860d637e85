//! Measured data read from the disk.

use std::path::Path;
use std::sync::Arc;

use super::read::Measured;
use crate::case::Side;
use crate::config::Problems;
use crate::files::{Disk, Files};

impl Measured {
    /// Reads the file at `path` for a `side` knee; paths in it count from its folder.
    ///
    /// # Errors
    /// As [`Self::read_from`].
    pub fn read(path: &Path, side: Side) -> Result<Self, Problems> {
        let disk: Arc<dyn Files> = Arc::new(Disk);
        Self::read_from(&disk, path, side)
    }
}
