//! Whether a finished run can be believed: each check with its number, its limit and what to do.
//!
//! A small discretisation error says that the model was solved well, not that the model is sane. These checks look
//! for what makes a sane-looking number wrong: wear at the rim, polyethylene pressed beyond yield, a mesh about to
//! fold, two counts of one volume that differ.

mod bodies;
mod finished;
mod numbers;

use condyle::evolve::March;
use condyle_io::results::{PlausibilityWarning, Summary};

use finished::Finished;

/// A check: none where the run is as it should be.
type Check = fn(&Finished<'_>) -> Option<PlausibilityWarning>;

/// Every check, that which spoils the answer most first.
const CHECKS: [Check; 11] = [
    bodies::wear_at_rim,
    bodies::pressure_at_rim,
    bodies::pressure_beyond_yield,
    bodies::thin_polyethylene,
    numbers::mesh_quality,
    numbers::counts_of_volume,
    numbers::error_of_mass,
    numbers::error_of_depth,
    numbers::cycles_not_repeating,
    numbers::ap_range,
    numbers::ie_range,
];

/// What makes a finished march doubtful, the worst first.
pub(crate) fn warnings(march: &March, summary: &Summary) -> Vec<PlausibilityWarning> {
    let finished = Finished::new(march, summary);
    let warnings = CHECKS.iter().filter_map(|check| check(&finished));
    warnings.collect()
}
