//! Plausibility checks of a finished run: each with its number, its limit and a remedy.
//!
//! A small discretisation error shows that the model was solved well, not that the model is right. These checks find
//! causes of wrong numbers that look right: wear at the rim, pressure beyond yield, nearly inverted elements, and
//! different values of the worn volume from two computations.

pub(crate) mod bodies;
pub(crate) mod finished;
pub(crate) mod loads;
pub(crate) mod waveforms;

use condyle::evolve::March;
use condyle_case::case::BuildWarning;
use condyle_results::{
    MAX_FACTOR_OF_RUN, PlausibilityWarning, Side, Summary,
    catalogue::{
        ADDED_INERTIA, CYCLES_NOT_REPEATING, MASS_LOSS_MG, MAX_DEPTH_MM, PEAK_PRESSURE_MPA, Scalar,
        VOLUME_LOSS_MESH_MM3, VOLUME_LOSS_MM3, WORST_QUALITY,
    },
};

use finished::{Finished, percent_of, warning};

/// A check of one number; none if the run is plausible.
type Check = fn(&Finished<'_>) -> Option<PlausibilityWarning>;

/// The unit of the load, the place of the femur on the insert, their meshes, and impossible pressure.
const PLACE: [Check; 8] = [
    loads::load_small,
    bodies::femur_on_eminence,
    bodies::pressure_at_rim,
    bodies::femur_mesh,
    bodies::insert_mesh,
    bodies::hollow_insert,
    bodies::noisy_mesh,
    bodies::pressure_beyond_flow,
];

/// Load on the polyethylene, and quality of the solution.
const REST: [Check; 16] = [
    loads::slides_slowly,
    bodies::insert_rocks,
    bodies::contact_coarse,
    bodies::single_layer,
    interval_too_wide,
    mesh_quality,
    counts_of_volume,
    single_update,
    updates_too_few,
    updates_overshoot,
    error_incomplete,
    |finished| large_error("error_of_mass", &MASS_LOSS_MG, MAX_ERROR_PERCENT, finished),
    |finished| large_error("error_of_depth", &MAX_DEPTH_MM, MAX_ERROR_PERCENT, finished),
    |finished| {
        large_error(
            "error_of_peak",
            &PEAK_PRESSURE_MPA,
            MAX_PEAK_ERROR_PERCENT,
            finished,
        )
    },
    added_inertia,
    cycles_not_repeating,
];

/// Remarks on the physics of a sound run: most knees have them.
const NOTES: [Check; 2] = [bodies::pressure_beyond_yield, bodies::thin_polyethylene];

/// Findings that make the numbers of a finished march doubtful, the worst first, and remarks that do not.
///
/// Places are stated in the frame of `side`. In a batch, the gaps of the nodes over the cycle are not examined, since this
/// would take a large part of the time of a run.
pub(crate) fn warnings(
    march: &March,
    summary: &Summary,
    side: Side,
    of_build: &[BuildWarning],
    is_batch: bool,
) -> (Vec<PlausibilityWarning>, Vec<PlausibilityWarning>) {
    let finished = Finished::new(march, summary, side, of_build);
    let one = |check: &Check| check(&finished);
    let mut warnings = Vec::new();
    warnings.extend(bodies::wear_at_rim(&finished));
    warnings.extend(
        (!is_batch)
            .then(|| bodies::femur_beyond_rim(&finished))
            .flatten(),
    );
    warnings.extend(PLACE.iter().filter_map(one));
    warnings.extend(waveforms::motions(&finished));
    warnings.extend(waveforms::noise(&finished));
    warnings.extend(waveforms::overshoots(&finished));
    warnings.extend(waveforms::coarse_increments(&finished));
    warnings.extend(loads::not_reached(&finished));
    warnings.extend(loads::impact(&finished));
    warnings.extend(loads::springs_far(&finished));
    warnings.extend(loads::ranges(&finished));
    warnings.extend(loads::lift_off(&finished));
    warnings.extend(REST.iter().filter_map(one));
    (warnings, NOTES.iter().filter_map(one).collect())
}

/// Largest difference between the two values of the worn volume, %.
const COUNTS_PERCENT: f64 = 1.0;
/// Smallest volume that the change of a mesh determines, mm3: a part of 1e-11 of a large insert.
const MIN_VOLUME_MM3: f64 = 1e-6;
/// Scaled Jacobian below which an element is nearly inverted.
const MIN_QUALITY: f64 = 0.1;
/// Largest added inertia, as a multiple of the machine's own; our choice.
const MAX_ADDED_INERTIA: f64 = 1.0;
/// Largest wear in one step, as a multiple of the wear that evens out the pressure at the bottom of the scar: the
/// shape of at most a tenth of the depth is then wrong. Our choice.
const MAX_RELAXED: f64 = 0.2;
/// Largest change of the wear rates of the nodes in a step, as a part of their sum: sound tests of knees and hips stay below 3 %,
/// and steps that overshoot change 25 % or more.
const MAX_CHANGE_IN_STEP_PERCENT: f64 = 20.0;
/// Largest depth by which a step may overshoot at the deepest place, % of the deepest wear: in sound tests 2 % at most.
const MAX_ALTERNATING_DEPTH_PERCENT: f64 = 5.0;
/// Part of the depth's error that is due to updates, %, up to which the estimates held for random designs.
const MAX_OF_UPDATES_PERCENT: f64 = 2.0;
/// Largest bound of an error, %: twice an estimate of 5 %. Our choice.
const MAX_ERROR_PERCENT: f64 = 10.0;
/// The same for the peak pressure, %: at the edge of a body it is known to a third, in shipped implants too. Our choice.
const MAX_PEAK_ERROR_PERCENT: f64 = 50.0;

/// Compares the volume from depth times area with that of the mesh.
pub(crate) fn counts_of_volume(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let [depth, mesh] =
        [&VOLUME_LOSS_MM3, &VOLUME_LOSS_MESH_MM3].map(|volume| finished.summary[volume]);
    // Without wear both are 0: MIN_POSITIVE makes the result 0 % instead of NaN.
    let percent = 100.0 * (depth - mesh).abs() / depth.max(mesh).max(f64::MIN_POSITIVE);
    let message = format!(
        "the worn volume is {depth:.2} mm3 by depth times area and {mesh:.2} mm3 by the change of the mesh, {percent:.1} % \
             apart"
    );
    let advice =
        "The mesh is too coarse for the scar, or worn at a crease: take a smaller edge_mm.";
    let value = (percent, COUNTS_PERCENT, "%");
    (percent > COUNTS_PERCENT && depth.max(mesh) > MIN_VOLUME_MM3)
        .then(|| warning("counts_of_volume", value, message, advice))
}

pub(crate) fn mesh_quality(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let quality = finished.summary[&WORST_QUALITY];
    let message = format!(
        "the worst element is nearly flat: its scaled Jacobian is {quality:.3}, and at least {MIN_QUALITY} is acceptable"
    );
    let advice = "Use fewer layers, or a larger edge_mm if the element is at the outline; if the wear itself distorts it, use more \
                 updates or fewer cycles.";
    (quality < MIN_QUALITY)
        .then(|| warning("mesh_quality", (quality, MIN_QUALITY, ""), message, advice))
}

fn large_error(
    check: &str,
    scalar: &Scalar,
    limit_percent: f64,
    finished: &Finished<'_>,
) -> Option<PlausibilityWarning> {
    let percent = finished.summary.error.as_ref()?.of(scalar).percent.total;
    let message = format!(
        "the {} has a discretisation error of {percent:.1} %",
        scalar.label
    );
    let advice = "Refine the setting with the largest part of the error: increments, updates, edge_mm or slip tolerance.";
    (percent > limit_percent)
        .then(|| warning(check, (percent, limit_percent, "%"), message, advice))
}

/// Warns of an estimate of the error of the mass that lacks one of its parts.
pub(crate) fn error_incomplete(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let error = finished.summary.error.as_ref()?;
    let parts = error.of(&MASS_LOSS_MG).percent.parts().into_iter();
    let missing = parts.filter(|(_, percent)| percent.is_none());
    let missing: Vec<&str> = missing.map(|(part, _)| part.name()).collect();
    let message = format!(
        "the discretisation error of the mass loss is incomplete, since it lacks the part from {}: the error is larger than stated",
        missing.join(", ").replace('_', " ")
    );
    let advice = "The warnings at the end state the reason. Refine the part that is missing, and compare both runs.";
    let value = (missing.len() as f64, 0.0, "");
    // Nothing worn has no error in %.
    let is_worn = finished.summary[&MASS_LOSS_MG] > 0.0;
    (is_worn && !missing.is_empty()).then(|| warning("error_incomplete", value, message, advice))
}

/// Warns of a predicted interval that is too wide for decisions.
pub(crate) fn interval_too_wide(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let prediction = finished.summary.prediction.as_ref()?;
    let factor = prediction.factor_of_run();
    let message = format!(
        "law, inputs and discretisation leave the mass uncertain by a factor of {factor:.1} either way; up to \
         {MAX_FACTOR_OF_RUN} is acceptable"
    );
    let advice = "The largest source of the interval shows the cause: the test is far from those that the law was fitted to, \
                  or the run is discretised too coarsely.";
    let value = (factor, MAX_FACTOR_OF_RUN, "");
    (prediction.is_of_run && factor > MAX_FACTOR_OF_RUN)
        .then(|| warning("interval_too_wide", value, message, advice))
}

/// Warns of a single update that wears the scar of the first cycle for the whole test, so deep that the pressure
/// would have changed.
pub(crate) fn single_update(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let state = finished.march.state();
    let step = state.last_step.as_ref()?;
    let relaxed = step.relaxation_per_cycle * step.interval;
    let message = format!(
        "the single update applies the wear of the first cycle for all cycles, {relaxed:.1} times the depth that would equalise \
             the pressure at the bottom of the scar; the resulting error is unknown and not part of the stated error"
    );
    let advice = "Take more updates, or update = \"auto\".";
    (state.updates.len() == 1 && relaxed > MAX_RELAXED)
        .then(|| warning("single_update", (relaxed, MAX_RELAXED, ""), message, advice))
}

/// Warns of steps beyond the stability of the march: a place that lies too deep carries so little that the next step leaves it
/// too high, and the other way round. The error by the updates is estimated from sums over the surface, which hardly change.
pub(crate) fn updates_overshoot(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let state = finished.march.state();
    let (step, fields) = (state.last_step.as_ref()?, state.fields.as_ref()?);
    let reversals_mm = step.reversals_mm(&fields.depth_per_cycle_mm);
    let (mut changed, mut reversed, mut sum, mut deepest_mm) = (0.0, 0.0, 0.0, 0.0_f64);
    for (node, reversal_mm) in reversals_mm.iter().enumerate() {
        let (area_mm2, before) = (step.area_mm2[node], step.depth_per_cycle_mm[node]);
        let now = fields.depth_per_cycle_mm[node];
        let reversed_mm = reversal_mm[0].abs().min(reversal_mm[1].abs());
        changed += area_mm2 * (now - before).abs();
        reversed += 2.0 * area_mm2 * reversed_mm;
        sum += area_mm2 * (now + before);
        deepest_mm = deepest_mm.max(fields.wear_depth_mm[node] + step.interval * reversed_mm);
    }
    let (rates, worn_mm) = (MAX_CHANGE_IN_STEP_PERCENT, finished.summary[&MAX_DEPTH_MM]);
    let found = [
        // Where nodes alternately wear and rest, all of the sum changes.
        (
            percent_of(changed, sum),
            rates,
            "changes the wear rates of the nodes by",
            "their sum",
        ),
        (
            percent_of(reversed, sum),
            rates,
            "reverses a change of the wear rates of the nodes by",
            "the rates",
        ),
        // The sums hide a few nodes.
        (
            percent_of(deepest_mm - worn_mm, worn_mm),
            MAX_ALTERNATING_DEPTH_PERCENT,
            "may leave the deepest wear too deep by",
            "it",
        ),
    ];
    let (percent, limit, does, of) = found
        .into_iter()
        .find(|(percent, limit, ..)| percent > limit)?;
    let message = format!(
        "the last step of {:.0} cycles {does} {percent:.0} % of {of}: such long steps overshoot",
        step.interval
    );
    let advice = "Take more updates, or update = \"auto\".";
    let value = (percent, limit, "%");
    (state.updates.len() > 1).then(|| warning("updates_overshoot", value, message, advice))
}

/// Warns of steps of the march that are so long that the estimate of their error is too small.
pub(crate) fn updates_too_few(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let error = finished.summary.error.as_ref()?;
    let percent = error.of(&MAX_DEPTH_MM).percent.updates?.abs();
    let message = format!(
        "the estimated error of the deepest wear due to updates is {percent:.1} %; with such long steps, the stated errors \
             of mass and depth are uncertain themselves"
    );
    let advice = "Take more updates, or update = \"auto\".";
    let value = (percent, MAX_OF_UPDATES_PERCENT, "%");
    (percent > MAX_OF_UPDATES_PERCENT).then(|| warning("updates_too_few", value, message, advice))
}

pub(crate) fn added_inertia(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let added = finished.summary.get(&ADDED_INERTIA)?;
    let message = format!(
        "the requested explicit steps are stable only with up to {added:.0} times the machine's inertia added to it, which \
             changes the motion of the machine"
    );
    let advice = "Set a shorter explicit_step_s (0 takes the longest stable step), a larger slip_tolerance_mm_per_s, or \
                 integrator = \"implicit\".";
    let value = (added, MAX_ADDED_INERTIA, "");
    (added > MAX_ADDED_INERTIA).then(|| warning("added_inertia", value, message, advice))
}

pub(crate) fn cycles_not_repeating(finished: &Finished<'_>) -> Option<PlausibilityWarning> {
    let count = finished.summary[&CYCLES_NOT_REPEATING];
    let message = format!("no cycle repeated within the tolerance {count} times");
    let advice = "The motion still changes from cycle to cycle: use more cycles per update, or a machine with more \
                 damping or stiffer springs.";
    (count > 0.0).then(|| warning("cycles_not_repeating", (count, 0.0, ""), message, advice))
}
