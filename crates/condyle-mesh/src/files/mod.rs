//! Files by an interface, so that a case can be read wherever its files are: on a disk, or as bytes
//! in memory, where a browser or another program has put them.

#[cfg(feature = "file-system")]
mod disk;
mod interface;
mod memory;
#[cfg(feature = "file-system")]
mod path_from;

#[cfg(feature = "file-system")]
pub use disk::Disk;
pub use interface::Files;
pub use memory::MemoryFiles;
#[cfg(feature = "file-system")]
pub use path_from::path_from;
