//! A femur held on an insert, and what the contact carries there.

use condyle::{
    Mat3, Vec3,
    contact::{Bodies, ContactLaw, ContactMemory, ContactModel, Foundation, PressureLaw},
    geometry::{Insert, Meshing, flat_insert},
    spatial::{Pose, RelativeMotion, Twist},
};

/// A foundation without friction.
pub(crate) fn without_friction(law: &PressureLaw) -> Foundation {
    Foundation::new(law.clone(), 0.0, 1.0)
}

/// The contact of bodies on a foundation that nothing has pressed before.
pub(crate) fn contact_of<'a>(
    law: &'a Foundation,
    bodies: Bodies<'a>,
) -> Box<dyn ContactModel + 'a> {
    law.contact(bodies, ContactMemory::default())
}

/// A flat square block of one layer, the articulating surface at y = 0.
pub(crate) fn block(size_mm: f64, thickness_mm: f64, edge_mm: f64) -> Insert {
    let meshing = Meshing { edge_mm, layers: 1 };
    flat_insert((size_mm, size_mm), thickness_mm, meshing).expect("a block is an insert")
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
        pose: Pose::new(Mat3::identity(), place),
        twist: Twist::new(Vec3::zeros(), velocity),
    }
}

/// Lets the contact respond to a motion.
pub(crate) fn press(contact: &mut dyn ContactModel, motion: &RelativeMotion) -> Pressed {
    let force_n = contact.respond(motion).wrench.force;
    let evaluated = contact.evaluate(motion);
    Pressed {
        force_n,
        area_mm2: evaluated.touched.iter().map(|node| node.covered_mm2).sum(),
        peak_pressure_mpa: evaluated.peak_pressure_mpa,
    }
}

/// What is exact of a body pressed on a flat layer.
pub(crate) struct Exact {
    /// Vertical force, N.
    pub force_n: f64,
    /// Area in contact, mm2.
    pub area_mm2: f64,
    /// Highest pressure, MPa.
    pub peak_mpa: f64,
}

/// Half of the force's range over its mean.
pub(crate) fn ripple(forces_n: &[f64]) -> f64 {
    let low = forces_n.iter().copied().fold(f64::INFINITY, f64::min);
    let high = forces_n.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let mean = forces_n.iter().sum::<f64>() / forces_n.len() as f64;
    (high - low) / 2.0 / mean
}
