//! Stress below the surface of a deformable insert, what has yielded, and its backside.
//!
//! Stress is that of the centres of elements, at the increment of each solved cycle with the highest pressure.

use condyle::{
    contact::BacksideAtRest,
    evolve::{PlasticRecord, UnderSurfaceRecord},
};

use super::finished::{FinishedRun, largest};
use super::{Scalar, scalar::scalars};

scalars! { "Below the surface";
    /// Largest von Mises stress. At the centre of an element, at the instant with the highest pressure of a solved cycle.
    PEAK_VON_MISES_MPA = Scalar::sometimes("peak_von_mises_mpa", "largest von Mises stress", 1, |run| Some(most_stressed(run)?.von_mises_mpa))
        .estimated();

    /// Depth of the largest von Mises stress. Below the surface, to half an element.
    PEAK_VON_MISES_DEPTH_MM = Scalar::sometimes("peak_von_mises_depth_mm", "depth of that stress", 1, |run| Some(most_stressed(run)?.von_mises_depth_mm))
        .continued();

    /// Largest shear stress. At the centre of an element, at the instant with the highest pressure of a solved cycle.
    PEAK_MAX_SHEAR_MPA = Scalar::sometimes("peak_max_shear_mpa", "largest shear stress", 1, |run| Some(most_sheared(run)?.1.max_shear_mpa))
        .estimated()
        .in_cycle("peak_max_shear_cycle");

    /// Depth of the largest shear stress. Below the surface, to half an element.
    PEAK_MAX_SHEAR_DEPTH_MM = Scalar::sometimes("peak_max_shear_depth_mm", "depth of that stress", 1, |run| Some(most_sheared(run)?.1.max_shear_depth_mm))
        .continued();

    /// Cycles before the cycle with the largest shear stress. 0 is the first cycle.
    PEAK_MAX_SHEAR_CYCLE = Scalar::sometimes("peak_max_shear_cycle", "cycles before that stress", 0, |run| Some(most_sheared(run)?.0))
        .listed();

    /// Instant of the largest shear stress in its cycle.
    PEAK_MAX_SHEAR_PERCENT = Scalar::sometimes("peak_max_shear_percent", "instant of that stress", 1, |run| Some(most_sheared(run)?.1.percent))
        .listed();

    /// Largest shear stress of the first cycle. On the unworn insert.
    FIRST_CYCLE_MAX_SHEAR_MPA = Scalar::sometimes("first_cycle_max_shear_mpa", "largest shear stress, first cycle", 1, |run| Some(first(run)?.max_shear_mpa))
        .listed();

    /// Depth of the largest shear stress of the first cycle. Below the surface, to half an element.
    FIRST_CYCLE_MAX_SHEAR_DEPTH_MM = Scalar::sometimes("first_cycle_max_shear_depth_mm", "depth of that stress", 1, |run| Some(first(run)?.max_shear_depth_mm))
        .listed();

    /// Largest permanent set. Permanent displacement of the surface by yield, without wear.
    MAX_PERMANENT_SET_MM = Scalar::sometimes("max_permanent_set_mm", "permanent set", 4, |run| Some(plastic(run)?.max_permanent_set_mm));

    /// Largest permanent set of the first cycle. After the first periodic cycle.
    FIRST_CYCLE_PERMANENT_SET_MM = Scalar::sometimes("first_cycle_permanent_set_mm", "permanent set in the first cycle", 4, |run| {
        plastic(run)?;
        Some(first(run)?.plastic.map_or(0.0, |plastic| plastic.max_permanent_set_mm))
    })
        .continued();

    /// Largest accumulated plastic strain. At a Gauss point.
    MAX_PLASTIC_STRAIN = Scalar::sometimes("max_plastic_strain", "largest plastic strain", 4, |run| Some(plastic(run)?.max_plastic_strain));

    /// Elements that have yielded.
    YIELDED_ELEMENTS = Scalar::sometimes("yielded_elements", "yielded elements", 0, |run| Some(plastic(run)?.yielded_elements as f64))
        .count();

    /// Elements that still yield in every cycle. By a plastic strain of more than 1e-5 in the last cycle; the other yielded elements have shaken down.
    RATCHETING_ELEMENTS = Scalar::sometimes("ratcheting_elements", "ratcheting elements", 0, |run| Some(plastic(run)?.ratcheting_elements as f64))
        .count()
        .continued();

    /// Largest lift of the backside off the tray. In any solved cycle, like all numbers of the backside.
    BACKSIDE_LIFT_MM = Scalar::sometimes("backside_lift_mm", "lift of the backside", 4, |run| backside(run, |rest| rest.lift_mm));

    /// Largest part of the backside that is lifted at the same time.
    BACKSIDE_LIFTED_PERCENT = Scalar::sometimes("backside_lifted_percent", "part of the backside that is lifted", 0, |run| Some(100.0 * backside(run, |rest| rest.lifted_part)?))
        .continued();

    /// Longest slip of the backside in a cycle. The length of the path of a node along the tray under pressure.
    BACKSIDE_SLIP_MM = Scalar::sometimes("backside_slip_mm", "slip of the backside", 4, |run| backside(run, |rest| rest.slip_mm));

    /// Largest force on the lock. Along the tray; friction carries the rest.
    BACKSIDE_LOCK_FORCE_N = Scalar::sometimes("backside_lock_force_n", "force on the lock", 0, |run| backside(run, |rest| rest.lock_force_n));

    /// Largest moment on the lock. About the vertical axis.
    BACKSIDE_LOCK_MOMENT_NM = Scalar::sometimes("backside_lock_moment_nm", "moment on the lock", 2, |run| Some(1e-3 * backside(run, |rest| rest.lock_moment_nmm)?))
        .continued();
}

/// Returns the stresses of all solved cycles with the cycles done before each; none for a foundation.
fn records(
    run: &FinishedRun<'_>,
) -> impl DoubleEndedIterator<Item = (f64, UnderSurfaceRecord)> {
    let peaks = run.peaks();
    peaks.filter_map(|(cycles, peaks)| Some((cycles, peaks.under_surface?)))
}

fn first(run: &FinishedRun<'_>) -> Option<UnderSurfaceRecord> {
    records(run).next().map(|(_, record)| record)
}

fn most_stressed(run: &FinishedRun<'_>) -> Option<UnderSurfaceRecord> {
    largest(records(run), |record| record.von_mises_mpa).map(|(_, record)| record)
}

fn most_sheared(run: &FinishedRun<'_>) -> Option<(f64, UnderSurfaceRecord)> {
    largest(records(run), |record| record.max_shear_mpa)
}

/// Returns the yield up to the final cycle; `None` for an insert that does not yield.
fn plastic(run: &FinishedRun<'_>) -> Option<PlasticRecord> {
    records(run).next_back()?.1.plastic
}

/// Returns the largest value of all solved cycles; `None` for a bonded backside.
fn backside(run: &FinishedRun<'_>, value: fn(&BacksideAtRest) -> f64) -> Option<f64> {
    let rests = records(run).filter_map(|(_, record)| record.backside);
    rests.map(|rest| value(&rest)).reduce(f64::max)
}
