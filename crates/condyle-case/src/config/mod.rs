//! Files of keys and values: every key declared once, read with the place of each problem, and
//! written back.
//!
//! What a case or measured data are made of stands above and is not known here: each brings its
//! own keys ([`Settings`], [`Variants`]) and its own reasons ([`Reason`]).

mod columns;
mod data_file;
pub(crate) mod key;
pub(crate) mod log;
mod problem;
mod reason;
mod render;
mod schema;
pub(crate) mod section;
pub(crate) mod setting;
pub(crate) mod settings;
mod suggest;
pub(crate) mod variants;
pub(crate) mod writer;

pub use columns::ColumnReason;
pub use data_file::DataFile;
pub use key::{Key, Kind, Limits, WhereSilent};
pub use log::{Base, Log};
pub use problem::{Problem, Problems};
pub use reason::{FileReason, KeyReason, Reason};
pub use render::{RenderStyle, visible};
pub use section::Section;
pub use setting::{Level, Levels, Names, Setting};
pub use settings::Settings;
pub use variants::{Choices, Offered, Variants};
pub use writer::Writer;

pub(crate) use columns::{Cell, Columns};
pub(crate) use key::{names, number, plain, quoted_list, within};
pub(crate) use problem::{Placed, Source, read_source};
pub(crate) use schema::{Page, TableSchema};
pub(crate) use section::read_document;
pub(crate) use setting::{choice, pairs, read_word, wrong_type};
pub(crate) use settings::{read_table, settings};
pub(crate) use suggest::{likeliest, nearest};
pub(crate) use variants::variants;

#[cfg(feature = "file-system")]
pub(crate) use key::quoted;

#[cfg(test)]
pub(crate) use suggest::SYNONYMS;
