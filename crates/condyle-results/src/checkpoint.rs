//! The checkpoint: the state from which a run resumes after a crash, to the same bytes.

use condyle::evolve::MarchState;
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// First bytes of a checkpoint; the last of them is the version of the format.
const MAGIC: &[u8; 20] = b"condyle checkpoint \x10";
const HASH_LENGTH: usize = 32;

/// A march in progress, with the hash of its inputs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint {
    /// Hash of case and meshes, in hexadecimal.
    pub inputs_blake3: String,
    /// Version of condyle that wrote it.
    pub version: String,
    /// The march.
    pub state: MarchState,
}

/// A reason why bytes are not a checkpoint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum CheckpointError {
    /// Not a checkpoint, or one of another version.
    #[error("it was not written by this version of condyle; run the case again in another folder")]
    Foreign,
    /// Its bytes are damaged.
    #[error("the file is damaged; run the case again in another folder")]
    Damaged,
}

impl Checkpoint {
    /// Returns the checkpoint as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        let content = postcard::to_stdvec(self).expect("numbers and text always serialise");
        let hash = blake3::hash(&content);
        [MAGIC.as_slice(), hash.as_bytes(), &content].concat()
    }

    /// Reads a checkpoint from its bytes.
    ///
    /// # Errors
    /// Bytes of another program or version, or damaged ones.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, CheckpointError> {
        // The hash is checked before the bytes are parsed: a damaged length could ask for any amount of memory.
        let guarded = bytes.strip_prefix(MAGIC).ok_or(CheckpointError::Foreign)?;
        let (hash, content) = guarded
            .split_at_checked(HASH_LENGTH)
            .ok_or(CheckpointError::Damaged)?;
        if blake3::hash(content).as_bytes().as_slice() != hash {
            return Err(CheckpointError::Damaged);
        }
        postcard::from_bytes(content).map_err(|_| CheckpointError::Damaged)
    }
}
