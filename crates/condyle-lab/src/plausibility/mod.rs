//! Whether a finished run can be believed: each check with its number, its limit and what to do.
//!
//! A small discretisation error says that the model was solved well, not that the model is sane. These checks look
//! for what makes a sane-looking number wrong: wear at the rim, polyethylene pressed beyond yield, a mesh about to
//! fold, two counts of one volume that differ.

mod bodies;
mod finished;
mod loads;
mod motions;
mod numbers;
mod rim;

use condyle::evolve::March;
use condyle_io::results::{PlausibilityWarning, Summary};

use finished::Finished;

/// A check of one number: none where the run is as it should be.
type Check = fn(&Finished<'_>) -> Option<PlausibilityWarning>;

/// Where the femur is on the insert, and pressure that there cannot be.
const PLACE: [Check; 4] = [
    bodies::wear_at_rim,
    rim::femur_beyond_rim,
    bodies::pressure_at_rim,
    bodies::pressure_beyond_flow,
];

/// What the polyethylene bears, and how well the model was solved.
const REST: [Check; 11] = [
    bodies::pressure_beyond_yield,
    bodies::insert_rocks,
    bodies::thin_polyethylene,
    numbers::mesh_quality,
    numbers::counts_of_volume,
    numbers::single_update,
    numbers::updates_too_few,
    numbers::error_of_mass,
    numbers::error_of_depth,
    numbers::added_inertia,
    numbers::cycles_not_repeating,
];

/// What makes a finished march doubtful, the worst first.
pub(crate) fn warnings(march: &March, summary: &Summary) -> Vec<PlausibilityWarning> {
    let finished = Finished::new(march, summary);
    let one = |check: &Check| check(&finished);
    let mut warnings = Vec::new();
    warnings.extend(PLACE.iter().filter_map(one));
    warnings.extend(loads::not_reached(&finished));
    warnings.extend(loads::springs_far(&finished));
    warnings.extend(motions::ranges(&finished));
    warnings.extend(motions::lift_off(&finished));
    warnings.extend(REST.iter().filter_map(one));
    warnings
}
