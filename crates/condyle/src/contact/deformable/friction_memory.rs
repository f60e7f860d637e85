//! What friction on an elastic surface remembers: where it sticks, from increment to increment and update to update.

use std::collections::BTreeMap;

use super::stick_slip::Pair;
use crate::{
    Mat3, Vec3,
    contact::memory::{ContactState, StateField},
    spatial::Pose,
};

/// The fields of the contact's state with what each activity left: the femur's pose, rotation by columns and then
/// translation in mm, and of every node that carries a load along the surface its number and that load.
pub(super) const FRICTION_FIELD: &str = "femur_pose_and_loads_along_surface_n";

/// Numbers of a pose.
const OF_POSE: usize = 12;

/// Loads along the surface on some nodes, ascending, N.
pub(super) type LoadsAlong = Vec<(u32, Pair)>;

/// Where an increment begins.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Held {
    /// Where the femur is; none before it was anywhere.
    pub pose: Option<Pose>,
    pub loads: LoadsAlong,
}

/// What every activity left, and the loads of the cycle that is being solved.
#[derive(Default)]
pub(super) struct FrictionMemory {
    activities: Vec<Held>,
    /// The number of the activity, once a cycle has begun.
    activity: Option<usize>,
    increment: usize,
    /// The loads at the end of each increment when it was solved last.
    landed: BTreeMap<usize, LoadsAlong>,
}

impl Held {
    fn of(values: &[f64]) -> Option<Self> {
        let (pose, loads) = values.split_at_checked(OF_POSE)?;
        let rotation = Mat3::from_column_slice(&pose[..9]);
        let translation = Vec3::from_column_slice(&pose[9..]);
        let loads = loads.chunks_exact(3);
        Some(Self {
            pose: Some(Pose::new(rotation, translation)),
            loads: loads.map(|of| (of[0] as u32, [of[1], of[2]])).collect(),
        })
    }

    fn values(&self) -> Vec<f64> {
        let Some(pose) = &self.pose else {
            return Vec::new();
        };
        let pose = pose.rotation.iter().chain(&pose.translation).copied();
        let loads = self.loads.iter();
        let loads = loads.flat_map(|&(node, [x, y])| [f64::from(node), x, y]);
        pose.chain(loads).collect()
    }
}

impl FrictionMemory {
    /// What a state says.
    pub fn of(state: &ContactState) -> Self {
        let fields = state.fields.iter();
        let fields = fields.filter(|field| field.name == FRICTION_FIELD);
        Self {
            activities: fields
                .map(|field| Held::of(&field.values).unwrap_or_default())
                .collect(),
            ..Self::default()
        }
    }

    /// Where the present activity begins.
    pub fn start(&self) -> Held {
        let held = self.activities.get(self.activity.unwrap_or(0));
        held.cloned().unwrap_or_default()
    }

    /// The next increments are of the next activity; the one before has got to `held`.
    pub fn begin_cycle(&mut self, held: Held) {
        self.activity = Some(self.activity.map_or(0, |activity| {
            self.keep(activity, held);
            activity + 1
        }));
        self.landed.clear();
    }

    pub fn begin_increment(&mut self, increment: usize) {
        self.increment = increment;
    }

    /// An increment ends with loads; those with which it did so a cycle before.
    pub fn land(&mut self, loads: LoadsAlong) -> Option<LoadsAlong> {
        self.landed.insert(self.increment, loads)
    }

    /// The fields of the state, once the last activity has got to `held`.
    pub fn into_fields(mut self, held: Held) -> impl Iterator<Item = StateField> {
        self.keep(self.activity.unwrap_or(0), held);
        self.activities.into_iter().map(|held| StateField {
            name: FRICTION_FIELD.to_owned(),
            values: held.values(),
        })
    }

    fn keep(&mut self, activity: usize, held: Held) {
        let count = self.activities.len().max(activity + 1);
        self.activities.resize_with(count, Held::default);
        self.activities[activity] = held;
    }
}
