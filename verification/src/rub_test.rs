//! A femur that rubs an insert, moved along AP under a load that is held.

use std::sync::Arc;

use condyle::{
    contact::Foundation,
    evolve::{Activity, Schedule, WearTest},
    geometry::{Counterface, Insert},
    machine::{Drive, Waveform},
    wear::Archard,
};

use crate::machine::{exact_time, machine};

/// Wear factor of these tests, that of Knight 2007, mm3/(N m).
pub(crate) const WEAR_FACTOR_MM3_PER_NM: f64 = 2.64e-7;

/// A metre in millimetres.
pub(crate) const MM_PER_M: f64 = 1000.0;

/// What a rub is made of.
pub(crate) struct Rub {
    pub femur: Counterface,
    pub insert: Insert,
    pub contact: Foundation,
    /// Motion of the insert along AP.
    pub ap: Drive,
    pub load_n: f64,
    pub increments: usize,
    pub cycles: f64,
    pub updates: usize,
}

impl Rub {
    /// The wear test; what is not moved or loaded is locked.
    pub(crate) fn test(self) -> WearTest {
        let locked = || Drive::Locked(0.0);
        let load = Drive::Loaded(Waveform::constant(-self.load_n));
        let drives = [locked(), locked(), locked(), self.ap, load, locked()];
        let mut time = exact_time(self.increments);
        time.force_tolerance_n = 1e-6 * self.load_n;
        (time.repeat_tolerance_mm, time.repeat_tolerance_rad) = (1e-5, 1e-6);
        WearTest {
            counterface: Arc::new(self.femur),
            flexion_axis_mm: (0.0, 0.0),
            start_mm: (0.0, 0.0),
            start_height_mm: None,
            insert: Arc::new(self.insert),
            contact: Arc::new(self.contact),
            activities: vec![Activity::only("rub", machine(drives, Vec::new()))],
            wear: Arc::new(Archard {
                wear_factor_mm3_per_nm: WEAR_FACTOR_MM3_PER_NM,
            }),
            comparison_laws: Vec::new(),
            law_family: false,
            creep: None,
            density_mg_per_mm3: 0.93,
            time,
            schedule: Schedule::fixed(self.cycles, self.updates),
        }
    }
}
