//! A machine without a knee in it, and machines with simple drives.

use condyle::{
    Vec3,
    contact::{ContactModel, ContactResult, MAX_REGIONS, Response, Tangent},
    machine::{
        Chain, Cycle, Drive, JointKind, Machine, MachineState, Simulator, Spring, TimeSettings,
        knee::KNEE,
    },
    spatial::{RelativeMotion, Wrench, WrenchByTwist},
};
use std::ops::ControlFlow;

/// No contact at all.
pub(crate) struct Apart;

impl ContactModel for Apart {
    fn node_count(&self) -> usize {
        0
    }

    fn respond(&mut self, _: &RelativeMotion) -> Response {
        Response {
            wrench: Wrench::zero(),
            mean_slip: [Vec3::zeros(); MAX_REGIONS],
        }
    }

    fn tangent(&self) -> Tangent {
        Tangent {
            by_pose: WrenchByTwist::zero(),
            by_twist: WrenchByTwist::zero(),
        }
    }

    fn evaluate(&mut self, _: &RelativeMotion) -> ContactResult {
        ContactResult::default()
    }
}

/// A knee's machine whose joints, in the order of the chain, are driven so; one cycle a second, light
/// and a little damped, all axes through the origin.
pub(crate) fn machine(drives: [Drive; 6], springs: Vec<Spring>) -> Machine {
    let mut machine = Machine::new(&KNEE);
    for (joint, drive) in machine.joints.iter_mut().zip(drives) {
        joint.drive = drive;
        (joint.inertia, joint.damping) = match joint.description.kind() {
            JointKind::Rotation => (1.0, 300.0),
            JointKind::Translation => (1e-3, 0.3),
        };
    }
    Machine { springs, ..machine }
}

/// Time settings that leave nothing to chance.
pub(crate) fn exact_time(increments: usize) -> TimeSettings {
    TimeSettings {
        increments,
        force_tolerance_n: 1e-9,
        repeat_tolerance_mm: 1e-10,
        repeat_tolerance_rad: 1e-12,
        most_cycles_to_repeat: 50,
        ..TimeSettings::default()
    }
}

/// A cycle that repeats itself, the femur's frame at `zero_mm` with the machine at zero.
pub(crate) fn cycle(
    machine: &Machine,
    contact: &mut dyn ContactModel,
    zero_mm: Vec3,
    time: &TimeSettings,
) -> Cycle {
    let chain = Chain::new(machine, zero_mm, (0.0, 0.0));
    let mut simulator = Simulator::new(machine, &chain, contact, time);
    let start = MachineState::at_rest(machine, [0.0; 6]);
    let mut watch = |_| ControlFlow::Continue(());
    simulator
        .cycle(&start, &mut watch)
        .expect("a solved cycle")
        .continue_value()
        .expect("nobody stops it")
}
