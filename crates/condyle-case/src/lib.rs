//! Files that a user writes: case files, study files and measured data, each key declared once.
//!
//! Numbers carry their unit in the name of their key. Every problem is reported with its file, its line and a remedy,
//! and all problems of a file are reported together:
//!
//! ```
//! use std::path::Path;
//! use condyle_case::case::CaseReader;
//! use condyle_mesh::files::MemoryFiles;
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
//! # Ok::<(), condyle_case::config::Problems>(())
//! ```

pub mod abaqus;
pub mod cache;
pub mod case;
pub mod config;
pub mod measured;
#[cfg(feature = "file-system")]
pub mod study;
