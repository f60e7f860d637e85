//! The results of the runs, as numbers.

use condyle_report::{Region, Side, SurfaceFields, Vec3};
use condyle_results::catalogue;
use serde::Serialize;

use crate::runs::{Ran, StudyError, TableOf, reference};

/// End of stance, % of the cycle.
const STANCE_END_PERCENT: f64 = 60.0;

/// The results of the runs; units are in the names.
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
    /// Posterior shift of the insert's mean AP from the first cycle to the last, force control.
    pub ap_posterior_shift_mm: f64,
    /// R2 of volume over cycles, 40 updates, force control.
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
    /// Where in the cycle, %.
    pub ie_stance_largest_fall_at_percent: f64,
    /// Largest rise of IE in stance.
    pub ie_stance_largest_rise_deg: f64,
    /// Where in the cycle, %.
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
    /// The results of `force` and `displacement`, each in the order of its updates.
    pub(crate) fn of(force: &[Ran], displacement: &[Ran]) -> Result<Self, StudyError> {
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
            ap_range_mm: summary[&catalogue::AP_RANGE_MM],
            ie_range_deg: summary[&catalogue::IE_RANGE_DEG],
            ap_posterior_shift_mm: mean_ap(of_paper, true)? - mean_ap(of_paper, false)?,
            volume_r_squared: line.r_squared,
            volume_rate_mm3_per_million_cycles: 1e6 * line.slope,
            rate_growth_force_percent: rate_growth(of_paper)?,
            rate_growth_displacement_percent: rate_growth(held)?,
            mass_force_mg: summary[&catalogue::MASS_LOSS_MG],
            mass_displacement_mg: held.summary[&catalogue::MASS_LOSS_MG],
            mass_force_against_displacement_percent: above_percent(
                summary[&catalogue::MASS_LOSS_MG],
                held.summary[&catalogue::MASS_LOSS_MG],
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
            wall_s: summary[&catalogue::WALL_S],
            cycles_solved: summary[&catalogue::CYCLES_SOLVED],
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

/// The results as the worn shape is updated more often.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Intervals {
    /// Volume worn against the updates it was computed with.
    pub volume_loss_mm3: Vec<OverUpdates>,
    /// Volume of 1 x 5M above that of 10 x 500k.
    pub volume_1_against_10_percent: f64,
    /// Peak pressure of the last cycle that 5 x 1M solves above that of 40 x 125k at the same cycles.
    pub pressure_5_against_40_percent: f64,
    /// The same of the largest contact area.
    pub area_5_against_40_percent: f64,
    /// Deepest wear against the updates.
    pub max_depth_mm: Vec<OverUpdates>,
    /// Deepest wear of 10 x 500k above that of 40 x 125k.
    pub depth_10_against_40_percent: f64,
    /// Largest and smallest excess of the depth over that of 40 updates, at the same cycles, from
    /// a fifth of the test on.
    pub depth_excess: Vec<Excess>,
}

/// A result against the updates it was computed with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OverUpdates {
    /// Updates.
    pub updates: usize,
    /// The result.
    pub value: f64,
    /// Its excess over that of the most updates.
    pub above_finest_percent: f64,
}

/// The range of a result relative to the finest run over the test.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Excess {
    /// Updates.
    pub updates: usize,
    /// Furthest below.
    pub least_percent: f64,
    /// Furthest above.
    pub most_percent: f64,
}

impl Intervals {
    /// The results of `runs`, which are in the order of their updates.
    pub(crate) fn of(runs: &[Ran]) -> Result<Self, StudyError> {
        let of_paper = &reference(runs).summary;
        let (coarsest, finest) = (&runs[0].summary, &runs[runs.len() - 1]);
        let five = with_updates(runs, 5);
        let coarser = runs[..runs.len() - 1].iter();
        Ok(Self {
            volume_loss_mm3: over_updates(runs, |ran| ran.summary[&catalogue::VOLUME_LOSS_MM3]),
            volume_1_against_10_percent: above_percent(
                coarsest[&catalogue::VOLUME_LOSS_MM3],
                of_paper[&catalogue::VOLUME_LOSS_MM3],
            ),
            pressure_5_against_40_percent: at_last_cycle(five, finest, "peak_pressure_mpa")?,
            area_5_against_40_percent: at_last_cycle(five, finest, "peak_contact_area_mm2")?,
            max_depth_mm: over_updates(runs, |ran| ran.summary[&catalogue::MAX_DEPTH_MM]),
            depth_10_against_40_percent: above_percent(
                of_paper[&catalogue::MAX_DEPTH_MM],
                finest.summary[&catalogue::MAX_DEPTH_MM],
            ),
            depth_excess: coarser
                .map(|ran| excess(ran, finest))
                .collect::<Result<_, _>>()?,
        })
    }
}

fn with_updates(runs: &[Ran], updates: usize) -> &Ran {
    let found = runs.iter().find(|ran| ran.updates == updates);
    found.unwrap_or(&runs[0])
}

fn over_updates(runs: &[Ran], of: fn(&Ran) -> f64) -> Vec<OverUpdates> {
    let finest = of(&runs[runs.len() - 1]);
    let one = |ran: &Ran| OverUpdates {
        updates: ran.updates,
        value: of(ran),
        above_finest_percent: above_percent(of(ran), finest),
    };
    runs.iter().map(one).collect()
}

/// A quantity of the last cycle that `coarse` solves above that of `fine` after as many cycles.
///
/// A row of wear.csv stands for the interval before it, and its cycle is solved at the start.
fn at_last_cycle(coarse: &Ran, fine: &Ran, name: &'static str) -> Result<f64, StudyError> {
    let starts = |ran: &Ran| -> Result<Vec<f64>, StudyError> {
        let ends = ran.column(TableOf::Wear, "cycles")?;
        let interval = ran.summary[&catalogue::CYCLES] / ran.updates as f64;
        Ok(ends.iter().map(|end| end - interval).collect())
    };
    let (coarse_starts, fine_starts) = (starts(coarse)?, starts(fine)?);
    let coarse_values = coarse.column(TableOf::Wear, name)?;
    let last = coarse_values.len() - 1;
    let found = at(
        &fine_starts,
        fine.column(TableOf::Wear, name)?,
        coarse_starts[last],
    );
    let fine_value = found.ok_or_else(|| fine.lacks("cycle at the same place"))?;
    Ok(above_percent(coarse_values[last], fine_value))
}

fn excess(ran: &Ran, finest: &Ran) -> Result<Excess, StudyError> {
    const FROM_SHARE: f64 = 0.2;
    let (cycles, depth) = ran.depths()?;
    let (known_cycles, known_depth) = finest.depths()?;
    let from = FROM_SHARE * ran.summary[&catalogue::CYCLES] * (1.0 - 1e-9);
    let later = cycles
        .iter()
        .zip(depth)
        .filter(|(cycles, _)| **cycles >= from);
    let (least_percent, most_percent) = range(later.filter_map(|(&cycles, &depth)| {
        let known = at(known_cycles, known_depth, cycles)?;
        Some(above_percent(depth, known))
    }));
    Ok(Excess {
        updates: ran.updates,
        least_percent,
        most_percent,
    })
}

/// Depth above which a face counts as part of a scar, as a share of the largest depth.
const SCAR_SHARE: f64 = 0.05;

/// The scar of one side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Scar {
    /// Deepest wear.
    pub max_depth_mm: f64,
    /// Its position, anterior of the insert's origin.
    pub x_mm: f64,
    /// Its position, to the right of the insert's origin.
    pub z_mm: f64,
    /// From the posterior edge of that side to what is deeper than a twentieth of the deepest wear.
    pub to_posterior_edge_mm: f64,
    /// Area deeper than a twentieth of the whole insert's deepest wear.
    pub area_mm2: f64,
    /// Volume.
    pub volume_mm3: f64,
}

/// The medial scar and the lateral one.
pub(crate) fn scars(ran: &Ran) -> Result<[Scar; 2], StudyError> {
    let surface = ran.results.surface.as_ref();
    let depth = surface.and_then(|surface| Some((surface, surface.field("wear_depth_mm")?)));
    let (surface, depth) = depth.ok_or_else(|| ran.lacks("wear_depth_mm"))?;
    let whole = surface.largest(depth, Region::Whole);
    let threshold = SCAR_SHARE * whole.map_or(0.0, |deepest| deepest.value);
    let scar = |region: Region| {
        let deepest = surface.largest(depth, region);
        deepest.map_or_else(Scar::default, |deepest| Scar {
            max_depth_mm: deepest.value,
            x_mm: deepest.position.x,
            z_mm: deepest.position.z,
            to_posterior_edge_mm: to_posterior_edge(surface, depth, threshold, region),
            area_mm2: surface.area_above(depth, threshold, region),
            volume_mm3: surface.integral(depth, region),
        })
    };
    Ok(match ran.results.side {
        Side::Right => [Region::Left, Region::Right].map(scar),
        Side::Left => [Region::Right, Region::Left].map(scar),
    })
}

/// Distance of the nodes of a region that are deeper than `threshold` from the rearmost of all, mm.
fn to_posterior_edge(
    surface: &SurfaceFields,
    depth: &[f64],
    threshold: f64,
    region: Region,
) -> f64 {
    let nodes = surface.nodes.iter().zip(depth);
    let inside = nodes.filter(|(node, _)| region.holds(node.z));
    let rearmost = |(edge, scar): (f64, f64), (node, depth): (&Vec3, &f64)| {
        let worn = if *depth > threshold {
            scar.min(node.x)
        } else {
            scar
        };
        (edge.min(node.x), worn)
    };
    let (edge, scar) = inside.fold((f64::INFINITY, f64::INFINITY), rearmost);
    scar - edge
}

/// The straight line that fits points best, and how well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    /// Rise for each unit of x.
    pub(crate) slope: f64,
    /// Share of the variance that it explains, R2.
    pub(crate) r_squared: f64,
}

/// Least squares through `points`; two or more with different x.
pub(crate) fn line_through(points: &[(f64, f64)]) -> Line {
    let count = points.len() as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(&|point| point.0), mean(&|point| point.1));
    let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
        points
            .iter()
            .map(|point| of(point.0 - x, point.1 - y))
            .sum()
    };
    let (xx, xy, yy) = (sum(&|u, _| u * u), sum(&|u, v| u * v), sum(&|_, v| v * v));
    Line {
        slope: xy / xx,
        r_squared: xy * xy / (xx * yy),
    }
}

/// Smallest and largest.
pub(crate) fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
        (low.min(value), high.max(value))
    })
}

/// The excess of `value` over `reference`, % of it.
pub(crate) fn above_percent(value: f64, reference: f64) -> f64 {
    100.0 * (value / reference - 1.0)
}

/// The value of `values` where `xs` is `x`, to a part in 1e9.
pub(crate) fn at(xs: &[f64], values: &[f64], x: f64) -> Option<f64> {
    let close = |known: &f64| (known - x).abs() <= 1e-9 * x.abs();
    Some(values[xs.iter().position(close)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verify_line_and_r_squared() {
        let exact = line_through(&[(0.0, 1.0), (1.0, 3.0), (2.0, 5.0)]);
        assert!((exact.slope - 2.0).abs() < 1e-12 && (exact.r_squared - 1.0).abs() < 1e-12);
        let bent = line_through(&[(0.0, 0.0), (1.0, 0.0), (2.0, 3.0)]);
        assert!((bent.slope - 1.5).abs() < 1e-12 && (bent.r_squared - 0.75).abs() < 1e-12);
    }

    #[test]
    fn values_are_found_at_their_place() {
        assert_eq!(at(&[1e6, 2e6], &[3.0, 4.0], 2e6), Some(4.0));
        assert_eq!(at(&[1e6, 2e6], &[3.0, 4.0], 1.5e6), None);
        assert_eq!(range([2.0, -1.0].into_iter()), (-1.0, 2.0));
    }
}
