//! Keeps in memory what the command writes into a folder.

use condyle::{evolve::March, geometry::TriangleMesh};
use condyle_case::case::{Case, Side};
use condyle_lab::RunKeeper;
use condyle_results::{
    InsertFields, Summary, femur_on_side, femur_pose_csv, kinematics_csv, kinematics_file, wear_csv,
};

use crate::record::Record;
use crate::table::Table;

/// Keeps in memory what the command writes into a folder.
pub struct Recorder {
    side: Side,
    /// Whether the insert and its fields are kept.
    keeps_fields: bool,
    record: Record,
}

impl Recorder {
    pub fn new(case: &Case, keeps_fields: bool) -> Self {
        let record = Record {
            case: case.to_toml(),
            ..Record::default()
        };
        Self {
            side: case.heading.side,
            keeps_fields,
            record,
        }
    }

    /// The whole, with its summary if the run is done.
    pub fn into_record(mut self, summary: Option<&Summary>) -> Record {
        let text = |summary| serde_json::to_string(summary).expect("numbers and text serialise");
        self.record.summary = summary.map(text);
        self.record
    }

    fn push_insert(&mut self, march: &March) {
        if !self.keeps_fields {
            return;
        }
        let fields = InsertFields::of(march, self.side);
        let insert = &mut self.record.insert;
        insert.articulating = fields.articulating.iter().map(|&mark| mark == 1).collect();
        let scalars = fields
            .scalars
            .iter()
            .map(|(name, values)| (*name, values.as_slice()));
        let vectors = fields
            .vectors
            .iter()
            .map(|(name, values)| (*name, values.as_slice()));
        insert.push(&fields.mesh, scalars, vectors);
    }

    /// The tables so far; they are written when nothing more comes.
    fn take_tables(&mut self, march: &March) {
        let mut texts = vec![
            ("wear".to_owned(), wear_csv(&march.state().updates)),
            ("femur_pose".to_owned(), femur_pose_csv(march, self.side)),
        ];
        let activities = march
            .test()
            .activities
            .iter()
            .zip(&march.state().activities);
        for (number, (activity, own)) in activities.enumerate() {
            let file = kinematics_file(number, &activity.name);
            let cycles = own.first_and_last.as_ref();
            let text = kinematics_csv(activity.machine.mechanism, cycles);
            texts.push((file.trim_end_matches(".csv").to_owned(), text));
        }
        let table =
            |(name, text): (String, String)| (name, Table::parse(&text).unwrap_or_default());
        self.record.tables = texts.into_iter().map(table).collect();
    }
}

impl RunKeeper for Recorder {
    fn settled(&mut self, march: &March, femur: &TriangleMesh) {
        self.record.femur = femur_on_side(femur, &march.neutral_pose(), self.side);
        self.push_insert(march);
        self.take_tables(march);
    }

    fn updated(&mut self, march: &March) {
        self.push_insert(march);
        if march.is_done() {
            self.take_tables(march);
        }
    }
}
