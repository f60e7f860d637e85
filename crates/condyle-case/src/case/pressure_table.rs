//! The pressure table of a case: points in the case itself, or in a CSV file.

use condyle::contact::{PressureTable, PressureTableError};

use crate::config::*;

struct Form {
    law: &'static str,
    /// Keys of the points in the case file and of a CSV file.
    ways: [&'static str; 2],
    doc: &'static str,
    header: [&'static str; 2],
    /// Units of the columns and the suffixes of their names.
    units: [(&'static str, &'static str); 2],
}

const BY_OVERCLOSURE: Form = Form {
    law: "tabulated",
    ways: ["table", "table_file"],
    doc: "Points [overclosure in mm, pressure in MPa], rising from [0.0, 0.0].",
    header: ["overclosure_mm", "pressure_mpa"],
    units: [("mm", "_mm"), ("MPa", "_mpa")],
};

const BY_STRAIN: Form = Form {
    law: "tabulated-strain",
    ways: ["strain_table", "strain_table_file"],
    doc: "Points [overclosure over thickness, pressure in MPa], rising from [0.0, 0.0].",
    header: ["overclosure_over_thickness", "pressure_mpa"],
    units: [
        ("parts of the thickness", "_over_thickness"),
        ("MPa", "_mpa"),
    ],
};

settings! {
    /// Error of a fitted table.
    TableError {
        /// Largest error of the peak pressure with this table in stance, in the first and last cycle, relative to the deformable insert; `condyle calibrate` writes it, and runs with the table report it.
        peak_error_percent: Option<f64> = None, in within(0.0, 1000.0);
    }
}

/// Pressure against overclosure over thickness.
#[derive(Clone, Debug, PartialEq)]
pub struct StrainTable {
    /// The points, with the overclosure of a layer 1 mm thick.
    pub points: PressureTable,
    /// Their error.
    pub error: TableError,
}

impl Settings for PressureTable {
    fn items() -> Vec<Item> {
        BY_OVERCLOSURE.items()
    }

    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        BY_OVERCLOSURE.read(section, log)
    }

    fn write(&self, out: &mut Writer) {
        BY_OVERCLOSURE.write(self, out);
    }
}

impl Settings for StrainTable {
    fn items() -> Vec<Item> {
        [BY_STRAIN.items(), TableError::items()].concat()
    }

    fn read(section: &Section<'_>, log: &mut Log<'_>) -> Option<Self> {
        let points = BY_STRAIN.read(section, log);
        let error = TableError::read(section, log);
        Some(Self {
            points: points?,
            error: error?,
        })
    }

    fn write(&self, out: &mut Writer) {
        BY_STRAIN.write(&self.points, out);
        self.error.write(out);
    }
}

impl StrainTable {
    /// Returns the points as a file that `strain_table_file` reads.
    pub fn to_csv(&self) -> String {
        let rows = self.points.points().iter();
        let rows = rows.map(|(strain, pressure_mpa)| format!("{strain:?},{pressure_mpa:?}\n"));
        let header = BY_STRAIN.header.join(",");
        format!("{header}\n{}", rows.collect::<String>())
    }
}

impl Form {
    fn items(&self) -> Vec<Item> {
        let keys = self.keys().map(Item::Key);
        keys.into_iter()
            .chain([Item::OneOf(self.ways.to_vec())])
            .collect()
    }

    fn keys(&self) -> [Key; 2] {
        let [table, file] = self.ways;
        let header = self.header.join(",");
        let about_file = format!("CSV file of these points, with the header {header}.");
        [
            Key::optional(table, self.doc, Kind::Pairs),
            Key::optional(file, about_file, DataFile::kind()),
        ]
    }

    fn read(&self, section: &Section<'_>, log: &mut Log<'_>) -> Option<PressureTable> {
        let ([table_key, file_key], [table, file]) = (self.keys(), self.ways);
        match (section.value(table), section.value(file)) {
            (Some(value), None) => {
                let Points(points) = Points::read(value, &table_key, log)?;
                let read = PressureTable::new(points).map_err(|error| {
                    let place = section.item_span(table, point_of(&error));
                    log.problem(place, self.fault(table, &error));
                });
                read.ok()
            }
            (None, Some(value)) => {
                let source = DataFile::read(value, &file_key, log)?.source(section, file, log)?;
                log.noted(&source, self.csv_points(source.inner(), source.name()))
            }
            (Some(_), Some(_)) => {
                log.reject(section.key_span(file), both(&section.name(), table, file))
            }
            (None, None) => {
                let (name, law) = (section.name(), self.law);
                let message =
                    format!("{name} needs one of `{table}` or `{file}` for law = {law:?}");
                log.reject(section.value_span("law"), Fault::new(message, ""))
            }
        }
    }

    fn write(&self, table: &PressureTable, out: &mut Writer) {
        out.comment(self.doc);
        out.pairs(self.ways[0], table.points());
    }

    fn fault(&self, key: &str, error: &PressureTableError) -> Fault {
        let words = match error {
            // The message of the error has the unit of an overclosure, which a strain has not.
            PressureTableError::NotFromZero {
                overclosure_mm: strain,
                pressure_mpa,
            } if self.law == BY_STRAIN.law => format!(
                "a pressure table starts at overclosure over thickness 0 and pressure 0 MPa, this one at {strain} and {pressure_mpa} MPa"
            ),
            error => error.to_string(),
        };
        Fault::new(format!("`{key}`: {words}"), "")
    }

    fn csv_points(&self, text: &str, file: &str) -> Result<PressureTable, Vec<Placed>> {
        let columns = Columns::split(text, file, &self.header.join(","))?;
        let names = columns.names();
        let wrong = (0..2).filter(|&index| names[index] != self.header[index]);
        let problems = wrong.map(|index| {
            let (unit, suffix) = self.units[index];
            let fault = other_unit(names[index], unit, suffix);
            (columns.name_span(index), fault)
        });
        let problems: Vec<Placed> = problems.collect();
        if !problems.is_empty() {
            return Err(problems);
        }
        let (overclosures, pressures) = (columns.numbers(0)?, columns.numbers(1)?);
        let point = |(d, p): (&Cell, &Cell)| (d.value, p.value);
        let points = overclosures.iter().zip(&pressures).map(point).collect();
        PressureTable::new(points).map_err(|error| {
            let cell = overclosures.get(point_of(&error));
            let at = cell.map_or(0..0, |cell| cell.span.clone());
            vec![(at, self.fault(self.ways[1], &error))]
        })
    }
}

/// Returns the index of the point at fault.
fn point_of(error: &PressureTableError) -> usize {
    match *error {
        PressureTableError::TooShort { .. } | PressureTableError::NotFromZero { .. } => 0,
        PressureTableError::NotRising { index } => index,
    }
}
