//! Pressure law and friction.

use condyle::contact::{PressureTable, PressureTableError};

use super::declared::{Friction, PressureForm};
use super::files::DataFile;
use super::keys::{Key, Settings};
use super::parse::{Log, Others, Section, names};
use super::problems::{Reason, Source};
use super::setting::Setting;
use super::table::{Placed, Table, read_source};
use super::waveforms::pairs;

/// Pressure law and friction.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Pressure against overclosure.
    pub law: PressureLawChoice,
    /// Friction.
    pub friction: Friction,
}

/// Pressure against overclosure; the modulus comes from the material.
#[derive(Clone, Debug, PartialEq)]
pub enum PressureLawChoice {
    /// p = K d / h.
    Linear,
    /// p = -K ln(1 - d / h).
    Logarithmic,
    /// Points of pressure against overclosure.
    Tabulated(PressureTable),
}

impl PressureLawChoice {
    /// The word for it.
    pub fn form(&self) -> PressureForm {
        match self {
            Self::Linear => PressureForm::Linear,
            Self::Logarithmic => PressureForm::Logarithmic,
            Self::Tabulated(_) => PressureForm::Tabulated,
        }
    }
}

/// The key that chooses the law.
pub(super) const LAW: Key = Key {
    name: "law",
    doc: "Form of pressure against overclosure.",
    kind: <PressureForm as Setting>::kind,
    default: Some(|| Some("\"linear\"".to_owned())),
    limits: None,
};

/// The keys of a tabulated law.
pub(super) const TABULATED: &[Key] = &[TABLE, TABLE_FILE];

/// Points in the case file.
pub(super) const TABLE: Key = Key {
    name: "table",
    doc: "Points [overclosure in mm, pressure in MPa], rising from [0.0, 0.0].",
    kind: || "a list of pairs of numbers".to_owned(),
    default: Some(|| None),
    limits: None,
};

const TABLE_FILE: Key = Key {
    name: "table_file",
    doc: "CSV file of these points, with the header overclosure_mm,pressure_mpa.",
    kind: <DataFile as Setting>::kind,
    default: Some(|| None),
    limits: None,
};

/// Header of a file of points.
const TABLE_HEADER: [&str; 2] = ["overclosure_mm", "pressure_mpa"];

impl Contact {
    pub(super) fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let form = section.setting(&LAW, Some(PressureForm::Linear), log)?;
        check_keys(section, form, log);
        let friction = Friction::read(section, log);
        let law = match form {
            PressureForm::Linear => PressureLawChoice::Linear,
            PressureForm::Logarithmic => PressureLawChoice::Logarithmic,
            PressureForm::Tabulated => PressureLawChoice::Tabulated(read_table(section, log)?),
        };
        Some(Self {
            law,
            friction: friction?,
        })
    }
}

fn check_keys(section: &Section<'_>, form: PressureForm, log: &mut Log<'_>) {
    let mut known: Vec<&str> = names(Friction::KEYS).chain(["law"]).collect();
    if form == PressureForm::Tabulated {
        known.extend(names(TABULATED));
    }
    let others = Others {
        key: "law",
        word: form.word(),
        all: &[("tabulated", TABULATED)],
    };
    section.check_keys(&known, &others, log);
}

fn read_table(section: &Section<'_>, log: &mut Log<'_>) -> Option<PressureTable> {
    match (section.value(TABLE.name), section.value(TABLE_FILE.name)) {
        (Some(value), None) => {
            let pairs = pairs(value, TABLE.name, log)?;
            let points = pairs.iter().map(|&([d, p], _)| (d, p)).collect();
            PressureTable::new(points)
                .map_err(|error| {
                    let at = pairs.get(place_of(&error)).map(|(_, span)| span.clone());
                    let key = TABLE.name;
                    log.problem(
                        at.unwrap_or(value.span()),
                        Reason::PressureTable { key, error },
                    );
                })
                .ok()
        }
        (None, Some(value)) => {
            let file = DataFile::read(value, &TABLE_FILE, log)?;
            match read_source(file.path()) {
                Ok(source) => from_csv(&source, log),
                Err(reason) => {
                    log.problem(value.span(), reason);
                    None
                }
            }
        }
        (Some(_), Some(_)) => {
            let (first, second) = (TABLE.name.to_owned(), TABLE_FILE.name.to_owned());
            let reason = Reason::Both {
                section: section.name(),
                first,
                second,
            };
            log.problem(section.key_span(TABLE_FILE.name), reason);
            None
        }
        (None, None) => {
            let keys = "`table` or `table_file` for law = \"tabulated\"".to_owned();
            let reason = Reason::NoneOf {
                section: section.name(),
                keys,
            };
            log.problem(section.value_span("law"), reason);
            None
        }
    }
}

/// Which point an error is about.
fn place_of(error: &PressureTableError) -> usize {
    match *error {
        PressureTableError::TooShort { .. } | PressureTableError::NotFromZero { .. } => 0,
        PressureTableError::NotRising { index } => index,
    }
}

fn from_csv(source: &Source, log: &mut Log<'_>) -> Option<PressureTable> {
    match csv_points(source.inner(), source.name()) {
        Ok(table) => Some(table),
        Err(problems) => {
            for (span, reason) in problems {
                log.problem_in(source, span, reason);
            }
            None
        }
    }
}

fn csv_points(text: &str, file: &str) -> Result<PressureTable, Vec<Placed>> {
    let table = Table::split(text, file, &TABLE_HEADER.join(",")).map_err(|placed| vec![placed])?;
    check_header(&table)?;
    let (overclosures, pressures) = (table.numbers(0)?, table.numbers(1)?);
    let points = overclosures.iter().zip(&pressures);
    let points = points.map(|(d, p)| (d.value, p.value)).collect();
    PressureTable::new(points).map_err(|error| {
        let at = overclosures
            .get(place_of(&error))
            .map_or(0..0, |cell| cell.span.clone());
        let key = TABLE_FILE.name;
        vec![(at, Reason::PressureTable { key, error })]
    })
}

fn check_header(table: &Table<'_>) -> Result<(), Vec<Placed>> {
    let columns = table.columns();
    let units = [("mm", "_mm"), ("MPa", "_mpa")];
    let problem = |column: usize| {
        let (unit, suffix) = units[column];
        let name = columns[column].to_owned();
        let reason = Reason::ColumnUnit {
            column: name,
            unit,
            suffix,
        };
        (table.column_span(column), reason)
    };
    let wrong = |&column: &usize| columns[column] != TABLE_HEADER[column];
    let problems: Vec<Placed> = (0..2).filter(wrong).map(problem).collect();
    if problems.is_empty() {
        Ok(())
    } else {
        Err(problems)
    }
}
