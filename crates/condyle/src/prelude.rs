//! The names that most programs need: `use condyle::prelude::*;`.

pub use crate::{
    Vec3,
    contact::{
        Bodies, ContactLaw, ContactMemory, ContactModel, Deformable, Foundation, PressureLaw,
    },
    evolve::{Activity, March, MarchError, PlacementError, Progress, Schedule, Updates, WearTest},
    geometry::{
        Counterface, GenericFemur, GenericFemurShape, GenericInsertShape, Insert, Meshing,
        flat_insert,
    },
    machine::{Drive, Interpolation, Knot, Machine, Mechanism, TimeSettings, Waveform},
    spatial::{Pose, RelativeMotion},
    wear::{Archard, MeanCycle, NamedLaw, NodeWear, WEAR_LAWS, WearLaw},
};
