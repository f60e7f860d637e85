//! What the runs found, as numbers.

use serde::Serialize;

use super::intervals::Intervals;
use super::scar::{Scar, scars};
use super::series::{above_percent, line_through, range};
use super::{
    error::StudyError,
    ran::{Ran, TableOf, reference},
};

/// End of stance, % of the cycle.
const STANCE_END_PERCENT: f64 = 60.0;

/// What the runs found; units are in the names.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Findings {
    /// Update intervals in displacement control, as in the paper.
    pub displacement_intervals: Intervals,
    /// Update intervals in force control.
    pub force_intervals: Intervals,
    /// Range of AP in the first cycle, force control.
    pub ap_range_mm: f64,
    /// Range of IE in the first cycle, force control.
    pub ie_range_deg: f64,
    /// How far the insert's mean AP has moved back from the first cycle to the last, force control.
    pub ap_posterior_shift_mm: f64,
    /// How straight volume is in cycles, 40 updates, R2, force control.
    pub volume_r_squared: f64,
    /// Slope of that line.
    pub volume_rate_mm3_per_million_cycles: f64,
    /// Rate of the last tenth of the test above that of the first, force control.
    pub rate_growth_force_percent: f64,
    /// The same in displacement control.
    pub rate_growth_displacement_percent: f64,
    /// Mass worn in force control.
    pub mass_force_mg: f64,
    /// Mass worn in displacement control.
    pub mass_displacement_mg: f64,
    /// Mass in force control above displacement control.
    pub mass_force_against_displacement_percent: f64,
    /// Deepest wear in force control above displacement control at the end.
    pub depth_force_against_displacement_percent: f64,
    /// The least of that before the end.
    pub depth_force_least_against_displacement_percent: f64,
    /// The most of that before the end.
    pub depth_force_most_against_displacement_percent: f64,
    /// Range of IE in stance, first cycle.
    pub ie_stance_range_first_deg: f64,
    /// Range of IE in stance, last cycle.
    pub ie_stance_range_last_deg: f64,
    /// Largest fall of IE in stance at the same percent, from the first cycle to the last.
    pub ie_stance_largest_fall_deg: f64,
    /// Where that is.
    pub ie_stance_largest_fall_at_percent: f64,
    /// Largest rise of IE in stance.
    pub ie_stance_largest_rise_deg: f64,
    /// Where that is.
    pub ie_stance_largest_rise_at_percent: f64,
    /// Medial scar, force control.
    pub medial: Scar,
    /// Lateral scar, force control.
    pub lateral: Scar,
    /// Time of the solver for 10 x 500k, one core.
    pub wall_s: f64,
    /// Cycles that it solved.
    pub cycles_solved: f64,
}

impl Findings {
    /// What `force` and `displacement` found, each in the order of its updates.
    pub(super) fn of(force: &[Ran], displacement: &[Ran]) -> Result<Self, StudyError> {
        let (of_paper, held) = (reference(force), reference(displacement));
        let finest = &force[force.len() - 1];
        let line = line_through(&volumes(finest)?);
        let [fall, rise] = changes_of_ie(finest)?;
        let [medial, lateral] = scars(of_paper)?;
        let [first, last] = [true, false].map(|is_first| stance_range(finest, is_first));
        let depths = depth_above(of_paper, held)?;
        let (end, before) = depths.split_last().unwrap_or((&f64::NAN, &[]));
        let (least, most) = range(before.iter().copied());
        let summary = &of_paper.summary;
        Ok(Self {
            displacement_intervals: Intervals::of(displacement)?,
            force_intervals: Intervals::of(force)?,
            ap_range_mm: summary.ap_range_mm,
            ie_range_deg: summary.ie_range_deg,
            ap_posterior_shift_mm: mean_ap(of_paper, true)? - mean_ap(of_paper, false)?,
            volume_r_squared: line.r_squared,
            volume_rate_mm3_per_million_cycles: 1e6 * line.slope,
            rate_growth_force_percent: rate_growth(of_paper)?,
            rate_growth_displacement_percent: rate_growth(held)?,
            mass_force_mg: summary.mass_loss_mg,
            mass_displacement_mg: held.summary.mass_loss_mg,
            mass_force_against_displacement_percent: above_percent(
                summary.mass_loss_mg,
                held.summary.mass_loss_mg,
            ),
            depth_force_against_displacement_percent: *end,
            depth_force_least_against_displacement_percent: least,
            depth_force_most_against_displacement_percent: most,
            ie_stance_range_first_deg: first?,
            ie_stance_range_last_deg: last?,
            ie_stance_largest_fall_deg: -fall.1,
            ie_stance_largest_fall_at_percent: fall.0,
            ie_stance_largest_rise_deg: rise.1,
            ie_stance_largest_rise_at_percent: rise.0,
            medial,
            lateral,
            wall_s: summary.wall_s,
            cycles_solved: summary.cycles_solved,
        })
    }
}

/// Deepest wear of a run above that of another with as many updates, after each of them, %.
fn depth_above(ran: &Ran, other: &Ran) -> Result<Vec<f64>, StudyError> {
    let pairs = ran.depths()?.1.iter().zip(other.depths()?.1);
    Ok(pairs
        .map(|(depth, other)| above_percent(*depth, *other))
        .collect())
}

fn volumes(ran: &Ran) -> Result<Vec<(f64, f64)>, StudyError> {
    let cycles = ran.column(TableOf::Wear, "cycles")?;
    let volumes = ran.column(TableOf::Wear, "volume_loss_mm3")?;
    let after = cycles.iter().copied().zip(volumes.iter().copied());
    Ok([(0.0, 0.0)].into_iter().chain(after).collect())
}

/// The wear of the last interval above that of the first.
fn rate_growth(ran: &Ran) -> Result<f64, StudyError> {
    let volumes = volumes(ran)?;
    let worn = |end: usize| volumes[end].1 - volumes[end - 1].1;
    Ok(above_percent(worn(volumes.len() - 1), worn(1)))
}

/// (percent, value) of a column through the first cycle or the last.
fn cycle_of(ran: &Ran, is_first: bool, name: &'static str) -> Result<Vec<(f64, f64)>, StudyError> {
    let cycles = ran.column(TableOf::Kinematics, "cycles")?;
    let percent = ran.column(TableOf::Kinematics, "percent")?;
    let values = ran.column(TableOf::Kinematics, name)?;
    let rows = cycles.iter().zip(percent.iter().zip(values));
    let wanted = rows.filter(|(cycles, _)| (**cycles == 0.0) == is_first);
    Ok(wanted
        .map(|(_, (percent, value))| (*percent, *value))
        .collect())
}

/// Mean AP of the first cycle or the last, mm.
fn mean_ap(ran: &Ran, is_first: bool) -> Result<f64, StudyError> {
    let rows = cycle_of(ran, is_first, "ap_mm")?;
    Ok(rows.iter().map(|row| row.1).sum::<f64>() / rows.len() as f64)
}

/// (percent, IE in degrees) through stance of the first cycle or the last.
fn stance_ie(ran: &Ran, is_first: bool) -> Result<Vec<(f64, f64)>, StudyError> {
    let mut rows = cycle_of(ran, is_first, "ie_deg")?;
    rows.retain(|(percent, _)| *percent <= STANCE_END_PERCENT);
    Ok(rows)
}

fn stance_range(ran: &Ran, is_first: bool) -> Result<f64, StudyError> {
    let rows = stance_ie(ran, is_first)?;
    let (low, high) = range(rows.iter().map(|row| row.1));
    Ok(high - low)
}

/// The lowest and the highest change of IE in stance, each as (percent, degrees).
fn changes_of_ie(ran: &Ran) -> Result<[(f64, f64); 2], StudyError> {
    let (first, last) = (stance_ie(ran, true)?, stance_ie(ran, false)?);
    let changes: Vec<(f64, f64)> = first
        .iter()
        .zip(&last)
        .map(|(first, last)| (first.0, last.1 - first.1))
        .collect();
    let order = |one: &&(f64, f64), other: &&(f64, f64)| one.1.total_cmp(&other.1);
    let lowest = changes.iter().min_by(order);
    let highest = changes.iter().max_by(order);
    let found = lowest.zip(highest).ok_or_else(|| ran.lacks("last cycle"));
    found.map(|(lowest, highest)| [*lowest, *highest])
}
