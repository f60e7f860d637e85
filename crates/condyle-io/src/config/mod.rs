//! Files of keys and values: every key declared once, read with the place of each problem, and
//! written back.
//!
//! What a case or measured data are made of stands above and is not known here: each brings its
//! own keys ([`Settings`], [`Variants`]) and its own reasons ([`Reason`]).

mod base;
mod choice;
pub(crate) mod choices;
mod column_reason;
mod columns;
mod cropped;
mod data_file;
mod document;
mod file_reason;
mod json_schema;
pub(crate) mod key;
mod key_at;
mod key_reason;
pub(crate) mod kind;
mod limits;
mod listed;
pub(crate) mod log;
mod numbers;
mod page;
mod problem;
mod problems;
mod reason;
mod render;
pub(crate) mod section;
pub(crate) mod setting;
pub(crate) mod settings;
mod shown;
mod source;
mod synonyms;
mod unit;
mod unknown;
pub(crate) mod value;
pub(crate) mod variants;
mod visible;
pub(crate) mod words;
pub(crate) mod writer;

pub use base::Base;
pub use choices::{Choices, Offered};
pub use column_reason::ColumnReason;
pub use data_file::DataFile;
pub use file_reason::FileReason;
pub use key::{Key, WhereSilent};
pub use key_reason::KeyReason;
pub use kind::Kind;
pub use limits::Limits;
pub use listed::{Level, Levels, Names};
pub use log::Log;
pub use problem::Problem;
pub use problems::Problems;
pub use reason::Reason;
pub use render::RenderStyle;
pub use section::Section;
pub use setting::Setting;
pub use settings::Settings;
pub use unit::unit_of;
pub use variants::Variants;
pub use visible::visible;
pub use writer::Writer;

pub(crate) use choice::choice;
pub(crate) use columns::{Cell, Columns};
pub(crate) use document::read_document;
pub(crate) use json_schema::TableSchema;
pub(crate) use key::names;
pub(crate) use limits::{plain, within};
pub(crate) use numbers::pairs;
pub(crate) use page::Page;
pub(crate) use problem::Placed;
pub(crate) use settings::{read_table, settings};
pub(crate) use source::{Source, read_source};
#[cfg(test)]
pub(crate) use synonyms::SYNONYMS;
pub(crate) use unit::split_unit;
pub(crate) use unknown::{likeliest, nearest};
#[cfg(feature = "file-system")]
pub(crate) use value::quoted;
pub(crate) use value::{number, quoted_list};
pub(crate) use variants::variants;
pub(crate) use words::{read_word, wrong_type};
