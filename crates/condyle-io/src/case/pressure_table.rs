//! The pressure table of a case: points in the case itself, or in a CSV file.

use condyle::contact::{PressureTable, PressureTableError};
use thiserror::Error;

use crate::keyed::{
    Cell, ColumnReason, Columns, DataFile, Key, KeyReason, Kind, Log, Placed, Reason, Section,
    Setting, Settings, WhereSilent, Writer, pairs,
};

/// Points in the case file.
const TABLE: &str = "table";
/// A CSV file of points.
const TABLE_FILE: &str = "table_file";
/// The keys of which one gives the points.
pub(super) const WAYS: [&str; 2] = [TABLE, TABLE_FILE];
/// Header of a file of points.
const HEADER: [&str; 2] = ["overclosure_mm", "pressure_mpa"];

/// Points that make no pressure table.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("`{key}`: {error}")]
pub struct PressureTableReason {
    /// The key that gives them.
    pub key: &'static str,
    /// Why.
    pub error: PressureTableError,
}

impl Reason for PressureTableReason {
    fn advice(&self) -> Option<String> {
        None
    }
}

impl Settings for PressureTable {
    fn keys() -> Vec<Key> {
        let points = Key {
            name: TABLE,
            doc: "Points [overclosure in mm, pressure in MPa], rising from [0.0, 0.0].".into(),
            kind: Kind::Pairs,
            silent: WhereSilent::LeftOut,
            limits: None,
        };
        vec![points, file_key()]
    }

    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        match (section.value(TABLE), section.value(TABLE_FILE)) {
            (Some(_), None) => inline(section, log),
            (None, Some(_)) => from_file(section, log),
            (Some(_), Some(_)) => {
                let reason = KeyReason::Both {
                    section: section.name(),
                    first: TABLE.to_owned(),
                    second: TABLE_FILE.to_owned(),
                };
                log.problem(section.key_span(TABLE_FILE), reason);
                None
            }
            (None, None) => {
                let reason = KeyReason::NoneOf {
                    section: section.name(),
                    keys: "`table` or `table_file` for law = \"tabulated\"".to_owned(),
                };
                log.problem(section.value_span("law"), reason);
                None
            }
        }
    }

    fn write(&self, out: &mut Writer) {
        for key in Self::keys().iter().filter(|key| key.name == TABLE) {
            out.comment(&key.doc);
            out.pairs(key.name, self.points());
        }
    }
}

fn file_key() -> Key {
    Key {
        name: TABLE_FILE,
        doc: "CSV file of these points, with the header overclosure_mm,pressure_mpa.".into(),
        kind: DataFile::kind(),
        silent: WhereSilent::LeftOut,
        limits: None,
    }
}

/// The points that stand in the case itself.
fn inline(section: &Section<'_>, log: &mut Log<'_>) -> Option<PressureTable> {
    let value = section.value(TABLE)?;
    let pairs = pairs(value, TABLE, log)?;
    let points = pairs.iter().map(|&([d, p], _)| (d, p)).collect();
    let table = PressureTable::new(points);
    let placed = table.map_err(|error| {
        let at = pairs.get(place_of(&error)).map(|(_, span)| span.clone());
        let reason = PressureTableReason { key: TABLE, error };
        log.problem(at.unwrap_or(value.span()), reason);
    });
    placed.ok()
}

/// The points of a CSV file.
fn from_file(section: &Section<'_>, log: &mut Log<'_>) -> Option<PressureTable> {
    let value = section.value(TABLE_FILE)?;
    let file = DataFile::read(value, &file_key(), log)?;
    let source = file.source(section, TABLE_FILE, log)?;
    log.noted(&source, csv_points(source.inner(), source.name()))
}

/// Which point an error is about.
fn place_of(error: &PressureTableError) -> usize {
    match *error {
        PressureTableError::TooShort { .. } | PressureTableError::NotFromZero { .. } => 0,
        PressureTableError::NotRising { index } => index,
    }
}

fn csv_points(text: &str, file: &str) -> Result<PressureTable, Vec<Placed>> {
    let columns = Columns::split(text, file, &HEADER.join(",")).map_err(|placed| vec![placed])?;
    check_header(&columns)?;
    let (overclosures, pressures) = (columns.numbers(0)?, columns.numbers(1)?);
    let point = |(d, p): (&Cell, &Cell)| (d.value, p.value);
    let points = overclosures.iter().zip(&pressures).map(point).collect();
    PressureTable::new(points).map_err(|error| {
        let cell = overclosures.get(place_of(&error));
        let at = cell.map_or(0..0, |cell| cell.span.clone());
        let key = TABLE_FILE;
        vec![Placed::new(at, PressureTableReason { key, error })]
    })
}

fn check_header(columns: &Columns<'_>) -> Result<(), Vec<Placed>> {
    let names = columns.names();
    let units = [("mm", "_mm"), ("MPa", "_mpa")];
    let problem = |index: usize| {
        let (unit, suffix) = units[index];
        let column = names[index].to_owned();
        let reason = ColumnReason::OtherUnit {
            column,
            unit,
            suffix,
        };
        Placed::new(columns.name_span(index), reason)
    };
    let wrong = |&index: &usize| names[index] != HEADER[index];
    let problems: Vec<Placed> = (0..2).filter(wrong).map(problem).collect();
    if problems.is_empty() {
        Ok(())
    } else {
        Err(problems)
    }
}
