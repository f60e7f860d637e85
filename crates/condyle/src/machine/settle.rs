//! Where the extended femur settles under the vertical load: the machine's neutral position.

use super::joint_numbers::Mat6;
use super::{
    Chain, Drive, Freedom, Machine, Waveform,
    balance::{Balance, Kinematics, StepSlopes},
    integrator::{SolverCounters, drive, loads_at, longest_mm, out_of_balance_n},
};
use crate::contact::ContactModel;

/// Iterations after which settling is given up.
const MOST_ITERATIONS: usize = 2000;
/// Farthest that one iteration may move, mm.
const LONGEST_CORRECTION_MM: f64 = 0.2;
/// Motion that the first iteration allows for the whole load, mm.
const FIRST_MOTION_MM: f64 = 0.05;

/// The femur did not come to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NotSettled {
    /// Positions at the last iteration, mm and rad, in the order of [`FREEDOMS`](super::FREEDOMS).
    pub positions: [f64; 6],
    /// Force left out of balance, N.
    pub residual_n: f64,
}

/// Positions of static balance under the axial load at the start of the cycle alone.
///
/// Femur extended as at 0 % of the cycle, IE at zero, no springs, no other loads and, nothing
/// sliding, no friction; AP always free, the other freedoms if the machine loads them. Newton's
/// method with a damping that vanishes as balance nears (pseudo-transient continuation), so that
/// it also finds its way from a first touch of one condyle.
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
    let loads = loads_at(&machine, 0.0);
    let mut positions = [0.0; 6];
    drive(&machine, 0.0, &mut positions, &mut [0.0; 6]);
    let axial_n = loads[Freedom::InferoSuperior as usize].abs().max(1.0);
    let mut damping = axial_n / FIRST_MOTION_MM;
    let mut last_residual_n = f64::INFINITY;
    for _ in 0..MOST_ITERATIONS {
        let kinematics = Kinematics {
            positions,
            rates: [0.0; 6],
            accelerations: [0.0; 6],
        };
        let still = StepSlopes {
            rate: 0.0,
            acceleration: 0.0,
        };
        let balance = Balance::new(&machine, chain, contact, kinematics);
        let residual = balance.residual(&loads);
        counters.contact_evaluations += 1;
        let residual_n = out_of_balance_n(&residual);
        if residual_n <= force_tolerance_n {
            return Ok(positions);
        }
        if last_residual_n.is_finite() {
            damping *= (residual_n / last_residual_n).clamp(0.3, 2.0);
        }
        last_residual_n = residual_n;
        let damped = balance.tangent(still) + damping_matrix(damping);
        let Some(correction) = damped.lu().solve(&residual) else {
            break;
        };
        counters.newton_iterations += 1;
        let limit = (LONGEST_CORRECTION_MM / longest_mm(&correction)).min(1.0);
        positions
            .iter_mut()
            .zip(&correction)
            .for_each(|(q, c)| *q -= c * limit);
    }
    Err(NotSettled {
        positions,
        residual_n: last_residual_n,
    })
}

/// The machine while it settles.
fn settling(machine: &Machine) -> Machine {
    let mut settling = machine.clone();
    settling.ap_springs.clear();
    for (j, row) in settling.freedoms.iter_mut().enumerate() {
        (row.inertia, row.damping) = (0.0, 0.0);
        let free = Drive::Loaded(Waveform::constant(0.0));
        row.drive = match (super::FREEDOMS[j], &row.drive) {
            (Freedom::AnteroPosterior, _) => free,
            (Freedom::InternalExternal, _) => Drive::Locked(0.0),
            (Freedom::InferoSuperior | Freedom::Flexion, kept) => kept.clone(),
            (_, Drive::Loaded(_)) => free,
            (_, driven) => driven.clone(),
        };
    }
    settling
}

/// Damping of all rows, rotations on a lever of 30 mm.
fn damping_matrix(damping: f64) -> Mat6 {
    const LEVER2_MM2: f64 = 900.0;
    let row = |freedom: Freedom| {
        damping
            * if freedom.is_rotation() {
                LEVER2_MM2
            } else {
                1.0
            }
    };
    Mat6::from_diagonal(&super::FREEDOMS.map(row).into())
}
