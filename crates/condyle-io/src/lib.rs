//! Files of condyle: mesh formats, case files and the results folder, one file a format.
//!
//! Numbers cross this border with their unit in the name, and every error says which file, which
//! line where the format is text, and what to do.
//!
//! A case without a disk; what is wrong with it is told with its place, all at once:
//!
//! ```
//! use std::path::Path;
//! use condyle_io::{case::CaseReader, files::MemoryFiles};
//!
//! let read = |text: &str| {
//!     let files = MemoryFiles::default().with("case.toml", text);
//!     CaseReader::new(files).read(Path::new("case.toml"))
//! };
//! let case = read("[contact]\nfriction = 0.04\n")?;
//! let test = case.build(1).expect("the generic implant").test;
//! assert_eq!(test.insert.regions().names(), ["medial", "lateral"]);
//!
//! let problems = read("[contact]\nfrictoin = 0.04\n").unwrap_err();
//! assert!(problems.to_string().contains("friction"), "did you mean?");
//! # Ok::<(), condyle_io::config::Problems>(())
//! ```

pub use condyle_mesh::{files, formats as mesh};

pub mod abaqus;
pub mod cache;
pub mod case;
pub mod config;
pub mod measured;
pub mod results;
#[cfg(feature = "file-system")]
pub mod study;
