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

pub use self::{data_file::*, key::*, problem::*, render::*, setting::*};
pub(crate) use self::{fault::*, items::*, schema::*, section::*, settings::*};
