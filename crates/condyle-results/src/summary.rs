//! `summary.json`: the numbers of the catalogue, and the parts that are not numbers.

use std::{collections::BTreeMap, ops::Index};

use condyle::{
    evolve::March,
    machine::{Mechanism, TestedJoint},
};
use serde::{
    Deserialize, Deserializer, Serialize, Serializer, de::DeserializeOwned, ser::SerializeMap,
};
use serde_json::{Map, Value};

use super::{
    catalogue::{self, FinishedRun, PARTS, RunFacts, Scalar},
    error_estimate::ErrorEstimate,
    parts::{ActivitySummary, CreepSummary, LawWear, MotionColumn, NeutralPose},
    prediction::Prediction,
};

/// The results of a run in one table: `summary[&MASS_LOSS_MG]` is a number of the catalogue.
///
/// A summary is read from any version of `summary.json`: an entry that is missing is absent, and one that is not in the
/// catalogue is in [`Self::others`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    scalars: BTreeMap<&'static str, f64>,
    /// Reasons to doubt the numbers, the worst first.
    pub plausibility: Vec<PlausibilityWarning>,
    /// Remarks on the physics of the run that leave its numbers sound, each with its effect on them.
    pub notes: Vec<PlausibilityWarning>,
    /// The results that laboratories would find; none unless the march summed the family of calibrated laws.
    pub prediction: Option<Prediction>,
    /// Estimated discretisation errors; none if the case does not request them.
    pub error: Option<ErrorEstimate>,
    /// Wear by every law for the same histories, that of the run first; only this law moves the surface.
    pub wear_laws: Vec<LawWear>,
    /// Each of several activities; motions and ranges of the summary are those of the first.
    pub activities: Vec<ActivitySummary>,
    /// Creep; none for an insert that does not creep.
    pub creep: Option<CreepSummary>,
    /// The joint whose replacement the machine tests.
    pub joint: TestedJoint,
    /// The joints of the machine; empty in a file of an older version.
    pub motions: Vec<MotionColumn>,
    /// The pose of the settled femur in the insert frame, at which AP, ML and IS read zero.
    pub neutral_pose: Option<NeutralPose>,
    /// Corrections of the input, and remarks on suspicious input.
    pub warnings: Vec<String>,
    /// Version of condyle.
    pub version: String,
    /// Hash of case and meshes, in hexadecimal.
    pub inputs_blake3: String,
    /// Entries of a file by another version that the catalogue does not have.
    pub others: BTreeMap<String, Value>,
}

/// A number of a run beyond the limit of plausible runs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlausibilityWarning {
    /// The name of the check, the same in all versions.
    pub check: String,
    /// The value, in `unit`.
    pub value: f64,
    /// Its limit.
    pub limit: f64,
    /// Unit of value and limit; empty for a pure number.
    pub unit: String,
    /// The doubt in a sentence with the numbers.
    pub message: String,
    /// The remedy in a sentence.
    pub advice: String,
}

impl Summary {
    /// Creates the numbers, activities and creep of a march; none before its first update.
    pub fn new(march: &March, facts: RunFacts) -> Option<Self> {
        let run = FinishedRun::new(march, facts)?;
        let values = catalogue::scalars();
        let values = values.filter_map(|scalar| Some((scalar.key, scalar.compute(&run)?)));
        Some(Self {
            scalars: values.collect(),
            activities: ActivitySummary::of(march),
            creep: CreepSummary::of(march.state()),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            ..Self::of_machine(march.test().machine().mechanism)
        })
    }

    /// Creates a summary without numbers, which names the joints of a machine.
    pub fn of_machine(mechanism: &Mechanism) -> Self {
        Self {
            joint: mechanism.tests,
            motions: MotionColumn::all_of(mechanism),
            ..Self::default()
        }
    }

    /// Returns the value of a number; none if the run does not have it.
    pub fn get(&self, scalar: &Scalar) -> Option<f64> {
        self.scalars.get(scalar.key).copied()
    }

    /// Returns the estimated discretisation error of a number, in its unit; none if it was not estimated.
    pub fn total_error(&self, scalar: &Scalar) -> Option<f64> {
        Some(self.error.as_ref()?.get(scalar)?.in_unit.total)
    }

    /// Replaces the value of a number.
    pub fn set(&mut self, scalar: &Scalar, value: f64) {
        self.scalars.insert(scalar.key, value);
    }

    fn write_part<M: SerializeMap>(&self, key: &'static str, map: &mut M) -> Result<(), M::Error> {
        match key {
            "plausibility" => map.serialize_entry(key, &self.plausibility),
            "notes" => map.serialize_entry(key, &self.notes),
            "prediction" if self.prediction.is_some() => map.serialize_entry(key, &self.prediction),
            "error" => map.serialize_entry(key, &self.error),
            "wear_laws" => map.serialize_entry(key, &self.wear_laws),
            "activities" if !self.activities.is_empty() => {
                map.serialize_entry(key, &self.activities)
            }
            "creep" if self.creep.is_some() => map.serialize_entry(key, &self.creep),
            "joint" => map.serialize_entry(key, &self.joint),
            "motions" => map.serialize_entry(key, &self.motions),
            "neutral_pose" => map.serialize_entry(key, &self.neutral_pose),
            "warnings" => map.serialize_entry(key, &self.warnings),
            "version" => map.serialize_entry(key, &self.version),
            "inputs_blake3" => map.serialize_entry(key, &self.inputs_blake3),
            _ => Ok(()),
        }
    }
}

/// NaN where the run does not have the number.
impl Index<&Scalar> for Summary {
    type Output = f64;

    fn index(&self, scalar: &Scalar) -> &f64 {
        self.scalars.get(scalar.key).unwrap_or(&f64::NAN)
    }
}

impl Serialize for Summary {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        for scalar in catalogue::scalars() {
            for part in PARTS.iter().filter(|part| part.before == Some(scalar)) {
                self.write_part(part.key, &mut map)?;
            }
            match self.get(scalar) {
                // A double holds whole numbers up to 2^53: no count is rounded.
                Some(value) if scalar.is_count => {
                    map.serialize_entry(scalar.key, &(value as u64))?;
                }
                Some(value) => map.serialize_entry(scalar.key, &value)?,
                None => {}
            }
        }
        for part in PARTS.iter().filter(|part| part.before.is_none()) {
            self.write_part(part.key, &mut map)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Summary {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut entries = Map::deserialize(deserializer)?;
        let values = catalogue::scalars();
        let values =
            values.filter_map(|scalar| Some((scalar.key, entries.remove(scalar.key)?.as_f64()?)));
        Ok(Self {
            scalars: values.collect(),
            plausibility: part(&mut entries, "plausibility"),
            notes: part(&mut entries, "notes"),
            prediction: part(&mut entries, "prediction"),
            error: part(&mut entries, "error"),
            wear_laws: part(&mut entries, "wear_laws"),
            activities: part(&mut entries, "activities"),
            creep: part(&mut entries, "creep"),
            joint: part(&mut entries, "joint"),
            motions: part(&mut entries, "motions"),
            neutral_pose: part(&mut entries, "neutral_pose"),
            warnings: part(&mut entries, "warnings"),
            version: part(&mut entries, "version"),
            inputs_blake3: part(&mut entries, "inputs_blake3"),
            others: entries.into_iter().collect(),
        })
    }
}

/// Removes a part from the entries; returns its default if it is missing or has the form of another version.
fn part<T: DeserializeOwned + Default>(entries: &mut Map<String, Value>, key: &str) -> T {
    // A summary of another version is read as far as it can be, so that old results stay readable.
    let entry = entries.remove(key).map(serde_json::from_value);
    entry.and_then(Result::ok).unwrap_or_default()
}
