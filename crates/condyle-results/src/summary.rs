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
    catalogue::{
        self, CYCLES, FinishedRun, MAX_PENETRATION_MM, RunFacts, Scalar, UPDATES, WALL_S,
        WEAR_OVER_CONVENTIONAL,
    },
    error_estimate::ErrorEstimate,
    parts::{ActivitySummary, LawWear, MotionColumn, NeutralPose},
    prediction::Prediction,
};

/// Returns a result as JSON, with a line end.
pub fn json_text(result: &impl Serialize) -> String {
    // Maps have keys of text, and numbers that JSON lacks become null: nothing can fail.
    let text = serde_json::to_string_pretty(result);
    text.expect("numbers and text always serialise") + "\n"
}

/// The JSON type of a part of `summary.json`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartKind {
    /// A text.
    Text,
    /// A list of texts.
    Texts,
    /// An object.
    Object,
    /// An object or null.
    ObjectOrNull,
    /// A list of objects.
    Objects,
}

/// An entry of `summary.json` that is not a number.
#[derive(Clone, Copy, Debug)]
pub struct SummaryPart {
    /// Its key.
    pub key: &'static str,
    /// Its JSON type.
    pub kind: PartKind,
    /// True if every run has it.
    pub is_always_there: bool,
    /// A description.
    pub about: &'static str,
    /// The number that it stands before in the file; none at the end.
    pub before: Option<&'static Scalar>,
}

/// Declares [`Summary`] and [`PARTS`]: the type and JSON type of each part, whether every run has it, the number that it
/// stands before, and a description; more for readers of the code is in its doc comment.
macro_rules! summary {
    ($(
        $(#[doc = $more:literal])*
        $key:ident: $ty:ty as $kind:ident, $is_always_there:literal, before $before:expr, $about:literal;
    )+) => {
        /// The results of a run in one table: `summary[&MASS_LOSS_MG]` is a number of the catalogue.
        ///
        /// A summary is read from any version of `summary.json`: an entry that is missing is absent, and one that is not in the
        /// catalogue is in [`Self::others`].
        #[derive(Clone, Debug, Default, PartialEq)]
        pub struct Summary {
            scalars: BTreeMap<&'static str, f64>,
            $(
                #[doc = $about]
                $(#[doc = $more])*
                pub $key: $ty,
            )+
            /// Entries of a file by another version that the catalogue does not have.
            pub others: BTreeMap<String, Value>,
        }

        /// All parts, in the order of the file.
        pub static PARTS: &[SummaryPart] = &[$(SummaryPart {
            key: stringify!($key),
            kind: PartKind::$kind,
            is_always_there: $is_always_there,
            about: $about,
            before: $before,
        }),+];

        impl Summary {
            fn write_part<M: SerializeMap>(&self, part: &SummaryPart, map: &mut M) -> Result<(), M::Error> {
                match part.key {
                    $( stringify!($key) if part.is_always_there || self.$key != <$ty>::default() => {
                        map.serialize_entry(part.key, &self.$key)
                    } )+
                    _ => Ok(()),
                }
            }

            /// Creates the summary with these numbers, and the parts among `entries`.
            fn with_parts(scalars: BTreeMap<&'static str, f64>, mut entries: Map<String, Value>) -> Self {
                Self {
                    scalars,
                    $( $key: part(&mut entries, stringify!($key)), )+
                    others: entries.into_iter().collect(),
                }
            }
        }
    };
}

summary! {
    plausibility: Vec<PlausibilityWarning> as Objects, true, before Some(&CYCLES),
        "Findings that make the numbers doubtful, the worst first, each with `message` and `advice`.";
    notes: Vec<PlausibilityWarning> as Objects, true, before Some(&CYCLES),
        "Remarks on the physics that do not make the numbers doubtful, each with `message` and its effect in `advice`.";
    /// None unless the march summed the family of calibrated laws.
    prediction: Option<Prediction> as Object, false, before Some(&CYCLES),
        "Predicted results of laboratories: medians and 90 % intervals of mass and depth, and the sources of their width.";
    error: Option<ErrorEstimate> as ObjectOrNull, true, before Some(&WEAR_OVER_CONVENTIONAL),
        "Estimated discretisation errors by their parts; null if the case does not ask for them.";
    wear_laws: Vec<LawWear> as Objects, true, before Some(&WEAR_OVER_CONVENTIONAL),
        "Wear by every law for the same histories, that of the run first; only this law moves the surface.";
    /// Empty for one activity; motions and ranges of the summary are those of the first.
    activities: Vec<ActivitySummary> as Objects, false, before Some(&MAX_PENETRATION_MM),
        "Motion, loads and wear of each activity.";
    joint: TestedJoint as Text, true, before Some(&UPDATES),
        "The joint whose replacement the machine tests, such as `hip`.";
    /// Empty in a file of an older version.
    motions: Vec<MotionColumn> as Objects, true, before Some(&UPDATES),
        "The joints of the machine: `column` of `kinematics.csv`, `title`, and the `positive` direction.";
    neutral_pose: Option<NeutralPose> as Object, true, before Some(&UPDATES),
        "Pose of the settled femur in the insert frame: there AP, ML and IS of a knee read zero.";
    /// None unless the counterface is a mesh of a joint with a ball or socket, and the case does not place its axis.
    axes: Option<String> as Text, false, before Some(&UPDATES),
        "The place that the machine's axes pass through: the ball or socket found in the mesh of the counterface, or its origin.";
    warnings: Vec<String> as Texts, true, before Some(&WALL_S), "Corrections of the input, and doubts about it.";
    version: String as Text, true, before None, "Version of condyle.";
    inputs_blake3: String as Text, true, before None, "Hash of case and meshes.";
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
    /// Creates the numbers and activities of a march; none before its first update.
    pub fn new(march: &March, facts: RunFacts) -> Option<Self> {
        let run = FinishedRun::new(march, facts)?;
        let values = catalogue::scalars();
        let values = values.filter_map(|scalar| Some((scalar.key, scalar.compute(&run)?)));
        Some(Self {
            scalars: values.collect(),
            activities: ActivitySummary::of(march),
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

    /// Returns the checks of plausibility that the run fails.
    pub fn doubts(&self) -> Vec<&str> {
        let doubts = self.plausibility.iter();
        doubts.map(|doubt| doubt.check.as_str()).collect()
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
                self.write_part(part, &mut map)?;
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
            self.write_part(part, &mut map)?;
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
        Ok(Self::with_parts(values.collect(), entries))
    }
}

/// Removes a part from the entries; returns its default if it is missing or has the form of another version.
fn part<T: DeserializeOwned + Default>(entries: &mut Map<String, Value>, key: &str) -> T {
    // A summary of another version is read as far as it can be, so that old results stay readable.
    let entry = entries.remove(key).map(serde_json::from_value);
    entry.and_then(Result::ok).unwrap_or_default()
}
