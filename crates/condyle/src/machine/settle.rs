//! The neutral position of a machine: where the extended counterface settles under the vertical load.

use super::{
    Chain, Drive, Joint, JointKind, Kinematics, Machine, Settling, SolverCounters, Waveform,
    balance::{Balance, correction, move_by},
};
use crate::{contact::ContactModel, spatial::Mat6};

const MAX_ITERATIONS: usize = 2000;
const LONGEST_CORRECTION_MM: f64 = 0.2;
/// Motion of the first iteration under the whole load, mm, which sets the first damping.
const FIRST_MOTION_MM: f64 = 0.05;
/// Limits of the change of the damping from one iteration to the next.
const DAMPING_CHANGE: (f64, f64) = (0.3, 2.0);
/// Lever of the damping of a rotation, mm: about the distance of the contact from the axes, so that the
/// surfaces move at the same pace in rotation and translation. It changes the path to the rest position, not
/// the position.
const TURNING_LEVER_MM: f64 = 30.0;

/// The counterface did not come to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotSettled {
    /// Positions at the last iteration, mm and rad, in the order of the chain.
    pub positions: [f64; 6],
    /// Force left out of balance, N.
    pub residual_n: f64,
    /// Motion of the last iteration, mm, rotations on a lever; infinite if there was none.
    pub moved_mm: f64,
}

/// Finds the positions of static balance under the load at the start of the cycle.
///
/// The [description](Settling) of each joint defines its state during settling. Springs and ligaments do not act, and neither does
/// friction, since nothing slides. Newton's method with a damping that vanishes near the balance (pseudo-transient
/// continuation) also converges from a first touch on one side.
///
/// # Errors
/// If the counterface does not come to rest, for instance because it slides off.
pub fn settle(
    machine: &Machine,
    chain: &Chain,
    contact: &mut dyn ContactModel,
    force_tolerance_n: f64,
    counters: &mut SolverCounters,
) -> Result<[f64; 6], NotSettled> {
    let machine = settling(machine);
    let mut positions = [0.0; 6];
    machine.drive(0.0, &mut positions, &mut [0.0; 6]);
    balanced(
        &machine,
        chain,
        contact,
        force_tolerance_n,
        positions,
        counters,
    )
}

/// Finds the positions from which an activity starts: those of `from` where the machine is loaded, balanced in height
/// and tilt under the load at the start of the cycle.
///
/// Flexion that starts elsewhere than the settled one would leave the counterface above the insert or inside it.
///
/// # Errors
/// If the counterface does not come to rest.
pub(crate) fn settle_from(
    from: [f64; 6],
    machine: &Machine,
    chain: &Chain,
    contact: &mut dyn ContactModel,
    force_tolerance_n: f64,
    counters: &mut SolverCounters,
) -> Result<[f64; 6], NotSettled> {
    let mut start = machine.clone();
    start.springs.clear();
    start.ligaments.clear();
    for (joint, position) in start.joints.iter_mut().zip(from) {
        if joint.is_loaded() {
            joint.drive = match joint.description.settling {
                Settling::Free | Settling::HeldAtZero => Drive::Locked(position),
                Settling::DrivenWithoutLoad => Drive::Loaded(Waveform::constant(0.0)),
                Settling::Driven => continue,
            };
        }
    }
    let mut positions = from;
    start.drive(0.0, &mut positions, &mut [0.0; 6]);
    balanced(
        &start,
        chain,
        contact,
        force_tolerance_n,
        positions,
        counters,
    )
}

/// Finds the positions of static balance of a machine under the loads at the start of the cycle, from `positions`.
fn balanced(
    machine: &Machine,
    chain: &Chain,
    contact: &mut dyn ContactModel,
    force_tolerance_n: f64,
    mut positions: [f64; 6],
    counters: &mut SolverCounters,
) -> Result<[f64; 6], NotSettled> {
    let (loads, levers) = (machine.loads_at(0.0), machine.levers());
    // At least a newton, so that an unloaded machine has a finite first step.
    let mut damping = levers.largest_n(&loads).max(1.0) / FIRST_MOTION_MM;
    let (mut last_residual_n, mut moved_mm) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..MAX_ITERATIONS {
        // Without rates there is no friction, and the contact is a function of the pose alone.
        let still = Kinematics::at_rest(positions);
        let balance = Balance::new(machine, chain, contact, still);
        counters.contact_evaluations += 1;
        let residual = balance.residual(&loads);
        let residual_n = levers.largest_n(&residual);
        if residual_n <= force_tolerance_n {
            return Ok(positions);
        }
        // The damping follows the residual: it vanishes at the balance, where the iteration becomes Newton's.
        if last_residual_n.is_finite() {
            let (least, most) = DAMPING_CHANGE;
            damping *= (residual_n / last_residual_n).clamp(least, most);
        }
        last_residual_n = residual_n;
        let of_joint = |joint: &Joint| match joint.description.kind() {
            JointKind::Rotation => damping * (TURNING_LEVER_MM * TURNING_LEVER_MM),
            JointKind::Translation => damping,
        };
        let dampings = machine.joints.each_ref().map(of_joint);
        let damped = balance.tangent(0.0, 0.0) + Mat6::from_diagonal(&dampings.into());
        let Some(correction) = correction(&damped, &residual) else {
            break;
        };
        counters.newton_iterations += 1;
        let taken = correction * levers.part_within(&correction, LONGEST_CORRECTION_MM);
        moved_mm = levers.longest_mm(&taken);
        move_by(&mut positions, &taken);
    }
    Err(NotSettled {
        positions,
        residual_n: last_residual_n,
        moved_mm,
    })
}

fn settling(machine: &Machine) -> Machine {
    let mut settling = machine.clone();
    // Neutral is where springs and ligaments are slack.
    settling.springs.clear();
    settling.ligaments.clear();
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
