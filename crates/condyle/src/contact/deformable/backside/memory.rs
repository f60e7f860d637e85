//! What a resting backside remembers: where it was left, from increment to increment and update to update.

use super::cycle::BacksideCycle;
use crate::contact::memory::{ContactState, StateField};

/// The fields of the contact's state with where each activity left the points of the backside, three numbers each:
/// along their own directions, anterior, lateral, off the tray.
pub(in super::super) const BACKSIDE_FIELD: &str = "backside_moved_mm";

/// The field with what the last cycles came to: see [`BacksideCycle`].
pub(in super::super) const BACKSIDE_CYCLE_FIELD: &str =
    "backside_lift_mm_lifted_part_slip_mm_lock_n_lock_nmm";

/// Where every activity left the backside, and what the last cycles came to.
#[derive(Clone, Debug, Default, PartialEq)]
pub(in super::super) struct BacksideMemory {
    activities: Vec<Vec<f64>>,
    pub last_cycles: BacksideCycle,
}

impl BacksideMemory {
    /// What a state says.
    pub fn of(state: &ContactState) -> Self {
        let named = |name| state.fields.iter().filter(move |field| field.name == name);
        let cycle = named(BACKSIDE_CYCLE_FIELD).find_map(|field| field.values.first_chunk());
        Self {
            activities: named(BACKSIDE_FIELD)
                .map(|field| field.values.clone())
                .collect(),
            last_cycles: cycle.map_or_else(BacksideCycle::default, BacksideCycle::of_numbers),
        }
    }

    /// Where an activity begins, of so many numbers: where it ended, or on the tray as it was made where it has not begun, or
    /// did so on other points.
    pub fn start(&self, activity: usize, freedoms: usize) -> Vec<f64> {
        let left = self.activities.get(activity);
        let left = left.filter(|left| left.len() == freedoms);
        left.cloned().unwrap_or_else(|| vec![0.0; freedoms])
    }

    /// An activity has left the backside there.
    pub fn keep(&mut self, activity: usize, moved_mm: Vec<f64>) {
        let count = self.activities.len().max(activity + 1);
        self.activities.resize_with(count, Vec::new);
        self.activities[activity] = moved_mm;
    }

    /// The fields of the state.
    pub fn into_fields(self) -> impl Iterator<Item = StateField> {
        let named = |name: &str, values| StateField {
            name: name.to_owned(),
            values,
        };
        let cycle = named(BACKSIDE_CYCLE_FIELD, self.last_cycles.numbers().to_vec());
        let activities = self.activities.into_iter();
        let activities = activities.map(move |moved_mm| named(BACKSIDE_FIELD, moved_mm));
        activities.chain([cycle])
    }
}
