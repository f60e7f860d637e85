//! What every table of a case brings: how it is read, written and described.

use condyle::machine::Waveform;
use condyle::wear::WearLawKind;

use super::frame::Side;
use super::waveform::CaseChannel;
use crate::config::{Log, Page, Section, TableSchema, Writer};

/// Kinds of wear law to choose from; the first is taken where a case names none.
pub type WearLaws = &'static [&'static WearLawKind];

/// How the table of a waveform is written.
pub(super) type WriteWaveform = fn(&mut Writer, &str, CaseChannel, &Waveform);

/// What a table is read with besides its keys.
pub(super) struct Context {
    pub side: Side,
    pub wear_laws: WearLaws,
}

/// A part of a case with a table of its own, declared once in its file and listed once in `contents.rs`.
pub(super) trait Table: Sized {
    /// Name of the table in the file.
    const NAME: &'static str;

    /// Reads the table from the `root` of a case; every problem goes to `log`.
    fn read_in(root: &Section<'_>, context: &Context, log: &mut Log<'_>) -> Option<Self>;

    /// Writes the table with its header.
    fn write_in(&self, waveforms: WriteWaveform, out: &mut Writer);

    /// Adds the table to the JSON schema of a case.
    fn add_to_schema(case: TableSchema, laws: WearLaws) -> TableSchema;

    /// Adds the table to the page of the book that lists every key.
    fn add_to_page(page: &mut Page, laws: WearLaws);
}

/// Makes tables of [`Settings`](crate::config::Settings): `Type = "name", "what it holds.";`
macro_rules! plain_tables {
    ($( $table:ty = $name:literal, $about:literal; )+) => { $(
        impl $crate::case::table::Table for $table {
            const NAME: &'static str = $name;

            fn read_in(
                root: &$crate::config::Section<'_>,
                _: &$crate::case::table::Context,
                log: &mut $crate::config::Log<'_>,
            ) -> Option<Self> {
                $crate::config::read_table(root, $name, log)
            }

            fn write_in(
                &self,
                _: $crate::case::table::WriteWaveform,
                out: &mut $crate::config::Writer,
            ) {
                out.table($name);
                $crate::config::Settings::write(self, out);
            }

            fn add_to_schema(
                case: $crate::config::TableSchema,
                _: $crate::case::table::WearLaws,
            ) -> $crate::config::TableSchema {
                let keys = <Self as $crate::config::Settings>::keys();
                case.with_table($name, $crate::config::TableSchema::new($about).with_keys(&keys))
            }

            fn add_to_page(page: &mut $crate::config::Page, _: $crate::case::table::WearLaws) {
                page.section(concat!("`[", $name, "]`"), &<Self as $crate::config::Settings>::keys());
            }
        }
    )+ };
}

pub(super) use plain_tables;
