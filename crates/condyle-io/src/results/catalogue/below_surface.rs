//! Stress below the surface of a deformable insert, what has yielded, and its backside.
//!
//! Stress is that of the centres of elements, at the increment of each update with the highest pressure.

use std::cmp::Ordering;

use condyle::contact::BacksideAtRest;
use condyle::evolve::{PlasticRecord, UnderSurfaceRecord};

use super::{FinishedRun, Scalar, scalar::scalars};

scalars! { "Below the surface";
    /// Largest von Mises stress. At the centre of an element, at the instant of highest pressure of a cycle solved.
    PEAK_VON_MISES_MPA = Scalar::new("peak_von_mises_mpa", "largest von Mises stress", 1, |run| {
        Some(most_stressed(run)?.von_mises_mpa)
    }).sometimes();

    /// Depth of the largest von Mises stress. Below the surface, to half an element.
    PEAK_VON_MISES_DEPTH_MM = Scalar::new("peak_von_mises_depth_mm", "depth of that stress", 1, |run| {
        Some(most_stressed(run)?.von_mises_depth_mm)
    }).sometimes();

    /// Largest shear stress. At the centre of an element, at the instant of highest pressure of a cycle solved.
    PEAK_MAX_SHEAR_MPA = Scalar::new("peak_max_shear_mpa", "largest shear stress", 1, |run| {
        Some(most_sheared(run)?.1.max_shear_mpa)
    }).sometimes().in_cycle("peak_max_shear_cycle");

    /// Depth of the largest shear stress. Below the surface, to half an element.
    PEAK_MAX_SHEAR_DEPTH_MM = Scalar::new("peak_max_shear_depth_mm", "depth of that stress", 1, |run| {
        Some(most_sheared(run)?.1.max_shear_depth_mm)
    }).sometimes();

    /// Cycles done before the cycle with the largest shear stress. 0 is the first cycle.
    PEAK_MAX_SHEAR_CYCLE = Scalar::new("peak_max_shear_cycle", "cycles before that stress", 0, |run| {
        Some(run.state().cycles_before(most_sheared(run)?.0))
    }).sometimes().listed();

    /// Instant of the largest shear stress in its cycle.
    PEAK_MAX_SHEAR_PERCENT = Scalar::new("peak_max_shear_percent", "instant of that stress", 1, |run| {
        Some(most_sheared(run)?.1.percent)
    }).sometimes().listed();

    /// Largest shear stress of the first cycle. Of the unworn insert.
    FIRST_CYCLE_MAX_SHEAR_MPA = Scalar::new("first_cycle_max_shear_mpa", "largest shear stress, first cycle", 1, |run| {
        Some(records(run).next()?.1.max_shear_mpa)
    }).sometimes().listed();

    /// Depth of the largest shear stress of the first cycle. Below the surface, to half an element.
    FIRST_CYCLE_MAX_SHEAR_DEPTH_MM = Scalar::new("first_cycle_max_shear_depth_mm", "depth of that stress", 1, |run| {
        Some(records(run).next()?.1.max_shear_depth_mm)
    }).sometimes().listed();

    /// Largest permanent set. How far yielding has lowered the surface for good; wear is not included.
    MAX_PERMANENT_SET_MM = Scalar::new("max_permanent_set_mm", "permanent set", 4, |run| {
        Some(plastic(run)?.max_permanent_set_mm)
    }).sometimes();

    /// Largest permanent set of the first cycle. After the first cycle that repeats itself.
    FIRST_CYCLE_PERMANENT_SET_MM = Scalar::new("first_cycle_permanent_set_mm", "permanent set, first cycle", 4, |run| {
        plastic(run)?;
        Some(records(run).next()?.1.plastic.map_or(0.0, |first| first.max_permanent_set_mm))
    }).sometimes();

    /// Largest accumulated plastic strain. At a Gauss point.
    MAX_PLASTIC_STRAIN = Scalar::new("max_plastic_strain", "largest plastic strain", 4, |run| {
        Some(plastic(run)?.max_plastic_strain)
    }).sometimes();

    /// Elements that have yielded.
    YIELDED_ELEMENTS = Scalar::new("yielded_elements", "yielded elements", 0, |run| {
        Some(plastic(run)?.yielded_elements as f64)
    }).count().sometimes();

    /// Elements that still yield in every cycle. By a strain of more than 1e-5 in the last cycle; the other yielded
    /// elements have shaken down.
    RATCHETING_ELEMENTS = Scalar::new("ratcheting_elements", "ratcheting elements", 0, |run| {
        Some(plastic(run)?.ratcheting_elements as f64)
    }).count().sometimes();

    /// Largest lift of the backside off the tray. In the last cycle of any update, as all numbers of the backside.
    BACKSIDE_LIFT_MM = Scalar::new("backside_lift_mm", "lift of the backside", 4, |run| {
        backside(run, |side| side.lift_mm)
    }).sometimes();

    /// Largest part of the backside that lifts at once.
    BACKSIDE_LIFTED_PERCENT = Scalar::new("backside_lifted_percent", "part of the backside that lifts", 0, |run| {
        Some(100.0 * backside(run, |side| side.lifted_part)?)
    }).sometimes();

    /// Longest slip of the backside in a cycle. The path of a node along the tray while it presses, there and back.
    BACKSIDE_SLIP_MM = Scalar::new("backside_slip_mm", "slip of the backside", 4, |run| {
        backside(run, |side| side.slip_mm)
    }).sometimes();

    /// Largest force on the lock. Along the tray; friction under the insert carries the rest.
    BACKSIDE_LOCK_FORCE_N = Scalar::new("backside_lock_force_n", "force on the lock", 0, |run| {
        backside(run, |side| side.lock_force_n)
    }).sometimes();

    /// Largest moment on the lock. About the vertical axis.
    BACKSIDE_LOCK_MOMENT_NM = Scalar::new("backside_lock_moment_nm", "moment on the lock", 2, |run| {
        Some(1e-3 * backside(run, |side| side.lock_moment_nmm)?)
    }).sometimes();
}

/// The records of all updates with their numbers; none of a rigid insert.
fn records<'a>(
    run: &FinishedRun<'a>,
) -> impl DoubleEndedIterator<Item = (usize, &'a UnderSurfaceRecord)> {
    let updates = run.state().updates.iter().enumerate();
    updates.filter_map(|(number, update)| Some((number, update.under_surface.as_ref()?)))
}

fn most_stressed<'a>(run: &FinishedRun<'a>) -> Option<&'a UnderSurfaceRecord> {
    let by_stress = |a: &(usize, &UnderSurfaceRecord), b: &(usize, &UnderSurfaceRecord)| -> Ordering {
        a.1.von_mises_mpa.total_cmp(&b.1.von_mises_mpa)
    };
    Some(records(run).max_by(by_stress)?.1)
}

fn most_sheared<'a>(run: &FinishedRun<'a>) -> Option<(usize, &'a UnderSurfaceRecord)> {
    records(run).max_by(|a, b| a.1.max_shear_mpa.total_cmp(&b.1.max_shear_mpa))
}

fn plastic(run: &FinishedRun<'_>) -> Option<PlasticRecord> {
    records(run).next_back()?.1.plastic
}

/// The largest value of any update; none of a bonded backside.
fn backside(run: &FinishedRun<'_>, value: fn(&BacksideAtRest) -> f64) -> Option<f64> {
    let values = records(run).filter_map(|(_, record)| record.backside.as_ref().map(value));
    values.reduce(f64::max)
}
