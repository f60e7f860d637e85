//! `summary.json`.

use condyle_results::{ActivitySummary, LawWear, NeutralPose, PlausibilityWarning};
use serde::Deserialize;
use serde_json::{Map, Value};

/// The numbers of a run by name; names carry their units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    values: Map<String, Value>,
}

impl Summary {
    /// Reads the text of a `summary.json`.
    ///
    /// # Errors
    /// The text is not JSON, or not an object.
    pub fn parse(text: &str) -> Result<Self, serde_json::Error> {
        serde_json::from_str(text).map(|values| Self { values })
    }

    /// The number called `key`, in the unit of its name.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.values.get(key)?.as_f64()
    }

    /// The estimated discretisation error of the number called `key`, in the same unit, where the run estimated it.
    pub fn total_error(&self, key: &str) -> Option<f64> {
        self.object("error")?.get(key)?.get("total")?.as_f64()
    }

    /// The text called `key`.
    pub fn text(&self, key: &str) -> Option<&str> {
        self.values.get(key)?.as_str()
    }

    /// The object called `key`: numbers and texts that belong together.
    pub fn object(&self, key: &str) -> Option<&Map<String, Value>> {
        self.values.get(key)?.as_object()
    }

    /// Where the femur is at neutral.
    pub fn neutral_pose(&self) -> Option<NeutralPose> {
        NeutralPose::deserialize(self.values.get("neutral_pose")?).ok()
    }

    /// What makes the run doubtful; nothing where that is not said.
    pub fn plausibility(&self) -> Vec<PlausibilityWarning> {
        let listed = self.values.get("plausibility");
        let read = listed.and_then(|listed| Vec::deserialize(listed).ok());
        read.unwrap_or_default()
    }

    /// What every law of wear says of the run; nothing where that is not said.
    pub fn wear_laws(&self) -> Vec<LawWear> {
        let listed = self.values.get("wear_laws");
        let read = listed.and_then(|listed| Vec::deserialize(listed).ok());
        read.unwrap_or_default()
    }

    /// What cross-linked polyethylene is taken to wear over conventional one; none where the insert is of conventional
    /// one.
    pub fn wear_over_conventional(&self) -> Option<f64> {
        self.values.get("wear_over_conventional")?.as_f64()
    }

    /// What each of several activities did; nothing where there is one, or that is not said.
    pub fn activities(&self) -> Vec<ActivitySummary> {
        let listed = self.values.get("activities");
        let read = listed.and_then(|listed| Vec::deserialize(listed).ok());
        read.unwrap_or_default()
    }

    /// What was put right or looked doubtful on the way in; nothing where that is not said.
    pub fn warnings(&self) -> Vec<String> {
        let listed = self.values.get("warnings");
        let read = listed.and_then(|listed| Vec::deserialize(listed).ok());
        read.unwrap_or_default()
    }

    /// All entries, sorted by name.
    pub fn entries(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.values.iter().map(|(key, value)| (key.as_str(), value))
    }
}
