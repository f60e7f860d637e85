//! Where the extended femur settles under the vertical load: the machine's neutral position.

use super::{
    Chain, Drive, Joint, JointKind, Kinematics, Machine, Settling, SolverCounters, Waveform,
    balance::{Balance, StepSlopes},
    joint_vectors::JointStiffness,
};
use crate::contact::ContactModel;

/// Iterations after which settling is given up.
const MAX_ITERATIONS: usize = 2000;
/// Farthest that one iteration may move, mm.
const LONGEST_CORRECTION_MM: f64 = 0.2;
/// Motion that the first iteration allows for the whole load, mm.
const FIRST_MOTION_MM: f64 = 0.05;
/// Lever on which damping slows a turn, mm: about how far the contact is from the axes, so that the
/// surfaces move against each other at the same pace whether the femur turns or shifts. It changes how the
/// machine gets to rest, and not where that is.
const TURNING_LEVER_MM: f64 = 30.0;

/// The femur did not come to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotSettled {
    /// Positions at the last iteration, mm and rad, in the order of the chain.
    pub positions: [f64; 6],
    /// Force left out of balance, N.
    pub residual_n: f64,
    /// How far the last iteration moved, mm, turns on a lever; infinite if none did.
    pub moved_mm: f64,
}

/// Positions of static balance under the load at the start of the cycle.
///
/// What each joint does meanwhile is part of its [description](Settling); there are no springs and,
/// nothing sliding, no friction. Newton's method with a damping that vanishes as balance nears
/// (pseudo-transient continuation), so that it also finds its way from a first touch on one side.
///
/// # Errors
/// Where the femur does not come to rest, for instance because it slides off.
pub fn settle(
    machine: &Machine,
    chain: &Chain,
    contact: &mut dyn ContactModel,
    force_tolerance_n: f64,
    counters: &mut SolverCounters,
) -> Result<[f64; 6], NotSettled> {
    let machine = settling(machine);
    let (loads, levers) = (machine.loads_at(0.0), machine.levers());
    let mut positions = [0.0; 6];
    machine.drive(0.0, &mut positions, &mut [0.0; 6]);
    let mut damping = loads.largest_n(&levers).max(1.0) / FIRST_MOTION_MM;
    let (mut last_residual_n, mut moved_mm) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..MAX_ITERATIONS {
        let still = Kinematics::at_rest(positions);
        let balance = Balance::new(&machine, chain, contact, still);
        counters.contact_evaluations += 1;
        let residual = balance.residual(&loads);
        let residual_n = residual.largest_n(&levers);
        if residual_n <= force_tolerance_n {
            return Ok(positions);
        }
        if last_residual_n.is_finite() {
            damping *= (residual_n / last_residual_n).clamp(0.3, 2.0);
        }
        last_residual_n = residual_n;
        let damped = balance.tangent(StepSlopes::STILL) + damping_of(&machine, damping);
        let Some(correction) = damped.correction(&residual) else {
            break;
        };
        counters.newton_iterations += 1;
        let part = correction.part_within(LONGEST_CORRECTION_MM, &levers);
        moved_mm = (correction * part).longest_mm(&levers);
        (correction * part).move_from(&mut positions);
    }
    Err(NotSettled {
        positions,
        residual_n: last_residual_n,
        moved_mm,
    })
}

/// The machine while it settles.
fn settling(machine: &Machine) -> Machine {
    let mut settling = machine.clone();
    settling.springs.clear();
    for joint in &mut settling.joints {
        (joint.inertia, joint.damping) = (0.0, 0.0);
        let free = Drive::Loaded(Waveform::constant(0.0));
        match joint.description.settling {
            Settling::Free => joint.drive = free,
            Settling::HeldAtZero => joint.drive = Drive::Locked(0.0),
            Settling::DrivenWithoutLoad if joint.is_loaded() => joint.drive = free,
            Settling::DrivenWithoutLoad | Settling::Driven => {}
        }
    }
    settling
}

/// The same damping of every joint, turns on their lever.
fn damping_of(machine: &Machine, damping: f64) -> JointStiffness {
    let of_joint = |joint: &Joint| match joint.description.kind() {
        JointKind::Rotation => damping * (TURNING_LEVER_MM * TURNING_LEVER_MM),
        JointKind::Translation => damping,
    };
    JointStiffness::from_diagonal(machine.joints.each_ref().map(of_joint))
}
