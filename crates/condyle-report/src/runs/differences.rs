//! All in which two runs differ.

use serde::Serialize;

use super::{
    curves::{CurveDifference, curves},
    maps::{MapDifference, maps},
    numbers::{NumberDifference, numbers},
    run::Run,
    settings::{SettingDifference, settings},
};

/// All in which two runs differ: second less first.
#[derive(Clone, Debug, Serialize)]
pub struct Differences {
    /// What the runs are called.
    pub runs: [String; 2],
    /// What their cases set otherwise.
    pub settings: Vec<SettingDifference>,
    /// Numbers, by size over errors.
    pub numbers: Vec<NumberDifference>,
    /// Motions and loads, by size over range.
    pub curves: Vec<CurveDifference>,
    /// Maps of the last update, by size over the first's largest value.
    pub maps: Vec<MapDifference>,
    /// What could not be held against each other, and why.
    pub notes: Vec<String>,
}

impl Differences {
    /// Holds the second run against the first.
    pub fn of(first: &Run, second: &Run) -> Self {
        let [one, two] = [first, second].map(|run| &run.results);
        let cases = one.case.as_deref().zip(two.case.as_deref());
        let summaries = one.summary.as_ref().zip(two.summary.as_ref());
        Self {
            runs: [first.name.clone(), second.name.clone()],
            settings: cases.map_or_else(Vec::new, |(one, two)| settings(one, two)),
            numbers: summaries.map_or_else(Vec::new, |(one, two)| numbers(one, two)),
            curves: curves(one, two),
            maps: maps(first, second),
            notes: notes(first, second),
        }
    }

    /// Whether nothing differs of what could be held against each other.
    pub fn is_none(&self) -> bool {
        self.numbers.is_empty() && self.curves.is_empty() && self.maps.is_empty()
    }
}

fn notes(first: &Run, second: &Run) -> Vec<String> {
    let mut notes = Vec::new();
    for run in [first, second] {
        let left_out = run.results.left_out.iter();
        notes.extend(left_out.map(|why| format!("{}: left out: {why}", run.name)));
        notes.extend(run.lacks());
    }
    let maps = first.maps_apart(second);
    notes.extend(maps.map(|why| {
        let [one, two] = [first, second].map(|run| &run.name);
        format!("Maps of {one} and {two} cannot be subtracted: {why}.")
    }));
    if first.results.side != second.results.side {
        notes.push(
            "One is a right knee and the other a left one: medial is on opposite sides.".to_owned(),
        );
    }
    let version = |run: &Run| Some(run.results.summary.as_ref()?.version.clone());
    if let Some((one, two)) = version(first).zip(version(second))
        && one != two
    {
        notes.push(format!("The runs are of condyle {one} and {two}."));
    }
    notes
}

impl Run {
    /// Files without which something cannot be held against another run.
    fn lacks(&self) -> Option<String> {
        let Self { name, results, .. } = self;
        let gone: Vec<&str> = [
            (
                "summary.json (the run is not finished)",
                results.summary.is_none(),
            ),
            ("kinematics.csv", results.kinematics.is_none()),
            ("case.toml", results.case.is_none()),
        ]
        .into_iter()
        .filter_map(|(file, gone)| gone.then_some(file))
        .collect();
        (!gone.is_empty()).then(|| format!("{name}: not there: {}.", gone.join(", ")))
    }
}
