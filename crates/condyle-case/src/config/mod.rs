//! Files of keys and values: every key is declared once, read with the place of each problem, and written back.
//!
//! The layer is independent of contents: cases, studies and measured data declare their own keys (`Settings`).

mod data_file;
mod fault;
mod items;
mod key;
mod problem;
mod render;
mod schema;
mod section;
mod setting;
pub(crate) mod settings;

pub use data_file::DataFile;
pub use key::Limits;
pub use problem::{Problem, Problems};
pub use render::{RenderStyle, visible};
pub use setting::{Level, Levels, Names, Points};

pub(crate) use data_file::{Cell, Columns, cells, lines, no_column, other_unit};
pub(crate) use fault::{Fault, both, idle, likeliest, nearest, out_of_range, unknown_word};
pub(crate) use items::{Choices, Item, Offered, TableItem, check, keys};
pub(crate) use key::{Key, Kind, WhereSilent, names, number, plain, quoted, quoted_list, within};
pub(crate) use problem::{Base, Log, Placed, Source, read_source};
pub(crate) use schema::{rows, sections, table_schema};
pub(crate) use section::{Section, read_document, read_part, rename, set_value, take, value_at};
pub(crate) use setting::{Setting, Writer, choice, read_word, words, wrong_type};
pub(crate) use settings::{Settings, settings, variants};

#[cfg(test)]
pub(crate) use fault::SYNONYMS;
