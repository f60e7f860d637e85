//! All that a case says: the one list of its tables, from which it is read, written and described.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::Arc;

use condyle::wear::WEAR_LAWS;

use super::activity::Activities;
use super::contact::Contact;
use super::femur::{Femur, FemurPlacement};
use super::frame::{Heading, Side};
use super::insert::{Insert, InsertPlacement};
use super::machine::Machine;
use super::material::{Creep, Material};
use super::run_options::{Accuracy, Limits, Output};
use super::schedule::{March, Time};
use super::table::{Context, Table, WearLaws, WriteWaveform};
use super::wear::Wear;
use crate::config::{Log, Page, Section, Settings, Source, TableSchema, Writer, names};

const OPENING: &str = "\
# The case file

A case is a TOML file. Every key that has a default may be left out; every number has its unit in
its name; paths count from the folder of the case file. This page is made from the declarations
that the program reads a case with.

Editors complete the keys, show what each means, its unit and range, and underline what is wrong, by the schema that
`condyle schema > condyle.schema.json` writes. A case names it in its first line, `#:schema condyle.schema.json`, as the
shipped cases do and `condyle new` writes it, with the schema beside; taplo and the extension Even Better TOML of VS Code read that line. `condyle check` knows more than the
schema: files that must be there, and values that do not fit each other.

## Top of the file

";

/// Declares a case by its tables, in the order they are written.
macro_rules! tables {
    ($( $(#[doc = $about:literal])+ $field:ident: $table:ty, )+) => {
        /// A wear test as its file describes it, checked, with every default filled in.
        #[derive(Clone, Debug, PartialEq)]
        pub struct Case {
            /// Title and side.
            pub heading: Heading,
            $( $(#[doc = $about])+ pub $field: $table, )+
            pub(super) origin: Origin,
        }

        /// Reads every table before giving up on any, so that all problems are found at once.
        pub(super) fn read_case(
            root: &Section<'_>,
            wear_laws: WearLaws,
            log: &mut Log<'_>,
        ) -> Option<Case> {
            let known: Vec<&str> =
                names(&Heading::keys()).chain([$( <$table>::NAME ),+]).collect();
            root.check_keys(&known, log);
            let heading = Heading::read(root, log);
            let side = heading.as_ref().map_or(Side::Right, |heading| heading.side);
            let context = Context { side, wear_laws };
            $( let $field = <$table>::read_in(root, &context, log); )+
            Some(Case {
                heading: heading?,
                $( $field: $field?, )+
                origin: Origin {
                    source: Arc::clone(log.source()),
                    places: root.places(),
                    left_out: Vec::new(),
                },
            })
        }

        impl Case {
            pub(super) fn written(&self, waveforms: WriteWaveform) -> String {
                let mut out = Writer::default();
                self.heading.write(&mut out);
                $( self.$field.write_in(waveforms, &mut out); )+
                out.into_text()
            }
        }

        /// A JSON schema, draft 2020-12, of a case file that may choose from `wear_laws`: every key with
        /// its unit, range, default and meaning, from the declarations that a case is read with.
        ///
        /// It refuses nothing that [`CaseReader`](super::CaseReader) takes. The reader knows more: files
        /// that must be there, and values that do not fit each other.
        pub fn json_schema(wear_laws: WearLaws) -> String {
            let about = "A virtual wear test of a joint replacement: a case of condyle.";
            let case = TableSchema::new(about).with_keys(&Heading::keys());
            $( let case = <$table>::add_to_schema(case, wear_laws); )+
            let mut schema = case.into_schema();
            schema["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
            schema["title"] = "Case of condyle".into();
            format!("{schema:#}\n")
        }

        /// Every key of a case file that may choose from `wear_laws`, with its unit, range, default and
        /// meaning, as Markdown.
        pub fn schema_markdown(wear_laws: WearLaws) -> String {
            let mut page = Page::new(OPENING);
            page.table(&Heading::keys());
            $( <$table>::add_to_page(&mut page, wear_laws); )+
            page.into_text()
        }
    };
}

// A new table is a type with `Table` in its own file, and one line here.
tables! {
    /// The femoral component.
    femur: Femur,
    /// How it sits on its bone.
    femur_placement: FemurPlacement,
    /// The tibial insert.
    insert: Insert,
    /// How it sits in its holder.
    insert_placement: InsertPlacement,
    /// Polyethylene of the insert.
    material: Material,
    /// Pressure law and friction.
    contact: Contact,
    /// The simulator.
    machine: Machine,
    /// What it does in turn; where there is none, what the machine's own waveforms say.
    activities: Activities,
    /// The wear law.
    wear: Wear,
    /// The law of creep.
    creep: Creep,
    /// The march over the life of the insert.
    march: March,
    /// Steps and tolerances in time.
    time: Time,
    /// What a run tells of its own accuracy.
    accuracy: Accuracy,
    /// What a run may take of the computer.
    limits: Limits,
    /// What a run writes besides what it always does.
    output: Output,
}

impl Case {
    /// The [`json_schema`] of a case that may choose from the wear laws that come with condyle.
    pub fn json_schema() -> String {
        json_schema(WEAR_LAWS)
    }
}

/// The text of a case file, the places of its keys, and what of it was left out.
///
/// All origins are equal: two cases are the same if they say the same, wherever they stand.
#[derive(Clone, Debug)]
pub(super) struct Origin {
    /// The text.
    pub(super) source: Source,
    /// The places of its keys and tables, by dotted path: a failed build points to them.
    pub(super) places: BTreeMap<String, Range<usize>>,
    /// Constants that a law chosen from outside does not have.
    pub(super) left_out: Vec<LeftOutConstant>,
}

impl PartialEq for Origin {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// A constant of the file that the law chosen from outside does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LeftOutConstant {
    /// As the file writes it.
    pub(super) written: String,
    /// The law chosen from outside.
    pub(super) law: &'static str,
}
