//! The physics of a virtual wear test of a joint replacement: from two shapes and a machine to motion,
//! contact pressure and wear over millions of cycles.
//!
//! # A complete run
//!
//! A counterface of two condyles flexes by 60 degrees under a load of up to 2 kN on an insert that moves
//! 4 mm to and fro. The insert is worn by 1 million cycles in two updates of its surface:
//!
//! ```
//! use std::sync::Arc;
//!
//! use condyle::{contact::confined_modulus, machine::knee, prelude::*};
//!
//! // Two shapes: mm, in a right knee; x anterior, y superior, z lateral.
//! let counterface = GenericFemur::new(GenericFemurShape::default());
//! let coarse = Meshing { edge_mm: 3.0, layers: 2 };
//! let insert = GenericInsertShape::default().insert(coarse)?;
//!
//! // The machine: a waveform for each joint that moves or bears a load; the others stay locked.
//! let wave = |points: &[(f64, f64)]| {
//!     let knot = |&(percent, value): &(f64, f64)| Knot { percent, value };
//!     Waveform::new(points.iter().map(knot).collect(), Interpolation::HalfCosine)
//! };
//! let mut machine = Machine::new(&knee::KNEE);
//! let flexion_rad = wave(&[(0.0, 0.0), (70.0, 60_f64.to_radians())])?;
//! machine.joint_mut(knee::FLEXION).drive = Drive::Prescribed(flexion_rad);
//! machine.joint_mut(knee::AP).drive = Drive::Prescribed(wave(&[(0.0, 0.0), (50.0, 4.0)])?);
//! // IS is positive upwards, so that compression is negative.
//! let axial_n = wave(&[(0.0, -300.0), (15.0, -2000.0), (45.0, -1500.0), (65.0, -300.0)])?;
//! machine.joint_mut(knee::IS).drive = Drive::Loaded(axial_n);
//!
//! // Polyethylene as an elastic foundation with a friction coefficient of 0.07, regularised over 1 mm/s.
//! let modulus_mpa = confined_modulus(463.0, 0.46);
//! let test = WearTest {
//!     counterface: Arc::new(Counterface::Generic(counterface)),
//!     flexion_axis_mm: (0.0, 0.0),
//!     start_mm: (0.0, 0.0),
//!     start_height_mm: None,
//!     insert: Arc::new(insert),
//!     contact: Arc::new(Foundation::new(PressureLaw::Linear { modulus_mpa }, 0.07, 1.0)),
//!     activities: vec![Activity::only("walking", machine)],
//!     wear: Arc::new(Archard { wear_factor_mm3_per_nm: 2.64e-7 }),
//!     comparison_laws: Vec::new(),
//!     law_family: false,
//!     creep: None,
//!     density_mg_per_mm3: 0.93,
//!     time: TimeSettings { increments: 40, ..TimeSettings::default() },
//!     schedule: Schedule::fixed(1e6, 2),
//! };
//!
//! // Lower the counterface until it rests on the insert, then march to the last cycle.
//! let mut march = March::start(test)?;
//! march.run()?;
//!
//! let end = &march.state().updates[1];
//! assert_eq!(end.cycles, 1e6);
//! assert!(end.mass_loss_mg > 1.0 && end.mass_loss_mg < 20.0, "{end:?}");
//! assert!(end.max_depth_mm > 0.01 && end.max_depth_mm < 0.2, "{end:?}");
//! // The depth at every surface node, for a map of wear.
//! assert_eq!(march.fields().wear_depth_mm.len(), march.insert().surface_nodes().len());
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # How the parts fit together
//!
//! A [`WearTest`](evolve::WearTest) is a value. It holds the bodies, the laws and the activities; to vary one of
//! them, clone it, and run the clones on other threads. A [`March`](evolve::March) runs it: it solves one
//! cycle of every activity that repeats, wears the insert by an interval of such cycles, and starts again on the
//! new surface.
//!
//! | part | module | to replace it |
//! | --- | --- | --- |
//! | shapes and meshes | [`geometry`], [`anatomy`] | [`Counterface`](geometry::Counterface), [`Insert`](geometry::Insert) |
//! | joints, drives, springs | [`machine`] | a table: [`Mechanism`](machine::Mechanism) |
//! | contact pressure | [`contact`] | the trait [`ContactLaw`](contact::ContactLaw) |
//! | wear of a node in a cycle | [`wear`] | the trait [`WearLaw`](wear::WearLaw) |
//! | creep | [`creep`] | [`LeePienkowski`](creep::LeePienkowski) |
//! | the march over cycles | [`evolve`] | [`Schedule`](evolve::Schedule) |
//!
//! Each program in `examples/` shows one part: `rigid_test`, then `custom_wear_law`, `contact_at_a_pose` and
//! `custom_machine`.
//!
//! # Units and frames
//!
//! Millimetre, newton, second, MPa, tonne and radian everywhere. The insert frame has x anterior, y superior and z
//! lateral (a right knee). Tibial motions are those of the insert in the machine; the sign of a load is that of the
//! motion it causes. A gap is positive where the bodies are apart. `NOTATION.md` in the repository has the details.
//!
//! The crate opens no files, prints nothing and has no global state; results are the same bytes on every run and
//! any number of threads.

pub mod anatomy;
pub mod contact;
pub mod creep;
pub mod evolve;
pub mod geometry;
pub mod machine;
mod number;
pub mod parameter;
pub mod prelude;
pub mod spatial;
pub mod wear;

/// A point or a vector in space, mm unless stated otherwise.
pub type Vec3 = nalgebra::Vector3<f64>;
/// A vector of numbers, or of several numbers in lanes.
pub type Vector<T> = nalgebra::Vector3<T>;
/// A 3 by 3 matrix.
pub type Mat3 = nalgebra::Matrix3<f64>;
