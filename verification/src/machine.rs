//! A machine without a knee in it, and machines with simple drives.

use condyle::{
    Vec3,
    contact::{ContactModel, Mat6, RelativeMotion, Tangent, TouchedNode, Vec6},
    machine::{
        ApSpring, Chain, Cycle, Drive, FreedomSettings, Machine, MachineState, Simulator,
        SolverCounters, TimeSettings,
    },
};
use std::ops::ControlFlow;

/// No contact at all.
pub(crate) struct Apart;

impl ContactModel for Apart {
    fn respond(&mut self, _: &RelativeMotion) -> Vec6 {
        Vec6::zeros()
    }

    fn tangent(&self) -> Tangent {
        let none = Mat6::zeros();
        Tangent {
            by_pose: none,
            by_twist: none,
        }
    }

    fn mean_slip(&self) -> [Vec3; 2] {
        [Vec3::zeros(); 2]
    }

    fn node_count(&self) -> usize {
        0
    }

    fn touched(&mut self, _: &RelativeMotion) -> Vec<TouchedNode> {
        Vec::new()
    }

    fn peak_pressure_mpa(&self, _: &RelativeMotion, _: &[TouchedNode]) -> f64 {
        0.0
    }
}

/// A machine whose rows, in the order of the freedoms, are driven so; one cycle a second, light
/// and a little damped, all axes through the origin.
pub(crate) fn machine(drives: [Drive; 6], ap_springs: Vec<ApSpring>) -> Machine {
    let row = |drive, rotates: bool| FreedomSettings {
        drive,
        inertia: if rotates { 1.0 } else { 1e-3 },
        damping: if rotates { 300.0 } else { 0.3 },
    };
    let [vv, ie, ml, ap, is, flexion] = drives;
    Machine {
        freedoms: [
            row(vv, true),
            row(ie, true),
            row(ml, false),
            row(ap, false),
            row(is, false),
            row(flexion, true),
        ],
        ap_springs,
        frequency_hz: 1.0,
        vv_axis_mm: (0.0, 0.0),
        ie_axis_mm: (0.0, 0.0),
    }
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
    contact: impl ContactModel,
    zero_mm: Vec3,
    time: &TimeSettings,
) -> Cycle {
    let chain = Chain::new(machine, zero_mm, (0.0, 0.0));
    let mut simulator = Simulator::new(machine, &chain, contact, time);
    let start = MachineState::at_rest(machine, [0.0; 6]);
    let mut watch = |_| ControlFlow::Continue(());
    simulator
        .cycle(&start, &mut SolverCounters::default(), &mut watch)
        .expect("a solved cycle")
}
