//! Files of keys and values: every key is declared once, read with the place of each problem, and written back.
//!
//! The layer is independent of contents: cases, studies and measured data declare their own keys (`Settings`) and
//! their own problems ([`Reason`]).

mod columns;
mod data_file;
mod document;
mod items;
mod key;
mod log;
mod problem;
mod reason;
mod render;
mod schema;
mod section;
mod setting;
pub(crate) mod settings;
mod suggest;
mod writer;

pub use data_file::DataFile;
pub use key::Limits;
pub use problem::{Problem, Problems};
pub use reason::Reason;
pub use render::{RenderStyle, visible};
pub use setting::{Level, Levels, Names, Points};

pub(crate) use columns::{Cell, Columns, no_column, other_unit};
pub(crate) use document::{rename, set_value, take, value_at};
pub(crate) use items::{Choices, Item, Offered, TableItem, check, keys};
pub(crate) use key::{Key, Kind, WhereSilent, names, number, plain, quoted, quoted_list, within};
pub(crate) use log::{Base, Log};
pub(crate) use problem::{Placed, Source, read_source};
pub(crate) use reason::{Fault, both, idle, out_of_range, unknown_word};
pub(crate) use schema::{rows, sections, table_schema};
pub(crate) use section::{Section, read_document, read_part};
pub(crate) use setting::{Setting, choice, read_word, wrong_type};
pub(crate) use settings::{Settings, settings, variants};
pub(crate) use suggest::{likeliest, nearest};
pub(crate) use writer::Writer;

#[cfg(test)]
pub(crate) use suggest::SYNONYMS;
