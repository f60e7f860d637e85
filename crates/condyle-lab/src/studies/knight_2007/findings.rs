//! What the runs found, as numbers.

use condyle_report::{Region, Side};
use serde::Serialize;

use super::series::{above_percent, at, line_through, range};
use super::{
    error::StudyError,
    ran::{Ran, TableOf, reference},
};

/// End of stance, % of the cycle.
const STANCE_END_PERCENT: f64 = 60.0;
/// Depth above which a face counts as part of a scar, as a share of the largest depth.
const SCAR_SHARE: f64 = 0.05;

/// What the runs found; units are in the names.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Findings {
    /// Volume worn against the updates it was computed with, force control.
    pub volume_loss_mm3: Vec<OverUpdates>,
    /// Volume of 1 x 5M above that of 10 x 500k, force control.
    pub volume_1_against_10_percent: f64,
    /// The same in displacement control.
    pub volume_1_against_10_displacement_percent: f64,
    /// Peak pressure of the last cycle that 5 x 1M solves above that of 40 x 125k at the same cycles.
    pub pressure_5_against_40_percent: f64,
    /// The same of the largest contact area.
    pub area_5_against_40_percent: f64,
    /// Deepest wear against the updates.
    pub max_depth_mm: Vec<OverUpdates>,
    /// Deepest wear of 40 x 125k above that of 10 x 500k.
    pub depth_40_against_10_percent: f64,
    /// Largest and smallest excess of the depth over that of 40 updates, at the same cycles, from
    /// a fifth of the test on.
    pub depth_excess: Vec<Excess>,
    /// Range of AP in the first cycle, force control.
    pub ap_range_mm: f64,
    /// Range of IE in the first cycle, force control.
    pub ie_range_deg: f64,
    /// How straight volume is in cycles, 40 updates, R2.
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
    /// Force control above displacement control.
    pub mass_force_against_displacement_percent: f64,
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
    /// Medial scar.
    pub medial: Scar,
    /// Lateral scar.
    pub lateral: Scar,
    /// Time of the solver for 10 x 500k, one core.
    pub wall_s: f64,
    /// Cycles that it solved.
    pub cycles_solved: f64,
}

/// A result against the updates it was computed with.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct OverUpdates {
    /// Updates.
    pub updates: usize,
    /// The result.
    pub value: f64,
    /// How far it lies above that of the most updates.
    pub above_finest_percent: f64,
}

/// How far a result goes above and below that of the finest run as the test goes on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Excess {
    /// Updates.
    pub updates: usize,
    /// Furthest below.
    pub least_percent: f64,
    /// Furthest above.
    pub most_percent: f64,
}

/// The scar of one side.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Scar {
    /// Deepest wear.
    pub max_depth_mm: f64,
    /// Where that is, anterior of the insert's origin.
    pub x_mm: f64,
    /// Where that is, to the right of the insert's origin.
    pub z_mm: f64,
    /// Area deeper than a twentieth of the whole insert's deepest wear.
    pub area_mm2: f64,
    /// Volume.
    pub volume_mm3: f64,
}

impl Findings {
    /// What `force` and `displacement` found, each in the order of its updates.
    pub(super) fn of(force: &[Ran], displacement: &[Ran]) -> Result<Self, StudyError> {
        let of_paper = reference(force);
        let finest = &force[force.len() - 1];
        let five = with_updates(force, 5);
        let held = &displacement[displacement.len() - 1];
        let volume_loss_mm3 = over_updates(force, |ran| ran.summary.volume_loss_mm3);
        let max_depth_mm = over_updates(force, |ran| ran.summary.max_depth_mm);
        let line = volume_line(finest)?;
        let [fall, rise] = changes_of_ie(finest)?;
        let [medial, lateral] = scars(of_paper)?;
        let [first, last] = [true, false].map(|is_first| stance_range(finest, is_first));
        Ok(Self {
            volume_1_against_10_percent: above_percent(
                force[0].summary.volume_loss_mm3,
                of_paper.summary.volume_loss_mm3,
            ),
            volume_1_against_10_displacement_percent: above_percent(
                displacement[0].summary.volume_loss_mm3,
                held.summary.volume_loss_mm3,
            ),
            pressure_5_against_40_percent: at_last_cycle(five, finest, "peak_pressure_mpa")?,
            area_5_against_40_percent: at_last_cycle(five, finest, "peak_contact_area_mm2")?,
            depth_40_against_10_percent: above_percent(
                finest.summary.max_depth_mm,
                of_paper.summary.max_depth_mm,
            ),
            depth_excess: force[..force.len() - 1]
                .iter()
                .map(|ran| excess(ran, finest))
                .collect::<Result<_, _>>()?,
            volume_loss_mm3,
            max_depth_mm,
            ap_range_mm: of_paper.summary.ap_range_mm,
            ie_range_deg: of_paper.summary.ie_range_deg,
            volume_r_squared: line.r_squared,
            volume_rate_mm3_per_million_cycles: 1e6 * line.slope,
            rate_growth_force_percent: rate_growth(of_paper)?,
            rate_growth_displacement_percent: rate_growth(held)?,
            mass_force_mg: of_paper.summary.mass_loss_mg,
            mass_displacement_mg: held.summary.mass_loss_mg,
            mass_force_against_displacement_percent: above_percent(
                of_paper.summary.mass_loss_mg,
                held.summary.mass_loss_mg,
            ),
            ie_stance_range_first_deg: first?,
            ie_stance_range_last_deg: last?,
            ie_stance_largest_fall_deg: -fall.1,
            ie_stance_largest_fall_at_percent: fall.0,
            ie_stance_largest_rise_deg: rise.1,
            ie_stance_largest_rise_at_percent: rise.0,
            medial,
            lateral,
            wall_s: of_paper.summary.wall_s,
            cycles_solved: of_paper.summary.cycles_solved,
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
        let interval = ran.summary.cycles / ran.updates as f64;
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
    let (cycles, depth) = depths(ran)?;
    let (known_cycles, known_depth) = depths(finest)?;
    let from = FROM_SHARE * ran.summary.cycles * (1.0 - 1e-9);
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

/// Cycles and deepest wear after every update.
fn depths(ran: &Ran) -> Result<(&[f64], &[f64]), StudyError> {
    Ok((
        ran.column(TableOf::Wear, "cycles")?,
        ran.column(TableOf::Wear, "max_depth_mm")?,
    ))
}

fn volumes(ran: &Ran) -> Result<Vec<(f64, f64)>, StudyError> {
    let cycles = ran.column(TableOf::Wear, "cycles")?;
    let volumes = ran.column(TableOf::Wear, "volume_loss_mm3")?;
    let after = cycles.iter().copied().zip(volumes.iter().copied());
    Ok([(0.0, 0.0)].into_iter().chain(after).collect())
}

fn volume_line(ran: &Ran) -> Result<super::series::Line, StudyError> {
    Ok(line_through(&volumes(ran)?))
}

/// The wear of the last interval above that of the first.
fn rate_growth(ran: &Ran) -> Result<f64, StudyError> {
    let volumes = volumes(ran)?;
    let worn = |end: usize| volumes[end].1 - volumes[end - 1].1;
    Ok(above_percent(worn(volumes.len() - 1), worn(1)))
}

/// (percent, IE in degrees) through stance of the first cycle or the last.
fn stance_ie(ran: &Ran, is_first: bool) -> Result<Vec<(f64, f64)>, StudyError> {
    let cycles = ran.column(TableOf::Kinematics, "cycles")?;
    let percent = ran.column(TableOf::Kinematics, "percent")?;
    let ie = ran.column(TableOf::Kinematics, "ie_deg")?;
    let rows = cycles.iter().zip(percent).zip(ie);
    let wanted = rows.filter(|((cycles, percent), _)| {
        (**cycles == 0.0) == is_first && **percent <= STANCE_END_PERCENT
    });
    Ok(wanted.map(|((_, percent), ie)| (*percent, *ie)).collect())
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

/// The medial scar and the lateral one.
fn scars(ran: &Ran) -> Result<[Scar; 2], StudyError> {
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
            area_mm2: surface.area_above(depth, threshold, region),
            volume_mm3: surface.integral(depth, region),
        })
    };
    Ok(match ran.results.side {
        Side::Right => [Region::Left, Region::Right].map(scar),
        Side::Left => [Region::Right, Region::Left].map(scar),
    })
}
