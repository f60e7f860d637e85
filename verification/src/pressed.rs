//! A femur held on an insert, and what the contact carries there.

use condyle::{
    Mat3, Vec3,
    contact::{
        ContactModel, Foundation, FoundationSettings, Pose, PressureLaw, RelativeMotion, Vec6,
        confined_modulus,
    },
};

/// Modulus of the confined layer of the default material, MPa: E = 463 MPa, v = 0.46.
pub(crate) fn modulus_mpa() -> f64 {
    confined_modulus(463.0, 0.46)
}

/// A foundation of the default material.
pub(crate) fn linear(friction: f64) -> FoundationSettings {
    foundation(
        PressureLaw::Linear {
            modulus_mpa: modulus_mpa(),
        },
        friction,
    )
}

/// A foundation of any law; friction is full well below the slowest slip of these cases.
pub(crate) fn foundation(law: PressureLaw, friction: f64) -> FoundationSettings {
    FoundationSettings {
        law,
        friction,
        slip_tolerance_mm_per_s: 1.0,
    }
}

/// What the contact carries at one motion.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pressed {
    /// Force on the insert, N.
    pub force_n: Vec3,
    /// Area in contact, mm2.
    pub area_mm2: f64,
    /// Highest pressure, MPa.
    pub peak_pressure_mpa: f64,
}

/// The femur unturned, its origin at `place`, at rest.
pub(crate) fn still(place: Vec3) -> RelativeMotion {
    moving(place, Vec3::zeros())
}

/// The femur unturned, its origin at `place`, moving without turning.
pub(crate) fn moving(place: Vec3, velocity: Vec3) -> RelativeMotion {
    RelativeMotion {
        pose: Pose {
            rotation: Mat3::identity(),
            translation: place,
        },
        twist: Vec6::new(0.0, 0.0, 0.0, velocity.x, velocity.y, velocity.z),
    }
}

/// Lets the contact respond to a motion.
pub(crate) fn press(contact: &mut Foundation<'_>, motion: &RelativeMotion) -> Pressed {
    let wrench = contact.respond(motion);
    let touched = contact.touched();
    let pressures = touched.iter().map(|node| node.pressure_mpa);
    Pressed {
        force_n: wrench.fixed_rows::<3>(3).into(),
        area_mm2: touched.iter().map(|node| node.covered_mm2).sum(),
        peak_pressure_mpa: pressures.fold(0.0, f64::max),
    }
}
