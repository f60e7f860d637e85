//! How exact a step of backward differences is.

use super::{Machine, MachineState};

/// What the error of a step of backward differences is of that of an extrapolation with lasting
/// accelerations: 2/9 of h^3 and the third derivative against 1/2, since the rates and the
/// accelerations that the extrapolation goes by are backward differences too.
const STEP_ERROR_PER_SURPRISE: f64 = 4.0 / 9.0;

/// Estimated error that a step makes in the positions of the loaded joints, mm; rotations on their
/// lever.
pub(super) fn step_error_mm(machine: &Machine, from: &MachineState, to: &MachineState) -> f64 {
    let levers = machine.levers();
    let step_s = to.before.map_or(0.0, |(_, step_s)| step_s);
    let extrapolated = from.extrapolated(step_s);
    // Both the step and the extrapolation miss the truth by a multiple of the same h^3 q''', so their
    // difference, which is known, is in constant proportion to the error of the step, which is not.
    let surprise_mm = |j: usize| (to.now.positions[j] - extrapolated[j]).abs() * levers.of_joint(j);
    STEP_ERROR_PER_SURPRISE * machine.loaded().map(surprise_mm).fold(0.0, f64::max)
}
