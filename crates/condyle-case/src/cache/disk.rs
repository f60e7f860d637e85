//! Results kept on the disk.

use std::{
    env,
    ffi::OsString,
    fs,
    io::{self, Write},
    path::{Path, PathBuf},
    time::SystemTime,
};

use super::Keep;

/// Version of the layout of files.
const FORMAT: &str = "4";
/// Length of the hash that guards a file's content.
const HASH_LENGTH: usize = 32;
/// Extension of the cached files; files with another extension are never removed.
const ENDING: &str = "kept";
/// Limits of the number of files and of their bytes; the newest are kept. A file has about 3 MB for a mesh femur and
/// 5 to 40 MB for a deformable insert, and a study over many of them must not fill the disk.
const MAX_FILES: usize = 20;
const MAX_BYTES: u64 = 300_000_000;

/// A folder of results that are kept from run to run.
///
/// The name of a file is the hash of everything that determines its content: the inputs and the program. A failure is
/// never an error: content that cannot be read is computed again, and content that cannot be written is not kept.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cache {
    folder: Option<PathBuf>,
}

impl Cache {
    /// Creates a cache that keeps nothing.
    pub fn off() -> Self {
        Self::default()
    }

    /// Creates a cache in a folder, which is created when it is needed.
    pub fn in_folder(folder: impl Into<PathBuf>) -> Self {
        let folder = Some(folder.into());
        Self { folder }
    }

    /// Creates the cache of the user: in the folder that `CONDYLE_CACHE` names, or none if that is `off`; otherwise
    /// in `condyle` in the cache folder of the user.
    pub fn of_user() -> Self {
        Self::by_environment(|name| env::var_os(name))
    }

    fn by_environment(variable: impl Fn(&str) -> Option<OsString>) -> Self {
        // The XDG specification requires that relative paths are ignored.
        let path = |name: &str| {
            let path = PathBuf::from(variable(name)?);
            path.is_absolute().then_some(path)
        };
        let own = variable("CONDYLE_CACHE").filter(|own| !own.is_empty());
        let users = || {
            let home = || path("HOME").map(|home| home.join(".cache"));
            let all = path("XDG_CACHE_HOME").or_else(|| path("LOCALAPPDATA").or_else(home));
            all.map(|all| all.join("condyle"))
        };
        let folder = match own {
            Some(own) if own.eq_ignore_ascii_case("off") => None,
            Some(own) => Some(own.into()),
            None => users(),
        };
        Self { folder }
    }
}

impl Keep for Cache {
    fn find(&self, what: &str, inputs: &[&[u8]]) -> Option<Vec<u8>> {
        let key = key(what, inputs);
        read(&file(self.folder.as_ref()?, what, &key), &key)
    }

    fn keep(&self, what: &str, inputs: &[&[u8]], content: &[u8]) {
        if let Some(folder) = &self.folder {
            let key = key(what, inputs);
            // A failure to write is harmless: the content is computed again.
            let _ = write(folder, &file(folder, what, &key), &key, content);
        }
    }
}

fn file(folder: &Path, what: &str, key: &blake3::Hash) -> PathBuf {
    folder.join(format!("{what}-{key}.{ENDING}"))
}

fn key(what: &str, inputs: &[&[u8]]) -> blake3::Hash {
    let mut hasher = blake3::Hasher::new();
    let program = [FORMAT, env!("CARGO_PKG_VERSION"), what].map(str::as_bytes);
    let stamp = program_stamp();
    for part in program.iter().chain([&stamp.as_slice()]).chain(inputs) {
        hasher.update(&part.len().to_le_bytes());
        hasher.update(part);
    }
    hasher.finalize()
}

/// Returns size and date of the program's file: another build of the same version may compute other results.
fn program_stamp() -> Vec<u8> {
    let file = env::current_exe().and_then(fs::metadata);
    let date = |file: &fs::Metadata| {
        file.modified()
            .ok()?
            .duration_since(SystemTime::UNIX_EPOCH)
            .ok()
    };
    let stamp = file.map(|file| (file.len(), date(&file).map_or(0, |date| date.as_nanos())));
    let (length, date) = stamp.unwrap_or_default();
    [length.to_le_bytes().as_slice(), &date.to_le_bytes()].concat()
}

/// Returns the content of a file of that key, unless it is damaged.
fn read(file: &Path, key: &blake3::Hash) -> Option<Vec<u8>> {
    let bytes = fs::read(file).ok()?;
    let (hash, content) = bytes.split_at_checked(HASH_LENGTH)?;
    let is_whole = blake3::keyed_hash(key.as_bytes(), content) == *hash;
    is_whole.then(|| content.to_vec())
}

/// Writes a temporary file and renames it, so that two runs at once each write a whole file.
fn write(folder: &Path, file: &Path, key: &blake3::Hash, content: &[u8]) -> io::Result<()> {
    fs::create_dir_all(folder)?;
    let mut beside = tempfile::NamedTempFile::new_in(folder)?;
    beside.write_all(blake3::keyed_hash(key.as_bytes(), content).as_bytes())?;
    beside.write_all(content)?;
    beside.persist(file)?;
    remove_old(folder)
}

fn remove_old(folder: &Path) -> io::Result<()> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry
            .path()
            .extension()
            .is_some_and(|ending| ending == ENDING)
        {
            let about = entry.metadata()?;
            files.push((about.modified()?, entry.path(), about.len()));
        }
    }
    files.sort();
    let mut bytes = 0;
    let stay = files.iter().rev().take(MAX_FILES).take_while(|file| {
        bytes += file.2;
        bytes <= MAX_BYTES
    });
    let surplus = files.len() - stay.count();
    files[..surplus]
        .iter()
        .try_for_each(|(_, file, _)| fs::remove_file(file))
}

#[cfg(test)]
mod tests;
